//! The `sprag` command as a user meets it: what it writes, what it says, that bad input costs one clear line, and its numbers beside Python's.

mod accuracy_options;
mod bad_input;
mod batch_streams;
mod divided;
mod formats;
mod keys;
mod long_runs;
mod needs_python;
mod outputs;
mod records;
mod runs;
mod shared_options;
mod studies;
#[cfg(unix)]
mod terminal;
mod usage;
mod warnings;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const SCENES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes");

/// The first line of a case file.
const CASE_TITLES: &str =
    "id,geometry,slenderness_deg,device,mass_ratio,restitution,pulse,frequency_ratio,amplitude_ratio,free_time\n";

fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sprag"));
    command.args(arguments);
    command
}

fn sprag(arguments: &[&str]) -> Output {
    command(arguments).output().expect("sprag starts")
}

/// The output of a run that succeeds.
fn well(output: Output) -> Output {
    assert!(output.status.success(), "{}", said(&output));
    output
}

/// The summary in `folder`.
fn summary(folder: &Path) -> serde_json::Value {
    serde_json::from_slice(&fs::read(folder.join("summary.json")).unwrap()).unwrap()
}

/// What was said on the side of anything but records.
fn errors(message: &str) -> Vec<&str> {
    message.lines().filter(|line| !line.starts_with("sprag: warning: ")).collect()
}

/// Runs `sprag`, expects exit code 2 and one line that contains `words`, and that `out` holds no file.
fn refused(arguments: &[&str], out: &Path, words: &[&str]) {
    let output = sprag(arguments);
    let message = said(&output);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    assert_eq!(errors(&message).len(), 1, "one line: {message}");
    for word in words {
        assert!(message.contains(word), "{arguments:?} must say `{word}`: {message}");
    }
    let left: Vec<PathBuf> = fs::read_dir(out).map(|files| files.map(|file| file.unwrap().path()).collect()).unwrap_or_default();
    assert!(left.is_empty(), "half-written: {left:?}");
}

fn scene(name: &str) -> String {
    format!("{SCENES}/{name}.toml")
}

/// A block under a short pulse: the whole table of variants in a moment.
const SHORT_SCENE: &str = "[block]\nsize_m = 2\nslenderness_deg = 10\n[[device]]\nkind = \"inerter\"\nmass_ratio = 0.2\n\
    [[ground]]\nmotion = \"record\"\nfile = \"own.csv\"\n[run]\nfree_time_s = 2\n";

/// Half a sine of `peak` (g) and 0.6 s, as a record.
fn pulse(peak: f64) -> String {
    let sample = |k: i32| format!("{},{}\n", f64::from(k) * 0.01, peak * f64::from(k * (60 - k)) / 900.0);
    (0..=60).fold("# time_s,acc_g\n".to_owned(), |text, k| text + &sample(k))
}

/// What a run said on the side, without the lines of work that takes long on a busy machine.
fn said(output: &Output) -> String {
    let number = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit() || c == ',');
    let sign_of_life = |line: &str| {
        let counted = line.strip_prefix("sprag: ").and_then(|line| line.split_once(" of "));
        counted.is_some_and(|(count, rest)| number(count) && number(rest.split(' ').next().unwrap_or_default()))
            || line.contains(" so far")
    };
    String::from_utf8_lossy(&output.stderr).split_inclusive('\n').filter(|line| !sign_of_life(line)).collect()
}
