//! The command line: which subcommands there are, and how the help presents them.

use std::ffi::OsString;
use std::fmt::Write as _;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use sprag_report::streams::{Errors, Output};
use sprag_sim::interrupt::Interrupt;

#[cfg(feature = "effects")]
use crate::command::{accuracy, board, closed_loop, hil, loop_study};
use crate::command::{
    batch, cloud, completions, effects, example, explain, manual, map, new, optimise, record, schema, sensitivity, similar,
    simulate, synthesize,
};

/// Rocking structures with inerters and clutches: simulate, and get the numbers to decide with.
#[derive(Parser)]
#[command(name = "sprag", version, propagate_version = true, disable_help_subcommand = true)]
struct Line {
    #[command(subcommand)]
    command: Command,
}

/// A subcommand with its arguments.
#[derive(Subcommand)]
pub enum Command {
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
    #[command(alias = "device")]
    Board(board::BoardArguments),
    #[cfg(feature = "effects")]
    LoopStudy(loop_study::LoopStudyArguments),
    Record(record::RecordArguments),
    Synthesize(synthesize::SynthesizeArguments),
    Effects(effects::EffectsArguments),
    Explain(explain::ExplainArguments),
    Example(example::ExampleArguments),
    New(new::NewArguments),
    Schema(schema::SchemaArguments),
    Completions(completions::CompletionsArguments),
    Manual(manual::ManualArguments),
}

/// The subcommands as the help groups them.
const GROUPS: [(&str, &[&str]); 5] = [
    ("Simulate", &["example", "new", "schema", "simulate", "explain", "effects", "batch"]),
    ("Study", &["map", "cloud", "optimise", "sensitivity", "similar", "accuracy"]),
    ("Control", &["loop", "loop-study", "hil", "board"]),
    ("Ground motions", &["record", "synthesize"]),
    ("Shell", &["completions", "manual"]),
];

/// What ends the help.
const EXIT_CODES: &str = "Exit codes: 0 well; 1 finished, with a decision of the firmware that is not the host's (`hil`); 2 wrong usage or input, \
    something that cannot be written, a run or record that failed, or no device within the limits (`optimise`); 130 interrupted; 143 terminated.\n\n\
    `sprag COMMAND --help` describes a command, with examples.";

/// The command as clap has it.
pub fn definition() -> clap::Command {
    let command = with_negative_numbers(Line::command());
    let mut groups = String::new();
    for (title, names) in GROUPS {
        let _ = writeln!(groups, "{title}:");
        // A program may lack a part.
        for about in names.iter().filter_map(|name| command.find_subcommand(name)) {
            let _ = writeln!(groups, "  {:<13}{}", about.get_name(), about.get_about().cloned().unwrap_or_default());
        }
        groups.push('\n');
    }
    let template = format!("{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{groups}Options:\n{{options}}{{after-help}}");
    command.help_template(template).after_help(EXIT_CODES)
}

/// The subcommand that the words of a command line ask for.
///
/// # Errors
/// What is wrong with the line, or the help that it asks for.
pub fn read(words: &[OsString]) -> Result<Command, clap::Error> {
    Line::from_arg_matches(&definition().try_get_matches_from(words)?).map(|line| line.command)
}

/// A negative number is a value, of which its option says whether it is allowed.
fn with_negative_numbers(command: clap::Command) -> clap::Command {
    let number = |arg: clap::Arg| {
        let takes_values = arg.get_action().takes_values();
        if takes_values { arg.allow_negative_numbers(true) } else { arg }
    };
    command.mut_args(number).mut_subcommands(with_negative_numbers)
}

impl Command {
    /// Runs it and gives its exit code.
    pub fn run(&self, out: &mut Output, err: &mut Errors, interrupt: &Interrupt) -> i32 {
        match self {
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
            Command::Board(arguments) => board::run(arguments, out, err, interrupt),
            #[cfg(feature = "effects")]
            Command::LoopStudy(arguments) => loop_study::run(arguments, out, err, interrupt),
            Command::Record(arguments) => record::run(arguments, out, err),
            Command::Synthesize(arguments) => synthesize::run(arguments, out, err),
            Command::Effects(arguments) => effects::run(arguments, out, err),
            Command::Explain(arguments) => explain::run(arguments, out, err),
            Command::Example(arguments) => example::run(arguments, out, err),
            Command::New(arguments) => new::run(arguments, out, err),
            Command::Schema(arguments) => schema::run(arguments, out),
            Command::Completions(arguments) => completions::run(arguments, out),
            Command::Manual(arguments) => manual::run(arguments, out, err),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_is_in_one_group_with_a_line_that_fits_a_terminal() {
        let definition = definition();
        let mut names: Vec<&str> = definition.get_subcommands().map(clap::Command::get_name).collect();
        let mut grouped: Vec<&str> = GROUPS.iter().flat_map(|(_, names)| names.iter().copied()).collect();
        names.sort_unstable();
        grouped.sort_unstable();
        grouped.retain(|name| definition.find_subcommand(name).is_some());
        assert_eq!(names, grouped);
        for command in definition.get_subcommands() {
            let about = command.get_about().unwrap().to_string();
            assert!(about.chars().count() <= 64, "{}: {about}", command.get_name());
        }
    }

    #[test]
    fn the_definition_has_no_contradiction() {
        definition().debug_assert();
    }
}
