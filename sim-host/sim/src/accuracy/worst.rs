//! The least accurate of many results.

use serde::Serialize;

use super::estimate::ErrorEstimate;

/// What is known of the errors of many results. Does not depend on their order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Worst {
    /// The largest relative error of a peak rotation, of results whose outcome is certain.
    pub peak_rotation_relative: f64,
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
            self.peak_rotation_relative = self.peak_rotation_relative.max(error.relative(peak));
        } else {
            self.outcomes_in_doubt += 1;
        }
    }
}

impl std::fmt::Display for Worst {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Worst { peak_rotation_relative, outcomes_in_doubt, results } = self;
        write!(formatter, "of {results} runs {outcomes_in_doubt} outcomes are in doubt; ")?;
        write!(formatter, "peaks of the others are within {peak_rotation_relative:.1e} of themselves")
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
        assert_eq!(worst, Worst { peak_rotation_relative: 2e-9, outcomes_in_doubt: 1, results: 3 });
    }
}
