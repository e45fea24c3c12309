//! Who watches a case: a digest, or nobody.

use sprag_shared::{
    method::dense_output::Arc,
    motion::{
        device_snapshot::{DeviceArc, DeviceObserver},
        observer::{Event, Observer, Stretch},
        state::State,
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
    fn stretch(&mut self, arc: &dyn Arc<f32>, stretch: &Stretch<f32>) {
        if let Some(digest) = &mut self.digest {
            digest.stretch(arc, stretch);
        }
    }

    #[inline]
    fn event(&mut self, event: Event, time: f32, state: &State<f32>) {
        if let Some(digest) = &mut self.digest {
            Observer::event(digest, event, time, state);
        }
    }
}

impl DeviceObserver<f32> for Watcher {
    fn device_stretch(&mut self, arc: &dyn DeviceArc<f32>, stretch: &Stretch<f32>) {
        if let Some(digest) = &mut self.digest {
            digest.device_stretch(arc, stretch);
        }
    }

    fn device_event(&mut self, event: Event, time: f32, state: &State<f32>) {
        if let Some(digest) = &mut self.digest {
            digest.device_event(event, time, state);
        }
    }
}
