//! The `sprag` command.

use std::process::ExitCode;

use clap::{Parser, Subcommand};
#[cfg(feature = "effects")]
use sprag_sim_host::command::{accuracy, closed_loop, device, hil, loop_study};
use sprag_sim_host::command::{
    batch, cloud, effects, explain, map, optimise, record, sensitivity, similar, simulate, synthesize,
};
use sprag_sim_host::interrupt::Interrupt;
use sprag_sim_host::streams::{Errors, Output};

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
    Device(device::DeviceArguments),
    #[cfg(feature = "effects")]
    LoopStudy(loop_study::LoopStudyArguments),
    Record(record::RecordArguments),
    Synthesize(synthesize::SynthesizeArguments),
    Effects(effects::EffectsArguments),
    Explain(explain::ExplainArguments),
}

fn main() -> ExitCode {
    let line = Line::parse();
    let interrupt = Interrupt::installed();
    let (mut out, mut err) = (Output::default(), Errors::default());
    let code = match &line.command {
        Command::Simulate(arguments) => simulate::run(arguments, &mut out, &mut err, &interrupt),
        Command::Batch(arguments) => batch::run(arguments, &mut err, &interrupt),
        Command::Similar(arguments) => similar::run(arguments, &mut out, &mut err, &interrupt),
        Command::Cloud(arguments) => cloud::run(arguments, &mut out, &mut err, &interrupt),
        Command::Optimise(arguments) => optimise::run(arguments, &mut out, &mut err, &interrupt),
        Command::Map(arguments) => map::run(arguments, &mut out, &mut err, &interrupt),
        Command::Sensitivity(arguments) => sensitivity::run(arguments, &mut out, &mut err, &interrupt),
        #[cfg(feature = "effects")]
        Command::Accuracy(arguments) => accuracy::run(arguments, &mut out, &mut err, &interrupt),
        #[cfg(feature = "effects")]
        Command::Loop(arguments) => closed_loop::run(arguments, &mut out, &mut err, &interrupt),
        #[cfg(feature = "effects")]
        Command::Hil(arguments) => hil::run(arguments, &mut out, &mut err, &interrupt),
        #[cfg(feature = "effects")]
        Command::Device(arguments) => device::run(arguments, &mut out, &mut err, &interrupt),
        #[cfg(feature = "effects")]
        Command::LoopStudy(arguments) => loop_study::run(arguments, &mut out, &mut err, &interrupt),
        Command::Record(arguments) => record::run(arguments, &mut out, &mut err),
        Command::Synthesize(arguments) => synthesize::run(arguments, &mut out, &mut err),
        Command::Effects(arguments) => effects::run(arguments, &mut out, &mut err),
        Command::Explain(arguments) => explain::run(arguments, &mut out, &mut err),
    };
    ExitCode::from(u8::try_from(out.finish(code, &mut err)).unwrap_or(1))
}
