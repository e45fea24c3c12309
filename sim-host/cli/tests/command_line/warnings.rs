//! What looks like a mistake is said and kept, and what is reported of a fall is not taken for a fault of device or toe.

use std::fs;

use super::{refused, said, scene, sprag, summary, well};

/// A block a hundred times too large, its slenderness in radians.
const MIXED_UP: &str = "[block]\nsize_m = 1100\nslenderness_deg = 0.24\n[[device]]\nkind = \"clutched-pair\"\nmass_ratio = 0.5\n\
    clutch = { capacity_ratio = 0.1 }\n[[ground]]\nmotion = \"sine\"\namplitude_ratio = 0.5\nfrequency_ratio = 3\n[run]\nfree_time_s = 1\n";

#[test]
fn every_command_that_reads_a_scene_warns_of_mixed_up_units_and_keeps_that() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scene.toml");
    fs::write(&file, MIXED_UP).unwrap();
    let file = file.to_str().unwrap();
    let no_clutch = "device.0.clutch={ capacity_ratio = 0.1 }";
    for (name, more) in [
        ("simulate", &[][..]),
        ("map", &["--x", "block.restitution=0.5:0.9:2", "--cut"]),
        ("similar", &["--with", "block.restitution=0.8"]),
        ("sensitivity", &["--set", no_clutch]),
        ("loop", &[]),
        ("explain", &[]),
    ] {
        let out = folder.path().join(name);
        let to = ["--out", out.to_str().unwrap()];
        let kept = if name == "explain" { &to[..0] } else { &to[..] };
        let output = sprag(&[&[name, file][..], more, kept].concat());
        let message = said(&output);
        for key in ["block.size_m is 1100: ", "block.slenderness_deg is 0.24: ", "device.0.clutch is given: "] {
            let line = format!("sprag: warning: {file}: {key}");
            assert_eq!(message.lines().filter(|printed| printed.starts_with(&line)).count(), 1, "{name}: {message}");
        }
        if name != "explain" {
            let kept = summary(&out)["warnings"].clone();
            let printed: Vec<&str> = message.lines().filter_map(|line| line.strip_prefix("sprag: warning: ")).collect();
            assert_eq!(kept, serde_json::json!(printed), "{name}");
        }
    }
}

#[test]
fn a_scene_without_oddities_has_an_empty_list() {
    let folder = tempfile::tempdir().unwrap();
    let output = sprag(&["simulate", &scene("figure05"), "--out", folder.path().to_str().unwrap()]);
    assert!(!said(&output).contains("warning"), "{}", said(&output));
    assert_eq!(summary(folder.path())["warnings"], serde_json::json!([]));
}

/// The bare pier is thrown over: its checks end where it can no longer come back.
#[test]
fn checks_say_nothing_of_a_fall() {
    let folder = tempfile::tempdir().unwrap();
    let set = ["--set", "checks.friction_coefficient=0.9", "--set", "checks.largest_stroke_m=1"];
    let output = sprag(&[&["simulate", &scene("near_fault"), "--out", folder.path().to_str().unwrap()], &set[..]].concat());
    assert_eq!(said(&output), "");
    assert!(!String::from_utf8_lossy(&output.stdout).contains("friction needed"), "there is enough");
    let run = &summary(folder.path())["runs"][0];
    assert_eq!(run["outcome"], "overturned-after-impact");
    assert!(run["checks"]["contact_lost_time_s"].is_null());
    assert!(run["checks"]["friction_needed"].as_f64().unwrap() < 0.9);
}

#[test]
fn a_loop_warns_of_what_its_checks_found() {
    let folder = tempfile::tempdir().unwrap();
    let set = ["--set", "checks.largest_force_ratio=1e-6"];
    let output = sprag(&[&["loop", &scene("controller"), "--out", folder.path().to_str().unwrap()], &set[..]].concat());
    let message = said(&output);
    assert!(
        message.contains("the force on the device's support reaches") && message.contains("the limit is 0.000001"),
        "{message}"
    );
    assert!(summary(folder.path())["runs"][0]["checks"]["force_ratio"].as_f64().unwrap() > 1e-6);
}

/// The sensors of a falling block contradict each other, as the history shows; that is no fault of the encoder.
#[test]
fn a_fallen_block_is_no_fault_of_its_sensors() {
    let folder = tempfile::tempdir().unwrap();
    let set = ["--set", "device.0.clutch.capacity_ratio=0.05"];
    let output = sprag(&[&["loop", &scene("controller"), "--out", folder.path().to_str().unwrap()], &set[..]].concat());
    let run = &summary(folder.path())["runs"][0];
    assert_eq!((&run["outcome"], &run["faults"]), (&"overturned-after-impact".into(), &serde_json::json!([])));
    assert_eq!(run["controller_state"], "rocking");
    let table = String::from_utf8(output.stdout).unwrap();
    assert!(!table.contains("fault ") && table.contains("rocking when the fall began"), "{table}");
    assert!(table.contains("late by \u{2212}"), "{table}");
    let history = fs::read_to_string(folder.path().join("history.csv")).unwrap();
    assert!(history.trim_end().ends_with(",fault,45"), "otherwise there is nothing to be left out");
}

/// A flywheel so large that the block hardly lifts: its first impacts are too weak to be counted.
#[test]
fn the_first_impact_is_the_first_that_counts() {
    let folder = tempfile::tempdir().unwrap();
    let set = ["--set", "device.1.mass_ratio=1e4"];
    sprag(&[&["simulate", &scene("near_fault"), "--out", folder.path().to_str().unwrap()], &set[..]].concat());
    let summary = summary(folder.path());
    for run in summary["runs"].as_array().unwrap() {
        assert_eq!(run["impacts"].as_u64() > Some(0), run["first_impact_time_s"].is_f64());
    }
    let first = summary["runs"][1]["first_impact_time_s"].as_f64().unwrap();
    let history = fs::read_to_string(folder.path().join("history.csv")).unwrap();
    let titles: Vec<&str> = history.lines().next().unwrap().split(',').collect();
    let column = |name: &str| titles.iter().position(|title| *title == name).unwrap();
    let (device, time, velocity) = (column("device"), column("time_s"), column("velocity_rad_s"));
    let speeds = history.lines().map(|line| line.split(',').collect::<Vec<_>>()).filter(|row| row[device] == "inerter");
    let at_it = speeds.filter(|row| row[time].parse() == Ok(first)).map(|row| row[velocity].parse::<f64>().unwrap().abs());
    // 1e-6 pα of this pier.
    assert!(at_it.fold(0.0, f64::max) > 1e-6 * 1.9177 * 0.17453);
}

#[test]
fn messages_are_in_words_that_need_no_rust() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let figure = scene("figure05");
    let set = |item: &str, words: &[&str]| {
        refused(&["simulate", &figure, "--out", out.to_str().unwrap(), "--set", item], &out, words);
    };
    set("block.slenderness_deg=ten", &["block.slenderness_deg is \"ten\", but must be a number"]);
    set("ground={motion=\"sine\"}", &["ground is a table, but must be a list"]);
    set("device.1.kind=5", &["device.1.kind"]);
    set("vertical.1.motion=sine", &[": vertical.1.motion: ", "`1` must be 0, for there is none yet"]);
    set("ground.2.scale=1", &["`2` must be a number from 0 to 0, or 1 to add one"]);
    set("block.size_m=3", &["give only one of size_m and frequency_parameter_1_s", "--set KEY="]);
    set("block.colour=", &["block.colour is not there"]);
    set("block.restitution=1e308", &["block.restitution is 1e308, but"]);
    set("block.inertia_ratio=1e-308", &["block.inertia_ratio is 1e-308, but"]);
}

#[test]
fn tables_can_be_added_and_keys_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let sets = ["block.frequency_parameter_1_s=", "block.size_m=3", "device.3={kind=\"inerter\",mass_ratio=0.1,name=\"fourth\"}"];
    let sets: Vec<&str> = sets.iter().flat_map(|set| ["--set", set]).collect();
    well(sprag(&[&["simulate", &scene("figure05"), "--out", out][..], &sets].concat()));
    let summary = summary(folder.path());
    assert_eq!(summary["scene"]["block"]["size_m"], 3.0);
    assert_eq!(summary["runs"][3]["device"], "fourth");
}

#[test]
fn a_comparison_with_nothing_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    for nothing in ["", " , "] {
        let arguments = ["similar", &scene("figure06"), "--with", nothing, "--out", out.to_str().unwrap()];
        refused(&arguments, &out, &["--with: names nothing that differs"]);
    }
    let help = String::from_utf8(sprag(&["batch", "--help"]).stdout).unwrap();
    assert!(help.contains("[default: 1e-15]"), "{help}");
}
