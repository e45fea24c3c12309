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
