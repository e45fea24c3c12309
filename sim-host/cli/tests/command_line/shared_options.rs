//! Options that every command has, and what its end means.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use super::{SHORT_SCENE, pulse, said, scene, sprag};

/// The commands that simulate, on small work; each writes to the folder `out`.
fn lines(folder: &Path) -> Vec<Vec<String>> {
    let path = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    fs::write(path("short.toml"), SHORT_SCENE).unwrap();
    fs::write(path("own.csv"), pulse(0.4)).unwrap();
    let (short, records) = (path("short.toml"), super::studies::folder_of_pulses(folder));
    let lines: [&[&str]; 8] = [
        &["simulate", &short],
        &["map", &short, "--x", "block.restitution=0.7:0.9:2", "--cut"],
        &["cloud", &scene("cloud"), "--records", &records],
        &["optimise", &scene("optimise"), "--records", &records],
        &["design", &short, "--set", "block.mass_kg=8000"],
        &["sensitivity", &short],
        &["similar", &short, "--with", "block.size_m=3"],
        &["loop", &scene("controller"), "--set", "run.free_time_s=0"],
    ];
    lines.map(|line| line.iter().map(|&word| word.to_owned()).collect()).to_vec()
}

fn run(folder: &Path, line: &[String], more: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sprag"));
    let formats: &[&str] = if more.contains(&"--formats") { &[] } else { &["--formats", "csv"] };
    command.current_dir(folder).args(line).args(["--out", "out", "--overwrite"]).args(formats).args(more).output().unwrap()
}

#[test]
fn json_is_the_summary_and_nothing_else_and_quiet_is_silent() {
    let folder = tempfile::tempdir().unwrap();
    for line in lines(folder.path()) {
        let plain = run(folder.path(), &line, &[]);
        let json = run(folder.path(), &line, &["--json"]);
        assert_eq!((plain.status.code(), json.status.code()), (Some(0), Some(0)), "{line:?}: {}", said(&json));
        let summary = fs::read(folder.path().join("out/summary.json")).unwrap();
        assert!(json.stdout == summary, "{line:?}: {}", String::from_utf8_lossy(&json.stdout));
        let document: serde_json::Value = serde_json::from_slice(&summary).unwrap();
        assert_eq!((&document["command"], &document["schema_version"]), (&line[0].as_str().into(), &1.into()), "{line:?}");
        // The table has moved; how fast the machine is may differ.
        let table = String::from_utf8(plain.stdout).unwrap();
        let moved = table.lines().next().is_some_and(|heading| said(&json).contains(heading));
        assert!(
            moved && table.ends_with("results written to out\n") && said(&json).ends_with("results written to out\n"),
            "{line:?}: {}",
            said(&json)
        );
        let quiet = run(folder.path(), &line, &["--quiet"]);
        assert!(quiet.status.success() && quiet.stdout.is_empty(), "{line:?}");
        assert!(said(&quiet).lines().count() < said(&json).lines().count(), "{line:?}: {}", said(&quiet));
        fs::remove_dir_all(folder.path().join("out")).unwrap();
    }
}

#[test]
fn every_command_takes_the_same_options() {
    let folder = tempfile::tempdir().unwrap();
    for line in lines(folder.path()) {
        let help = sprag(&[&line[0], "--help"]);
        let text = String::from_utf8(help.stdout).unwrap();
        for option in ["--out <DIR>", "--overwrite", "--formats <LIST>", "--png", "--json", "-q, --quiet", "--set <KEY=VALUE>"] {
            assert!(text.contains(option), "{line:?}: {option}");
        }
    }
    // A format that the command does not have is refused before the work.
    let short = folder.path().join("short.toml");
    let refused = sprag(&["simulate", short.to_str().unwrap(), "--formats", "csv,parquet"]);
    assert!(refused.status.code() == Some(2) && said(&refused).contains("--formats"), "{}", said(&refused));
    for line in lines(folder.path()).iter().filter(|line| ["sensitivity", "similar"].contains(&line[0].as_str())) {
        let output = run(folder.path(), line, &["--formats", "csv,parquet"]);
        assert!(
            output.status.success() && folder.path().join("out").join(format!("{}.parquet", line[0])).exists(),
            "{}",
            said(&output)
        );
    }
}

#[test]
fn pictures_come_as_asked() {
    let folder = tempfile::tempdir().unwrap();
    let [line, ..] = &lines(folder.path())[..] else { panic!() };
    for (more, svg, png) in [(&[][..], true, false), (&["--png"], true, true), (&["--formats", "csv,png"], false, true)] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_sprag"));
        let output = command.current_dir(folder.path()).args(line).args(["--out", "out"]).args(more).output().unwrap();
        assert!(output.status.success(), "{}", said(&output));
        let there = |name: &str| folder.path().join("out").join(name).exists();
        assert_eq!((there("history.svg"), there("history.png"), there("history.csv")), (svg, png, true), "{more:?}");
        fs::remove_dir_all(folder.path().join("out")).unwrap();
    }
}

#[test]
fn the_help_says_what_each_exit_code_means() {
    let help = String::from_utf8(sprag(&["--help"]).stdout).unwrap();
    let codes = help.split_once("Exit codes:").unwrap().1.split_whitespace().collect::<Vec<_>>().join(" ");
    for words in
        ["0 well", "1 finished and results written, with a negative or partial answer", "2 wrong usage", "130 int", "143 term"]
    {
        assert!(codes.contains(words), "`{words}`: {codes}");
    }
}

#[test]
fn a_picture_that_cannot_be_shown_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let simulate = &lines(folder.path())[0];
    let refused = run(folder.path(), simulate, &["--formats", "csv", "--open"]);
    assert_eq!(refused.status.code(), Some(2), "{}", said(&refused));
    assert!(said(&refused).contains("--open: there is no picture to show without svg or png"), "{}", said(&refused));
    assert!(!folder.path().join("out").exists());
    // Only there are all programs that show pictures found by the search path.
    if cfg!(target_os = "linux") {
        let nobody = tempfile::tempdir().unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_sprag"));
        command.current_dir(&folder).env("PATH", nobody.path()).args(simulate).args(["--out", "out", "--open"]);
        let shown = command.output().unwrap();
        let picture = Path::new("out").join("history.svg");
        let line = format!("sprag: {}: written, but there is no program that could show it", picture.display());
        assert!(shown.status.success() && said(&shown).lines().any(|said| said == line), "{}", said(&shown));
    }
}
