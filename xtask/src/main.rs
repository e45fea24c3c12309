//! Sprag's own tasks, run as `cargo xtask <task>`.

mod accuracy;
mod board_image;
mod budget;
#[cfg(test)]
mod documentation_links;
mod effects;
mod exhaustive;
mod figures;
mod firmware;
mod fuzz;
mod graph;
mod hardware;
mod panic_check;
mod process;
mod program;
mod reach;
mod seal;
mod size;
mod steps;
mod stop;
mod test;
mod thumb;
mod ticks;
mod tools;

use fuzz::Inputs;
use std::{path::PathBuf, process::ExitCode};
use steps::Steps;
use stop::Stop;

const HELP: &str = "\
Sprag's own tasks.

Usage: cargo xtask <task> [options]

Tasks:
  test      every check, in order; stops at the first that fails
  ci        the same
  nightly   the same with the exhaustive tests, which otherwise run when what they prove has changed, and each fuzz target from its seeds
            on
  firmware  build the images for the board, hold their sizes against tests/emulated-core/size.budget and
            firmware/size.budget, and prove that no panic can be reached from the firmware's control tick
  flash [g474]
            build the image for the board with an STM32F405 (or an STM32G474), seal it, write it to the board and show its output; needs
            probe-rs
  effects   measure what each effect costs, on the host under callgrind and on the emulated board, and write
            docs/effects-cost.csv; fails if an effect that is off costs more than 1 %
  accuracy  measure what accuracy costs in time, on the host, in the emulator and against SciPy, and write docs/accuracy.md with
            its tables and pictures; needs python3 with venv
  ticks     measure what a control tick of the firmware costs in the emulator, with and without logs, and write docs/ticks.csv
  board-image ticks
            count what a control tick of the unmodified board image costs, at rest and in motion, between models of the board's parts
  board-image profile
            the same, by the folders of the sources that the instructions are from
  hardware  simulate the coil driver of docs/hardware in ngspice and check the schematic's electrical rules by SKiDL (where Python has
            it); fails when an assert or a rule does
  figures [PROGRAM]
            print figures of the code: lines without tests, test executables, and of each program that is built (or of PROGRAM, an
            ELF file with symbols) the event loops and the bytes of code by room of the core
  fuzz [TARGET]
            feed random input to one fuzz target, or to each of them in turn

Options:
  --seconds N  how long each fuzz target runs (default 12; 0 only tries the committed seeds)
  --overwrite  with `firmware`: accept the sizes of the sections as they are; limits stay
  -h, --help   this text

Exit codes: 0 all well, 1 a check failed, 2 wrong usage or a tool is missing.";

/// Seconds for each of five fuzz targets: a minute in all.
const FUZZ_SECONDS: u32 = 12;

fn main() -> ExitCode {
    match run(std::env::args().skip(1)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(stop) => {
            eprintln!("error: {stop}");
            stop.exit_code()
        }
    }
}

fn run(mut args: impl Iterator<Item = String>) -> Result<(), Stop> {
    let mut words = Vec::new();
    let mut seconds = FUZZ_SECONDS;
    let mut overwrite = false;
    while let Some(arg) = args.next() {
        match arg.as_str() {
            "-h" | "--help" => {
                println!("{HELP}");
                return Ok(());
            }
            "--seconds" => {
                seconds = args
                    .next()
                    .and_then(|text| text.parse().ok())
                    .ok_or_else(|| Stop::usage("--seconds needs a whole number"))?;
            }
            "--overwrite" => overwrite = true,
            _ if arg.starts_with('-') => {
                return Err(Stop::usage(format!("there is no option {arg}; see --help")));
            }
            _ => words.push(arg),
        }
    }
    let root = workspace_root()?;
    match words.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [..] if overwrite && words != ["firmware"] => Err(Stop::usage("--overwrite is only for firmware")),
        ["test" | "ci"] => test::run(&root, None),
        ["nightly"] => test::run(&root, Some(seconds)),
        ["firmware"] => {
            tools::need_target(&root, firmware::TARGET)?;
            test::images(&root, &mut Steps::default(), overwrite).map(drop)
        }
        ["flash"] => firmware::BOARD.flash(&root, "STM32F405RGTx"),
        ["flash", "g474"] => firmware::BOARD_G474.flash(&root, "STM32G474RETx"),
        ["effects"] => {
            tools::need_target(&root, firmware::TARGET)?;
            effects::run(&root)
        }
        ["accuracy"] => {
            tools::need_target(&root, firmware::TARGET)?;
            accuracy::run(&root)
        }
        ["ticks"] => {
            tools::need_target(&root, firmware::TARGET)?;
            ticks::run(&root)
        }
        ["hardware"] => hardware::run(&root, &mut Steps::default()),
        ["board-image", what @ ("ticks" | "profile")] => {
            tools::need_target(&root, firmware::TARGET)?;
            board_image::measure(&root, what)
        }
        ["figures"] => figures::run(&root, None),
        ["figures", program] => figures::run(&root, Some(program)),
        ["fuzz"] => fuzz::run(&root, None, seconds, Inputs::New),
        ["fuzz", target] => fuzz::run(&root, Some(target), seconds, Inputs::New),
        [] => Err(Stop::usage("no task given; see --help")),
        [task, ..] => Err(Stop::usage(format!("no task \"{task}\" with these words; see --help"))),
    }
}

/// The folder of the workspace, so that tasks work from any folder inside it.
fn workspace_root() -> Result<PathBuf, Stop> {
    let package = std::env::var_os("CARGO_MANIFEST_DIR").ok_or_else(|| Stop::usage("run this as `cargo xtask`"))?;
    PathBuf::from(package)
        .parent()
        .map(PathBuf::from)
        .ok_or_else(|| Stop::usage("run this as `cargo xtask` inside the workspace"))
}
