//! Records are read without misleading: what looks wrong is said by every command, what cannot be read is refused before work.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use super::{command, errors, pulse, refused, said, scene, sprag};

/// Half a sine as [`pulse`], whose column says g and whose values are cm/s².
fn gal_as_g() -> String {
    let sample = |k: i32| format!("{},{}\n", f64::from(k) * 0.01, 300.0 * f64::from(k * (60 - k)) / 900.0);
    (0..=60).fold("# time_s,acc_g\n".to_owned(), |text, k| text + &sample(k))
}

/// A weak component x and a strong one y, in the format of SimCenter.
fn two_components() -> String {
    let of = |peak: f64| -> Vec<f64> { (0..=60).map(|k| peak * f64::from(k * (60 - k)) / 900.0).collect() };
    serde_json::json!({ "dT": 0.01, "data_x": of(0.1), "data_y": of(0.3) }).to_string()
}

/// Values alone, of which nothing is known.
fn bare() -> String {
    (0..=60).map(|k| format!("{}\n", 300.0 * f64::from(k * (60 - k)) / 900.0)).collect()
}

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Folder {
        Folder(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn file(&self, name: &str, text: &str) -> String {
        fs::create_dir_all(self.path(name).parent().unwrap()).unwrap();
        fs::write(self.path(name), text).unwrap();
        self.name(name)
    }

    fn name(&self, name: &str) -> String {
        self.path(name).to_str().unwrap().to_owned()
    }

    /// The lines on the side, and `summary.json`, of a run that ends well.
    fn run(&self, line: &[&str]) -> (String, Value) {
        let out = self.name("out");
        let output = sprag(&[line, &["--out", &out]].concat());
        assert!(output.status.success(), "{line:?}: {}", said(&output));
        let summary = fs::read(Path::new(&out).join("summary.json")).unwrap();
        fs::remove_dir_all(&out).unwrap();
        (said(&output), serde_json::from_slice(&summary).unwrap())
    }
}

/// A loop over a record and a map over another, short enough for a test.
fn scenes(folder: &Folder) -> [String; 3] {
    let block = "[block]\nsize_m = 2\nslenderness_deg = 10\n[run]\nfree_time_s = 1\n[[ground]]\nmotion = \"record\"\n";
    let pair = "[[device]]\nkind = \"clutched-pair\"\nmass_ratio = 0.5\n";
    let none = "[[device]]\nkind = \"none\"\n";
    let map = "[map]\nx = { key = \"block.size_m\", from = 1, to = 2, cells = 2 }\n";
    let vertical = "[[vertical]]\nmotion = \"record\"\n";
    [
        folder.file("loop.toml", &format!("{block}{pair}")),
        folder.file("map.toml", &format!("{block}{none}{map}")),
        folder.file("vertical.toml", &format!("{block}{none}{vertical}{map}")),
    ]
}

/// The record of a summary, and that its warnings are also those printed.
fn only_record<'a>(stderr: &str, summary: &'a Value) -> &'a Value {
    let [record] = summary["records"].as_array().unwrap().as_slice() else { panic!("{}", summary["records"]) };
    let file = record["file"].as_str().unwrap();
    for warning in record["warnings"].as_array().unwrap() {
        let line = format!("{file}: {}", warning.as_str().unwrap());
        assert!(stderr.lines().any(|said| said == format!("sprag: warning: {line}")), "{line}: {stderr}");
        assert!(summary["warnings"].as_array().unwrap().iter().any(|warning| *warning == line.as_str()), "{line}");
    }
    record
}

#[test]
fn every_command_says_what_looks_wrong_with_a_record() {
    let folder = Folder::new();
    let [pair, map, _] = scenes(&folder);
    let gal = folder.file("gal.csv", &gal_as_g());
    let study = folder.file("study.toml", &format!("scene = \"{pair}\"\n[optimise]\nlaws = [\"inerter\"]\nmounts = [\"centre-of-mass\"]\nmass_ratio = {{ from = 0.5, to = 1, cells = 2 }}\n"));
    let lines: [&[&str]; 7] = [
        &["simulate", &pair, "--record", &gal],
        &["similar", &pair, "--with", "block.size_m=3", "--record", &gal],
        &["sensitivity", &pair, "--records", &gal],
        &["map", &map, "--record", &gal],
        &["loop", &pair, "--record", &gal],
        &["accuracy", &pair, "--record", &gal, "--cells", "0", "--smallest-step", "0.1"],
        &["cloud", &study, "--records", &gal],
    ];
    for line in lines {
        // The scale is none of the record's, and lets the block stand.
        let scale: &[&str] = if line[0] == "cloud" { &[] } else { &["--set", "ground.0.scale=0.0008"] };
        let (stderr, summary) = folder.run(&[line, scale].concat());
        let record = only_record(&stderr, &summary);
        assert!(record["warnings"].to_string().contains("check the units"), "{line:?}: {record}");
        assert!((record["pga_m_s2"].as_f64().unwrap() - 300.0 * 9.80665).abs() < 1e-6, "{line:?}");
        assert_eq!((&record["samples"], &record["dt_s"], &record["units"]), (&61.into(), &0.01.into(), &"g".into()), "{line:?}");
        assert!(gal.ends_with(record["file"].as_str().unwrap()), "{line:?}");
    }
    // No device can help against 300 g, but it is said of what the records are.
    let out = folder.name("out");
    let output = sprag(&["optimise", &study, "--records", &gal, "--out", &out]);
    assert!(said(&output).contains("sprag: warning: gal.csv: peak of 300.000 g"), "{}", said(&output));
}

#[test]
fn a_component_that_was_taken_is_said() {
    let folder = Folder::new();
    let [pair, ..] = scenes(&folder);
    let both = folder.file("both.json", &two_components());
    let (stderr, summary) = folder.run(&["simulate", &pair, "--record", &both]);
    let record = only_record(&stderr, &summary);
    assert_eq!(record["component"], "y");
    assert!(stderr.contains("component y taken") && stderr.contains("--component"), "{stderr}");
    for line in [&["--record", &format!("{both}#x")][..], &["--record", &both, "--component", "x"]] {
        let (stderr, summary) = folder.run(&[&["simulate", &pair][..], line].concat());
        assert_eq!(only_record(&stderr, &summary)["component"], "x");
        assert!(!stderr.contains("taken"), "{stderr}");
    }
}

#[test]
fn what_a_file_does_not_say_can_be_given_wherever_a_record_can() {
    let folder = Folder::new();
    let [pair, map, _] = scenes(&folder);
    let bare = folder.file("la03.dat", &bare());
    let given = ["--units", "cm/s2", "--dt", "0.01", "--resample", "0.005"];
    let lines: [&[&str]; 6] = [
        &["simulate", &pair, "--record", &bare],
        &["similar", &pair, "--with", "block.size_m=3", "--record", &bare],
        &["sensitivity", &pair, "--records", &bare],
        &["map", &map, "--record", &bare],
        &["loop", &pair, "--record", &bare],
        &["accuracy", &pair, "--record", &bare, "--cells", "0", "--smallest-step", "0.1"],
    ];
    for line in lines {
        let out = folder.path("out");
        refused(
            &[line, &["--out", out.to_str().unwrap()]].concat(),
            &out,
            &["la03.dat: no time step", "--dt", "ground.0.time_step_s"],
        );
        let (stderr, summary) = folder.run(&[line, &given].concat());
        let record = only_record(&stderr, &summary);
        assert_eq!((&record["dt_s"], &record["samples"]), (&0.005.into(), &121.into()), "{line:?}");
        assert!((record["pga_m_s2"].as_f64().unwrap() - 3.0).abs() < 1e-9, "{line:?}");
    }
    for command in ["hil", "loop-study"] {
        let help = String::from_utf8(sprag(&[command, "--help"]).stdout).unwrap();
        assert!(["--units", "--dt", "--component", "--resample"].iter().all(|option| help.contains(option)), "{command}");
    }
    let out = folder.path("out");
    let place = out.to_str().unwrap();
    refused(&["simulate", &scene("figure05"), "--dt", "0.01", "--out", place], &out, &["--dt", "motion = \"record\""]);
    let study = folder.file("study.toml", "");
    refused(&["cloud", &study, "--records", &bare, "--out", place], &out, &["--dt", "record.time_step_s in "]);
}

#[test]
fn a_summary_names_records_as_the_user_did_wherever_it_was_made() {
    let folder = Folder::new();
    let [pair, map, vertical] = scenes(&folder);
    folder.file("one.csv", &pulse(0.2));
    folder.file("up.csv", &pulse(0.05));
    let run = |line: &[&str]| {
        let line = [line, &["--overwrite", "--out", "out"]].concat();
        let output = command(&line).current_dir(folder.0.path()).output().unwrap();
        assert!(output.status.success(), "{line:?}: {}", said(&output));
        fs::read_to_string(folder.path("out/summary.json")).unwrap()
    };
    for line in [
        &["simulate", &pair, "--record", "one.csv"][..],
        &["loop", &pair, "--record", "one.csv"],
        &["map", &map, "--record", "one.csv"],
        &["map", &vertical, "--record", "one.csv", "--record-vertical", "up.csv"],
        &["accuracy", &pair, "--record", "one.csv", "--cells", "0", "--smallest-step", "0.1"],
        &["sensitivity", &pair, "--records", "one.csv", "--records-vertical", "up.csv"],
    ] {
        let text = run(line);
        let summary: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(summary["records"][0]["file"], "one.csv", "{line:?}");
        assert!(!text.contains(folder.0.path().to_str().unwrap()), "{line:?}: {text}");
        if line.contains(&"up.csv") {
            assert_eq!(summary["records"][1]["file"], "up.csv", "{line:?}");
        }
    }
}

#[test]
fn a_missing_vertical_record_is_asked_for_by_the_option_that_gives_it() {
    let folder = Folder::new();
    let [.., vertical] = scenes(&folder);
    let record = folder.file("one.csv", &pulse(0.2));
    let out = folder.path("out");
    for command in ["simulate", "map"] {
        let line = [command, &vertical, "--record", &record, "--out", out.to_str().unwrap()];
        refused(&line, &out, &["vertical.0.file is missing", "--record-vertical FILE"]);
        assert!(sprag(&[&line[..], &["--record-vertical", &record]].concat()).status.success());
        fs::remove_dir_all(&out).unwrap();
    }
}

#[test]
fn a_study_of_the_controller_reads_its_records_before_it_works() {
    let folder = Folder::new();
    let out = folder.path("out");
    for (study, words) in [
        ("practice", ["nosuch", "cannot be read"]),
        ("ideal-limit", ["ideal-limit", "no records"]),
        ("faults", ["faults", "no records"]),
    ] {
        let begun = Instant::now();
        refused(&["loop-study", study, "--records", "nosuch.AT2", "--out", out.to_str().unwrap()], &out, &words);
        assert!(begun.elapsed() < Duration::from_secs(60), "{study} took {:?}", begun.elapsed());
        assert!(!out.exists(), "{study} left a folder");
    }
    let bare = folder.file("la03.dat", &bare());
    let line = ["loop-study", "practice", "--records", &bare, "--out", out.to_str().unwrap()];
    let output = sprag(&line);
    assert!(said(&output).contains("--dt") && !said(&output).contains("ground.0"), "{}", said(&output));
}

#[test]
fn a_folder_says_what_it_passed_over_and_which_components_are_vertical() {
    let folder = Folder::new();
    let study = folder.file("study.toml", &format!("scene = \"{}\"\n", scenes(&folder)[0]));
    for (name, peak) in [("a-000.csv", 0.2), ("a-090.csv", 0.25), ("a-UP.csv", 0.1), ("b-000.csv", 0.3)] {
        folder.file(&format!("records/{name}"), &pulse(peak));
    }
    folder.file("records/.hidden.csv", "");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("nowhere", folder.path("records/gone.csv")).unwrap();
        assert!(Command::new("mkfifo").arg(folder.path("records/pipe.csv")).status().unwrap().success());
    }
    let (stderr, summary) = folder.run(&["cloud", &study, "--records", &folder.name("records")]);
    let vertical = "taken as horizontal motions: 1 of 4 records: a-UP.csv";
    assert!(stderr.contains(vertical) && stderr.contains(" passed over: .hidden.csv (hidden)"), "{stderr}");
    #[cfg(unix)]
    assert!(
        stderr.contains("3 passed over") && stderr.contains("gone.csv (a link") && stderr.contains("pipe.csv (a pipe"),
        "{stderr}"
    );
    assert!(summary["warnings"].to_string().contains(vertical));
    let files: Vec<&str> = summary["records"].as_array().unwrap().iter().map(|record| record["file"].as_str().unwrap()).collect();
    assert_eq!(files, ["a-000.csv", "a-090.csv", "a-UP.csv", "b-000.csv"]);
    assert!(summary["records"][2]["warnings"].to_string().contains("vertical component"));
    let (stderr, _) = folder.run(&["simulate", &folder.name("loop.toml"), "--record", &folder.name("records/a-UP.csv")]);
    assert!(stderr.contains("seems to be a vertical component"), "{stderr}");
}

#[test]
fn many_records_do_not_flood_the_screen() {
    let folder = Folder::new();
    let study = folder.file("study.toml", &format!("scene = \"{}\"\n", scenes(&folder)[0]));
    for number in 0..40 {
        folder.file(&format!("records/{number:02}.csv"), &pulse(0.1 + 0.002 * f64::from(number)));
    }
    let (stderr, summary) = folder.run(&["cloud", &study, "--records", &folder.name("records")]);
    let lines: Vec<&str> = stderr.lines().filter(|line| line.starts_with("sprag: warning: ")).collect();
    assert!((2..10).contains(&lines.len()) && lines.last().unwrap().contains("more warnings"), "{stderr}");
    let warned = |record: &&Value| !record["warnings"].as_array().unwrap().is_empty();
    assert_eq!(summary["records"].as_array().unwrap().iter().filter(warned).count(), 40);
}

#[cfg(unix)]
#[test]
fn a_pipe_is_refused_and_not_waited_for() {
    let folder = Folder::new();
    let [pair, map, _] = scenes(&folder);
    let pipe = folder.name("pipe.csv");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    for line in [&["record", &pipe][..], &["simulate", &pair, "--record", &pipe], &["map", &map, "--record", &pipe]] {
        let mut child = command(line).current_dir(folder.0.path()).stderr(Stdio::piped()).spawn().unwrap();
        let begun = Instant::now();
        while child.try_wait().unwrap().is_none() && begun.elapsed() < Duration::from_secs(60) {
            std::thread::sleep(Duration::from_millis(20));
        }
        let _ = child.kill();
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{line:?}: {}", said(&output));
        assert!(errors(&said(&output)).concat().contains("is a pipe or a device"), "{line:?}: {}", said(&output));
    }
}

#[test]
fn decimal_commas_are_read_in_every_command() {
    let folder = Folder::new();
    let [pair, ..] = scenes(&folder);
    let text = pulse(0.25).replacen("# time_s,acc_g", "Zeit (s);Beschleunigung (g)", 1);
    let commas: String =
        text.lines()
            .map(|line| {
                if line.starts_with('Z') {
                    format!("{line}\n")
                } else {
                    format!("{}\n", line.replace(',', ";").replace('.', ","))
                }
            })
            .collect();
    let (points, commas) = (folder.file("points.csv", &pulse(0.25)), folder.file("commas.csv", &commas));
    let (_, one) = folder.run(&["simulate", &pair, "--record", &points]);
    let (stderr, other) = folder.run(&["simulate", &pair, "--record", &commas]);
    assert_eq!(one["runs"], other["runs"]);
    assert!(stderr.contains("commas are read as decimal marks"), "{stderr}");
}

#[cfg(unix)]
#[test]
fn a_record_whose_name_is_not_unicode_is_named() {
    use std::os::unix::ffi::OsStrExt;
    let folder = Folder::new();
    let record = folder.0.path().join(std::ffi::OsStr::from_bytes(b"own\xff.csv"));
    fs::write(&record, pulse(0.4)).unwrap();
    let line = ["simulate", &scene("record"), "--out", &folder.name("out"), "--record"];
    let output = command(&line).arg(&record).output().unwrap();
    assert!(
        output.status.code() == Some(2) && said(&output).contains("own\u{fffd}.csv: its name is not Unicode"),
        "{}",
        said(&output)
    );
}
