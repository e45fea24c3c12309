//! Impacts that differ (`docs/modes.md`, Impact).

use std::f64::consts::TAU;

use crate::random::{GAMMA, Random};
use crate::scene::BlockTable;

/// Words that one impact has for its draws.
const WORDS: u64 = 256;

/// Scatter of η from impact to impact.
#[derive(Clone, Copy, Debug)]
pub struct Scatter {
    /// Standard deviation of η; 0 for none.
    pub deviation: f64,
    /// Of the draws.
    pub seed: u64,
}

impl Scatter {
    /// Of a scene's block.
    pub fn of(table: &BlockTable) -> Scatter {
        Scatter { deviation: table.restitution_scatter, seed: table.restitution_seed }
    }

    /// η of impact number `impact`, from 1, where `mean` is that of all: Box and Muller's normal deviates by turns, until one is possible.
    pub fn drawn(&self, impact: u32, mean: f64) -> f64 {
        if self.deviation == 0.0 {
            return mean;
        }
        let stream = Random::new(self.seed).next_u64();
        let before = (WORDS * u64::from(impact) - 1).wrapping_mul(GAMMA);
        let mut words = Random::new(stream.wrapping_add(before));
        for _ in 0..WORDS / 2 {
            let (u, v) = (1.0 - words.between(0.0, 1.0), words.between(0.0, 1.0));
            let eta = mean + self.deviation * (-2.0 * u.ln()).sqrt() * (TAU * v).cos();
            if (f64::MIN_POSITIVE..=1.0).contains(&eta) {
                return eta;
            }
        }
        mean
    }
}
