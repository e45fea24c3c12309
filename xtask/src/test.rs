//! Every check of the project, in the order in which they are cheapest to fail.

use crate::{
    board_image, cluster,
    firmware::{BOARD, Built, LINTED, TARGET},
    fuzz::{self, Inputs},
    hardware, package, panic_check,
    passed::Passed,
    process::{Beside, cargo, cargo_in, host, run as done, target_folder},
    python, site, size,
    steps::Steps,
    stop::Stop,
    tools, web,
};
use std::path::{Path, PathBuf};

/// The tests that prove a bound of the core's arithmetic by trying every input.
const EXHAUSTIVE: Passed = Passed {
    sources: &["shared/src/math", "tests/tests/motion/sine_exhaustive.rs"],
    file: "tests/tests/motion/sine_exhaustive.passed",
};

/// Tests that are not run again with the same sources, by what their names have in common.
const KEPT: [(&str, Passed); 2] = [("exhaustive::every_", EXHAUSTIVE), ("coil::tests::needs_ngspice::", hardware::COIL_TESTS)];

/// Runs every check; where `fuzz_seconds` are given, those too that have passed with the same sources before, the installed program, and each
/// fuzz target for so long.
///
/// # Errors
/// At the first check that fails.
pub fn run(root: &Path, fuzz_seconds: Option<u32>) -> Result<(), Stop> {
    let mut steps = Steps::default();
    steps.step("tools", || {
        tools::need_target(root, TARGET)?;
        tools::need_emulator()?;
        tools::need_unicorn()?;
        tools::need_circuit_simulator()?;
        tools::need_cxx()
    })?;
    steps.step("format", || {
        done(&mut cargo(root, &["fmt", "--all", "--check"]))?;
        done(&mut cargo_in(root, BOARD.workspace, &["fmt", "--all", "--check"]))?;
        done(&mut cargo_in(root, web::BINDINGS, &["fmt", "--check"]))
    })?;
    // The firmware and the page's bindings have target folders of their own, in which these wait for one another.
    let others: Vec<_> = LINTED
        .iter()
        .map(|image| Beside::start(image.cargo(root, "clippy").args(["--", "-D", "warnings"])))
        .chain([
            Beside::start(BOARD.cargo(root, "doc").arg("--no-deps").env("RUSTDOCFLAGS", "-D warnings")),
            Beside::start(&mut cargo_in(root, web::BINDINGS, &["build", "--locked"])),
        ])
        .collect::<Result<_, Stop>>()?;
    steps.step("lints, host", || {
        done(&mut cargo(root, &["clippy", "--workspace", "--all-targets", "--features", site::FULL, "--", "-D", "warnings"]))
    })?;
    // Not the tests: they are of the whole program.
    steps.step("lints, parts of host", || {
        ["", "effects"].iter().try_for_each(|features| {
            let args = ["clippy", "--package", "sprag-cli", "--bins", "--no-default-features", "--features", features];
            done(cargo(root, &args).args(["--", "-D", "warnings"]))
        })
    })?;
    steps.step("documentation", || done(&mut site::rust_documents(root)))?;
    steps.step("rest of board's lints and documentation, of bindings", || others.into_iter().try_for_each(Beside::wait))?;
    // No step until they are needed keeps both processors busy.
    let built_tests = Beside::start(&mut cargo(root, &["test", "--workspace", "--no-run"]))?;
    let python = steps.step("tools, python", || Ok(python::Started::new(root, false)))?;
    let built = images(root, &mut steps, false)?;
    steps.step("tests, drivers", || {
        // The workspace's own target is the board's.
        let host = host(root)?;
        let args = ["test", "--package", "sprag-drivers", "--target", &host];
        done(&mut cargo_in(root, BOARD.workspace, &args))?;
        done(&mut cargo_in(
            root,
            BOARD.workspace,
            &["clippy", "--package", "sprag-drivers", "--all-targets", "--target", &host, "--", "-D", "warnings"],
        ))
    })?;
    hardware::schematic(root, &mut steps, fuzz_seconds.is_some())?;
    steps.step("tests, board image", || board_image::tests(root, &built))?;
    steps.step("rest of the tests' build", || built_tests.wait())?;
    // While the last test of a program runs, one processor is idle.
    let page = web::build_beside(root)?;
    let fuzz_targets = Beside::start(&mut fuzz::check(root))?;
    steps.step("tests", || tests(root, &built, fuzz_seconds.is_some()))?;
    steps.step("rest of fuzz targets", || fuzz_targets.wait())?;
    steps.step("rest of the page's build", || page.wait())?;
    // Python, the site and the page's tests keep one processor busy each.
    let page = web::tests_beside(root)?;
    steps.step("Slurm array", || cluster::run(root, &program(root)))?;
    match python {
        Ok(python) => {
            python.check(root, &mut steps, Some(&built))?;
            site::run(root, &mut steps)?;
        }
        Err(stop) => println!("-- checks not run: the Python package, the site: {stop}"),
    }
    steps.step("rest of the page's tests", || page.wait())?;
    match fuzz_seconds {
        Some(seconds) => {
            steps.step("installed program", || package::try_installed(root))?;
            steps.step("fuzzing", || fuzz::run(root, None, seconds, Inputs::Same))
        }
        None => Ok(()),
    }
}

/// Runs every test of the workspace but those whose needs this machine cannot meet, which are named, and those of [`KEPT`] that have passed
/// with these sources, unless all are wanted. A need that it may not meet is the name of a module.
fn tests(root: &Path, built: &Built, all: bool) -> Result<(), Stop> {
    let mut command = cargo(root, &["test", "--workspace", "--", "--include-ignored"]);
    // The emulator is here by now.
    command.envs(built.variables());
    let mut lacking = Vec::new();
    for (need, folder) in [("needs_records", "../shared/records"), ("needs_cells", "../shared/reference")] {
        if !root.join(folder).is_dir() {
            lacking.push((need, format!("no folder {folder}")));
        }
    }
    match tools::python(root, "sim-host/cli/tests/command_line/needs_python/requirements.txt") {
        Ok(python) => _ = command.env("SPRAG_PYTHON", python),
        Err(stop) => lacking.push(("needs_python", stop.to_string())),
    }
    let mut changed = Vec::new();
    for (name, checks) in KEPT {
        let sources = checks.checksum(root)?;
        if !all && checks.holds(root, &sources) {
            lacking.push((name, "passed with the same sources before".to_owned()));
        } else {
            changed.push((checks, sources));
        }
    }
    for (need, _) in &lacking {
        command.args(["--skip", need]);
    }
    let result = done(&mut command);
    if result.is_ok() {
        changed.iter().try_for_each(|(checks, sources)| checks.keep(root, sources))?;
    }
    for (need, why) in lacking {
        println!("-- tests not run: {need}: {why}");
    }
    result
}

/// The program that the tests of the command run, once they are built.
pub fn program(root: &Path) -> PathBuf {
    target_folder(root).join("debug/sprag")
}

/// Builds the images for the board and checks them; new sizes are accepted if they shall be overwritten.
///
/// # Errors
/// At the first check that fails.
pub fn images(root: &Path, steps: &mut Steps, overwrite: bool) -> Result<Built, Stop> {
    let built = steps.step("images", || Built::all(root))?;
    steps.step("sizes", || {
        built.budgets().try_for_each(|(image, elf, budget)| {
            println!("-- {}", image.name);
            size::check(elf, &root.join(budget), overwrite)
        })
    })?;
    steps.step("panic check", || panic_check::run(root))?;
    Ok(built)
}
