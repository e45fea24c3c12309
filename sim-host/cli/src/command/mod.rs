//! The subcommands of `sprag`: each has its arguments, which run it ([`context::Run`]).

#[cfg(feature = "effects")]
pub(crate) mod accuracy;
pub mod accuracy_arguments;
pub mod batch;
mod batch_cases;
mod batch_results;
#[cfg(feature = "effects")]
pub(crate) mod board;
#[cfg(feature = "effects")]
mod board_line;
#[cfg(feature = "effects")]
mod board_record;
#[cfg(feature = "effects")]
mod board_watch;
#[cfg(feature = "effects")]
pub(crate) mod closed_loop;
pub(crate) mod cloud;
pub(crate) mod completions;
pub mod context;
#[cfg(feature = "effects")]
pub(crate) mod design;
mod divided;
pub(crate) mod effects;
pub(crate) mod example;
pub(crate) mod explain;
#[cfg(feature = "effects")]
pub(crate) mod hil;
mod impact_specimens;
mod long_run_arguments;
#[cfg(feature = "effects")]
pub mod loop_scene;
#[cfg(feature = "effects")]
pub(crate) mod loop_study;
pub(crate) mod manual;
pub(crate) mod map;
mod map_boundaries;
pub(crate) mod new;
pub(crate) mod optimise;
pub mod out_arguments;
pub(crate) mod part;
pub(crate) mod plan;
mod read_motions;
pub(crate) mod record;
pub mod record_arguments;
mod report;
mod scene_arguments;
pub(crate) mod schema;
pub(crate) mod sensitivity;
pub(crate) mod similar;
pub(crate) mod simulate;
mod specimens;
mod study_input;
pub(crate) mod synthesize;
pub mod thread_arguments;
pub(crate) mod wrong_line;

use std::fmt::Display;
use std::ops::RangeInclusive;
use std::path::Path;
use std::str::FromStr;

use sprag_sim::keys::bounds::Bounds;

/// Reads a whole number within `range`, as an option has it.
fn whole_number<T: FromStr + PartialOrd + Display + Clone>(
    range: RangeInclusive<T>,
) -> impl Fn(&str) -> Result<T, String> + Clone {
    move |text| {
        let number = text.parse().ok().filter(|number| range.contains(number));
        number.ok_or_else(|| format!("must be a whole number from {} to {}", range.start(), range.end()))
    }
}

/// Reads a number within `bounds`, as an option has it.
fn number(bounds: impl Into<Bounds>) -> impl Fn(&str) -> Result<f64, String> + Clone {
    let bounds = bounds.into();
    move |text| {
        let number = text.parse().ok().filter(|number| bounds.allow(*number));
        number.ok_or_else(|| format!("must be a number {}", bounds.in_words("")))
    }
}

/// How long a user may have something take, s: up to a day.
const SECONDS: RangeInclusive<f64> = 1e-3..=86_400.0;

/// Reads a number whose range something else holds it to.
fn any_number(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| "must be a number".to_owned())
}

/// What is shown while a time budget is planned.
const TRYING: &str = "trying what the time affords";

/// What resumes an interrupted command that merges nothing.
const RESUMED: &str = "the same command with --resume";

/// How an interrupted command goes on from the `rows` in `place`: by `again`.
fn resumable(rows: &str, place: &Path, again: &str) -> String {
    format!("{rows} are kept in {}; {again} continues", place.display())
}
