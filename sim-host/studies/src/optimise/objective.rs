//! What a choice makes small: how many motions overturn the block, over the specimens of a robust study.

use crate::statistics::quantile;

/// The objective.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Objective {
    /// Specimens under which every design is tried.
    pub specimens: usize,
    /// The quantile over specimens that counts, 0 to 1; the mean without one.
    pub quantile: Option<f64>,
}

impl Objective {
    /// One specimen.
    pub const NOMINAL: Objective = Objective { specimens: 1, quantile: None };

    /// Of the numbers of motions that overturn each specimen.
    pub fn of(&self, counts: &[u64]) -> f64 {
        let counts: Vec<f64> = counts.iter().map(|count| *count as f64).collect();
        match self.quantile {
            Some(share) => quantile(&counts, share).unwrap_or(0.0),
            None => counts.iter().sum::<f64>() / counts.len().max(1) as f64,
        }
    }
}
