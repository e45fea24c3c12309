//! What a parameter may be, and the error that says it is not.

use core::fmt;

/// A parameter outside its range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterError {
    /// The parameter, as its field is named.
    pub parameter: &'static str,
    /// Value that was given.
    pub value: f64,
    /// Range that is allowed.
    pub range: &'static str,
}

impl fmt::Display for ParameterError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} is {}, but must be {}", self.parameter, Number(self.value), self.range)
    }
}

impl core::error::Error for ParameterError {}

/// A number in a message: all its digits, and a power of ten in the place of long rows of zeros.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number(pub f64);

impl fmt::Display for Number {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Number(value) = *self;
        let plain = value == 0.0 || !value.is_finite() || (1e-5..1e16).contains(&value.abs());
        if plain { write!(formatter, "{value}") } else { write!(formatter, "{value:e}") }
    }
}

/// `value`, if `allowed`; NaN never is.
pub fn require(parameter: &'static str, value: f64, allowed: bool, range: &'static str) -> Result<f64, ParameterError> {
    if allowed && value.is_finite() { Ok(value) } else { Err(ParameterError { parameter, value, range }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::format;

    #[test]
    fn no_number_is_a_row_of_zeros() {
        for (value, text) in
            [(0.5, "0.5"), (2.0, "2"), (-1100.0, "-1100"), (0.0, "0"), (1e308, "1e308"), (1e-308, "1e-308"), (f64::NAN, "NaN")]
        {
            assert_eq!(format!("{}", Number(value)), text);
            let error = ParameterError { parameter: "size", value, range: "above 0" };
            assert_eq!(format!("{error}"), format!("size is {text}, but must be above 0"));
        }
    }
}
