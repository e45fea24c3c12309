//! As accurate as a time affords.
//!
//! What a level costs is found by trying it, from the least accurate on, so the choice depends on the machine and its load. The results do
//! not: they are those of the level that was chosen, which is reported.

use std::time::{Duration, Instant};

use super::level::Accuracy;

/// How much longer than a level the next one may take; measured ratios are below 2 (`sprag accuracy`).
const GROWTH: f64 = 2.5;

/// A level and what it gave.
#[derive(Clone, Debug)]
pub struct Afforded<R> {
    /// The level.
    pub accuracy: Accuracy,
    /// Its result.
    pub result: R,
    /// How long it took.
    pub took: Duration,
    /// Nothing more accurate was asked for.
    pub reached: bool,
}

/// Runs level after level, up to `asked` or the most accurate, as long as the next one is likely to end within `budget`. The first is
/// always run.
///
/// # Errors
/// Those of `run`.
pub fn within<R, F>(
    budget: Duration,
    asked: Option<Accuracy>,
    run: impl FnMut(Accuracy) -> Result<R, F>,
) -> Result<Afforded<R>, F> {
    let start = Instant::now();
    within_by(budget, asked, run, || start.elapsed())
}

/// [`within`] by any clock.
fn within_by<R, F>(
    budget: Duration,
    asked: Option<Accuracy>,
    mut run: impl FnMut(Accuracy) -> Result<R, F>,
    mut clock: impl FnMut() -> Duration,
) -> Result<Afforded<R>, F> {
    let goal = asked.unwrap_or(Accuracy::Tight);
    let mut levels = Accuracy::LEVELS.into_iter().filter(|level| level.tolerance() > goal.tolerance()).chain([goal]);
    let mut accuracy = levels.next().unwrap_or(goal);
    let mut before = clock();
    loop {
        let result = run(accuracy)?;
        let now = clock();
        let took = now - before;
        before = now;
        let next = levels.next();
        match next {
            Some(next) if now + took.mul_f64(GROWTH) <= budget => accuracy = next,
            _ => return Ok(Afforded { accuracy, result, took, reached: next.is_none() }),
        }
    }
}

/// What a time affords, learnt from a sample of the work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// The level.
    pub accuracy: Accuracy,
    /// How long all of the work is likely to take, s.
    pub seconds: f64,
    /// The relative error of the peak rotation that 95 % of the sample stay below.
    pub error: f64,
}

impl std::fmt::Display for Plan {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            formatter,
            "--accuracy {} affords a relative error below {:.1e} for 95 % of the cases in some {:.2} s",
            self.accuracy, self.error, self.seconds
        )
    }
}

/// The work does not fit into the time.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TooLittleTime {
    /// Not even at the least accuracy.
    #[error("--time-budget: the work takes some {seconds:.2} s at the least accuracy, more than the {budget:.3} s given")]
    ForAnything {
        /// What it takes, s.
        seconds: f64,
        /// What there is, s.
        budget: f64,
    },
    /// Not as accurately as asked.
    #[error("--accuracy {asked} takes some {seconds:.2} s, more than the {budget:.3} s of --time-budget; {affordable}")]
    ForSoMuch {
        /// What was asked.
        asked: Accuracy,
        /// What that takes, s.
        seconds: f64,
        /// What there is, s.
        budget: f64,
        /// What can be had.
        affordable: Plan,
    },
}

/// The most accurate level, up to `asked` if that is given, at which `share` times the work of `sample` is likely to end within `budget`.
/// `sample` does a share of the work and gives its error.
///
/// # Errors
/// [`TooLittleTime`], with what the time affords.
pub fn plan(
    budget: Duration,
    asked: Option<Accuracy>,
    share: f64,
    mut sample: impl FnMut(Accuracy) -> f64,
) -> Result<Plan, TooLittleTime> {
    let mut timed = |accuracy: Accuracy| {
        let start = Instant::now();
        let error = sample(accuracy);
        Plan { accuracy, seconds: share * start.elapsed().as_secs_f64(), error }
    };
    // What is touched for the first time is slow.
    timed(Accuracy::Fast);
    choose(budget.as_secs_f64(), asked, timed)
}

/// [`plan`] by known costs.
fn choose(budget: f64, asked: Option<Accuracy>, mut cost: impl FnMut(Accuracy) -> Plan) -> Result<Plan, TooLittleTime> {
    let mut affordable: Option<Plan> = None;
    let goal = asked.unwrap_or(Accuracy::Tight);
    let below = Accuracy::LEVELS.into_iter().filter(|level| level.tolerance() > goal.tolerance());
    let mut dearest = 0.0;
    for level in below.chain([goal]) {
        let plan = cost(level);
        dearest = plan.seconds;
        if plan.seconds > budget {
            break;
        }
        affordable = Some(plan);
    }
    match (affordable, asked) {
        (None, _) => Err(TooLittleTime::ForAnything { seconds: dearest, budget }),
        (Some(plan), Some(asked)) if plan.accuracy != asked => {
            Err(TooLittleTime::ForSoMuch { asked, seconds: cost(asked).seconds, budget, affordable: plan })
        }
        (Some(plan), _) => Ok(plan),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Levels that take 1, 2 and 4 s.
    fn afforded(budget: f64, asked: Option<Accuracy>) -> Afforded<f64> {
        let mut times = [0.0, 1.0, 3.0, 7.0, 15.0].into_iter().map(Duration::from_secs_f64);
        let run = |accuracy: Accuracy| Ok::<_, ()>(accuracy.tolerance());
        within_by(Duration::from_secs_f64(budget), asked, run, || times.next().unwrap()).unwrap()
    }

    #[test]
    fn more_time_is_never_less_accurate() {
        let tolerances: Vec<f64> = [0.1, 3.0, 5.0, 7.0, 20.0].into_iter().map(|budget| afforded(budget, None).result).collect();
        assert!(tolerances.is_sorted_by(|a, b| a >= b), "{tolerances:?}");
        assert_eq!(afforded(0.1, None).accuracy, Accuracy::Fast);
        assert_eq!(afforded(100.0, None).accuracy, Accuracy::Tight);
        assert!(afforded(100.0, None).reached && !afforded(0.1, None).reached);
    }

    #[test]
    fn nothing_closer_than_asked_is_run() {
        let found = afforded(100.0, Some(Accuracy::Error(1e-7)));
        assert_eq!(found.accuracy, Accuracy::Error(1e-7));
        assert!(found.reached);
        let found = afforded(1e-3, Some(Accuracy::Fast));
        assert!(found.accuracy == Accuracy::Fast && found.reached);
    }

    /// 1, 2 and 3 s for the levels, 2.5 s for anything else.
    fn cost(accuracy: Accuracy) -> Plan {
        let seconds = Accuracy::LEVELS.iter().position(|level| *level == accuracy).map_or(2.5, |index| 1.0 + index as f64);
        Plan { accuracy, seconds, error: accuracy.tolerance() }
    }

    #[test]
    fn a_plan_is_the_most_accurate_that_fits() {
        assert_eq!(choose(10.0, None, cost).unwrap().accuracy, Accuracy::Tight);
        assert_eq!(choose(2.2, None, cost).unwrap().accuracy, Accuracy::Normal);
        assert_eq!(choose(2.7, Some(Accuracy::Error(1e-11)), cost).unwrap().accuracy, Accuracy::Error(1e-11));
    }

    #[test]
    fn what_does_not_fit_is_said_with_what_does() {
        assert_eq!(choose(0.5, None, cost), Err(TooLittleTime::ForAnything { seconds: 1.0, budget: 0.5 }));
        let error = choose(2.2, Some(Accuracy::Tight), cost).unwrap_err();
        assert!(matches!(&error, TooLittleTime::ForSoMuch { affordable, .. } if affordable.accuracy == Accuracy::Normal));
        let line = error.to_string();
        assert!(line.contains("3.00 s") && line.contains("normal") && !line.contains('\n'), "{line}");
    }
}
