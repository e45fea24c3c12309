//! A second opinion on an error, from a method of another kind.
//!
//! Runs of one method may share a fault: then they agree, and their difference says nothing. So a result is looked at by a fixed-step
//! method as well, at a step and at half of it. What separates the result from the second run should be less than what separates the two;
//! where it is more, or the outcome of one is another, the step is halved again: an error of the steps shrinks with them, a fault of the
//! result stays.

use super::answer::{Answer, Comparable};
use super::estimate::Compared;
use super::level::Accuracy;

/// Most runs by the second method.
const MOST_RUNS: usize = 5;

/// Relative differences that rounding alone may make between two methods.
const ROUNDING: f64 = 1e-11;

/// Whether `value`, known to within `error`, is as close to `fine` as `coarse` is.
fn agrees(value: Option<f64>, error: f64, coarse: Option<f64>, fine: Option<f64>) -> bool {
    let (Some(value), Some(coarse), Some(fine)) = (value, coarse, fine) else { return true };
    (value - fine).abs() <= (coarse - fine).abs() + error + ROUNDING * value.abs()
}

impl<R: Comparable> Answer<R> {
    /// Compares the result with `run`, the same motion by another method at its step times the given factor, and takes the errors larger
    /// where that method does not come closer. `run` gives none where it cannot follow the motion.
    ///
    /// # Errors
    /// The errors of `run`.
    pub fn confirm<F>(
        &mut self,
        accuracy: Accuracy,
        mut run: impl FnMut(f64) -> Result<Option<Compared<R::Outcome>>, F>,
    ) -> Result<(), F> {
        let found = self.result.compared();
        let error = &mut self.error;
        let mut factor = 1.0;
        let mut alike = true;
        let Some(mut coarse) = run(factor)? else { return Ok(()) };
        for _ in 1..MOST_RUNS {
            factor *= 0.5;
            let Some(fine) = run(factor)? else { return Ok(()) };
            alike = [&coarse, &fine].iter().all(|run| run.outcome == found.outcome);
            let agreed = alike
                && agrees(found.peak_rotation, error.peak_rotation, coarse.peak_rotation, fine.peak_rotation)
                && agrees(found.peak_acceleration, error.peak_acceleration, coarse.peak_acceleration, fine.peak_acceleration)
                && agrees(found.first_impact_time, error.first_impact_time, coarse.first_impact_time, fine.first_impact_time);
            if agreed {
                return Ok(());
            }
            coarse = fine;
        }
        error.widen(&found, &coarse);
        error.outcome_certain &= alike;
        self.as_wanted &= accuracy.wanted().is_none_or(|wanted| error.relative(found.peak_rotation) <= wanted);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use sprag_shared::math;

    use super::*;
    use crate::accuracy::{Closeness, ErrorEstimate};

    /// A result whose outcome is whether its peak is above 1.
    struct Peak(f64);

    fn compared(peak: f64) -> Compared<bool> {
        Compared { outcome: peak > 1.0, peak_rotation: Some(peak), peak_acceleration: Some(2.0 * peak), first_impact_time: None }
    }

    impl Comparable for Peak {
        type Outcome = bool;

        fn compared(&self) -> Compared<bool> {
            compared(self.0)
        }
    }

    /// An answer of `peak` that claims to be good to rounding, after a look by a method that finds `other` of a step.
    fn confirmed(peak: f64, mut other: impl FnMut(f64) -> f64) -> Answer<Peak> {
        let error =
            ErrorEstimate { outcome_certain: true, peak_rotation: 7e-14, peak_acceleration: 2e-13, first_impact_time: 0.0 };
        let closeness = Closeness { tolerance: 1e-15 };
        let mut answer = Answer { result: Peak(peak), error, closeness, as_wanted: true };
        answer.confirm::<()>(Accuracy::Error(1e-9), |factor| Ok(Some(compared(other(factor))))).unwrap();
        answer
    }

    #[test]
    fn a_fault_that_all_runs_share_is_seen() {
        // Second uplift with a spinning flywheel: the series had 0.8567, Runge-Kutta 0.8532.
        let answer = confirmed(0.8567, |factor| 0.8532 + 1e-4 * math::pow(factor, 4.0));
        assert!(answer.error.peak_rotation >= 3.5e-3 - 1e-4, "{:?}", answer.error);
        assert!(answer.error.outcome_certain && !answer.as_wanted);
    }

    #[test]
    fn an_error_of_the_second_method_is_not_one_of_the_result() {
        for order in [2.0, 4.0] {
            let answer = confirmed(0.8567, |factor| 0.8567 + 1e-4 * math::pow(factor, order));
            assert!(answer.error.peak_rotation == 7e-14 && answer.as_wanted);
        }
        // Two of its runs that agree by chance.
        let answer = confirmed(0.8567, |factor| if factor > 0.3 { 0.8566 } else { 0.8567 + 1e-4 * math::pow(factor, 4.0) });
        assert!(answer.error.peak_rotation == 7e-14);
    }

    #[test]
    fn another_ending_is_a_doubt() {
        assert!(!confirmed(0.9999, |_| 1.0001).error.outcome_certain);
        assert!(confirmed(0.9999, |factor| 0.9999 + 1e-3 * math::pow(factor, 4.0)).error.outcome_certain);
        // A motion that is so sensitive that each step has its own ending.
        let turns = |factor: f64| if factor == 0.5 || factor == 0.125 { 0.9998 } else { 1.0001 };
        assert!(!confirmed(0.9999, turns).error.outcome_certain);
    }

    #[test]
    fn a_method_that_cannot_follow_says_nothing() {
        let mut answer = confirmed(0.5, |_| 0.5);
        answer.confirm::<()>(Accuracy::Tight, |_| Ok(None)).unwrap();
        assert!(answer.error.peak_rotation == 7e-14);
    }
}
