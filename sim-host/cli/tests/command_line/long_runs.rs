//! Runs that are split over processes, interrupted and killed, by the command itself: always the bytes of one run.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use super::studies::folder_of_pulses;
use super::{command, said, scene, well};

/// Cells that are simulated one by one, so that a run takes a while.
pub const SLOW: [&str; 6] = ["--set", "map.x.cells=24", "--set", "map.y.cells=20", "--set", "ground.0.motion=\"half-sine\""];

pub fn map(out: &Path, more: &[&str]) -> Command {
    command(&[&["map", &scene("figure08"), "--out", out.to_str().unwrap()], more].concat())
}

/// The files without times.
pub fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let read = |name: &str| (name.to_owned(), std::fs::read(folder.join(name)).unwrap());
    ["map.csv", "map.svg", "rotation.svg", "acceleration.svg"].map(read).to_vec()
}

pub fn folders() -> (tempfile::TempDir, PathBuf, PathBuf) {
    let root = tempfile::tempdir().unwrap();
    let [one, other] = ["one", "other"].map(|name| root.path().join(name));
    (root, one, other)
}

#[test]
fn two_processes_make_the_bytes_of_one() {
    let (_root, whole, split) = folders();
    well(map(&whole, &[]).output().unwrap());
    let parts: Vec<Child> =
        ["1/2", "2/2"].map(|shard| map(&split, &["--shard", shard]).stdout(Stdio::null()).spawn().unwrap()).into();
    for part in parts {
        well(part.wait_with_output().unwrap());
    }
    assert!(!split.join("map.csv").exists() && !split.join("map.svg").exists());
    well(map(&split, &["--merge", "2"]).output().unwrap());
    assert_eq!(files(&whole), files(&split));
    // A part of another scene is not taken.
    let other = map(&split, &["--merge", "2", "--set", "block.restitution=0.8"]).output().unwrap();
    assert_eq!(other.status.code(), Some(2));
    assert!(said(&other).contains("scene.block.restitution"), "{}", said(&other));
    // Nor is one that is not there.
    std::fs::remove_file(split.join("map-2-of-2.csv")).unwrap();
    let missing = map(&split, &["--merge", "2"]).output().unwrap();
    assert!(said(&missing).contains("shard 2/2 is not finished"), "{}", said(&missing));
}

/// Waits until some rows of the map are written.
pub fn begun(folder: &Path) {
    grown(folder, ["map.csv.unfinished", "map.csv"]);
}

/// Waits until a file has some rows, or the one that it leads to is there.
pub fn grown(folder: &Path, [unfinished, finished]: [&str; 2]) {
    let start = Instant::now();
    while std::fs::metadata(folder.join(unfinished)).map_or(0, |data| data.len()) < 400 {
        if folder.join(finished).exists() || start.elapsed() > Duration::from_secs(60) {
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn a_killed_run_resumes() {
    let (_root, whole, killed) = folders();
    well(map(&whole, &SLOW).output().unwrap());
    let mut process = map(&killed, &SLOW).args(["--threads", "1"]).stdout(Stdio::null()).spawn().unwrap();
    begun(&killed);
    process.kill().unwrap();
    process.wait().unwrap();
    if killed.join("map.csv.unfinished").exists() {
        // Nothing is thrown away unasked.
        let again = map(&killed, &SLOW).output().unwrap();
        assert_eq!(again.status.code(), Some(2));
        assert!(said(&again).contains("--resume"), "{}", said(&again));
    }
    well(map(&killed, &SLOW).arg("--resume").output().unwrap());
    assert_eq!(files(&whole), files(&killed));
    // All there: nothing is worked out again, and pictures are.
    std::fs::remove_file(killed.join("map.svg")).unwrap();
    well(map(&killed, &SLOW).arg("--resume").output().unwrap());
    assert_eq!(files(&whole), files(&killed));
}

#[cfg(unix)]
#[test]
fn control_c_leaves_what_is_finished() {
    let (_root, folder, _) = folders();
    let large = ["--set", "map.x.cells=3000", "--set", "map.y.cells=3000", "--set", "ground.0.motion=\"half-sine\""];
    let process = map(&folder, &large).stderr(Stdio::piped()).spawn().unwrap();
    begun(&folder);
    super::terminal::signal("-INT", process.id());
    let ended = process.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(130));
    assert!(said(&ended).contains("of 27000000 rows are kept; the same command with --resume continues"), "{}", said(&ended));
    assert!(folder.join("map.csv.unfinished").exists() && !folder.join("map.csv").exists());
}

/// An optimisation that is killed and resumed leaves the files of one that is not, and no others.
#[test]
fn a_killed_optimisation_resumes() {
    let (root, whole, killed) = folders();
    let records = folder_of_pulses(root.path());
    let run = |out: &Path, more: &[&str]| {
        let optimise = ["optimise", &scene("optimise"), "--records", &records, "--out", out.to_str().unwrap()];
        command(&[&optimise, more].concat())
    };
    well(run(&whole, &[]).output().unwrap());
    let mut process = run(&killed, &["--threads", "1"]).stdout(Stdio::null()).spawn().unwrap();
    grown(&killed, ["tried.csv.unfinished", "summary.json"]);
    process.kill().unwrap();
    process.wait().unwrap();
    if killed.join("tried.csv.unfinished").exists() {
        let again = run(&killed, &[]).output().unwrap();
        assert_eq!(again.status.code(), Some(2));
        assert!(said(&again).contains("tried.csv.unfinished") && said(&again).contains("--resume"), "{}", said(&again));
    }
    well(run(&killed, &["--resume"]).output().unwrap());
    let all = |folder: &Path| {
        let mut files: Vec<(String, Vec<u8>)> = std::fs::read_dir(folder)
            .unwrap()
            .map(|file| file.unwrap())
            .map(|file| (file.file_name().into_string().unwrap(), std::fs::read(file.path()).unwrap()))
            .collect();
        files.sort();
        files
    };
    assert!(all(&whole) == all(&killed));
}
