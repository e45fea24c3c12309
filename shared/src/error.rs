//! What a parameter may be, and the error that says it is not.

use core::fmt;

/// A parameter outside its range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterError {
    /// The parameter, as its field is named.
    pub parameter: &'static str,
    /// What it was.
    pub value: f64,
    /// What it may be.
    pub range: &'static str,
}

impl fmt::Display for ParameterError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} is {}, but must be {}", self.parameter, self.value, self.range)
    }
}

impl core::error::Error for ParameterError {}

/// `value`, if `allowed`; NaN never is.
pub(crate) fn require(parameter: &'static str, value: f64, allowed: bool, range: &'static str) -> Result<f64, ParameterError> {
    if allowed && value.is_finite() { Ok(value) } else { Err(ParameterError { parameter, value, range }) }
}
