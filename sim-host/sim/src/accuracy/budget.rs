//! As accurate as a time affords.
//!
//! What a level costs is found by trying it, from the least accurate on, so the choice depends on the machine and its load. The results do
//! not: they are those of the level that was chosen, which is reported.

use std::time::Duration;

use super::level::Accuracy;

/// How much longer than a level the next one may take; measured ratios are below 2 (`sprag accuracy`).
const GROWTH: f64 = 2.5;

/// What is left to whom no level suffices.
const WITHOUT: &str = "without --time-budget and --accuracy it takes less, and no errors are estimated";

/// A level and what it gave.
#[derive(Clone, Debug)]
pub struct Afforded<R> {
    /// The level.
    pub accuracy: Accuracy,
    /// Result of the attempt.
    pub result: R,
    /// How long it took.
    pub took: Duration,
    /// How long all took that were run, this one the last.
    pub elapsed: Duration,
    /// Nothing more accurate was asked for.
    pub reached: bool,
}

impl<R> Afforded<R> {
    /// What `budget` affords, or that this is more than it does.
    pub fn words(&self, budget: Duration) -> String {
        let Afforded { accuracy, took, elapsed, reached, .. } = self;
        let took = format!("--accuracy {accuracy}, which took {:.3} s", took.as_secs_f64());
        if *elapsed > budget {
            let all = if elapsed == &self.took {
                format!("; {WITHOUT}")
            } else {
                format!(" ({:.3} s with what was tried before)", elapsed.as_secs_f64())
            };
            return format!("--time-budget {} does not suffice for {took}{all}", budget.as_secs_f64());
        }
        format!("the time affords {took}{}", if *reached { "" } else { "; more accuracy would take longer than there is" })
    }
}

/// Runs level after level, up to `asked` or the most accurate, as long as the next one is likely to end within `budget`. The first is
/// always run. `clock` is the time since this began.
///
/// # Errors
/// The errors of `run`.
pub fn within<R, F>(
    budget: Duration,
    asked: Option<Accuracy>,
    mut run: impl FnMut(Accuracy) -> Result<R, F>,
    mut clock: impl FnMut() -> Duration,
) -> Result<Afforded<R>, F> {
    let goal = asked.unwrap_or(Accuracy::Tight);
    let mut levels = Accuracy::LEVELS.into_iter().filter(|level| level.tolerance() > goal.tolerance()).chain([goal]);
    let mut accuracy = levels.next().unwrap_or(goal);
    let mut before = Duration::ZERO;
    loop {
        let result = run(accuracy)?;
        let now = clock();
        let took = now - before;
        before = now;
        let next = levels.next();
        match next {
            Some(next) if now + took.mul_f64(GROWTH) <= budget => accuracy = next,
            _ => return Ok(Afforded { accuracy, result, took, elapsed: now, reached: next.is_none() }),
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
    /// The relative error of the peak rotation that [`Plan::of`] stays below, unless no block rocks and stands.
    pub error: Option<f64>,
    /// What of the work the error is of.
    pub of: &'static str,
}

/// A part of the work, done to learn what all of it takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// How long all of the work is likely to take, s.
    pub seconds: f64,
    /// The relative error of the peak rotation that [`Sample::of`] stays below, unless no block rocks and stands.
    pub error: Option<f64>,
    /// What of the work the error is of.
    pub of: &'static str,
}

impl std::fmt::Display for Plan {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Plan { accuracy, seconds, error, of } = self;
        match error {
            Some(error) => {
                write!(
                    formatter,
                    "--accuracy {accuracy} affords a relative error below {error:.1e} for {of} in some {seconds:.2} s"
                )
            }
            None => write!(
                formatter,
                "--accuracy {accuracy} takes some {seconds:.2} s; no block that was tried rocks and stands, so that no peak has an error"
            ),
        }
    }
}

/// The work does not fit into the time.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TooLittleTime {
    /// Not even at the least accuracy.
    #[error(
        "--time-budget: the work with its error estimates takes some {seconds:.2} s at the least accuracy, more than the {budget} s given; {}",
        WITHOUT
    )]
    ForAnything {
        /// What it takes, s.
        seconds: f64,
        /// What there is, s.
        budget: f64,
    },
    /// Not as accurately as asked.
    #[error("--accuracy {asked} takes some {seconds:.2} s, more than the {budget} s of --time-budget; {affordable}")]
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

/// The most accurate level, up to `asked` if that is given, at which all of the work, of which `sample` does a part, is likely to end within
/// `budget`, the time that sampling takes included. `clock` is the time since any instant.
///
/// # Errors
/// [`TooLittleTime`], with what the time affords, and those of `sample`.
pub fn plan<F: From<TooLittleTime>>(
    budget: Duration,
    asked: Option<Accuracy>,
    mut sample: impl FnMut(Accuracy) -> Result<Sample, F>,
    clock: impl Fn() -> Duration,
) -> Result<Plan, F> {
    let start = clock();
    choose(budget.as_secs_f64(), asked, |accuracy| {
        let Sample { seconds, error, of } = sample(accuracy)?;
        Ok(Plan { accuracy, seconds: (clock() - start).as_secs_f64() + seconds, error, of })
    })
}

/// [`plan`] by known costs.
fn choose<F: From<TooLittleTime>>(
    budget: f64,
    asked: Option<Accuracy>,
    mut cost: impl FnMut(Accuracy) -> Result<Plan, F>,
) -> Result<Plan, F> {
    let mut affordable: Option<Plan> = None;
    let goal = asked.unwrap_or(Accuracy::Tight);
    let below = Accuracy::LEVELS.into_iter().filter(|level| level.tolerance() > goal.tolerance());
    let mut dearest = 0.0;
    for level in below.chain([goal]) {
        let plan = cost(level)?;
        dearest = plan.seconds;
        if plan.seconds > budget {
            break;
        }
        affordable = Some(plan);
    }
    match (affordable, asked) {
        (None, _) => Err(TooLittleTime::ForAnything { seconds: dearest, budget }.into()),
        (Some(plan), Some(asked)) if plan.accuracy != asked => {
            Err(TooLittleTime::ForSoMuch { asked, seconds: cost(asked)?.seconds, budget, affordable: plan }.into())
        }
        (Some(plan), _) => Ok(plan),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Levels that take 1, 2 and 4 s.
    fn afforded(budget: f64, asked: Option<Accuracy>) -> Afforded<f64> {
        let mut times = [1.0, 3.0, 7.0, 15.0].into_iter().map(Duration::from_secs_f64);
        let run = |accuracy: Accuracy| Ok::<_, ()>(accuracy.tolerance());
        within(Duration::from_secs_f64(budget), asked, run, || times.next().unwrap()).unwrap()
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
    fn cost(accuracy: Accuracy) -> Result<Plan, TooLittleTime> {
        let seconds = Accuracy::LEVELS.iter().position(|level| *level == accuracy).map_or(2.5, |index| 1.0 + index as f64);
        Ok(Plan { accuracy, seconds, error: Some(accuracy.tolerance()), of: "all" })
    }

    #[test]
    fn what_took_longer_than_there_was_is_not_called_afforded() {
        let second = Duration::from_secs(1);
        // However little time there is, the least level is run, and nothing else.
        let line = afforded(0.1, None).words(second / 10);
        assert_eq!(line, format!("--time-budget 0.1 does not suffice for --accuracy fast, which took 1.000 s; {WITHOUT}"));
        assert_eq!(
            afforded(7.0, None).words(7 * second),
            "the time affords --accuracy normal, which took 2.000 s; more accuracy would take longer than there is"
        );
        // The next level took more than was foreseen.
        assert!(afforded(7.0, None).words(2 * second).contains("(3.000 s with what was tried before)"));
    }

    #[test]
    fn a_plan_is_the_most_accurate_that_fits() {
        assert_eq!(choose(10.0, None, cost).unwrap().accuracy, Accuracy::Tight);
        assert_eq!(choose(2.2, None, cost).unwrap().accuracy, Accuracy::Normal);
        assert_eq!(choose(2.7, Some(Accuracy::Error(1e-11)), cost).unwrap().accuracy, Accuracy::Error(1e-11));
    }

    #[test]
    fn where_no_peak_has_an_error_none_is_promised() {
        let plan = cost(Accuracy::Fast).unwrap();
        assert!(plan.to_string().contains("a relative error below"), "{plan}");
        let plan = Plan { error: None, ..plan };
        let line = plan.to_string();
        assert!(line.starts_with("--accuracy fast takes some 1.00 s; ") && !line.contains("below"), "{line}");
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
