//! The overturning map that benchmarks go by, and the time of a pass over it.

use std::time::Instant;

use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::DeviceKind;
use sprag_sim::batch::case::{Case, PulseShape};

/// Cells along each axis.
const SIDE: u32 = 64;

/// The cells of both pulses.
pub fn cells(geometry: Geometry, device: DeviceKind) -> Vec<Case> {
    let along = |index: u32, low: f64, high: f64| low + (high - low) * f64::from(index) / f64::from(SIDE - 1);
    let mut cells = Vec::new();
    for pulse in [PulseShape::Sine, PulseShape::Cosine] {
        for row in 0..SIDE {
            for column in 0..SIDE {
                let (frequency_ratio, amplitude_ratio) = (along(column, 0.2, 8.0), along(row, 1.0, 10.0));
                cells.push(Case { geometry, device, pulse, frequency_ratio, amplitude_ratio, ..Case::default() });
            }
        }
    }
    cells
}

/// The least time of `passes` passes, s.
pub fn fastest(passes: usize, mut work: impl FnMut()) -> f64 {
    (0..passes)
        .map(|_| {
            let start = Instant::now();
            work();
            start.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min)
}
