//! The `sprag` command as a user meets it: what it writes, what it says, and that bad input costs one clear line.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const SCENES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes");

fn sprag(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_sprag")).args(arguments).output().expect("sprag starts")
}

/// Runs `sprag`, expects exit code 2 and one line that contains `words`, and that `out` holds no file.
fn refused(arguments: &[&str], out: &Path, words: &[&str]) {
    let output = sprag(arguments);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    assert_eq!(message.trim_end().lines().count(), 1, "one line: {message}");
    for word in words {
        assert!(message.contains(word), "{arguments:?} must say `{word}`: {message}");
    }
    let left: Vec<PathBuf> = fs::read_dir(out).map(|files| files.map(|file| file.unwrap().path()).collect()).unwrap_or_default();
    assert!(left.is_empty(), "half-written: {left:?}");
}

fn scene(name: &str) -> String {
    format!("{SCENES}/{name}.toml")
}

#[test]
fn simulate_writes_its_three_files_and_a_summary() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("near");
    let output = sprag(&["simulate", &scene("near_fault"), "--out", out.to_str().unwrap()]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let table = String::from_utf8(output.stdout).unwrap();
    for device in ["none", "inerter", "clutched pair"] {
        assert!(table.contains(device), "{table}");
    }
    let mut files: Vec<_> = fs::read_dir(&out).unwrap().map(|file| file.unwrap().file_name()).collect();
    files.sort();
    assert_eq!(files, ["history.csv", "history.svg", "summary.json"]);
    let summary: serde_json::Value = serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
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

#[test]
fn batch_results_do_not_depend_on_the_number_of_threads_and_keep_their_order() {
    let folder = tempfile::tempdir().unwrap();
    let cases = folder.path().join("cases.csv");
    let mut text =
        "id,geometry,slenderness_deg,device,mass_ratio,restitution,pulse,frequency_ratio,amplitude_ratio,free_time\n".to_owned();
    for index in 0..1000 {
        let device = ["none", "inerter", "clutched-pair"][index % 3];
        let geometry = ["full", "slender"][index % 2];
        text += &format!(
            "c{},{geometry},15,{device},0.5,0.85,sine,{},{},60\n",
            999 - index,
            1.0 + index as f64 * 0.005,
            1.5 + (index % 7) as f64
        );
    }
    fs::write(&cases, text).unwrap();
    let results = ["1", "2", "7"].map(|threads| {
        let out = folder.path().join(format!("{threads}.csv"));
        let output = sprag(&["batch", cases.to_str().unwrap(), "--out", out.to_str().unwrap(), "--threads", threads]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        fs::read_to_string(out).unwrap()
    });
    assert!(results[0] == results[1] && results[1] == results[2]);
    let ids: Vec<&str> = results[0].lines().skip(1).map(|line| line.split(',').next().unwrap()).collect();
    assert_eq!((ids.len(), ids[0], ids[999]), (1000, "c999", "c0"));
}

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
    let header = "id,geometry,slenderness_deg,device,mass_ratio,restitution,pulse,frequency_ratio,amplitude_ratio,free_time\n";
    let good = "0,full,15,none,0,0.85,sine,2,2,60\n";
    let try_text = |text: &str, words: &[&str]| {
        fs::write(&cases, text).unwrap();
        refused(&["batch", cases.to_str().unwrap(), "--out", results.to_str().unwrap()], &out, words);
    };
    try_text("", &["column `id` is missing"]);
    try_text(header, &["no cases"]);
    try_text(&format!("{header}{good}1,full,95,none,0,0.85,sine,2,2,60\n"), &["line 3", "slenderness_deg", "95"]);
    try_text(&format!("{header}1,round,15,none,0,0.85,sine,2,2,60\n"), &["geometry", "round", "full or slender"]);
    try_text(&format!("{header}1,full,15,none,0,1.85,sine,2,2,60\n"), &["restitution", "from 0 to 1"]);
    try_text(&format!("{header}1,full,15,none,0,0.85,sine,NaN,2,60\n"), &["frequency_ratio", "NaN"]);
    try_text(&format!("{header}1,full,15,none\n"), &["line 2", "4 fields"]);
    try_text(&format!("colour,{header}"), &["unknown column `colour`"]);
    fs::File::create(&cases).unwrap().set_len(2 << 30).unwrap();
    refused(&["batch", cases.to_str().unwrap(), "--out", results.to_str().unwrap()], &out, &["too large"]);
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
    let command = format!(
        "trap '' XFSZ; ulimit -f 16; exec '{}' simulate '{}' --out '{}'",
        env!("CARGO_BIN_EXE_sprag"),
        scene("near_fault"),
        out.display()
    );
    let output = Command::new("bash").args(["-c", &command]).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("cannot be written") && message.trim_end().lines().count() == 1, "{message}");
    assert_eq!(fs::read_dir(&out).unwrap().count(), 0);
}

#[cfg(target_os = "linux")]
#[test]
fn ctrl_c_ends_a_long_run_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut child = Command::new(env!("CARGO_BIN_EXE_sprag"))
        .args(["simulate", &scene("figure05"), "--out", out.to_str().unwrap()])
        .args([
            "--set",
            "accuracy.method=runge-kutta-4",
            "--set",
            "accuracy.step_ratio=1e-7",
            "--set",
            "run.free_time_ratio=10000",
        ])
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    // The folder is made once the scene has been read and just before the work starts.
    while !out.is_dir() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(fs::read_dir(&out).unwrap().count(), 0);
}

#[test]
fn effects_are_listed_and_shown() {
    let text = |arguments: &[&str]| {
        let output = sprag(arguments);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let table = text(&["effects"]);
    let names = [
        "kinematics",
        "mount",
        "geometry",
        "vertical",
        "impact",
        "flywheel",
        "engagement",
        "clutch",
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
    let seed = concat!(env!("CARGO_MANIFEST_DIR"), "/../fuzz/seeds/scene/effects.toml");
    let output = sprag(&["explain", seed, "--set", "device.3.clutch.capacity_ratio=0.25"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
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
    // No record is read, so that a scene may be explained before there is one.
    let output = sprag(&["explain", &scene("record")]);
    assert!(output.status.success() && String::from_utf8_lossy(&output.stdout).contains("effects on: none"));
    let nowhere = tempfile::tempdir().unwrap();
    refused(&["explain", "nowhere.toml"], nowhere.path(), &["nowhere.toml"]);
    let brake = "device.2.flywheel.brake_deceleration_m_s2=instant";
    refused(&["explain", &scene("figure05"), "--set", brake], nowhere.path(), &["figure05.toml", "brake", "ideal clutch"]);
}

/// A block under a short pulse: the whole table of variants in a moment.
const SHORT_SCENE: &str = "[block]\nsize_m = 2\nslenderness_deg = 10\n[[device]]\nkind = \"inerter\"\nmass_ratio = 0.2\n\
    [[ground]]\nmotion = \"record\"\nfile = \"own.csv\"\n[run]\nfree_time_s = 2\n";

/// Half a sine of `peak` (g) and 0.6 s, as a record.
fn pulse(peak: f64) -> String {
    let sample = |k: i32| format!("{},{}\n", f64::from(k) * 0.01, peak * f64::from(k * (60 - k)) / 900.0);
    (0..=60).fold("# time_s,acc_g\n".to_owned(), |text, k| text + &sample(k))
}

#[test]
fn sensitivity_does_not_depend_on_the_number_of_threads_and_names_a_bad_record() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let (scene, bad) = (file("short.toml", SHORT_SCENE), file("bad.csv", "# time_s,acc_g\n0,0\n0.01,NaN\n"));
    let records = [file("weak.csv", &pulse(0.25)), file("strong.csv", &pulse(-0.3)), file("own.csv", &pulse(0.28))];
    let outs = ["1", "3"].map(|threads| {
        let out = folder.path().join(threads);
        let line = ["sensitivity", &scene, "--threads", threads, "--out", out.to_str().unwrap(), "--records"];
        let output = sprag(&[&line[..], &[&records[0], &bad, &records[1]]].concat());
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains("bad.csv") && message.trim_end().lines().count() == 1, "{message}");
        out
    });
    for name in ["summary.json", "sensitivity.csv", "sensitivity.md", "sensitivity.svg"] {
        let [one, other] = outs.each_ref().map(|out| fs::read(out.join(name)).unwrap());
        assert!(one == other && !one.is_empty(), "{name}");
    }
    let summary: serde_json::Value = serde_json::from_slice(&fs::read(outs[0].join("summary.json")).unwrap()).unwrap();
    assert_eq!(summary["records"], serde_json::json!(["weak", "strong"]));
    let table = fs::read_to_string(outs[0].join("sensitivity.csv")).unwrap();
    let rows: Vec<&str> = table.lines().filter(|row| row.contains(",kinematics,consistent,")).collect();
    assert_eq!(rows.len(), 3, "{table}");
    assert!(rows[0].starts_with("own motion,inerter,") && rows[2].starts_with("strong,inerter,"), "{rows:?}");
}

#[test]
fn bad_input_of_sensitivity_costs_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let near_fault = scene("near_fault");
    let line = |scene: &str, more: &[&str], words: &[&str]| {
        refused(&[&["sensitivity", scene, "--out", out.to_str().unwrap()], more].concat(), &out, words);
    };
    line("nowhere.toml", &[], &["nowhere.toml"]);
    line(&near_fault, &["--set", "block.colour=red"], &["colour"]);
    line(&scene("figure05"), &["--records", "x.AT2"], &["motion = \"record\""]);
    line(&scene("record"), &[], &["--record"]);
    line(&near_fault, &["--records", "x.AT2", "y.AT2", "--records-vertical", "z.AT2"], &["1 files", "2"]);
}

#[test]
fn cloud_does_not_depend_on_the_number_of_threads_and_names_a_bad_record() {
    let folder = tempfile::tempdir().unwrap();
    let records = folder.path().join("records");
    fs::create_dir_all(&records).unwrap();
    for (number, peak) in [0.2, 0.25, -0.3, 0.35, 0.4, -0.5, 0.7].into_iter().enumerate() {
        fs::write(records.join(format!("{number}.csv")), pulse(peak)).unwrap();
    }
    fs::write(records.join("bad.csv"), "# time_s,acc_g\n0,0\n0.01,NaN\n").unwrap();
    let outs = ["1", "3"].map(|threads| {
        let out = folder.path().join(threads);
        let line = ["cloud", &scene("cloud"), "--threads", threads, "--out", out.to_str().unwrap(), "--records"];
        let output = sprag(&[&line[..], &[records.to_str().unwrap()]].concat());
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains("bad.csv") && message.trim_end().lines().count() == 1, "{message}");
        out
    });
    let names = ["summary.json", "runs.csv", "demand.csv", "demand.md", "demand.svg", "fragility.csv", "fragility.md"];
    for name in names.into_iter().chain(["fragility.svg", "ranking.csv", "ranking.md"]) {
        let [one, other] = outs.each_ref().map(|out| fs::read(out.join(name)).unwrap());
        assert!(one == other && !one.is_empty(), "{name}");
    }
    let summary: serde_json::Value = serde_json::from_slice(&fs::read(outs[0].join("summary.json")).unwrap()).unwrap();
    assert_eq!((&summary["command"], &summary["structures"][1]["scene"]["block"]["size_m"]), (&"cloud".into(), &1.0.into()));
    assert_eq!(summary["records"].as_array().unwrap().len(), 7);
    assert_eq!(summary["runs"].as_array().unwrap().len(), 3 * 3);
    let table = fs::read_to_string(outs[0].join("runs.csv")).unwrap();
    assert_eq!(table.lines().count(), 1 + 7 * 3 * 3);
    assert!(table.starts_with("record,structure,device,scale,level,uniform_duration,pgv,"), "{table}");
}

#[test]
fn bad_input_of_cloud_costs_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let study = folder.path().join("study.toml");
    let line = |text: &str, more: &[&str], words: &[&str]| {
        fs::write(&study, text).unwrap();
        refused(&[&["cloud", study.to_str().unwrap(), "--out", out.to_str().unwrap()], more].concat(), &out, words);
    };
    line("", &[], &["study.toml: records is missing", "--records"]);
    line("records = 'a.csv'", &[], &["study.toml:1", "records"]);
    line("record = ['a.csv']", &[], &["study.toml:1", "record"]);
    line("records = ['a.csv']", &[], &["no record could be read", "a.csv"]);
    line("records = [\"a.csv\"]\nscene = \"nowhere.toml\"", &[], &["nowhere.toml"]);
    line("scale = [-1]", &["--records", "a.csv"], &["scale.0 is -1", "above 0"]);
    line("", &["--records", "a.csv", "--set", "block.colour=red"], &["colour"]);
    line("", &["--records", "a.csv", "--time-budget", "1", "--shard", "1/2"], &["--time-budget", "--shard"]);
}

/// Records of pulses of several amplitudes (g), in a folder of their own.
fn folder_of_pulses(folder: &Path) -> String {
    let records = folder.join("records");
    fs::create_dir_all(&records).unwrap();
    for (number, peak) in [0.2, -0.3, 0.4, -0.5, 0.7].into_iter().enumerate() {
        fs::write(records.join(format!("{number}.csv")), pulse(peak)).unwrap();
    }
    records.to_str().unwrap().to_owned()
}

#[test]
fn optimise_writes_its_files_and_does_not_depend_on_the_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let records = folder_of_pulses(folder.path());
    let outs = ["1", "3"].map(|threads| {
        let out = folder.path().join(threads);
        let line = ["optimise", &scene("optimise"), "--threads", threads, "--out", out.to_str().unwrap(), "--records", &records];
        let output = sprag(&line);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let table = String::from_utf8(output.stdout).unwrap();
        assert!(table.contains("| bare block") && table.contains("| best") && table.contains("5 motions"), "{table}");
        out
    });
    let mut files: Vec<_> = fs::read_dir(&outs[0]).unwrap().map(|file| file.unwrap().file_name()).collect();
    files.sort();
    let tables = ["designs.csv", "designs.parquet", "motions.csv", "motions.parquet"];
    assert_eq!(files, [&tables[..], &["optimise.md", "summary.json", "trade_off.png", "trade_off.svg"]].concat());
    for name in &files {
        let [one, other] = outs.each_ref().map(|out| fs::read(out.join(name)).unwrap());
        assert!(one == other && !one.is_empty(), "{name:?}");
    }
    let summary: serde_json::Value = serde_json::from_slice(&fs::read(outs[0].join("summary.json")).unwrap()).unwrap();
    assert_eq!((&summary["command"], &summary["reference"]["law"]), (&"optimise".into(), &"none".into()));
    assert_eq!(summary["structure"]["scene"]["block"]["size_m"], 1.0);
    assert_eq!(summary["study"]["optimise"]["limit_quantile"], 1.0);
    for key in ["law", "mount", "mass_ratio", "probability", "probability_band", "peak_force_ratio", "stroke_m", "feasible"] {
        assert!(!summary["best"][key].is_null(), "{key}: {}", summary["best"]);
    }
    let table = fs::read_to_string(outs[0].join("designs.csv")).unwrap();
    assert_eq!(table.lines().count() as u64, 2 + summary["designs"].as_u64().unwrap());
}

#[test]
fn an_optimisation_without_a_device_within_the_limit_writes_its_results_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let records = folder_of_pulses(folder.path());
    let study = folder.path().join("study.toml");
    let keys = "mass_ratio = { from = 0.5, to = 1, cells = 2 }\nlaws = ['rigid', 'inerter']\nmounts = ['base-corners']";
    fs::write(&study, format!("[optimise]\nlargest_force_ratio = 1e-4\n{keys}")).unwrap();
    let out = folder.path().join("out");
    let output = sprag(&["optimise", study.to_str().unwrap(), "--out", out.to_str().unwrap(), "--records", &records]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(
        message.contains("study.toml: no device respects max |F|/(mg) ≤ 0.0001 in every motion; results are written"),
        "{message}"
    );
    assert!(message.contains("left out: rigid, base-corners: "), "{message}");
    assert!(String::from_utf8_lossy(&output.stdout).contains("nearest to the limits"));
    let summary: serde_json::Value = serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    assert!(summary["best"].is_null() && summary["nearest"]["demand_over_limit"].as_f64().unwrap() > 1.0);
}

#[test]
fn bad_input_of_optimise_costs_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let study = folder.path().join("study.toml");
    let line = |text: &str, more: &[&str], words: &[&str]| {
        fs::write(&study, text).unwrap();
        refused(&[&["optimise", study.to_str().unwrap(), "--out", out.to_str().unwrap()], more].concat(), &out, words);
    };
    let records = ["--records", "a.csv"];
    line("", &[], &["study.toml: records is missing", "--records"]);
    line("", &records, &["no record could be read", "a.csv"]);
    line("[optimise]\nlimit = 1", &records, &["study.toml:2", "limit"]);
    line("[optimise]\nlargest_force_ratio = -0.1", &records, &["study.toml: optimise.largest_force_ratio is -0.1", "above 0"]);
    line("[optimise]\nlaws = ['magic']", &records, &["optimise.laws.0 is \"magic\"", "\"overrunning\""]);
    line("", &["--records", "a.csv", "--set", "accuracy.colour=red"], &["colour"]);
    let method = ["--set", "accuracy.method=runge-kutta-4", "--set", "accuracy.step_s=0.01"];
    let step_end = [&method[..], &["--set", "accuracy.events=step-end"]].concat();
    line("", &[&records[..], &step_end].concat(), &["accuracy.events", "located"]);
}

#[test]
fn every_subcommand_has_help_with_an_example() {
    for command in [
        "simulate",
        "loop",
        "loop-study",
        "batch",
        "cloud",
        "optimise",
        "sensitivity",
        "record",
        "synthesize",
        "effects",
        "explain",
    ] {
        let output = sprag(&[command, "--help"]);
        let help = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success() && help.contains("Example"), "{command}: {help}");
    }
}

#[test]
fn loop_writes_its_files_and_does_not_depend_on_the_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let outs = ["1", "2"].map(|threads| {
        let out = folder.path().join(threads);
        let output = sprag(&[
            "loop",
            &scene("controller"),
            "--set",
            "run.free_time_s=0",
            "--set",
            "controller.rate_hz=500",
            "--monte-carlo",
            "3",
            "--threads",
            threads,
            "--out",
            out.to_str().unwrap(),
        ]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(String::from_utf8_lossy(&output.stdout).contains("ideal pair"));
        out
    });
    for name in ["summary.json", "history.csv", "loop.svg", "monte_carlo.csv"] {
        let [one, two] = outs.each_ref().map(|out| fs::read(out.join(name)).unwrap());
        assert!(!one.is_empty() && one == two, "{name}");
    }
    let summary: serde_json::Value = serde_json::from_slice(&fs::read(outs[0].join("summary.json")).unwrap()).unwrap();
    let run = &summary["runs"][0];
    assert_eq!(
        (&summary["command"], &run["outcome"], &run["controller_state"]),
        (&"loop".into(), &"safe".into(), &"armed".into())
    );
    assert_eq!(run["monte_carlo"]["specimens"], 3);
    assert!(run["peak_change"].as_f64().unwrap().abs() < 0.05);
}

#[test]
fn bad_input_of_loop_costs_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let place = out.to_str().unwrap();
    let scene_file = scene("controller");
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
        refused(&["loop", &scene_file, "--set", set, "--out", place], &out, words);
    }
}

#[test]
fn a_refined_map_has_its_boundaries_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let run = |threads: &str, more: &[&str]| {
        let out = folder.path().join(format!("{threads}{}", more.len()));
        let few = ["--set", "map.x.cells=6", "--set", "map.y.cells=5", "--refine", "--evaluations", "1500", "--threads", threads];
        let (scene, place) = (scene("figure08"), out.to_str().unwrap().to_owned());
        let output = sprag(&[&["map", &scene, "--out", &place][..], &few, more].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        (out, String::from_utf8(output.stdout).unwrap())
    };
    let ((one, table), (two, _)) = (run("1", &[]), run("2", &[]));
    assert!(table.contains("evaluations") && table.contains("are left coarser"), "{table}");
    for name in ["boundaries.csv", "boundaries.svg"] {
        let [one, two] = [&one, &two].map(|out| fs::read(out.join(name)).unwrap());
        assert!(!one.is_empty() && one == two, "{name}");
    }
    let summary: serde_json::Value = serde_json::from_slice(&fs::read(one.join("summary.json")).unwrap()).unwrap();
    for run in summary["runs"].as_array().unwrap() {
        let refined = &run["refined"];
        assert!(refined["evaluations"] == 1500 && refined["vertices"].as_u64().unwrap() > 10, "{refined}");
        assert!(refined["unresolved_squares"].as_u64().unwrap() > 0 && refined["unresolved_relative_width"].is_number());
    }
    // In a cut boundaries are points.
    let (cut, table) = run("1", &["--cut"]);
    assert!(cut.join("boundaries.csv").exists() && !cut.join("boundaries.svg").exists() && !table.contains("coarser"));
}
