//! The least accurate of many results.

use serde::Serialize;

use super::estimate::ErrorEstimate;

/// What is known of the errors of many results. Does not depend on their order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Worst {
    /// The largest relative error of a peak rotation, of results whose outcome is certain; none where none of them rocks and stands.
    pub peak_rotation_relative: Option<f64>,
    /// Results whose outcome is in doubt.
    pub outcomes_in_doubt: u64,
    /// Number of all results.
    pub results: u64,
}

impl Worst {
    /// Takes one more into account.
    pub fn note(&mut self, error: &ErrorEstimate, peak: Option<f64>) {
        self.results += 1;
        if error.outcome_certain {
            self.peak_rotation_relative = self.peak_rotation_relative.into_iter().chain(error.of_peak(peak)).reduce(f64::max);
        } else {
            self.outcomes_in_doubt += 1;
        }
    }
}

impl std::fmt::Display for Worst {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Worst { peak_rotation_relative, outcomes_in_doubt, results } = self;
        write!(formatter, "of {results} runs {outcomes_in_doubt} outcomes are in doubt; ")?;
        match peak_rotation_relative {
            Some(relative) => write!(formatter, "peaks of the others are within {relative:.1e} of themselves"),
            None => write!(formatter, "none of the others rocks and stands, so that no peak has an error"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn doubtful_results_do_not_set_the_error_of_the_others() {
        let of = |outcome_certain, peak_rotation| ErrorEstimate {
            outcome_certain,
            peak_rotation,
            peak_acceleration: 0.0,
            first_impact_time: 0.0,
        };
        let mut worst = Worst::default();
        worst.note(&of(true, 1e-9), Some(0.5));
        worst.note(&of(false, 3.0), Some(0.5));
        worst.note(&of(true, 1e-3), None);
        assert_eq!(worst.to_string(), "of 3 runs 1 outcomes are in doubt; peaks of the others are within 2.0e-9 of themselves");
        assert_eq!(worst, Worst { peak_rotation_relative: Some(2e-9), outcomes_in_doubt: 1, results: 3 });
    }

    /// A block that overturns or does not rock has no peak that could err.
    #[test]
    fn results_without_a_peak_have_no_error_of_one() {
        let certain = ErrorEstimate { outcome_certain: true, peak_rotation: 0.0, peak_acceleration: 0.0, first_impact_time: 0.0 };
        let mut worst = Worst::default();
        worst.note(&certain, None);
        worst.note(&certain, Some(0.0));
        assert_eq!(worst, Worst { peak_rotation_relative: None, outcomes_in_doubt: 0, results: 2 });
        let words = "of 2 runs 0 outcomes are in doubt; none of the others rocks and stands, so that no peak has an error";
        assert_eq!(worst.to_string(), words);
    }
}
