//! Fuzzing with libFuzzer on the stable toolchain: the compiler's instrumentation is switched on by hand, with the
//! flags that cargo-fuzz uses without a sanitizer, so that nothing but a C++ compiler needs installing.

use crate::{
    process::{cargo_in, executables, filtered, host, target_folder},
    stop::Stop,
    tools,
};
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

/// The folder of the fuzz targets' workspace, from the root.
const WORKSPACE: &str = "tests/fuzz";

/// The compiler flags that make the program count its branches and show its comparisons to libFuzzer.
const INSTRUMENTATION: [&str; 8] = [
    "--cfg",
    "fuzzing",
    "-Cpasses=sancov-module",
    "-Cllvm-args=-sanitizer-coverage-level=4",
    "-Cllvm-args=-sanitizer-coverage-inline-8bit-counters",
    "-Cllvm-args=-sanitizer-coverage-pc-table",
    "-Cllvm-args=-sanitizer-coverage-trace-compares",
    "-Cdebug-assertions",
];

/// Which inputs are tried, of those that a corpus and a program lead to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inputs {
    /// Others every time.
    New,
    /// The same every time, so that a check which passed passes again.
    Same,
}

/// Runs one fuzz target, or each in turn, for so many seconds; 0 only tries the seeds.
///
/// # Errors
/// If there is no such target, the build fails, or an input makes a target panic, hang or eat the memory.
pub fn run(root: &Path, only: Option<&str>, seconds: u32, inputs: Inputs) -> Result<(), Stop> {
    tools::need_cxx()?;
    let fuzz = root.join(WORKSPACE);
    let mut targets = build(root)?;
    none_forgotten(&fuzz, &targets)?;
    if let Some(only) = only {
        let names: Vec<_> = targets.iter().map(|(name, _)| name.clone()).collect();
        targets.retain(|(name, _)| name == only);
        if targets.is_empty() {
            return Err(Stop::usage(format!("no fuzz target \"{only}\"; there are: {}", names.join(", "))));
        }
    }
    for (name, program) in &targets {
        println!("-- fuzzing {name} for {seconds} s");
        fuzz_one(&fuzz, name, program, seconds, inputs)?;
    }
    Ok(())
}

/// The command that checks whether the targets still compile, without libFuzzer and the instrumentation that make building them slow.
pub fn check(root: &Path) -> Command {
    let mut command = cargo_in(root, WORKSPACE, &["check", "--all-targets"]);
    // The root's folder has the libraries of others checked already.
    command.env("CARGO_TARGET_DIR", target_folder(root));
    command
}

/// Builds all targets and gives their names, in order, and programs.
fn build(root: &Path) -> Result<Vec<(String, PathBuf)>, Stop> {
    let host = host(root)?;
    // Naming the target keeps the flags away from build scripts, which could not be linked with them.
    let mut command = cargo_in(root, WORKSPACE, &["build", "--release", "--features", "run", "--target", &host]);
    command.env("CARGO_ENCODED_RUSTFLAGS", INSTRUMENTATION.join("\u{1f}"));
    let mut targets: Vec<_> = executables(&mut command, &[])?
        .into_iter()
        .filter_map(|program| Some((program.file_stem()?.to_str()?.to_owned(), program)))
        .collect();
    targets.sort();
    Ok(targets)
}

/// Makes sure that each file with a target was built: cargo does not look for them in that folder by itself.
fn none_forgotten(fuzz: &Path, built: &[(String, PathBuf)]) -> Result<(), Stop> {
    let folder = fuzz.join("targets");
    let cannot = |error| Stop::failed(format!("{}: {error}", folder.display()));
    for entry in fs::read_dir(&folder).map_err(cannot)? {
        let path = entry.map_err(cannot)?.path();
        if path.extension().is_some_and(|extension| extension == "rs")
            && built.iter().all(|(name, _)| path.file_stem().is_none_or(|stem| stem != name.as_str()))
        {
            return Err(Stop::failed(format!("{} is no [[bin]] of tests/fuzz/Cargo.toml", path.display())));
        }
    }
    Ok(())
}

fn fuzz_one(fuzz: &Path, target: &str, program: &Path, seconds: u32, inputs: Inputs) -> Result<(), Stop> {
    let artifacts = fuzz.join("artifacts").join(target);
    let corpus = fuzz.join("corpus").join(target);
    for folder in [&artifacts, &corpus] {
        fs::create_dir_all(folder).map_err(|error| Stop::failed(format!("{}: {error}", folder.display())))?;
    }
    let mut command = Command::new(program);
    // The longest run of a simulation is the millions of events that it may have, in some ten seconds; a hang is longer.
    command.current_dir(fuzz).args(["-rss_limit_mb=1024", "-timeout=60", "-max_len=16384"]);
    if inputs == Inputs::Same {
        command.arg("-seed=1");
    }
    command.args(["-print_final_stats=1", &format!("-artifact_prefix=artifacts/{target}/")]);
    // Short words that parsers look for, which random bytes would hardly ever spell.
    let dictionary = format!("dictionaries/{target}.txt");
    if fuzz.join(&dictionary).is_file() {
        command.arg(format!("-dict={dictionary}"));
    }
    command.arg(if seconds == 0 { "-runs=0".to_owned() } else { format!("-max_total_time={seconds}") });
    // What is found goes to the first folder; the second, committed, is only read.
    command.arg(format!("corpus/{target}")).arg(format!("seeds/{target}"));
    command.env("RUST_BACKTRACE", "1");
    let found = |_| {
        Stop::failed(format!(
            "fuzzing {target} failed, see above; the input is in tests/fuzz/artifacts/{target}, and in tests/fuzz/seeds/{target} it would be tried for ever"
        ))
    };
    filtered(&mut command, is_news).map_err(found)
}

/// Whether a line of libFuzzer is worth showing: not one for every new input, nor the words it learnt.
fn is_news(line: &str) -> bool {
    let new_function = line.starts_with("\tNEW_FUNC");
    let new_input = line.starts_with('#') && ["\tNEW ", "\tREDUCE "].iter().any(|word| line.contains(word));
    let learnt = line.starts_with('"') || line.starts_with("######");
    let missing_sanitizer = line.starts_with("WARNING: Failed to find function");
    !(new_input || new_function || learnt || missing_sanitizer)
}
