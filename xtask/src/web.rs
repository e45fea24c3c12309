//! The page: its core as WebAssembly, its files, and its tests in a browser.

use crate::{
    process::{Beside, cargo, cargo_in, output, run as done, target_folder},
    scratch::empty,
    steps::Steps,
    stop::Stop,
    tools,
};
use std::{ffi::OsStr, fs, path::Path, process::Command};

/// Folder of the page.
const FOLDER: &str = "web";

/// Workspace of what writes the JavaScript of a module.
pub const BINDINGS: &str = "web/bindings";

/// Profile of the modules.
const PROFILE: &str = "page";

/// The target of programs in a browser.
const TARGET: &str = "wasm32-unknown-unknown";

/// What a browser's registers of 128 bits are called.
const SIMD: &str = "target.wasm32-unknown-unknown.rustflags=[\"-Ctarget-feature=+simd128\"]";

/// Packages of the modules.
const PACKAGES: [&str; 4] = ["--package", "sprag-page", "--package", "sprag-page-lanes"];

/// What npm is told to run the tests by.
const TESTS: &[&str] = &["test"];

/// A build: words of cargo, and of each module the folder of the page's sources and the file.
type Build = (&'static [&'static str], &'static [(&'static str, &'static str)]);

/// Both modules at once, so that they share what they are built of; and the lanes again for browsers with SIMD.
const BUILDS: [Build; 2] = [
    (&PACKAGES, &[("page", "sprag_page"), ("lanes", "sprag_lanes")]),
    (&["--package", "sprag-page-lanes", "--config", SIMD], &[("lanes-simd", "sprag_lanes")]),
];

/// Builds the page into web/dist, and tests it in a browser if it shall be.
///
/// # Errors
/// At the first check that fails, or if there is no Node, no browser for the tests or no package index.
pub fn run(root: &Path, steps: &mut Steps, tested: bool) -> Result<(), Stop> {
    let path = steps.step("tools, page", || {
        tools::need_target(root, TARGET)?;
        if tested {
            tools::need_browser()?
        }
        tools::path_with_node(root)
    })?;
    steps.step("core of the page", || {
        empty(&root.join(FOLDER).join("src/core"))?;
        build(root)
    })?;
    // What the host's lints do not see.
    steps.step("lints, core of the page", || {
        let lints = ["--", "-D", "warnings"];
        done(cargo(root, &["clippy", "--profile", PROFILE, "--target", TARGET]).args(PACKAGES).args(lints))
    })?;
    let npm = |words: &[&str]| done(&mut npm(root, &path, words));
    steps.step("page", || {
        npm(&["ci", "--no-audit", "--no-fund"])?;
        npm(&["run", "check"])?;
        npm(&["run", "types"])?;
        npm(&["run", "build"])
    })?;
    if tested { steps.step("tests, page", || npm(TESTS)) } else { Ok(()) }
}

/// Starts the build as a process that runs beside other steps.
///
/// # Errors
/// If it cannot be started.
pub fn build_beside(root: &Path) -> Result<Beside, Stop> {
    let own = std::env::current_exe().map_err(|error| Stop::failed(error.to_string()))?;
    Beside::start(Command::new(own).current_dir(root).args(["web", "--no-tests"]))
}

/// Starts the tests of the page that is built, which run beside other steps.
///
/// # Errors
/// If there is no Node or no browser, or they cannot be started.
pub fn tests_beside(root: &Path) -> Result<Beside, Stop> {
    tools::need_browser()?;
    let path = tools::path_with_node(root)?;
    Beside::start(&mut npm(root, &path, TESTS))
}

/// A command of the page's tools, with the Node of `path`.
fn npm(root: &Path, path: &OsStr, words: &[&str]) -> Command {
    let mut command = Command::new("npm");
    command.current_dir(root.join(FOLDER)).env("PATH", path).args(words);
    command
}

/// Prints cells a second of the page's lanes on one core and their ratios to those of a program: with SIMD to the registers that every machine
/// of this target has, without to one block at a time.
///
/// # Errors
/// If something cannot be built, or there is no Node.
pub fn speed(root: &Path) -> Result<(), Stop> {
    let folder = root.join(FOLDER);
    build(root)?;
    let native = output(&mut cargo(root, &["bench", "--quiet", "--package", "sprag-cli", "--bench", "maps"]))?;
    let path = tools::path_with_node(root)?;
    let page = output(Command::new("node").current_dir(&folder).env("PATH", path).arg("benches/lanes.mjs"))?;
    println!("{native}");
    println!("cells a second of the page on one core; of a program's in brackets");
    println!("{:8} {:>34} {:>34}", "geometry", "SIMD / baseline registers", "no SIMD / one block at a time");
    for line in page.lines() {
        let [geometry, simd, plain] = line.split(' ').collect::<Vec<_>>()[..] else { continue };
        let all = native.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
        let found = all
            .into_iter()
            .find(|words| words.first().is_some_and(|name| name.eq_ignore_ascii_case(geometry)) && words.get(1) == Some(&"all"));
        // Device, widest and its ratio, baseline and its ratio, core.
        let [_, _, _, _, baseline, _, core] = found.unwrap_or_default()[..] else {
            return Err(Stop::failed(format!("the benchmark has no row for {geometry}")));
        };
        let ratio = |own: &str, native: &str| {
            let [own_rate, native_rate] = [own, native].map(|text| text.parse::<f64>().unwrap_or(f64::NAN));
            format!("{own} ({:.2} of {native})", own_rate / native_rate)
        };
        println!("{geometry:8} {:>34} {:>34}", ratio(simd, baseline), ratio(plain, core));
    }
    Ok(())
}

/// Builds all modules, and writes the JavaScript of each beside it.
fn build(root: &Path) -> Result<(), Stop> {
    for (words, modules) in BUILDS {
        done(cargo(root, &["build", "--profile", PROFILE, "--target", TARGET]).args(words))?;
        for (name, file) in modules {
            let module = target_folder(root).join(TARGET).join(PROFILE).join(file).with_extension("wasm");
            let place = root.join(FOLDER).join("src/core").join(name);
            fs::create_dir_all(&place).map_err(|error| Stop::failed(format!("{}: {error}", place.display())))?;
            done(cargo_in(root, BINDINGS, &["run", "--locked", "--quiet", "--"]).arg(module).arg(place))?;
        }
    }
    Ok(())
}
