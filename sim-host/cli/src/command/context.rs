//! What every subcommand works with: where its text goes, how it is interrupted, and which exit code its end is.

use std::io::{self, Write};

use serde::Serialize;
use sprag_report::signals;
use sprag_report::streams::BAD_INPUT;
use sprag_sim::interrupt::Interrupt;

/// Exit code of a command that has finished and written its results, with a negative or partial answer.
pub const PARTIAL: i32 = 1;

/// A subcommand with its arguments.
pub trait Run {
    /// Does what the arguments ask for.
    ///
    /// # Errors
    /// What keeps it from finishing, in one line for the user.
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion>;
}

/// How a subcommand ended that was not kept from finishing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Completion {
    /// With all that was asked for.
    Complete,
    /// With results that are negative, or lack what could not be read or run.
    Partial,
    /// Without anything that could be read; every reason has been written.
    Refused,
    /// By the interrupt that is its usual end.
    Interrupted,
}

impl Completion {
    /// The end of a command that is complete or not.
    pub fn of(complete: bool) -> Completion {
        if complete { Completion::Complete } else { Completion::Partial }
    }
}

/// Work that ended because it was interrupted.
#[derive(Clone, Copy, Debug, thiserror::Error)]
#[error("interrupted")]
pub struct Interrupted;

/// Output, errors and interrupt of a subcommand.
pub struct Context<'a> {
    /// Standard output; [`Context::print`] writes text there, unless the user wants none.
    pub out: &'a mut dyn Write,
    /// Standard error, for messages.
    pub err: &'a mut dyn Write,
    /// Ctrl-C and termination.
    pub interrupt: &'a Interrupt,
    /// Whether text on standard output is left out.
    pub quiet: bool,
}

/// Writes results as JSON.
///
/// # Errors
/// The errors of `out`.
pub fn write_json(results: &impl Serialize, out: &mut impl Write) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, results)?;
    writeln!(out)
}

impl Context<'_> {
    /// Runs a subcommand and gives its exit code; what kept it from finishing is written in one line.
    pub fn run(&mut self, subcommand: &dyn Run) -> i32 {
        match subcommand.run(self) {
            Ok(Completion::Complete) => 0,
            Ok(Completion::Partial) => PARTIAL,
            Ok(Completion::Refused) => BAD_INPUT,
            Ok(Completion::Interrupted) => self.interrupt.exit_code(),
            // Whatever fails once the user has asked to stop: other programs of the command are stopped by the same Ctrl-C.
            Err(_) if self.interrupt.is_set() => {
                signals::report(self.interrupt, &mut self.err);
                self.interrupt.exit_code()
            }
            Err(error) => {
                self.note(error);
                BAD_INPUT
            }
        }
    }

    /// Writes text of results to standard output. What keeps it from being written is reported where standard output ends.
    pub fn print(&mut self, text: impl std::fmt::Display) {
        if !self.quiet {
            let _ = write!(self.out, "{text}");
        }
    }

    /// Writes results as JSON to standard output.
    pub fn print_json(&mut self, value: &impl Serialize) {
        let _ = write_json(value, &mut self.out);
    }

    /// Writes one line to standard error.
    pub fn note(&mut self, line: impl std::fmt::Display) {
        let _ = writeln!(self.err, "sprag: {line}");
    }

    /// Writes warnings to standard error, each once and in a line of its own, and hands those on for `summary.json`.
    pub fn warned(&mut self, warnings: impl IntoIterator<Item = String>) -> Vec<String> {
        let mut written: Vec<String> = Vec::new();
        for warning in warnings {
            if !written.contains(&warning) {
                self.note(format_args!("warning: {warning}"));
                written.push(warning);
            }
        }
        written
    }

    /// Ends work that the user has asked to stop.
    pub fn check_interrupt(&self) -> Result<(), Interrupted> {
        if self.interrupt.is_set() { Err(Interrupted) } else { Ok(()) }
    }
}
