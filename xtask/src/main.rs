//! Sprag's own tasks, run as `cargo xtask <task>`.

mod accuracy;
mod board_image;
mod budget;
mod callgrind;
mod cluster;
#[cfg(test)]
mod documentation_links;
mod effects;
mod figures;
mod firmware;
mod fuzz;
mod hardware;
mod map_cost;
mod package;
mod panic_check;
mod passed;
mod process;
mod python;
#[cfg(test)]
mod rooms;
mod scratch;
mod seal;
mod site;
mod size;
mod steps;
mod stop;
mod summary;
mod test;
mod ticks;
mod tools;
mod web;

use clap::{Parser, Subcommand, ValueEnum};
use fuzz::Inputs;
use std::{path::PathBuf, process::ExitCode};
use steps::Steps;
use stop::Stop;

/// Seconds for each of five fuzz targets: a minute in all.
const FUZZ_SECONDS: u32 = 12;

/// Sprag's own tasks.
#[derive(Parser)]
#[command(
    name = "cargo xtask",
    bin_name = "cargo xtask",
    after_help = "Exit codes: 0 all well, 1 a check failed, 2 wrong usage or a tool is missing."
)]
struct Line {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Every check, in order; stops at the first that fails
    #[command(alias = "ci")]
    Test,
    /// The same with the exhaustive tests and the checks of docs/hardware, which otherwise run when what they depend on has changed, the
    /// installed program, and each fuzz target from its seeds on
    Nightly {
        /// How long each fuzz target runs, s; 0 only tries the committed seeds
        #[arg(long, default_value_t = FUZZ_SECONDS)]
        seconds: u32,
    },
    /// Build the images for the board, hold their sizes against tests/emulated-core/size.budget and firmware/size.budget, and prove that
    /// no panic can be reached from the firmware's control tick
    Firmware {
        /// Accept the sizes of the sections as they are; limits stay
        #[arg(long)]
        overwrite: bool,
    },
    /// Build the image for a board, seal it, write it to the board and show its output; needs probe-rs
    Flash {
        /// The board's processor
        #[arg(default_value = "f405")]
        chip: Chip,
    },
    /// Measure what each effect costs, on the host under callgrind and on the emulated board, and write docs/effects-cost.csv; fails if an
    /// effect that is off costs more than 1 %
    Effects,
    /// Count where the time of an overturning map goes, under callgrind
    MapCost,
    /// Measure what accuracy costs in time, on the host, in the emulator and against SciPy, and write docs/accuracy.md with its tables and
    /// pictures; needs python3 with venv
    Accuracy,
    /// Measure what a control tick of the firmware costs in the emulator, with and without logs, and write docs/ticks.csv
    Ticks,
    /// Count what a control tick of the unmodified board image costs, between models of the board's parts
    BoardImage {
        /// At rest and in motion, or by the folders of the sources that the instructions are from
        what: Counted,
    },
    /// Simulate the coil driver of docs/hardware in ngspice and check the schematic's electrical rules by SKiDL (where Python has it);
    /// fails when an assert or a rule does
    Hardware,
    /// Build the wheel of the Python package into target/wheels, and check it in an empty environment: lints, types, tests; needs python3 with
    /// venv and a package index
    Python {
        /// Build it for others, with every optimisation, and not quickly for its tests
        #[arg(long)]
        dist: bool,
    },
    /// Build the wheels of the Python package for any Linux with glibc 2.17 or later, on x86_64 and aarch64, into target/wheels, and check the
    /// one of this machine in an empty environment; needs python3 with venv and a package index
    Wheels,
    /// Build the documents as a site into target/site, run the examples of its gallery and follow its links; needs python3 with venv and a
    /// package index
    Site,
    /// Build the page into web/dist and test it in a browser; needs Chromium, Node or a package index, and the registry of Node's packages
    Web {
        /// Build alone, for which no browser is needed
        #[arg(long)]
        no_tests: bool,
        /// Build, and instead of the tests print how fast the lanes are against those of this machine's programs
        #[arg(long, conflicts_with = "no_tests")]
        speed: bool,
    },
    /// Print figures of the code: lines without tests, test executables, and of each program that is built the event loops and the bytes
    /// of code by room of the core
    Figures {
        /// An ELF file with symbols, in place of the sources and programs
        program: Option<String>,
    },
    /// Build the Debian package of the program, with its pages for `man` and its completions; needs cargo-deb
    Deb,
    /// Make a map as an array job of a Slurm that is started on this machine alone
    Cluster,
    /// Install the program below target/installed and run the README's commands with it in an empty folder, without cargo
    Installed,
    /// Feed random input to the fuzz targets
    Fuzz {
        /// One of them; without, each in turn
        target: Option<String>,
        /// How long each runs, s; 0 only tries the committed seeds
        #[arg(long, default_value_t = FUZZ_SECONDS)]
        seconds: u32,
    },
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Chip {
    F405,
    G474,
}

#[derive(Clone, Copy, ValueEnum)]
enum Counted {
    Ticks,
    Profile,
}

fn main() -> ExitCode {
    match run(Line::parse().task) {
        Ok(()) => ExitCode::SUCCESS,
        Err(stop) => {
            eprintln!("error: {stop}");
            stop.exit_code()
        }
    }
}

fn run(task: Task) -> Result<(), Stop> {
    let root = &workspace_root()?;
    if matches!(task, Task::Firmware { .. } | Task::Effects | Task::Accuracy | Task::Ticks | Task::BoardImage { .. }) {
        tools::need_target(root, firmware::TARGET)?;
    }
    match task {
        Task::Test => test::run(root, None),
        Task::Nightly { seconds } => test::run(root, Some(seconds)),
        Task::Firmware { overwrite } => test::images(root, &mut Steps::default(), overwrite).map(drop),
        Task::Flash { chip: Chip::F405 } => firmware::BOARD.flash(root, "STM32F405RGTx"),
        Task::Flash { chip: Chip::G474 } => firmware::BOARD_G474.flash(root, "STM32G474RETx"),
        Task::Effects => effects::run(root),
        Task::MapCost => map_cost::run(root),
        Task::Accuracy => accuracy::run(root),
        Task::Ticks => ticks::run(root),
        Task::BoardImage { what: Counted::Ticks } => board_image::measure(root, "ticks"),
        Task::BoardImage { what: Counted::Profile } => board_image::measure(root, "profile"),
        Task::Hardware => hardware::run(root, &mut Steps::default()),
        Task::Python { dist } => python::Started::new(root, dist)?.check(root, &mut Steps::default(), None),
        Task::Wheels => python::wheels(root, &mut Steps::default()),
        Task::Site => site::run(root, &mut Steps::default()),
        Task::Web { speed: true, .. } => web::speed(root),
        Task::Web { no_tests, .. } => web::run(root, &mut Steps::default(), !no_tests),
        Task::Figures { program } => figures::run(root, program.as_deref()),
        Task::Deb => package::deb(root),
        Task::Cluster => cluster::run(root, &test::program(root)),
        Task::Installed => package::try_installed(root),
        Task::Fuzz { target, seconds } => fuzz::run(root, target.as_deref(), seconds, Inputs::New),
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
