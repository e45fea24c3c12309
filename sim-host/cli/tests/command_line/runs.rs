//! What runs write and say.

use std::fs;
use std::process::{Command, Output};

use super::studies::on_any_threads;
use super::{command, refused, said, scene, sprag, summary, well};

#[test]
fn simulate_writes_its_three_files_and_a_summary() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("near");
    let output = well(sprag(&["simulate", &scene("near_fault"), "--out", out.to_str().unwrap()]));
    let table = String::from_utf8(output.stdout).unwrap();
    for device in ["none", "inerter", "clutched pair"] {
        assert!(table.contains(device), "{table}");
    }
    assert!(table.contains("friction needed at impacts: 0.460 (none), 0.690 (inerter), 0.460 (clutched pair)"), "{table}");
    let mut files: Vec<_> = fs::read_dir(&out).unwrap().map(|file| file.unwrap().file_name()).collect();
    files.sort();
    assert_eq!(files, ["history.csv", "history.svg", "summary.json"]);
    let summary = summary(&out);
    assert_eq!(summary["command"], "simulate");
    assert_eq!(summary["scene"]["block"]["restitution"], 0.85);
    let runs = summary["runs"].as_array().unwrap();
    assert_eq!(runs.len(), 3);
    for run in runs {
        for key in ["device", "outcome", "peak_rotation", "peak_acceleration", "impacts"] {
            assert!(run.get(key).is_some(), "{key} in {run}");
        }
    }
}

/// A block that has overturned when its run begins, and a run that ends at once.
#[test]
fn a_run_without_time_keeps_its_results_without_a_picture() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scene.toml");
    let block = "[block]\nsize_m = 2.0\nslenderness_deg = 10.0\ngeometry = \"slender\"\ninitial_rotation_ratio = ";
    for (name, text, outcome) in [
        ("fallen", "1.2\n[[device]]\nkind = \"none\"\n", "overturned-without-impact"),
        ("short", "0.5\n[[device]]\nkind = \"none\"\n[run]\nfree_time_s = 0\n", "safe"),
    ] {
        fs::write(&file, format!("{block}{text}")).unwrap();
        let out = folder.path().join(name);
        let output = sprag(&["simulate", file.to_str().unwrap(), "--out", out.to_str().unwrap()]);
        assert_eq!(said(&output), "sprag: history: no picture: the responses span no time, so there is no time axis to draw\n");
        assert!(output.status.success());
        let summary = summary(&out);
        assert_eq!(summary["runs"][0]["outcome"], outcome, "{name}");
        assert!(out.join("history.csv").exists() && !out.join("history.svg").exists(), "{name}");
    }
}

#[test]
fn a_new_file_on_standard_output_is_the_file_alone() {
    let output = sprag(&["new", "scene", "-"]);
    let text = String::from_utf8(output.stdout).unwrap();
    sprag_sim::scene::Scene::parse(&text, "scene.toml").unwrap();
    assert!(text.starts_with("#:schema") && output.status.success());
    assert!(!std::path::Path::new("scene.schema.json").exists());
}

#[test]
fn keys_of_whole_numbers_may_be_axes() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    well(sprag(&[
        "map",
        &scene("figure08"),
        "--cut",
        "--set",
        "block.restitution_scatter=0.1",
        "--x",
        "block.restitution_seed=1:4:4",
        "--out",
        out.to_str().unwrap(),
    ]));
}

#[test]
fn the_same_scene_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let outs = ["first", "second"].map(|name| folder.path().join(name));
    for out in &outs {
        assert!(sprag(&["simulate", &scene("near_fault"), "--out", out.to_str().unwrap()]).status.success());
    }
    for file in ["summary.json", "history.csv", "history.svg"] {
        assert!(fs::read(outs[0].join(file)).unwrap() == fs::read(outs[1].join(file)).unwrap(), "{file}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn ctrl_c_ends_a_long_run_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let figure = scene("figure05");
    let run = ["simulate", &figure, "--out", out.to_str().unwrap(), "--set", "accuracy.method=runge-kutta-4"];
    let long = ["--set", "accuracy.step_ratio=1e-7", "--set", "run.free_time_ratio=10000"];
    let mut child = command(&[&run[..], &long].concat()).stderr(std::process::Stdio::null()).spawn().unwrap();
    // The folder is made once the scene has been read and just before the work starts.
    while !out.is_dir() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(!out.exists(), "an empty folder");
}

#[test]
fn effects_are_listed_and_shown() {
    let text = |arguments: &[&str]| {
        let output = well(sprag(arguments));
        String::from_utf8(output.stdout).unwrap()
    };
    let table = text(&["effects"]);
    let names = [
        "kinematics",
        "mount",
        "support",
        "geometry",
        "vertical",
        "impact",
        "scatter",
        "sliding",
        "foundation",
        "flywheel",
        "engagement",
        "clutch",
        "slip",
        "rack",
        "actuation",
        "weight",
        "checks",
        "energy",
    ];
    for name in names {
        assert!(table.lines().any(|line| line.starts_with(name)), "{name}: {table}");
        let in_full = text(&["effects", name]);
        assert!(["equation", "source", "keys", "cost"].iter().all(|part| in_full.contains(part)), "{in_full}");
        assert!(in_full.lines().chain(table.lines()).all(|line| line.chars().count() <= 130), "{in_full}");
    }
    assert!(table.contains("device.N.clutch.capacity_ratio") && !table.contains('\u{1b}'), "{table}");
    let json: serde_json::Value = serde_json::from_str(&text(&["effects", "--json"])).unwrap();
    let entries = json.as_array().unwrap();
    assert_eq!(entries.len(), names.len());
    for entry in entries {
        assert!(names.iter().any(|name| entry["name"] == *name), "{entry}");
        for key in ["summary", "equation", "source", "keys"] {
            assert!(entry.get(key).is_some(), "{key} in {entry}");
        }
        assert!(entry["keys"][0]["key"].is_string() && entry.get("cost").is_some(), "{entry}");
    }
    let one: serde_json::Value = serde_json::from_str(&text(&["effects", "rack", "--json"])).unwrap();
    assert_eq!(one["name"], "rack");
    let nowhere = tempfile::tempdir().unwrap();
    refused(&["effects", "magic"], nowhere.path(), &["magic", "kinematics", "energy"]);
}

#[test]
fn explain_says_what_is_on_why_and_which_equation_results() {
    let seed = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/fuzz/seeds/scene/effects.toml");
    let output = well(sprag(&["explain", seed, "--set", "device.3.clutch.capacity_ratio=0.25"]));
    let text = String::from_utf8(output.stdout).unwrap();
    for words in [
        "whole scene",
        "because block.restitution = \"momentum-balance\"",
        "because device.3.clutch.capacity_ratio = 0.25",
        "(λ + κ σ ℓ²) θ̈ + κ σ ℓ ℓ′ θ̇² = −(g/R) [ (1 + v̈_g/g) sin δ + (ü_g/g) cos δ ] − ℓ (F₁ + F₂)/(m R)",
        "F_c = 0.25 m g",
        "effects off: mount",
        "followed by",
    ] {
        assert!(text.contains(words), "must say `{words}`: {text}");
    }
    assert!(text.lines().all(|line| line.chars().count() <= 130) && !text.contains('\u{1b}'), "{text}");
    let output = sprag(&["explain", seed, "--json"]);
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["schema_version"], 1);
    let devices = json["devices"].as_array().unwrap();
    let explained =
        |device: &serde_json::Value| device["sections"][0]["lines"][0].is_string() && device["effects"]["on"].is_array();
    assert!(!devices.is_empty() && devices.iter().all(explained), "{json}");
    // No record is read, so that a scene may be explained before there is one.
    let output = sprag(&["explain", &scene("record")]);
    assert!(output.status.success() && String::from_utf8_lossy(&output.stdout).contains("effects on: none"));
    let nowhere = tempfile::tempdir().unwrap();
    refused(&["explain", "nowhere.toml"], nowhere.path(), &["nowhere.toml"]);
    let brake = "device.2.flywheel.brake_deceleration_m_s2=instant";
    refused(&["explain", &scene("figure05"), "--set", brake], nowhere.path(), &["figure05.toml", "brake", "ideal clutch"]);
}

/// Expects that a run succeeds and says `words`.
fn says(words: &str) -> impl Fn(&Output) {
    move |output: &Output| {
        let table = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success() && table.contains(words), "{}{table}", said(output));
    }
}

#[test]
fn loop_writes_its_files_and_does_not_depend_on_the_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let sets = ["--set", "run.free_time_s=0", "--set", "controller.rate_hz=500", "--monte-carlo", "3"];
    let controller = scene("controller");
    let line = [&["loop", &controller][..], &sets].concat();
    let files = ["summary.json", "history.csv", "loop.svg", "monte_carlo.csv"];
    let (_, summary) = on_any_threads(folder.path(), &line, says("ideal pair"), &files);
    let run = &summary["runs"][0];
    assert_eq!(
        (&summary["command"], &run["outcome"], &run["controller_state"]),
        (&"loop".into(), &"safe".into(), &"armed".into())
    );
    assert_eq!(run["monte_carlo"]["specimens"], 3);
    assert!(run["peak_change"].as_f64().unwrap().abs() < 0.05);
}

#[test]
fn specimens_of_impacts_are_those_of_their_seeds() {
    let folder = tempfile::tempdir().unwrap();
    let scattered = ["--set", "block.restitution_scatter=0.03", "--set", "block.restitution_seed=5"];
    let near_fault = scene("near_fault");
    let line = [&["simulate", &near_fault][..], &scattered, &["--monte-carlo", "4"]].concat();
    let (out, summary) = on_any_threads(folder.path(), &line, says("4 specimens"), &["summary.json", "monte_carlo.csv"]);
    let table = fs::read_to_string(out.join("monte_carlo.csv")).unwrap();
    let devices = summary["runs"].as_array().unwrap();
    assert_eq!(summary["monte_carlo"].as_array().unwrap().len(), devices.len());
    assert_eq!(table.lines().count(), 1 + 4 * devices.len(), "{table}");
    // Each specimen is the scene with its seed, whether in lanes or not, and no two are alike.
    for (number, seed) in (5..9).enumerate() {
        let out = folder.path().join(seed.to_string());
        let set = format!("block.restitution_seed={seed}");
        let line = ["simulate", &near_fault, scattered[0], scattered[1], "--set", &set, "--out", out.to_str().unwrap()];
        well(sprag(&line));
        let alone = super::summary(&out);
        for device in alone["runs"].as_array().unwrap() {
            let of_device = |row: &&str| row.split(',').next() == device["device"].as_str();
            let row: Vec<&str> = table.lines().filter(of_device).nth(number).unwrap().split(',').collect();
            assert_eq!(
                (row[2], row[4].parse().ok()),
                (device["outcome"].as_str().unwrap(), device["impacts"].as_u64()),
                "{row:?}"
            );
            let (found, exact) = (row[3].parse::<f64>().ok(), device["peak_rotation"].as_f64());
            let near = found.zip(exact).is_none_or(|(found, exact)| (found / exact - 1.0).abs() < 1e-9);
            assert!(near && found.is_some() == exact.is_some(), "{row:?}: {exact:?}");
        }
    }
    for device in devices {
        let name = device["device"].as_str().unwrap();
        let rows: Vec<Vec<&str>> =
            table.lines().map(|row| row.split(',').collect()).filter(|row: &Vec<&str>| row[0] == name).collect();
        assert_eq!(rows.iter().map(|row| row[1]).collect::<Vec<_>>(), ["5", "6", "7", "8"]);
        assert!(rows.iter().any(|row| row[3] != rows[0][3] || row[4] != rows[0][4]), "{name}: {rows:?}");
    }
    let output = sprag(&["simulate", &near_fault, "--monte-carlo", "4", "--out", folder.path().to_str().unwrap()]);
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success() && error.contains("block.restitution_scatter"), "{error}");
    assert_eq!(error.trim().lines().count(), 1, "{error}");
}

#[test]
fn a_base_that_slides_is_an_outcome_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("newmark.toml");
    let text = "[block]\nsize_m = 1.0\nslenderness_deg = 23.0\nfriction_coefficient = 0.15\nrestitution = \"geometric\"\n[[device]]\nkind = \"none\"\n\
        [[ground]]\nmotion = \"rectangular\"\namplitude_g = 0.4\nduration_s = 0.5\n";
    fs::write(&path, text).unwrap();
    let out = folder.path().join("out");
    let output = well(sprag(&["simulate", path.to_str().unwrap(), "--out", out.to_str().unwrap()]));
    // A (A − μ) g T²/(2μ).
    let newmark = 0.4 * 0.25 * 9.80665 * 0.25 / 0.3;
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(
        said.contains(&format!("the base slides from 0.000 s on: {newmark:.4} m at most, -{newmark:.4} m at the end")),
        "{said}"
    );
    let summary = summary(&out);
    let run = &summary["runs"][0];
    assert_eq!((&run["outcome"], &run["sliding"]["outcome"]), (&"no-rocking".into(), &"slides".into()));
    for (key, sign) in [("peak_slide_m", 1.0), ("residual_displacement_m", -1.0)] {
        assert!((run["sliding"][key].as_f64().unwrap() - sign * newmark).abs() < 1e-9, "{run}");
    }
    let history = fs::read_to_string(out.join("history.csv")).unwrap();
    assert!(history.lines().next().unwrap().ends_with(",engaged,displacement_m"));
    let last: f64 = history.lines().last().unwrap().rsplit(',').next().unwrap().parse().unwrap();
    assert!((last + newmark).abs() < 1e-9, "{last}");
}
