//! A result with its error, made as accurate as asked.

use sprag_shared::math;

use super::estimate::{Checks, Compared, ErrorEstimate};
use super::level::{Accuracy, FAST, TIGHT};

/// How closely a motion is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closeness {
    /// Size of the last terms of the series over the rotation that matters.
    pub tolerance: f64,
}

impl From<Accuracy> for Closeness {
    fn from(accuracy: Accuracy) -> Closeness {
        Closeness { tolerance: accuracy.tolerance() }
    }
}

impl Closeness {
    /// Steps of a fourth-order method to a control tick that follow a plant so closely; one at the tolerance of [`Accuracy::Fast`].
    pub fn steps_per_tick(self) -> u32 {
        let steps = math::pow(FAST / self.tolerance, 0.25).round();
        steps.clamp(1.0, 1000.0) as u32
    }
}

/// How runs of one motion at two tolerances lay their steps, which decides what their difference says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Steps {
    /// As long as the series or the ground allows; where the ground allows less, a smaller tolerance changes next to nothing.
    Free,
    /// As [`Steps::Free`], of a device with a memory: steps that end at the same events share a part of their error.
    BetweenEvents,
    /// Of equal length, which a smaller tolerance always makes smaller.
    Equal,
}

impl Steps {
    /// What differences are taken times.
    fn factor(self) -> f64 {
        match self {
            Steps::BetweenEvents => 2.0,
            Steps::Free | Steps::Equal => 1.0,
        }
    }

    /// Relative difference up to which a check repeats the result; `floor` is the error that no comparison can exclude.
    fn repeat_within(self, floor: f64) -> f64 {
        match self {
            Steps::Free | Steps::BetweenEvents => floor,
            Steps::Equal => 0.0,
        }
    }
}

/// A result that says what of it can be compared.
pub trait Comparable {
    /// How it may end.
    type Outcome: PartialEq;

    /// What is compared.
    fn compared(&self) -> Compared<Self::Outcome>;
}

/// A result and its error.
#[derive(Clone, Debug)]
pub struct Answer<R> {
    /// The result.
    pub result: R,
    /// Error of the result.
    pub error: ErrorEstimate,
    /// How closely it was followed.
    pub closeness: Closeness,
    /// False where an error was asked for that rounding, or the motion's own sensitivity, does not allow.
    pub as_wanted: bool,
}

/// Tolerance of a check over that of the result.
const CLOSER: f64 = 1e-3;

/// The largest tolerance of a check: with more, outcomes near a boundary may be wrong, and wrongly taken for certain.
const LARGEST_CHECK: f64 = 1e-10;

/// Tolerances of the checks of a result that is as close as rounding allows: they change nothing but where steps end.
const AS_CLOSE: [f64; 2] = [0.1 * TIGHT, 0.01 * TIGHT];

/// What a tolerance shrinks to when the error was too large.
const NEXT: f64 = 1e-3;

/// Follows a motion by `run`, which lays `steps`, and again to learn the error, until that is as small as `accuracy` asks.
///
/// # Errors
/// The errors of `run`.
pub fn answer<R: Comparable, F>(
    accuracy: Accuracy,
    steps: Steps,
    mut run: impl FnMut(Closeness) -> Result<R, F>,
) -> Result<Answer<R>, F> {
    let mut tolerance = accuracy.tolerance();
    loop {
        let closeness = Closeness { tolerance };
        let result = run(closeness)?;
        let found = result.compared();
        let mut check = |tolerance| -> Result<Compared<R::Outcome>, F> { Ok(run(Closeness { tolerance })?.compared()) };
        let mut error = if tolerance > 100.0 * TIGHT {
            let closer = (CLOSER * tolerance).clamp(AS_CLOSE[0], LARGEST_CHECK);
            let how = Checks::Closer(closer);
            let (_, floor) = how.margins();
            let mut checks = vec![check(closer)?];
            if found.repeats(&checks[0], steps.repeat_within(floor)) {
                checks.push(check(AS_CLOSE[0])?);
            }
            ErrorEstimate::of(&found, &checks, how)
        } else {
            ErrorEstimate::of(&found, &[check(AS_CLOSE[0])?, check(AS_CLOSE[1])?], Checks::AsClose)
        };
        error.enlarge(steps.factor());
        let as_wanted = accuracy.wanted().is_none_or(|wanted| error.relative(found.peak_rotation) <= wanted);
        if as_wanted || tolerance <= TIGHT {
            return Ok(Answer { result, error, closeness, as_wanted });
        }
        tolerance = (NEXT * tolerance).max(TIGHT);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1/3 with an error of a thousand times the tolerance, and another outcome where that is more than `margin`.
    struct Third {
        error: f64,
        margin: f64,
    }

    impl Comparable for Third {
        type Outcome = bool;

        fn compared(&self) -> Compared<bool> {
            let value = Some(1.0 / 3.0 + self.error);
            Compared {
                outcome: self.error > self.margin,
                peak_rotation: value,
                peak_acceleration: value,
                first_impact_time: None,
            }
        }
    }

    fn third(accuracy: Accuracy, margin: f64) -> Answer<Third> {
        answer::<_, ()>(accuracy, Steps::Free, |closeness| Ok(Third { error: 1e3 * closeness.tolerance, margin })).unwrap()
    }

    #[test]
    fn an_error_that_is_too_large_is_not_given() {
        for wanted in [1e-2, 1e-6, 1e-10] {
            let found = third(Accuracy::Error(wanted), 1.0);
            assert!(found.as_wanted && found.result.error * 3.0 <= wanted, "{wanted}: {found:?}", found = found.result.error);
            assert!(found.error.peak_rotation >= found.result.error && found.error.peak_rotation < 10.0 * found.result.error);
        }
    }

    #[test]
    fn what_cannot_be_had_is_said() {
        let found = third(Accuracy::Error(1e-15), 1.0);
        assert!(!found.as_wanted && found.closeness.tolerance == TIGHT);
        assert!(third(Accuracy::Fast, 1.0).as_wanted, "a level asks for no error");
    }

    /// Steps that no tolerance limits make one run of many tolerances, or nearly one, all of which err alike.
    #[test]
    fn a_run_is_not_its_own_check() {
        for drift in [0.0, 1e-6] {
            let third = |tolerance: f64| if tolerance > 1e-11 { 1e-5 + drift * tolerance } else { 10.0 * tolerance };
            let run = |closeness: Closeness| Ok::<_, ()>(Third { error: third(closeness.tolerance), margin: 1.0 });
            let wanted = [1e-2, 1e-6, 1e-9].map(Accuracy::Error);
            for accuracy in wanted.into_iter().chain([Accuracy::Fast, Accuracy::Normal]) {
                let found = answer(accuracy, Steps::Free, run).unwrap();
                let error = found.result.error;
                assert!(found.error.peak_rotation >= error, "{accuracy}, {drift}: {:?} for {error}", found.error);
                assert!(found.as_wanted);
            }
        }
    }

    /// A third run of a loop takes some six hundred steps to a tick.
    #[test]
    fn equal_steps_that_agree_have_converged() {
        let mut runs = 0;
        let run = |closeness: Closeness| {
            runs += 1;
            Ok::<_, ()>(Third { error: 1e-6 * closeness.tolerance, margin: 1.0 })
        };
        let found = answer(Accuracy::Fast, Steps::Equal, run).unwrap();
        assert!(found.error.peak_rotation >= found.result.error && runs == 2, "{:?}, {runs} runs", found.error);
    }

    #[test]
    fn a_doubtful_outcome_is_looked_at_again() {
        assert!(!third(Accuracy::Fast, 1e-4).error.outcome_certain);
        let found = third(Accuracy::Error(1e-1), 1e-4);
        assert!(found.error.outcome_certain && found.result.error < 1e-4);
    }
}
