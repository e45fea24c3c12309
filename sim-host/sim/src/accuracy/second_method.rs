//! A second opinion on an error, from a method of another kind.
//!
//! Runs of one method may share a fault: then they agree, and their difference says nothing. So a result is looked at by a fixed-step
//! method as well, at a step and at half of it. What separates the result from the second run should be less than what separates the two;
//! where it is more, or the outcome of one is another, the step is halved again: an error of the steps shrinks with them, a fault of the
//! result stays. Each number is looked at by itself: fixed steps find peaks of the rotation far closer than those of the acceleration,
//! which they see at their ends alone.

use super::answer::{Answer, Comparable};
use super::estimate::{Compared, ErrorEstimate};
use super::level::Accuracy;

/// Most runs by a method that differ.
const MOST_RUNS: usize = 5;

/// The smallest factor of its step, for steps that the samples of a record shorten: half of them is the same run again.
const SMALLEST_FACTOR: f64 = 1.0 / 64.0;

/// Relative differences that rounding alone may make between two methods.
const ROUNDING: f64 = 1e-11;

/// Whether `value`, known to within `error`, is as close to `fine` as `coarse` is.
fn agrees(value: Option<f64>, error: f64, coarse: Option<f64>, fine: Option<f64>) -> bool {
    let (Some(value), Some(coarse), Some(fine)) = (value, coarse, fine) else { return true };
    (value - fine).abs() <= (coarse - fine).abs() + error + ROUNDING * value.abs()
}

/// `error` of `found` after a look by `run`: larger for those numbers to which that method does not come closer. None where it cannot follow
/// the motion.
fn looked_at<O: PartialEq, F>(
    mut error: ErrorEstimate,
    found: &Compared<O>,
    mut run: impl FnMut(f64) -> Result<Option<Compared<O>>, F>,
) -> Result<Option<ErrorEstimate>, F> {
    let (mut factor, mut runs) = (1.0, 1);
    let (mut alike, mut apart) = (true, [true; 3]);
    let Some(mut coarse) = run(factor)? else { return Ok(None) };
    while runs < MOST_RUNS && factor > SMALLEST_FACTOR {
        factor *= 0.5;
        let Some(fine) = run(factor)? else { return Ok(None) };
        let (own, errors) = (found.numbers(), error.errors().map(|error| *error));
        let (before, after) = (coarse.numbers(), fine.numbers());
        apart = core::array::from_fn(|i| !agrees(own[i], errors[i], before[i], after[i]));
        alike = [&coarse, &fine].iter().all(|run| run.outcome == found.outcome);
        if alike && apart == [false; 3] {
            return Ok(Some(error));
        }
        runs += usize::from(fine != coarse);
        coarse = fine;
    }
    error.widen(found, &coarse, apart);
    error.outcome_certain &= alike;
    Ok(Some(error))
}

impl<R: Comparable> Answer<R> {
    /// Compares the result with `run`, the same motion by one of other `methods` at its step times the given factor, and takes the errors of
    /// those numbers larger to which that does not come closer. The next method looks where the one before does not confirm what `accuracy`
    /// asks for: then the closer one counts. `run` gives none where a method cannot follow the motion.
    ///
    /// # Errors
    /// The errors of `run`.
    pub fn confirm<M: Copy, F>(
        &mut self,
        accuracy: Accuracy,
        methods: &[M],
        mut run: impl FnMut(M, f64) -> Result<Option<Compared<R::Outcome>>, F>,
    ) -> Result<(), F> {
        let found = self.result.compared();
        let as_wanted =
            |error: &ErrorEstimate| accuracy.wanted().is_none_or(|wanted| error.relative(found.peak_rotation) <= wanted);
        let mut confirmed: Option<ErrorEstimate> = None;
        for &method in methods {
            let Some(error) = looked_at(self.error, &found, |factor| run(method, factor))? else { break };
            let closer = confirmed.map_or(error, |before| before.closer(error));
            confirmed = Some(closer);
            if as_wanted(&closer) {
                break;
            }
        }
        if let Some(error) = confirmed {
            self.error = error;
            self.as_wanted &= as_wanted(&error);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use sprag_shared::math;

    use super::*;
    use crate::accuracy::Closeness;

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

    /// An answer of `peak` that claims to be good to rounding, after a look by two methods, of which `other` has what they find of a step.
    fn seen(peak: f64, mut other: impl FnMut(u8, f64) -> Compared<bool>) -> Answer<Peak> {
        let error =
            ErrorEstimate { outcome_certain: true, peak_rotation: 7e-14, peak_acceleration: 2e-13, first_impact_time: 0.0 };
        let closeness = Closeness { tolerance: 1e-15 };
        let mut answer = Answer { result: Peak(peak), error, closeness, as_wanted: true };
        answer.confirm::<_, ()>(Accuracy::Error(1e-9), &[1, 2], |method, factor| Ok(Some(other(method, factor)))).unwrap();
        answer
    }

    fn confirmed(peak: f64, mut other: impl FnMut(f64) -> f64) -> Answer<Peak> {
        seen(peak, |_, factor| compared(other(factor)))
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
    fn a_peak_that_steps_pass_over_leaves_the_others_their_errors() {
        let answer =
            seen(0.5, |_, factor| Compared { peak_acceleration: Some(0.99), ..compared(0.5 + 1e-3 * math::pow(factor, 4.0)) });
        assert!(answer.error.peak_acceleration >= 0.01, "{:?}", answer.error);
        assert!(answer.error.peak_rotation == 7e-14 && answer.as_wanted, "{:?}", answer.error);
    }

    #[test]
    fn a_method_that_cannot_follow_says_nothing() {
        let mut answer = confirmed(0.5, |_| 0.5);
        answer.confirm::<_, ()>(Accuracy::Tight, &[1, 2], |_, _| Ok(None)).unwrap();
        assert!(answer.error.peak_rotation == 7e-14);
    }

    /// A clutch with backlash, of which the first method is coarse.
    #[test]
    fn the_closer_of_two_methods_counts() {
        let error =
            |method: u8, factor: f64| if method == 1 { 1e-3 * math::pow(factor, 0.1) } else { 1e-6 * math::pow(factor, 4.0) };
        let answer = seen(0.5, |method, factor| compared(0.5 + error(method, factor)));
        assert!(answer.error.peak_rotation == 7e-14 && answer.as_wanted, "{:?}", answer.error);
        let answer = seen(0.5, |method, factor| compared(0.5 + 1e-5 / f64::from(method) + error(2, factor)));
        assert!((answer.error.peak_rotation / 7.5e-6 - 1.0).abs() < 1e-3 && !answer.as_wanted, "{:?}", answer.error);
    }

    #[test]
    fn steps_that_samples_shorten_are_halved_until_they_differ() {
        let answer = confirmed(0.5, |factor: f64| 0.5 + 1e-5 * math::pow(factor.min(1.0 / 16.0), 4.0));
        assert!(answer.error.peak_rotation == 7e-14 && answer.as_wanted, "{:?}", answer.error);
    }
}
