//! Motions and blocks of the benchmarks of records.

use sprag_shared::math;
use sprag_shared::structure::block::{Block, RECTANGLE_INERTIA_RATIO};

pub const MOTIONS: u32 = 200;
pub const STRUCTURES: u32 = 100;
pub const SECONDS: f64 = 40.0;
pub const STEP: f64 = 0.005;

/// Block number `index` of [`STRUCTURES`].
pub fn block(index: u32) -> Option<Block> {
    let (row, column) = (f64::from(index / 10), f64::from(index % 10));
    Block::new(0.5 + 0.5 * row, (8.0 + 2.0 * column).to_radians(), RECTANGLE_INERTIA_RATIO).ok()
}

/// ü_g/g of motion number `seed` of [`MOTIONS`].
pub fn motion(seed: u32) -> Vec<f64> {
    let mut state = u64::from(seed) + 1;
    let mut noise = [0.0; 2];
    let share = f64::from(seed) / f64::from(MOTIONS);
    let (peak, frequency) = (0.2 + 0.8 * share, 2.0 + 8.0 * (7.0 * share).fract());
    let value = |index: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let uniform = (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
        // Two poles, as the ground filters what comes from below.
        noise = [0.9 * noise[0] + 0.1 * uniform, 0.9 * noise[1] + 0.1 * noise[0]];
        let time = index as f64 * STEP;
        let envelope = (time / 5.0).min(1.0) * math::exp(-((time - 8.0).max(0.0)) / 8.0);
        let from_pulse = (time - 7.0) * frequency / 4.0;
        let pulse = math::exp(-from_pulse * from_pulse) * math::sin(frequency * (time - 7.0));
        peak * (0.7 * pulse + 3.0 * envelope * noise[1])
    };
    (0..=(SECONDS / STEP) as usize).map(value).collect()
}
