//! The command `sprag`, as a library: its subcommands, and the boards that they talk to.
//!
//! - [`run`]: the command as another program can offer it; [`command`]: its subcommands.
//! - [`board`]: the firmware on a board or in an emulator.

#[cfg(feature = "effects")]
pub mod board;
pub mod command;
mod line;
#[cfg(feature = "effects")]
pub mod part;

use std::ffi::OsString;
use std::io::Write;

use clap::error::ErrorKind;
use sprag_report::streams::{BAD_INPUT, Errors, Output};
use sprag_report::{progress, signals};

use crate::command::context::Context;
use crate::command::wrong_line::{command_named, wrong_line};

/// Runs the command with the words of a command line, the first of which is the name of the program, and gives its exit code. Results go to
/// standard output, everything else to standard error; Ctrl-C and termination are waited for.
pub fn run<I>(words: I) -> i32
where
    I: IntoIterator,
    I::Item: Into<OsString>,
{
    let words: Vec<OsString> = words.into_iter().map(Into::into).collect();
    let interrupt = signals::interrupt();
    let (mut out, mut err) = (Output::default(), Errors::default());
    let code = match line::read(&words) {
        Ok(line) => {
            if line.quiet {
                progress::hide();
            }
            let mut context = Context { out: &mut out, err: &mut err, interrupt: &interrupt, quiet: line.quiet };
            context.run(line.command.arguments())
        }
        Err(error) if !error.use_stderr() || error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            let _ = out.noted(error.print());
            error.exit_code()
        }
        Err(error) => {
            let command = command_named(&line::definition(), words.into_iter().skip(1));
            let _ = writeln!(err, "sprag: {}; see {command} --help", wrong_line(&error));
            BAD_INPUT
        }
    };
    out.finish(code, &mut err)
}
