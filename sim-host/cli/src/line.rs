//! The command line: which subcommands there are, and how the help presents them.

use std::ffi::OsString;
use std::fmt::Write as _;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

#[cfg(test)]
use crate::command::context::Context;
use crate::command::context::Run;
#[cfg(feature = "effects")]
use crate::command::{accuracy, board, closed_loop, design, hil, loop_study};
use crate::command::{
    batch, cloud, completions, effects, example, explain, manual, map, new, optimise, part, plan, record, schema, sensitivity,
    similar, simulate, synthesize,
};

/// Rocking structures with inerters and clutches: simulate, and get the numbers to decide with.
#[derive(Parser)]
#[command(name = "sprag", version, propagate_version = true, disable_help_subcommand = true)]
pub struct Line {
    /// Print nothing but results as JSON, warnings and errors; show no progress.
    #[arg(long, short, global = true)]
    pub quiet: bool,
    /// The subcommand.
    #[command(subcommand)]
    pub command: Command,
}

/// A subcommand with its arguments.
#[derive(Subcommand)]
pub enum Command {
    Simulate(simulate::SimulateArguments),
    Batch(batch::BatchArguments),
    Map(map::MapArguments),
    Cloud(cloud::CloudArguments),
    Plan(plan::PlanArguments),
    Part(part::PartArguments),
    Collect(part::CollectArguments),
    Optimise(optimise::OptimiseArguments),
    #[cfg(feature = "effects")]
    Design(design::DesignArguments),
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
const GROUPS: [(&str, &[&str]); 6] = [
    ("Simulate", &["example", "new", "schema", "simulate", "explain", "effects", "batch"]),
    ("Study", &["map", "cloud", "optimise", "design", "sensitivity", "similar", "accuracy"]),
    ("Many machines", &["plan", "part", "collect"]),
    ("Control", &["loop", "loop-study", "hil", "board"]),
    ("Ground motions", &["record", "synthesize"]),
    ("Shell", &["completions", "manual"]),
];

/// What ends the help.
const EXIT_CODES: &str = "Exit codes: 0 well; 1 finished and results written, with a negative or partial answer: a record that cannot be read or a run \
    that failed among others, no device within the limits (`optimise`), decisions of the firmware that are not the host's (`hil`); 2 wrong usage or \
    input, or something that cannot be written; 130 interrupted; 143 terminated.\n\n\
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

/// The subcommand that the words of a command line ask for; `help COMMAND` is `COMMAND --help`.
///
/// # Errors
/// What is wrong with the line, or the help that it asks for.
pub fn read(words: &[OsString]) -> Result<Line, clap::Error> {
    let line = match words {
        [program, help, command @ ..] if help == "help" => [std::slice::from_ref(program), command, &["--help".into()]].concat(),
        _ => words.to_vec(),
    };
    Line::from_arg_matches(&definition().try_get_matches_from(line)?)
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
    /// The subcommand's arguments, which run it.
    pub fn arguments(&self) -> &dyn Run {
        match self {
            Command::Simulate(arguments) => arguments,
            Command::Batch(arguments) => arguments,
            Command::Similar(arguments) => arguments,
            Command::Cloud(arguments) => arguments,
            Command::Optimise(arguments) => arguments,
            #[cfg(feature = "effects")]
            Command::Design(arguments) => arguments,
            Command::Map(arguments) => arguments,
            Command::Plan(arguments) => arguments,
            Command::Part(arguments) => arguments,
            Command::Collect(arguments) => arguments,
            Command::Sensitivity(arguments) => arguments,
            #[cfg(feature = "effects")]
            Command::Accuracy(arguments) => arguments,
            #[cfg(feature = "effects")]
            Command::Loop(arguments) => arguments,
            #[cfg(feature = "effects")]
            Command::Hil(arguments) => arguments,
            #[cfg(feature = "effects")]
            Command::Board(arguments) => arguments,
            #[cfg(feature = "effects")]
            Command::LoopStudy(arguments) => arguments,
            Command::Record(arguments) => arguments,
            Command::Synthesize(arguments) => arguments,
            Command::Effects(arguments) => arguments,
            Command::Explain(arguments) => arguments,
            Command::Example(arguments) => arguments,
            Command::New(arguments) => arguments,
            Command::Schema(arguments) => arguments,
            Command::Completions(arguments) => arguments,
            Command::Manual(arguments) => arguments,
        }
    }
}

/// Runs the command with the `words` behind its name: its exit code, and what it writes to standard output and standard error.
#[cfg(test)]
pub fn run(words: &[&str]) -> (i32, String, String) {
    let words: Vec<OsString> = std::iter::once("sprag").chain(words.iter().copied()).map(Into::into).collect();
    let line = read(&words).unwrap_or_else(|error| panic!("{error}"));
    let (mut out, mut err, interrupt) = (Vec::new(), Vec::new(), sprag_sim::interrupt::Interrupt::default());
    let mut context = Context { out: &mut out, err: &mut err, interrupt: &interrupt, quiet: line.quiet };
    let code = context.run(line.command.arguments());
    (code, String::from_utf8(out).unwrap(), String::from_utf8(err).unwrap())
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
    fn every_option_says_what_it_does() {
        fn terse(command: &clap::Command) -> Vec<String> {
            let own = command.get_arguments().filter(|argument| !["help", "version"].contains(&argument.get_id().as_str()));
            let help = |argument: &clap::Arg| argument.get_help().map(ToString::to_string).unwrap_or_default();
            let short = own.filter(|argument| help(argument).split_whitespace().count() < 3);
            let named = short.map(|argument| format!("{} {}", command.get_name(), argument.get_id()));
            named.chain(command.get_subcommands().flat_map(terse)).collect()
        }
        assert_eq!(terse(&definition()), [""; 0]);
    }

    #[test]
    fn the_definition_has_no_contradiction() {
        definition().debug_assert();
    }
}
