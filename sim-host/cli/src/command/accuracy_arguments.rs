//! The options by which every command is told how accurate to be.

use std::time::{Duration, Instant};

use clap::Args;
use sprag_sim::accuracy::{Accuracy, budget};

/// How accurate, and how long it may take.
#[derive(Args, Clone, Debug, Default)]
pub struct AccuracyArguments {
    /// fast, normal, tight, or the relative error wanted of the peak rotation, such as 1e-6; reports errors with the results.
    #[arg(long, value_name = "LEVEL")]
    pub accuracy: Option<Accuracy>,
    /// Be as accurate as this many seconds allow, with all runs that errors are estimated by; says what accuracy that is, so that --accuracy
    /// gives the same again, and where even the least takes longer.
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub time_budget: Option<Duration>,
}

impl AccuracyArguments {
    /// The change of a scene that `accuracy` asks for; it takes the place of the scene's own `[accuracy]`.
    pub fn change(accuracy: Accuracy) -> String {
        match accuracy {
            Accuracy::Error(error) => format!("accuracy={{ level = {error:e} }}"),
            word => format!("accuracy={{ level = \"{word}\" }}"),
        }
    }

    /// Runs `command` with the changes of a scene that these options ask for, as [`AccuracyArguments::levels`].
    ///
    /// # Errors
    /// Those of `command`.
    pub fn run<R, F>(&self, mut command: impl FnMut(Option<String>) -> Result<R, F>, tell: impl FnOnce(&str)) -> Result<R, F> {
        self.levels(|accuracy| command(accuracy.map(AccuracyArguments::change)), tell)
    }

    /// Runs `command` as accurately as these options ask, if they do; within a time budget as accurately as that affords, which is told to
    /// `tell`.
    ///
    /// # Errors
    /// Those of `command`.
    pub fn levels<R, F>(
        &self,
        mut command: impl FnMut(Option<Accuracy>) -> Result<R, F>,
        tell: impl FnOnce(&str),
    ) -> Result<R, F> {
        let Some(seconds) = self.time_budget else { return command(self.accuracy) };
        let start = Instant::now();
        let found = budget::within(seconds, self.accuracy, |accuracy| command(Some(accuracy)), || start.elapsed())?;
        tell(&found.words(seconds));
        Ok(found.result)
    }
}

/// The longest time budget, s: a day.
const LONGEST: f64 = 86_400.0;

fn seconds(text: &str) -> Result<Duration, String> {
    match text.parse::<f64>() {
        Ok(seconds) if (1e-3..=LONGEST).contains(&seconds) => Ok(Duration::from_secs_f64(seconds)),
        _ => Err(format!("must be a number of seconds from 0.001 to {LONGEST}")),
    }
}
