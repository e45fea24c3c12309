//! Compliant foundation: a spring and a dashpot under each toe of the block.

use core::f64::consts::TAU;

use super::error::{ParameterError, require};

/// A foundation by what the block does on it: with m its mass, k and c of each of the two feet,
///
/// ω_v = √(2k/m) = 2π f_v,  ζ = c/√(2km).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foundation {
    /// f_v, natural frequency of the block moving up and down on both feet, Hz; 0.5 to 1000.
    pub vertical_frequency: f64,
    /// ζ, damping ratio of that motion; 0 to 2.
    pub damping_ratio: f64,
}

impl Foundation {
    /// k/m of each foot, 1/s², and c/m, 1/s.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter outside its range.
    pub fn feet(&self) -> Result<(f64, f64), ParameterError> {
        let Foundation { vertical_frequency: hertz, damping_ratio: ratio } = *self;
        require("vertical_frequency", hertz, (0.5..=1000.0).contains(&hertz), "from 0.5 to 1000 Hz")?;
        require("damping_ratio", ratio, (0.0..=2.0).contains(&ratio), "from 0 to 2")?;
        let frequency = TAU * hertz;
        Ok((0.5 * frequency * frequency, ratio * frequency))
    }
}
