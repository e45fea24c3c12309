//! The user's words for accuracy.

use std::str::FromStr;

/// How accurate a result shall be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Accuracy {
    /// Errors that no picture shows: [`FAST`].
    Fast,
    /// Errors that no later calculation notices: [`NORMAL`].
    Normal,
    /// To rounding: [`TIGHT`].
    Tight,
    /// The relative error of the peak rotation is to stay below this number, [`SMALLEST_ERROR`] to [`LARGEST_ERROR`].
    Error(f64),
}

/// Tolerance of the series behind [`Accuracy::Fast`].
pub const FAST: f64 = 1e-5;
/// Tolerance of the series behind [`Accuracy::Normal`].
pub const NORMAL: f64 = 1e-10;
/// Tolerance of the series behind [`Accuracy::Tight`].
pub const TIGHT: f64 = crate::batch::case::TIGHT;

/// The smallest error that may be asked for: below it is only rounding.
pub const SMALLEST_ERROR: f64 = 1e-15;
/// The largest error that may be asked for.
pub const LARGEST_ERROR: f64 = 0.1;

impl Accuracy {
    /// The three levels, from the least accurate.
    pub const LEVELS: [Accuracy; 3] = [Accuracy::Fast, Accuracy::Normal, Accuracy::Tight];

    /// What a word or a number for it must be.
    pub fn expected() -> String {
        format!(
            "must be fast, normal, tight, or a relative error of the peak rotation from {SMALLEST_ERROR:e} to {LARGEST_ERROR}"
        )
    }

    /// The tolerance of the series to begin with.
    pub fn tolerance(self) -> f64 {
        match self {
            Accuracy::Fast => FAST,
            Accuracy::Normal => NORMAL,
            Accuracy::Tight => TIGHT,
            // The error of most motions is some ten times the tolerance; those of which it is more are followed again.
            Accuracy::Error(error) => (0.1 * error).clamp(TIGHT, 1e-2),
        }
    }

    /// The largest relative error of the peak rotation that will do, where there is one.
    pub fn wanted(self) -> Option<f64> {
        match self {
            Accuracy::Error(error) => Some(error),
            _ => None,
        }
    }
}

impl std::fmt::Display for Accuracy {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Accuracy::Fast => formatter.write_str("fast"),
            Accuracy::Normal => formatter.write_str("normal"),
            Accuracy::Tight => formatter.write_str("tight"),
            Accuracy::Error(error) => write!(formatter, "{error:e}"),
        }
    }
}

impl FromStr for Accuracy {
    type Err = String;

    fn from_str(text: &str) -> Result<Accuracy, String> {
        let level = Accuracy::LEVELS.into_iter().find(|level| level.to_string() == text);
        let error = || text.parse().ok().filter(|error| (SMALLEST_ERROR..=LARGEST_ERROR).contains(error)).map(Accuracy::Error);
        level.or_else(error).ok_or_else(Accuracy::expected)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_and_numbers_read_back() {
        for level in [Accuracy::Fast, Accuracy::Normal, Accuracy::Tight, Accuracy::Error(1e-6), Accuracy::Error(0.1)] {
            assert_eq!(level.to_string().parse(), Ok(level));
        }
        for wrong in ["", "loose", "0", "-1e-3", "1", "nan", "1e-16", "FAST"] {
            assert!(wrong.parse::<Accuracy>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_closer_level_has_a_smaller_tolerance() {
        let tolerances: Vec<f64> = Accuracy::LEVELS.iter().map(|level| level.tolerance()).collect();
        assert!(tolerances.is_sorted_by(|a, b| a > b));
        assert!(Accuracy::Error(1e-12).tolerance() < Accuracy::Error(1e-3).tolerance());
        assert_eq!(Accuracy::Error(SMALLEST_ERROR).tolerance(), TIGHT);
    }
}
