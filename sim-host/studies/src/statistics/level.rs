//! Confidence levels, and the bands that hold at them.

use serde::Serialize;

use super::{normal, student};

/// The probability with which a band holds what it is for: more than 0, less than 1.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize)]
#[serde(transparent)]
pub struct Level(f64);

/// A confidence level outside its range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("confidence level {value}: allowed is more than 0 and less than 1")]
pub struct LevelError {
    /// The level asked for.
    pub value: f64,
}

impl Level {
    /// 95 %.
    pub const COMMON: Level = Level(0.95);

    /// The level `value`.
    ///
    /// # Errors
    ///
    /// [`LevelError`] unless 0 < `value` < 1.
    pub fn new(value: f64) -> Result<Level, LevelError> {
        if value > 0.0 && value < 1.0 { Ok(Level(value)) } else { Err(LevelError { value }) }
    }

    /// Value of the level.
    pub fn value(self) -> f64 {
        self.0
    }

    /// The shares of a distribution below the ends of its central band, (1 ∓ level)/2.
    pub fn shares(self) -> [f64; 2] {
        [0.5 * (1.0 - self.0), 0.5 * (1.0 + self.0)]
    }

    /// Half-width of the central band of a normal distribution in standard deviations: 1.96 at 95 %.
    pub fn normal(self) -> f64 {
        -normal::quantile(self.shares()[0])
    }

    /// Half-width of the central band of Student's t distribution with `freedom` ≥ 1 degrees of freedom.
    pub fn student(self, freedom: u32) -> f64 {
        student::central_quantile(self.0, freedom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_probabilities_are_levels() {
        for value in [0.0, 1.0, -0.5, 95.0, f64::NAN, f64::INFINITY] {
            let error = Level::new(value).unwrap_err();
            assert!(error.to_string().starts_with(&format!("confidence level {value}: allowed is more than 0")));
        }
        assert_eq!(Level::new(0.95), Ok(Level::COMMON));
        assert_eq!(Level::COMMON.value(), 0.95);
    }

    #[test]
    fn half_widths_are_those_of_tables() {
        assert!((Level::COMMON.normal() - 1.959963984540054).abs() < 1e-14);
        assert!((Level::COMMON.student(10) - 2.2281388519862744).abs() < 1e-13);
        let [low, high] = Level::COMMON.shares();
        assert!((low - 0.025).abs() < 1e-16 && (high - 0.975).abs() < 1e-15);
        assert_eq!(serde_json::to_string(&Level::COMMON).unwrap(), "0.95");
    }
}
