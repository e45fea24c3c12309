//! An interval that a value lies in.

use serde::Serialize;

/// An interval that holds a value with a stated confidence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Band {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Band {
    /// Both ends times `factor`, 0 or more.
    pub fn times(self, factor: f64) -> Band {
        Band { low: factor * self.low, high: factor * self.high }
    }
}
