//! In a program without PNG a figure is SVG only.

use std::collections::BTreeSet;

pub use crate::part::Missing as PngError;
use crate::part::Part;

/// A picture of dots: there is none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Png {
    /// The file.
    pub bytes: Vec<u8>,
    /// Characters that the font does not have.
    pub missing: BTreeSet<char>,
}

/// Refuses to draw.
pub fn png(_svg: &str) -> Result<Png, PngError> {
    Err(PngError(Part::PNG))
}
