//! The subcommands of `sprag`. Each has its arguments and a `run` that returns the exit code: 0 well, 1 (`hil`) a device that decides otherwise, 2 bad input or
//! output, 130 and 143 interrupted.

#[cfg(feature = "effects")]
pub mod accuracy;
pub mod accuracy_arguments;
pub mod batch;
#[cfg(feature = "effects")]
pub mod board;
#[cfg(feature = "effects")]
mod board_line;
#[cfg(feature = "effects")]
mod board_record;
#[cfg(feature = "effects")]
pub mod closed_loop;
pub mod cloud;
pub mod completions;
pub mod effects;
pub mod example;
pub mod explain;
mod format_arguments;
#[cfg(feature = "effects")]
pub mod hil;
pub mod long_run_arguments;
#[cfg(feature = "effects")]
pub mod loop_scene;
#[cfg(feature = "effects")]
pub mod loop_study;
#[cfg(feature = "effects")]
mod loop_trace;
pub mod manual;
pub mod map;
mod map_boundaries;
pub mod new;
pub mod optimise;
pub mod out_arguments;
pub mod record;
pub mod record_arguments;
pub mod schema;
pub mod sensitivity;
pub mod similar;
pub mod simulate;
pub mod study_input;
pub mod synthesize;
pub mod wrong_line;

use std::fmt::Display;
use std::io::Write;
use std::path::Path;

use sprag_report::signals;
pub use sprag_report::streams::BAD_INPUT;
use sprag_sim::interrupt::Interrupt;

/// A whole number from `low` to `high`, as an option has it.
fn whole_number(text: &str, low: u64, high: u64) -> Result<u64, String> {
    let number = text.parse().ok().filter(|number| (low..=high).contains(number));
    number.ok_or_else(|| format!("must be a whole number from {low} to {high}"))
}

/// A number of threads.
fn threads(text: &str) -> Result<u16, String> {
    whole_number(text, 1, 1024).map(|threads| threads as u16)
}

/// What is shown while results are made from finished runs.
const DRAWING: &str = "drawing and writing results";

/// What is shown while a time budget is planned.
const TRYING: &str = "trying what the time affords";

/// How an interrupted command goes on from the `rows` in `place`.
fn resumable(rows: &str, place: &Path) -> String {
    format!("{rows} are kept in {}; the same command with --resume goes on", place.display())
}

/// Writes `warnings` to `err`, each once and in a line of its own, and hands those on for `summary.json`.
fn warned(warnings: impl IntoIterator<Item = String>, err: &mut impl Write) -> Vec<String> {
    let mut told: Vec<String> = Vec::new();
    for warning in warnings {
        if !told.contains(&warning) {
            let _ = writeln!(err, "sprag: warning: {warning}");
            told.push(warning);
        }
    }
    told
}

/// The exit code of a command whose `result` is whether all is well; what ended it otherwise goes to `err` in one line.
fn ended<E: Display>(result: Result<bool, E>, interrupt: &Interrupt, err: &mut impl Write) -> i32 {
    match result {
        Ok(true) => 0,
        Ok(false) => BAD_INPUT,
        // Whatever fails once the user has asked to stop: other programs of the command are stopped by the same Ctrl-C.
        Err(_) if interrupt.is_set() => {
            signals::report(interrupt, err);
            interrupt.exit_code()
        }
        Err(failure) => {
            let _ = writeln!(err, "sprag: {failure}");
            BAD_INPUT
        }
    }
}
