//! The options by which a user states how accurate a command shall be.

use std::time::{Duration, Instant};

use clap::Args;
use clap::builder::TypedValueParser as _;
use sprag_report::long_run::error::LongRunError;
use sprag_sim::accuracy::{Accuracy, budget};

use super::context::Context;

/// How accurate, and how long it may take.
#[derive(Args, Clone, Debug, Default)]
pub struct AccuracyArguments {
    /// fast, normal, tight, or the relative error wanted of the peak rotation, such as 1e-6; reports errors with the results.
    #[arg(long, value_name = "LEVEL")]
    pub accuracy: Option<Accuracy>,
    /// Be as accurate as this many seconds allow, with all runs that errors are estimated by; says what accuracy that is, so that --accuracy
    /// gives the same again, and where even the least takes longer.
    #[arg(long, value_name = "SECONDS", value_parser = super::number(super::SECONDS).map(Duration::from_secs_f64))]
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

    /// Runs `work` with the changes of a scene that these options ask for, as [`AccuracyArguments::levels`].
    ///
    /// # Errors
    /// The errors of `work`.
    pub fn run<R>(
        &self,
        context: &mut Context<'_>,
        mut work: impl FnMut(Option<String>) -> anyhow::Result<R>,
    ) -> anyhow::Result<R> {
        self.levels(context, |accuracy| work(accuracy.map(AccuracyArguments::change)))
    }

    /// Runs `work` as accurately as these options ask, if they do; within a time budget as accurately as that affords, which is reported.
    ///
    /// # Errors
    /// The errors of `work`.
    pub fn levels<R>(
        &self,
        context: &mut Context<'_>,
        mut work: impl FnMut(Option<Accuracy>) -> anyhow::Result<R>,
    ) -> anyhow::Result<R> {
        let Some(seconds) = self.time_budget else { return work(self.accuracy) };
        let start = Instant::now();
        let found = budget::within(seconds, self.accuracy, |accuracy| work(Some(accuracy)), || start.elapsed())?;
        context.note(found.words(seconds));
        Ok(found.result)
    }

    /// Whether the accuracy may be another every time.
    pub fn is_chosen(&self) -> bool {
        self.time_budget.is_some()
    }

    /// Whether finished rows can be kept, as the `option` of a long run that is given needs.
    ///
    /// # Errors
    /// [`LongRunError::NoRows`] where the accuracy may be another every time.
    pub fn keeps_rows(&self, option: Option<&'static str>) -> Result<(), LongRunError> {
        option.filter(|_| self.is_chosen()).map_or(Ok(()), |option| Err(LongRunError::NoRows { option }))
    }
}
