//! The Python package: its wheel, and its tests in an environment that has nothing else.

use crate::{
    firmware::Built,
    process::{cargo, run as done},
    steps::Steps,
    stop::Stop,
    tools,
};
use std::{
    path::{Path, PathBuf},
    process::Command,
};

/// Folder of the package.
const FOLDER: &str = "python";

/// Folder of the wheels that are built.
const WHEELS: &str = "target/wheels";

/// Lints the package, builds its wheel by `profile` of its workspace, installs that into an empty environment and tests it there, with the
/// firmware too where images are `built`.
///
/// # Errors
/// At the first check that fails, or if there is no Python or no package index.
pub fn run(root: &Path, steps: &mut Steps, profile: &str, built: Option<&Built>) -> Result<(), Stop> {
    let folder = root.join(FOLDER);
    steps.step("lints, python's native module", || {
        done(&mut cargo(&folder, &["fmt", "--check"]))?;
        done(&mut cargo(&folder, &["clippy", "--locked", "--profile", profile, "--", "-D", "warnings"]))
    })?;
    let wheel = steps.step("wheel", || wheel(root, profile))?;
    let python = steps.step("environment", || {
        let place = root.join("target/python-wheel");
        done(Command::new("python3").args(["-m", "venv", "--clear"]).arg(&place))?;
        let python = place.join("bin/python");
        let wanted = format!("{}[test]", wheel.display());
        done(Command::new(&python).args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", &wanted]))?;
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

/// Builds the wheel.
fn wheel(root: &Path, profile: &str) -> Result<PathBuf, Stop> {
    let python = tools::python_of(root, "target/python-build", "python/requirements.txt", &[])?;
    let wheels = root.join(WHEELS);
    let _ = std::fs::remove_dir_all(&wheels);
    let mut build = Command::new(python.with_file_name("maturin"));
    done(build.current_dir(root.join(FOLDER)).args(["build", "--locked", "--profile", profile, "--out"]).arg(&wheels))?;
    built(&wheels).ok_or_else(|| Stop::failed(format!("there is no wheel in {WHEELS}")))
}

/// The wheel that was built last; where there is none, a new one.
///
/// # Errors
/// If it cannot be built.
pub fn last_wheel(root: &Path) -> Result<PathBuf, Stop> {
    built(&root.join(WHEELS)).map_or_else(|| wheel(root, "dev"), Ok)
}

fn built(wheels: &Path) -> Option<PathBuf> {
    Some(std::fs::read_dir(wheels).ok()?.next()?.ok()?.path())
}
