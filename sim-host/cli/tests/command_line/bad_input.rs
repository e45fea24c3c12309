//! Bad input costs one clear line, and nothing is left half-written.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::{CASE_TITLES, SCENES, refused, said, scene, sprag};

#[test]
fn bad_scenes_cost_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let to = out.to_str().unwrap();
    let figure = scene("figure05");
    let set = |item: &str, words: &[&str]| refused(&["simulate", &figure, "--out", to, "--set", item], &out, words);
    set("block.colour=red", &["colour"]);
    set("block.slenderness_deg=90", &["slenderness_deg", "90"]);
    set("block.restitution=1.5", &["restitution", "from 0 to 1"]);
    set("block.mass_kg=-1", &["mass_kg", "above 0"]);
    set("block.size_m=ten", &["size_m"]);
    set("block.geometry=1", &["block.geometry is 1, but must be \"full\" or \"slender\""]);
    let map = |axis: &str, words: &[&str]| refused(&["map", &scene("figure08"), "--out", to, "--x", axis], &out, words);
    map("block.size_m=nan:1:5", &["map.x.from is NaN, but must be"]);
    map("block.geometry=1:3:5", &["block.geometry is 1, but must be \"full\" or \"slender\""]);
    refused(&["simulate", &scene("cloud"), "--out", to], &out, &["is a key of studies", "`sprag cloud`"]);
    refused(&["cloud", &figure, "--records", "x.AT2", "--out", to], &out, &["block is a key of scenes", "`sprag simulate`"]);
    let similar = |with: &str, words: &[&str]| refused(&["similar", &figure, "--out", to, "--with", with], &out, words);
    similar("block.size_m", &[": block.size_m: must be KEY=VALUE"]);
    set("output.interval_s=1e-6", &["5 million"]);
    refused(&["simulate", "nowhere.toml", "--out", to], &out, &["nowhere.toml"]);
    refused(&["simulate", SCENES, "--out", to], &out, &["not a file"]);
    let empty = folder.path().join("empty.toml");
    fs::write(&empty, "").unwrap();
    refused(&["simulate", empty.to_str().unwrap(), "--out", to], &out, &["block"]);
    fs::write(&empty, [0xff, 0xfe, 0x00]).unwrap();
    refused(&["simulate", empty.to_str().unwrap(), "--out", to], &out, &["UTF-8"]);
    fs::File::create(&empty).unwrap().set_len(2 << 30).unwrap();
    refused(&["simulate", empty.to_str().unwrap(), "--out", to], &out, &["too large"]);
}

/// What the block of a cell cannot be is said with its place on the map, and what a controller believes with the key of the belief.
#[test]
fn an_error_within_a_map_or_a_loop_names_its_key() {
    let folder = tempfile::tempdir().unwrap();
    let to = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let vertical =
        ["vertical.0.motion=sine", "vertical.0.frequency_hz=1", "vertical.0.amplitude_g=0.5"].map(|key| ["--set", key]);
    let (map, out, none) = (scene("figure08"), to("map"), to("none"));
    let line = [&["map", &map, "--cut"], vertical.as_flattened()].concat();
    let output = sprag(&[&line[..], &["--out", &out, "--x", "vertical.0.amplitude_g=0.5:1.5:300"]].concat());
    assert_eq!(output.status.code(), Some(2));
    let message = said(&output);
    assert!(message.contains("vertical.0.amplitude_g=1.00") && message.contains("the ground would fall away"), "{message}");
    // What is there of the map is not left without a word.
    let rows = fs::read_to_string(Path::new(&out).join("map.csv.unfinished")).unwrap().lines().count() - 1;
    let kept = format!("; {rows} of 900 rows are kept; the same command with --resume continues");
    assert!(message.trim_end().ends_with(&kept), "{message}");
    // Where nothing is there, there is nothing to resume.
    let line = [&line[..], &["--out", &none, "--x", "vertical.0.amplitude_g=0.5:1.5:3"]].concat();
    refused(&line, Path::new(&none), &["vertical.0.amplitude_g=1: ", "the ground would fall away"]);
    let (controller, out) = (scene("controller"), folder.path().join("loop"));
    let belief = ["--set", "block.slenderness_deg=80", "--set", "controller.belief.slenderness_factor=1.2"];
    let arguments = [&["loop", &controller, "--out", out.to_str().unwrap()][..], &belief[..]].concat();
    refused(&arguments, &out, &["controller.belief.slenderness_factor is 1.2, but must be"]);
}

#[test]
fn bad_records_cost_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let to = out.to_str().unwrap();
    let record = folder.path().join("record.csv");
    let try_text = |text: &str, words: &[&str]| {
        fs::write(&record, text).unwrap();
        refused(&["simulate", &scene("record"), "--record", record.to_str().unwrap(), "--out", to], &out, words);
    };
    try_text("", &["record.csv"]);
    try_text("# time_s,acc_g\n0.00,0.1\n0.01,NaN\n0.02,0.1\n", &["record.csv", "NaN"]);
    try_text("# time_s,acc_g\n0.00,0.1\n", &["record.csv"]);
    try_text("# time_s,acc_furlong\n0.00,0.1\n0.01,0.2\n", &["record.csv"]);
    fs::File::create(&record).unwrap().set_len(2 << 30).unwrap();
    refused(&["simulate", &scene("record"), "--record", record.to_str().unwrap(), "--out", to], &out, &["record.csv"]);
    refused(&["simulate", &scene("record"), "--record", "nowhere.AT2", "--out", to], &out, &["nowhere.AT2"]);
    refused(&["simulate", &scene("record"), "--out", to], &out, &["--record"]);
    refused(&["simulate", &scene("figure05"), "--record", "x.AT2", "--out", to], &out, &["motion = \"record\""]);
    refused(&["simulate", &scene("record"), "--set", "ground.0.units=furlong", "--out", to], &out, &["units", "m/s2"]);
}

#[test]
fn bad_cases_cost_one_line_that_names_the_place() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    fs::create_dir(&out).unwrap();
    let results = out.join("results.csv");
    let cases = folder.path().join("cases.csv");
    let good = "0,full,15,none,0,0.85,sine,2,2,60\n";
    refused(&["batch", SCENES, "--out", results.to_str().unwrap()], &out, &[SCENES, "is a folder; name a file of cases"]);
    let try_text = |text: &str, words: &[&str]| {
        fs::write(&cases, text).unwrap();
        refused(&["batch", cases.to_str().unwrap(), "--out", results.to_str().unwrap()], &out, words);
    };
    try_text("", &["column `id` is missing"]);
    try_text(CASE_TITLES, &["no cases"]);
    try_text(&format!("{CASE_TITLES}{good}1,full,95,none,0,0.85,sine,2,2,60\n"), &["line 3", "slenderness_deg", "95"]);
    try_text(&format!("{CASE_TITLES}1,round,15,none,0,0.85,sine,2,2,60\n"), &["geometry", "round", "full or slender"]);
    try_text(&format!("{CASE_TITLES}1,full,15,none,0,1.85,sine,2,2,60\n"), &["restitution", "from 0 to 1"]);
    try_text(&format!("{CASE_TITLES}1,full,15,none,0,0.85,sine,NaN,2,60\n"), &["frequency_ratio", "NaN"]);
    try_text(&format!("{CASE_TITLES}1,full,15,none\n"), &["line 2", "4 fields"]);
    try_text(&format!("colour,{CASE_TITLES}"), &["unknown column `colour`"]);
    fs::File::create(&cases).unwrap().set_len(2 << 30).unwrap();
    refused(&["batch", cases.to_str().unwrap(), "--out", results.to_str().unwrap()], &out, &["line 1", "more than 1 MiB"]);
    // A quote that nothing closes.
    let open = format!("{CASE_TITLES}{good}\"{}", good.repeat(40_000));
    try_text(&open, &["line 3", "more than 1 MiB"]);
    try_text(&format!("id,{CASE_TITLES}"), &["column `id` is there twice"]);
}

#[test]
fn an_output_place_that_cannot_be_written_costs_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "kept").unwrap();
    let inside = file.join("out");
    refused(&["simulate", &scene("figure05"), "--out", inside.to_str().unwrap()], &inside, &["cannot be written"]);
    assert_eq!(fs::read_to_string(&file).unwrap(), "kept");
    #[cfg(target_os = "linux")]
    refused(&["simulate", &scene("figure05"), "--out", "/proc/sprag"], Path::new("/proc/sprag"), &["cannot be written"]);
}

/// A limit on the size of files stands for a full disk: the write fails half-way.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_nothing_behind() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    for (kilobytes, command) in [(16, format!("simulate '{}' --out", scene("near_fault"))), (1, "manual".to_owned())] {
        let sprag = env!("CARGO_BIN_EXE_sprag");
        let command = format!("trap '' XFSZ; ulimit -f {kilobytes}; exec '{sprag}' {command} '{}'", out.display());
        let output = Command::new("bash").args(["-c", &command]).output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains("cannot be written") && message.trim_end().lines().count() == 1, "{message}");
        assert!(!out.exists(), "an empty folder");
    }
}

/// Expects that `command` refuses `file`, with `more` on its line.
fn refuses(command: &str, file: &str, more: &[&str], words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    refused(&[&[command, file, "--out", out.to_str().unwrap()], more].concat(), &out, words);
}

/// The same of a study with this text.
fn refuses_study(command: &str, text: &str, more: &[&str], words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    fs::write(&study, text).unwrap();
    refuses(command, study.to_str().unwrap(), more, words);
}

#[test]
fn bad_input_of_sensitivity_costs_one_line() {
    let line = |scene: &str, more: &[&str], words: &[&str]| refuses("sensitivity", scene, more, words);
    let near_fault = scene("near_fault");
    line("nowhere.toml", &[], &["nowhere.toml"]);
    line(&near_fault, &["--set", "block.colour=red"], &["colour"]);
    line(&scene("figure05"), &["--records", "x.AT2"], &["motion = \"record\""]);
    line(&scene("record"), &[], &["--record"]);
    line(&near_fault, &["--records", "x.AT2", "y.AT2", "--records-vertical", "z.AT2"], &["1 files", "2"]);
    let empty = tempfile::tempdir().unwrap();
    line(&near_fault, &["--records", "x.AT2", "--records-vertical", empty.path().to_str().unwrap()], &["0 files", "1"]);
}

#[test]
fn bad_input_of_design_costs_one_line() {
    let line = |scene: &str, more: &[&str], words: &[&str]| refuses("design", scene, more, words);
    let near_fault = scene("near_fault");
    line("nowhere.toml", &[], &["nowhere.toml"]);
    line(&near_fault, &[], &["block.mass_kg is missing", "--set block.mass_kg"]);
    let heavy = |more: &[&str], words: &[&str]| {
        line(&near_fault, &[&["--set", "block.mass_kg=10000"], more].concat(), words);
    };
    heavy(&["--teeth", "11"], &["'11' for '--teeth", "from 12 to 200"]);
    heavy(&["--margin", "NaN"], &["--margin is NaN", "from 1 to 10"]);
    heavy(&["--service-factor", "0.9"], &["--service-factor is 0.9", "from 1 to 10"]);
    heavy(&["--face-width", "30"], &["--face-width is 30", "from 4 to 20"]);
    heavy(&["--allowable-stress", "-3"], &["--allowable-stress is -3", "above 0"]);
    heavy(&["--tolerance", "0"], &["--tolerance is 0", "above 0"]);
    heavy(&["--device", "none"], &["--device \"none\"", "\"inerter\", \"clutched pair\""]);
    heavy(&["--allowable-stress", "0.01"], &["inerter", "module 50 mm", "0.01 MPa", "--allowable-stress"]);
    heavy(&["--set", "ground.0.scale=0.01"], &["no motion lifts the block"]);
    let vertical =
        ["vertical.0.motion=sine", "vertical.0.amplitude_g=0.1", "vertical.0.frequency_hz=1"].map(|key| ["--set", key]);
    heavy(&[&["--records", "x.AT2"], vertical.as_flattened()].concat(), &["[[vertical]] or --records"]);
    line(&scene("figure05"), &["--set", "block.mass_kg=10000", "--records", "x.AT2"], &["motion = \"record\""]);
    line(&scene("record"), &["--set", "block.mass_kg=10000"], &["--record"]);
    let record = |file: &str, words: &[&str]| {
        line(
            &scene("record"),
            &["--set", "block.mass_kg=10000", "--records", file],
            &[&["no ground motion could be read"], words].concat(),
        );
    };
    record("x.AT2", &["x.AT2"]);
    record(concat!(env!("CARGO_MANIFEST_DIR"), "/src"), &["no file in it ends in acc"]);
}

#[test]
fn bad_input_of_cloud_costs_one_line() {
    let line = |text: &str, more: &[&str], words: &[&str]| refuses_study("cloud", text, more, words);
    line("", &[], &["study.toml: records is missing", "--records"]);
    line("records = 'a.csv'", &[], &["study.toml:1", "records"]);
    line("record = ['a.csv']", &[], &["study.toml:1", "record"]);
    line("records = ['a.csv']", &[], &["no record could be read", "a.csv"]);
    line("records = [\"a.csv\"]\nscene = \"nowhere.toml\"", &[], &["nowhere.toml"]);
    line("scale = [-1]", &["--records", "a.csv"], &["scale.0 is -1", "above 0"]);
    line("", &["--records", "a.csv", "--set", "block.colour=red"], &["colour"]);
    line("", &["--records", "a.csv", "--time-budget", "1", "--shard", "1/2"], &["--time-budget", "--shard"]);
}

#[test]
fn bad_input_of_optimise_costs_one_line() {
    let line = |text: &str, more: &[&str], words: &[&str]| refuses_study("optimise", text, more, words);
    let records = ["--records", "a.csv"];
    line("", &[], &["study.toml: records is missing", "--records"]);
    line("", &["--records", "a.csv", "--time-budget", "1", "--resume"], &["--time-budget", "--resume"]);
    line("", &records, &["no record could be read", "a.csv"]);
    line("[optimise]\nlimit = 1", &records, &["study.toml:2", "limit"]);
    line("[optimise]\nlargest_force_ratio = -0.1", &records, &["study.toml:2: optimise.largest_force_ratio is -0.1", "above 0"]);
    line("[optimise]\nlaws = ['magic']", &records, &["optimise.laws.0 is \"magic\"", "\"overrunning\""]);
    line("", &["--records", "a.csv", "--set", "accuracy.colour=red"], &["colour"]);
    let method = ["--set", "accuracy.method=runge-kutta-4", "--set", "accuracy.step_s=0.01"];
    let step_end = [&method[..], &["--set", "accuracy.events=step-end"]].concat();
    line("", &[&records[..], &step_end].concat(), &["accuracy.events", "located"]);
}

#[test]
fn bad_input_of_loop_costs_one_line() {
    let controller = scene("controller");
    for (set, words) in [
        ("controller.rate_hz=5", &["controller.rate_hz", "100"][..]),
        ("controller.law=\"nonsense\"", &["controller.law", "sign-table"][..]),
        ("controller.sensors.suite=\"nonsense\"", &["controller.sensors.suite", "adis16470"][..]),
        ("controller.belief.size_factor=0", &["controller.belief.size_factor", "0.1"][..]),
        ("controller.sign_table=3", &["controller.sign_table"][..]),
        ("device.0.kind=\"inerter\"", &["clutched-pair"][..]),
        ("device.0.engagement=\"overrunning\"", &["overrunning"][..]),
        ("block.initial_rotation_ratio=0.5", &["block.initial_rotation_ratio"][..]),
    ] {
        refuses("loop", &controller, &["--set", set], words);
    }
}
