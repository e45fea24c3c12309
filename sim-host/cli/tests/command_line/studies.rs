//! Studies over many motions or places.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use serde_json::Value;

use super::{SHORT_SCENE, errors, pulse, said, scene, sprag, summary, well};

/// A scene with a record of its own, and three more records: in the middle one that cannot be read.
fn inputs(folder: &Path) -> (String, [String; 3]) {
    let file = |name: &str, text: &str| {
        let path = folder.join(name);
        fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    file("own.csv", &pulse(0.28));
    let records = [file("weak.csv", &pulse(0.25)), file("bad.csv", BAD), file("strong.csv", &pulse(-0.3))];
    (file("short.toml", SHORT_SCENE), records)
}

/// A record that cannot be read.
const BAD: &str = "# time_s,acc_g\n0,0\n0.01,NaN\n";

fn names_the_bad_record(output: &Output) {
    let message = said(output);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("bad.csv") && errors(&message).len() == 1, "{message}");
}

/// Runs `line` on one thread and on three, looks at each run, and expects the same bytes in `files`; where one wrote them, and its summary.
pub(super) fn on_any_threads(folder: &Path, line: &[&str], look: impl Fn(&Output), files: &[&str]) -> (PathBuf, Value) {
    let [out, other] = ["1", "3"].map(|threads| {
        let out = folder.join(threads);
        look(&sprag(&[line, &["--threads", threads, "--out", out.to_str().unwrap()]].concat()));
        out
    });
    for name in files {
        let [one, other] = [&out, &other].map(|out| fs::read(out.join(name)).unwrap());
        assert!(one == other && !one.is_empty(), "{name}");
    }
    let summary = summary(&out);
    (out, summary)
}

#[test]
fn sensitivity_does_not_depend_on_the_number_of_threads_and_names_a_bad_record() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, [weak, bad, strong]) = inputs(folder.path());
    let line = ["sensitivity", &scene, "--records", &weak, &bad, &strong];
    let files = ["summary.json", "sensitivity.csv", "sensitivity.md", "sensitivity.svg"];
    let (out, summary) = on_any_threads(folder.path(), &line, names_the_bad_record, &files);
    let files: Vec<&str> = summary["records"].as_array().unwrap().iter().map(|record| record["file"].as_str().unwrap()).collect();
    assert_eq!(files, ["own.csv", &weak, &strong]);
    let table = fs::read_to_string(out.join("sensitivity.csv")).unwrap();
    let rows: Vec<&str> = table.lines().filter(|row| row.contains(",kinematics,consistent,")).collect();
    assert_eq!(rows.len(), 3, "{table}");
    assert!(rows[0].starts_with("own motion,inerter,") && rows[2].starts_with("strong,inerter,"), "{rows:?}");
}

#[test]
fn a_folder_of_records_is_the_files_in_it() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, [weak, bad, strong]) = inputs(folder.path());
    let [all, none] = ["all", "none"].map(|name| folder.path().join(name));
    fs::create_dir_all(all.join("deeper")).unwrap();
    fs::create_dir(&none).unwrap();
    let files = [(strong, "a.csv"), (bad, "b.csv"), (weak, "deeper/c.csv")].map(|(from, to)| {
        fs::copy(from, all.join(to)).unwrap();
        all.join(to).to_str().unwrap().to_owned()
    });
    let [all, none] = [all, none].map(|path| path.to_str().unwrap().to_owned());
    let pair = ["--set", "block.mass_kg=8000", "--set", "device.0.kind=clutched-pair"];
    for (line, table) in [(["sensitivity", &scene], "sensitivity.csv"), (["design", &scene], "motions.csv")] {
        let run = |records: &[&str], out: &str| {
            let out = folder.path().join(out);
            let output =
                sprag(&[&line[..], &pair, &["--records"], records, &["--overwrite", "--out", out.to_str().unwrap()]].concat());
            assert_eq!(output.status.code(), Some(1), "{}", said(&output));
            (fs::read(out.join(table)).unwrap(), said(&output))
        };
        let (by_name, _) = run(&files.each_ref().map(String::as_str), "by_name");
        let (by_folder, said) = run(&[&all, &none], "by_folder");
        assert!(by_name == by_folder, "{line:?}");
        assert!(said.contains("b.csv: ") && said.contains("none: no file in it ends in "), "{said}");
    }
}

#[test]
fn design_does_not_depend_on_the_number_of_threads_and_names_a_bad_record() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, [weak, bad, strong]) = inputs(folder.path());
    let mut line = vec!["design", &scene, "--set", "block.mass_kg=8000", "--set", "device.0.kind=clutched-pair"];
    line.extend(["--records", &weak, &bad, &strong]);
    let files = ["summary.json", "parts.csv", "motions.csv", "delays.csv", "design.md", "delay.svg"];
    let (out, summary) = on_any_threads(folder.path(), &line, names_the_bad_record, &files);
    assert_eq!((&summary["basis"]["teeth"], summary["designs"].as_array().unwrap().len()), (&20.into(), 1));
    let page = fs::read_to_string(out.join("design.md")).unwrap();
    assert!(page.contains("1 record could not be read") && page.contains("clutch, each"), "{page}");
    // Other assumptions are another design, which does not replace this one unasked.
    let output = sprag(&[&line[..], &["--teeth", "24", "--threads", "1", "--out", out.to_str().unwrap()]].concat());
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("basis.teeth differs"), "{}", said(&output));
}

#[test]
fn cloud_does_not_depend_on_the_number_of_threads_and_names_a_bad_record() {
    let folder = tempfile::tempdir().unwrap();
    let records = folder_of_pulses(folder.path());
    for (name, record) in [("5.csv", &*pulse(0.25)), ("6.csv", &pulse(0.35)), ("bad.csv", BAD)] {
        fs::write(Path::new(&records).join(name), record).unwrap();
    }
    let mut files = vec!["summary.json", "runs.csv", "demand.csv", "demand.md", "demand.svg", "fragility.csv", "fragility.md"];
    files.extend(["fragility.svg", "ranking.csv", "ranking.md"]);
    let line = ["cloud", &scene("cloud"), "--records", &records];
    let (out, summary) = on_any_threads(folder.path(), &line, names_the_bad_record, &files);
    assert_eq!((&summary["command"], &summary["structures"][1]["scene"]["block"]["size_m"]), (&"cloud".into(), &1.0.into()));
    assert_eq!(summary["records"].as_array().unwrap().len(), 7);
    assert_eq!(summary["runs"].as_array().unwrap().len(), 3 * 3);
    let table = fs::read_to_string(out.join("runs.csv")).unwrap();
    assert_eq!(table.lines().count(), 1 + 7 * 3 * 3);
    assert!(table.starts_with("record,structure,device,scale,level,uniform_duration,pgv,"), "{table}");
}

/// Records of pulses of several amplitudes (g), in a folder of their own.
pub(super) fn folder_of_pulses(folder: &Path) -> String {
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
    let line = ["optimise", &scene("optimise"), "--records", &records];
    let choice = ["choice.md", "choice.png", "choice.svg"];
    let tables = ["designs.csv", "designs.parquet", "motions.csv", "motions.parquet"];
    let files = [&choice[..], &tables, &["optimise.md", "summary.json", "trade_off.png", "trade_off.svg"]].concat();
    let look = |output: &Output| {
        assert!(output.status.success(), "{}", said(output));
        let table = String::from_utf8_lossy(&output.stdout);
        assert!(table.contains("\nbare block") && table.contains("\nbest") && table.contains("5 motions"), "{table}");
    };
    let (out, summary) = on_any_threads(folder.path(), &line, look, &files);
    let mut written: Vec<_> = fs::read_dir(&out).unwrap().map(|file| file.unwrap().file_name()).collect();
    written.sort();
    assert_eq!(written, files);
    assert_eq!((&summary["command"], &summary["reference"]["law"]), (&"optimise".into(), &"none".into()));
    assert_eq!(summary["structure"]["scene"]["block"]["size_m"], 1.0);
    assert_eq!(summary["study"]["optimise"]["limit_quantile"], 1.0);
    for key in ["law", "mount", "mass_ratio", "probability", "probability_band", "peak_force_ratio", "stroke_m", "feasible"] {
        assert!(!summary["best"][key].is_null(), "{key}: {}", summary["best"]);
    }
    let table = fs::read_to_string(out.join("designs.csv")).unwrap();
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
    let message = said(&output);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(
        message.contains("study.toml: no device respects max |F|/(mg) ≤ 0.0001 in every motion; results are written"),
        "{message}"
    );
    assert!(message.contains("left out: rigid, base-corners: "), "{message}");
    assert!(String::from_utf8_lossy(&output.stdout).contains("nearest to the limits"));
    let summary = summary(&out);
    assert!(summary["best"].is_null() && summary["nearest"]["demand_over_limit"].as_f64().unwrap() > 1.0);
}

#[test]
fn a_refined_map_has_its_boundaries_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let run = |threads: &str, more: &[&str]| {
        let out = folder.path().join(format!("{threads}{}", more.len()));
        let few = ["--set", "map.x.cells=6", "--set", "map.y.cells=5", "--refine", "--evaluations", "1500", "--threads", threads];
        let (scene, place) = (scene("figure08"), out.to_str().unwrap().to_owned());
        let output = well(sprag(&[&["map", &scene, "--out", &place][..], &few, more].concat()));
        (out, String::from_utf8(output.stdout).unwrap())
    };
    let ((one, table), (two, _)) = (run("1", &[]), run("2", &[]));
    assert!(table.contains("evaluations") && table.contains("are left coarser"), "{table}");
    for name in ["boundaries.csv", "boundaries.svg"] {
        let [one, two] = [&one, &two].map(|out| fs::read(out.join(name)).unwrap());
        assert!(!one.is_empty() && one == two, "{name}");
    }
    for run in summary(&one)["runs"].as_array().unwrap() {
        let refined = &run["refined"];
        assert!(refined["evaluations"] == 1500 && refined["vertices"].as_u64().unwrap() > 10, "{refined}");
        assert!(refined["unresolved_squares"].as_u64().unwrap() > 0 && refined["unresolved_relative_width"].is_number());
    }
    // In a cut boundaries are points.
    let (cut, table) = run("1", &["--cut"]);
    assert!(cut.join("boundaries.csv").exists() && !cut.join("boundaries.svg").exists() && !table.contains("coarser"));
}
