//! Studies that are planned in parts for many machines: always the bytes of a run that was not divided.

use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use super::long_runs::{files, folders, grown};
use super::studies::folder_of_pulses;
use super::{said, scene, well};

/// A smaller map.
const CELLS: [&str; 2] = ["map.x.cells=20", "map.y.cells=16"];

fn sprag(folder: &Path, words: &[&str]) -> Output {
    command(folder, words).output().unwrap()
}

fn command(folder: &Path, words: &[&str]) -> Command {
    let mut command = super::command(words);
    command.current_dir(folder);
    command
}

fn printed(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn refused(output: &Output, words: &[&str]) {
    assert_eq!(output.status.code(), Some(2), "{}{}", said(output), printed(output));
    assert!(words.iter().all(|word| said(output).contains(word)), "{}", said(output));
}

#[test]
fn parts_of_a_map_in_any_order_are_the_map() {
    let (root, whole, collected) = folders();
    let here = root.path();
    let scene = scene("figure08");
    let map = ["map", &scene, "--set", CELLS[0], "--set", CELLS[1], "--formats", "csv,svg", "--out"];
    well(sprag(here, &[&map[..], &["one"]].concat()));
    well(sprag(here, &[&["plan", "parts", "--parts", "5", "--"], &map[..], &["other"]].concat()));
    refused(&sprag(here, &["collect", "parts"]), &["5 of 5 parts are missing", "part-00001.parquet"]);
    // What processes have left that were killed goes with their part, and with the rest at the end.
    let left = ["00004", "00003", "lost"].map(|name| here.join("parts").join(format!(".unfinished-{name}-x")));
    left.iter().for_each(|folder| std::fs::create_dir(folder).unwrap());
    std::fs::write(left[0].join("map-4-of-5.csv.unfinished"), "x").unwrap();
    for part in ["4", "2", "5"] {
        well(sprag(here, &["part", "parts", part]));
    }
    assert_eq!(left.each_ref().map(|folder| folder.exists()), [false, true, true]);
    // One that is killed leaves no part; two that make the same one do no harm.
    let mut killed = command(here, &["part", "parts", "1"]).stdout(Stdio::null()).spawn().unwrap();
    killed.kill().unwrap();
    killed.wait().unwrap();
    let twice: Vec<_> = (0..2).map(|_| command(here, &["part", "parts", "1"]).stdout(Stdio::null()).spawn().unwrap()).collect();
    for part in twice {
        well(part.wait_with_output().unwrap());
    }
    refused(&sprag(here, &["collect", "parts"]), &["1 of 5 parts are missing", "part-00003.parquet"]);
    well(sprag(here, &["part", "parts", "3", "--threads", "1"]));
    // What is there is not made again, and what is there of another plan is.
    assert!(printed(&sprag(here, &["part", "parts", "3"])).contains("was there"));
    std::fs::write(here.join("parts/part-00002.parquet"), "not a table").unwrap();
    refused(&sprag(here, &["collect", "parts"]), &["part-00002.parquet: damaged; 1 of 5 parts are missing"]);
    assert!(printed(&sprag(here, &["part", "parts", "2"])).contains("made"));
    well(sprag(here, &["collect", "parts"]));
    assert_eq!(files(&whole), files(&collected));
    // Nothing but plan and parts is left.
    let left: Vec<_> = std::fs::read_dir(here.join("parts")).unwrap().map(|file| file.unwrap().file_name()).collect();
    assert_eq!(left.len(), 6, "{left:?}");
}

#[test]
fn parts_of_a_cloud_are_the_cloud() {
    for accuracy in [&[][..], &["--accuracy", "fast"]] {
        let (root, whole, collected) = folders();
        let here = root.path();
        let (study, records) = (scene("cloud"), folder_of_pulses(here));
        let cloud = [&["cloud", &study, "--records", &records, "--formats", "csv,svg"][..], accuracy, &["--out"]].concat();
        well(sprag(here, &[&cloud[..], &["one"]].concat()));
        well(sprag(here, &[&["plan", "parts", "--parts", "4", "--"], &cloud[..], &["other"]].concat()));
        for part in ["1", "2", "3", "4"] {
            well(sprag(here, &["part", "parts", part]));
        }
        well(sprag(here, &["collect", "parts"]));
        for name in ["runs.csv", "demand.csv", "fragility.csv", "fragility.svg", "summary.json"] {
            let read = |folder: &Path| std::fs::read(folder.join(name)).unwrap();
            assert!(read(&whole) == read(&collected), "{accuracy:?} {name}");
        }
    }
}

/// Rows of a part that is interrupted are gone, and nothing is said of keeping them.
#[cfg(unix)]
#[test]
fn an_interrupted_part_is_not_there() {
    let (root, ..) = folders();
    let here = root.path();
    let slow = ["--set", "map.x.cells=2000", "--set", "map.y.cells=2000", "--set", "ground.0.motion=\"half-sine\""];
    let figure = scene("figure08");
    let plan = ["plan", "parts", "--parts", "2", "--", "map", &figure];
    well(sprag(here, &[&plan[..], &slow].concat()));
    let process = command(here, &["part", "parts", "2"]).stderr(Stdio::piped()).spawn().unwrap();
    let names = || -> Vec<String> {
        let files = std::fs::read_dir(here.join("parts")).unwrap();
        files.map(|file| file.unwrap().file_name().into_string().unwrap()).collect()
    };
    let start = Instant::now();
    let scratch = || names().into_iter().find(|name| name.starts_with(".unfinished-"));
    while scratch().is_none() && start.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(1));
    }
    grown(&here.join("parts").join(scratch().unwrap()), ["map-2-of-2.csv.unfinished", "map-2-of-2.csv"]);
    super::terminal::signal("-INT", process.id());
    let ended = process.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(130));
    let words = "sprag: interrupted; part 2 is not there; the same command makes it\n";
    assert!(said(&ended).ends_with(words), "{}", said(&ended));
    assert!(!names().iter().any(|name| name.starts_with("part-")), "{:?}", names());
}

#[test]
fn a_plan_is_of_one_run() {
    let (root, ..) = folders();
    let here = root.path();
    std::fs::copy(scene("figure08"), here.join("scene.toml")).unwrap();
    let plan = |more: &[&str]| sprag(here, &[&["plan", "parts"], more, &["--", "map", "scene.toml"]].concat());
    let key = |output: &Output| printed(output).split("key ").nth(1).map(|key| key.trim().to_owned()).unwrap();
    let first = plan(&["--parts", "3"]);
    assert_eq!(key(&first), key(&plan(&["--parts", "3"])));
    refused(&plan(&["--parts", "4"]), &["number of parts"]);
    // Some seconds of work are one part.
    assert!(printed(&sprag(here, &["plan", "short", "--", "map", "scene.toml"])).starts_with("1 parts of 12288 rows"));
    let slurm = sprag(here, &["plan", "parts", "--parts", "3", "--slurm", "--", "map", "scene.toml"]);
    let script = printed(&slurm);
    assert!(script.contains("#SBATCH --array=1-3") && script.contains("sprag part 'parts'"), "{script}");
    refused(&sprag(here, &["part", "parts", "0"]), &["from 1 to 1000000"]);
    refused(&sprag(here, &["part", "parts", "4000"]), &["there is no part 4000"]);
    refused(&sprag(here, &["part", "parts", "4"]), &["there is no part 4"]);
    refused(&sprag(here, &["part", "nowhere", "1"]), &["plan.json"]);
    refused(&sprag(&here.join("parts"), &["part", ".", "1"]), &["the plan was made in"]);
    refused(&sprag(here, &["plan", "p", "--", "simulate", "scene.toml"]), &["`map` and `cloud`"]);
    refused(&sprag(here, &["plan", "p", "--", "map", "scene.toml", "--shard", "1/2"]), &["--shard"]);
    well(sprag(here, &["part", "parts", "3"]));
    // A scene that has changed since. A part that is there is not compared with it: to collect the parts is refused.
    let text = std::fs::read_to_string(here.join("scene.toml")).unwrap().replace("restitution = ", "restitution = 0.9 # ");
    std::fs::write(here.join("scene.toml"), text).unwrap();
    refused(&sprag(here, &["part", "parts", "1"]), &["scene.block.restitution differs"]);
    assert!(printed(&sprag(here, &["part", "parts", "3"])).contains("was there"));
    refused(&sprag(here, &["collect", "parts"]), &["scene.block.restitution differs"]);
}
