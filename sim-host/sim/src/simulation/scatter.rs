//! How specimens of one scene scatter.

use serde::Serialize;

/// What the specimens of a Monte-Carlo run came to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Scatter {
    /// Specimens.
    pub specimens: usize,
    /// Number of specimens that overturned.
    pub overturned: usize,
    /// 5th percentile of max |θ|/α of the others.
    pub peak_rotation_05: Option<f64>,
    /// Median.
    pub peak_rotation_median: Option<f64>,
    /// 95th percentile.
    pub peak_rotation_95: Option<f64>,
}
