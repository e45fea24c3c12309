//! Who watches a case: a digest, or nobody.

use sprag_shared::{
    method::dense_output::DenseOutput,
    motion::{
        device_snapshot::DeviceOutput,
        observer::{Event, MonotoneInterval, Observer},
        state::BlockState,
    },
    observers::digest::Digest,
};

/// A digest, or nobody, chosen at run time: every structure and method has one loop in flash, for cases and for kernels.
#[derive(Debug, Default)]
pub struct Watcher {
    /// The digest, if one is wanted.
    pub digest: Option<Digest>,
}

impl Observer<f32> for Watcher {
    #[inline]
    fn interval(&mut self, output: &dyn DenseOutput<f32>, interval: &MonotoneInterval<f32>) {
        if let Some(digest) = &mut self.digest {
            digest.interval(output, interval);
        }
    }

    #[inline]
    fn event(&mut self, event: Event, time: f32, state: &BlockState<f32>) {
        if let Some(digest) = &mut self.digest {
            digest.event(event, time, state);
        }
    }

    fn device_interval(&mut self, output: &dyn DeviceOutput<f32>, interval: &MonotoneInterval<f32>) {
        if let Some(digest) = &mut self.digest {
            digest.device_interval(output, interval);
        }
    }
}
