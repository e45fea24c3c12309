//! Blocks of unit frequency parameter under one cycle of a sine or a cosine, followed by the core with every event logged.

use core::f64::consts::TAU;

use sprag_shared::motion::state::BlockState;
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::DeviceKind;
use sprag_sim::batch::case::PulseShape;

use crate::{FullLog, Segment, shake, unit_block};

/// A block and its pulse; σ = 0.5 and η = 0.85, the paper's.
#[derive(Clone, Copy, Debug)]
pub struct Pulsed {
    /// Full or slender.
    pub geometry: Geometry,
    /// α, degrees.
    pub degrees: f64,
    /// Its device.
    pub device: DeviceKind,
    /// Shape of the pulse.
    pub shape: PulseShape,
    /// ω_g/p.
    pub frequency: f64,
    /// a_g over the uplift threshold.
    pub amplitude: f64,
}

impl Pulsed {
    /// The block with its device.
    pub fn structure(&self) -> Structure {
        unit_block(self.geometry, self.degrees, self.device, 0.5, 0.85)
    }

    /// The state `until` 1/p after the pulse begins, and what happened before; the pulse is over after 2π/ω_g.
    pub fn follow(&self, until: f64) -> (BlockState<f64>, FullLog) {
        let structure = self.structure();
        let level = self.amplitude * self.geometry.uplift_threshold(structure.block.slenderness());
        let end = TAU / self.frequency;
        let pulse = match self.shape {
            PulseShape::Sine => Segment::sine(level, self.frequency, end.min(until)),
            PulseShape::Cosine => Segment::cosine(level, self.frequency, end.min(until)),
        };
        let segments = [pulse, Segment::quiet((until - end).max(0.0))];
        shake(&structure, &segments[..if until > end { 2 } else { 1 }])
    }
}
