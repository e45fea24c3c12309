//! The command `sprag`, as a library: its subcommands, and the boards that they talk to.
//!
//! - [`run`]: the command as another program can offer it; [`command`]: its subcommands.
//! - [`device`]: the firmware on a board or in an emulator.

pub mod command;
#[cfg(feature = "effects")]
pub mod device;
#[cfg(feature = "effects")]
pub mod part;

use std::ffi::OsString;
use std::io::Write;

use crate::command::wrong_line::{command_named, wrong_line};
use crate::command::{
    BAD_INPUT, batch, cloud, effects, explain, map, optimise, record, sensitivity, similar, simulate, synthesize,
};
#[cfg(feature = "effects")]
use crate::command::{accuracy, closed_loop, hil, loop_study};
use clap::error::ErrorKind;
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use sprag_report::signals;
use sprag_report::streams::{Errors, Output};
use sprag_sim::interrupt::Interrupt;

/// Rocking structures with inerters and clutches: simulate, and get the numbers to decide with.
#[derive(Parser)]
#[command(name = "sprag", version, propagate_version = true)]
struct Line {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Simulate(simulate::SimulateArguments),
    Batch(batch::BatchArguments),
    Map(map::MapArguments),
    Cloud(cloud::CloudArguments),
    Optimise(optimise::OptimiseArguments),
    Similar(similar::SimilarArguments),
    Sensitivity(sensitivity::SensitivityArguments),
    #[cfg(feature = "effects")]
    Accuracy(accuracy::AccuracyCommandArguments),
    #[cfg(feature = "effects")]
    Loop(closed_loop::LoopArguments),
    #[cfg(feature = "effects")]
    Hil(hil::HilArguments),
    #[cfg(feature = "effects")]
    Device(command::device::DeviceArguments),
    #[cfg(feature = "effects")]
    LoopStudy(loop_study::LoopStudyArguments),
    Record(record::RecordArguments),
    Synthesize(synthesize::SynthesizeArguments),
    Effects(effects::EffectsArguments),
    Explain(explain::ExplainArguments),
}

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
    let code = match read_line(&words) {
        Ok(line) => run_command(&line.command, &mut out, &mut err, &interrupt),
        Err(error) if !error.use_stderr() || error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            let _ = out.noted(error.print());
            error.exit_code()
        }
        Err(error) => {
            let command = command_named(&Line::command(), words.into_iter().skip(1));
            let _ = writeln!(err, "sprag: {}; see {command} --help", wrong_line(&error));
            BAD_INPUT
        }
    };
    out.finish(code, &mut err)
}

/// The command line as it was given.
fn read_line(words: &[OsString]) -> Result<Line, clap::Error> {
    Line::from_arg_matches(&with_negative_numbers(Line::command()).try_get_matches_from(words)?)
}

/// A negative number is a value, of which its option says whether it is allowed.
fn with_negative_numbers(command: clap::Command) -> clap::Command {
    let number = |arg: clap::Arg| {
        let takes_values = arg.get_action().takes_values();
        if takes_values { arg.allow_negative_numbers(true) } else { arg }
    };
    command.mut_args(number).mut_subcommands(with_negative_numbers)
}

fn run_command(command: &Command, out: &mut Output, err: &mut Errors, interrupt: &Interrupt) -> i32 {
    match command {
        Command::Simulate(arguments) => simulate::run(arguments, out, err, interrupt),
        Command::Batch(arguments) => batch::run(arguments, err, interrupt),
        Command::Similar(arguments) => similar::run(arguments, out, err, interrupt),
        Command::Cloud(arguments) => cloud::run(arguments, out, err, interrupt),
        Command::Optimise(arguments) => optimise::run(arguments, out, err, interrupt),
        Command::Map(arguments) => map::run(arguments, out, err, interrupt),
        Command::Sensitivity(arguments) => sensitivity::run(arguments, out, err, interrupt),
        #[cfg(feature = "effects")]
        Command::Accuracy(arguments) => accuracy::run(arguments, out, err, interrupt),
        #[cfg(feature = "effects")]
        Command::Loop(arguments) => closed_loop::run(arguments, out, err, interrupt),
        #[cfg(feature = "effects")]
        Command::Hil(arguments) => hil::run(arguments, out, err, interrupt),
        #[cfg(feature = "effects")]
        Command::Device(arguments) => command::device::run(arguments, out, err, interrupt),
        #[cfg(feature = "effects")]
        Command::LoopStudy(arguments) => loop_study::run(arguments, out, err, interrupt),
        Command::Record(arguments) => record::run(arguments, out, err),
        Command::Synthesize(arguments) => synthesize::run(arguments, out, err),
        Command::Effects(arguments) => effects::run(arguments, out, err),
        Command::Explain(arguments) => explain::run(arguments, out, err),
    }
}
