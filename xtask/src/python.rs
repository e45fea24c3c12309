//! The Python package: its wheel, and its tests in an environment that has nothing else.

use crate::{
    firmware::Built,
    process::{Beside, output, run as done},
    scratch::empty,
    steps::Steps,
    stop::Stop,
    tools,
};
use std::{
    fs, io,
    path::{Path, PathBuf},
    process::Command,
};

/// Folder of the package.
const FOLDER: &str = "python";

/// Folder of the wheels that are built.
const WHEELS: &str = "target/wheels";

/// Environment of the tools that build them.
const BUILDER: &str = "target/python-build";

/// Machines that wheels are built for here, by Rust's and the package index's name.
const MACHINES: [&str; 2] = ["x86_64", "aarch64"];

/// The wheel of this machine, while it is built beside other steps.
#[derive(Debug)]
pub struct Started(Beside);

impl Started {
    /// Starts the build: with every optimisation for `others`, else of what the tests are built of. It waits for whatever builds in the
    /// target folder; all other wheels are removed.
    ///
    /// # Errors
    /// If there is no Python or no package index.
    pub fn new(root: &Path, others: bool) -> Result<Started, Stop> {
        let python = tools::python_of(root, BUILDER, "python/requirements.txt", &[])?;
        empty(&root.join(WHEELS))?;
        let mut build = maturin(root, &python, &["--profile", if others { "dist" } else { "dev" }])?;
        if !others {
            build.arg("--config").arg(tests_profile(root)?);
        }
        Beside::start(&mut build).map(Started)
    }

    /// Installs the wheel into an empty environment and tests it there, with the firmware too where images are `built`.
    ///
    /// # Errors
    /// At the first check that fails.
    pub fn check(self, root: &Path, steps: &mut Steps, built: Option<&Built>) -> Result<(), Stop> {
        steps.step("rest of python's wheel", || self.0.wait())?;
        check(root, steps, &last_wheel(root)?, built)
    }
}

/// A file of settings that makes `dev` the profile of tests, which no other build can name.
fn tests_profile(root: &Path) -> Result<PathBuf, Stop> {
    let cannot = |error: io::Error| Stop::failed(format!("the tests' profile: {error}"));
    let manifest = fs::read_to_string(root.join("Cargo.toml")).map_err(cannot)?;
    let mut settings = String::new();
    for part in manifest.split("\n[").filter_map(|part| part.strip_prefix("profile.test")) {
        settings.push_str(&format!("[profile.dev{part}\n"));
    }
    let file = root.join(WHEELS).join("profile.toml");
    fs::write(&file, settings).map_err(cannot)?;
    Ok(file)
}

/// Builds wheels that any Linux with glibc 2.17 or later loads, for x86_64 and aarch64, and checks the one of this machine.
///
/// # Errors
/// At the first check that fails, or if there is no Python or no package index.
pub fn wheels(root: &Path, steps: &mut Steps) -> Result<(), Stop> {
    let python = steps.step("tools", || tools::python_of(root, BUILDER, "python/requirements-wheels.txt", &[]))?;
    let built = steps.step("wheels", || {
        empty(&root.join(WHEELS))?;
        MACHINES.iter().map(|machine| portable(root, &python, machine)).collect::<Result<Vec<_>, _>>()
    })?;
    let own = MACHINES.iter().zip(built).find(|(machine, _)| **machine == std::env::consts::ARCH);
    own.map_or(Ok(()), |(_, wheel)| check(root, steps, &wheel, None))
}

/// Builds a wheel by Zig's C compiler and linker, which have every version of glibc.
fn portable(root: &Path, python: &Path, machine: &str) -> Result<PathBuf, Stop> {
    let target = format!("{machine}-unknown-linux-gnu");
    tools::need_target(root, &target)?;
    let options = ["--profile", "dist", "--zig", "--compatibility", "manylinux2014", "--target", &target];
    done(&mut maturin(root, python, &options)?)?;
    let wheel = found(root, machine)?;
    let shown = output(Command::new(python.with_file_name("auditwheel")).arg("show").arg(&wheel))?;
    println!("{shown}");
    let wanted = format!("manylinux_2_17_{machine}");
    if shown.contains(&wanted) { Ok(wheel) } else { Err(Stop::failed(format!("{}: it is not {wanted}", wheel.display()))) }
}

/// Installs a wheel into an empty environment and checks it there: lints, types, tests.
fn check(root: &Path, steps: &mut Steps, wheel: &Path, built: Option<&Built>) -> Result<(), Stop> {
    let python = steps.step("environment", || {
        let place = root.join("target/python-wheel");
        done(Command::new("python3").args(["-m", "venv", "--clear"]).arg(&place))?;
        let python = place.join("bin/python");
        let wanted = format!("{}[test]", wheel.display());
        done(tools::pip_install(&python).arg(wanted))?;
        Ok(python)
    })?;
    // From the root, where Python finds the package that is installed and not the folder's, which lacks its native module.
    let images = || built.into_iter().flat_map(Built::variables);
    let check = |words: &[&str]| done(Command::new(&python).current_dir(root).args(words).envs(images()));
    steps.step("lints, python", || {
        check(&["python/generate_tables.py", "--check"])?;
        let site = ["--config=python/pyproject.toml", "--exclude=docs/accuracy,docs/hardware,docs/made", "docs"];
        for words in [&["-m", "ruff", "check"][..], &["-m", "ruff", "format", "--check"]] {
            check(&[words, &[FOLDER]].concat())?;
            check(&[words, &site].concat())?;
        }
        Ok(())
    })?;
    steps.step("types, python", || {
        check(&["-m", "mypy", "--config-file", "python/pyproject.toml", "--package", "sprag"])?;
        check(&["-m", "mypy.stubtest", "sprag"])
    })?;
    steps.step("tests, python", || check(&["-m", "pytest", "--quiet", "--import-mode", "importlib", "python/tests"]))
}

/// The wheel for this machine that was built last.
///
/// # Errors
/// If there is none.
pub fn last_wheel(root: &Path) -> Result<PathBuf, Stop> {
    found(root, std::env::consts::ARCH)
}

/// The command that builds a wheel with the tools beside `python`.
fn maturin(root: &Path, python: &Path, options: &[&str]) -> Result<Command, Stop> {
    let mut build = Command::new(python.with_file_name("maturin"));
    build.current_dir(root.join(FOLDER)).args(["build", "--locked", "--out"]).arg(root.join(WHEELS)).args(options);
    // The Python that has Zig is the first.
    let others = std::env::var_os("PATH").unwrap_or_default();
    let folders = python.parent().into_iter().map(Path::to_owned).chain(std::env::split_paths(&others));
    build.env("PATH", std::env::join_paths(folders).map_err(|error| Stop::usage(format!("PATH: {error}")))?);
    Ok(build)
}

/// A wheel for a `machine` among those that are built.
fn found(root: &Path, machine: &str) -> Result<PathBuf, Stop> {
    let built = fs::read_dir(root.join(WHEELS)).into_iter().flatten().flatten().map(|file| file.path());
    let mut of_machine = built.filter(|path| path.to_string_lossy().ends_with(&format!("{machine}.whl")));
    of_machine.next().ok_or_else(|| Stop::failed(format!("there is no wheel in {WHEELS}: `cargo xtask python`")))
}
