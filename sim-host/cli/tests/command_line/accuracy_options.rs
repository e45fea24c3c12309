//! `--accuracy` and `--time-budget` as a user meets them.

use std::fs;
use std::path::Path;

use super::{CASE_TITLES, said, scene, sprag, summary, well};

/// Peak and error of the first run that stands.
fn peak_and_error(command: &str, scene: &str, level: &str) -> (f64, f64) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    well(sprag(&[command, &super::scene(scene), "--accuracy", level, "--out", out]));
    let summary = summary(folder.path());
    let run = summary["runs"].as_array().unwrap().iter().find(|run| run["outcome"] == "safe").unwrap();
    assert_eq!(run["error_estimate"]["outcome_certain"], true, "{run}");
    (run["peak_rotation"].as_f64().unwrap(), run["error_estimate"]["peak_rotation"].as_f64().unwrap())
}

#[test]
fn closer_levels_have_smaller_errors_and_lie_within_those_of_the_coarser() {
    for (command, scene, largest) in [("simulate", "figure05", 1e-3), ("loop", "controller", 1e-2)] {
        let (tight, smallest) = peak_and_error(command, scene, "tight");
        let mut before = largest;
        for level in ["fast", "1e-6", "normal"] {
            let (peak, error) = peak_and_error(command, scene, level);
            assert!(
                (peak - tight).abs() <= error + smallest,
                "{command} {level}: {peak} and {tight} differ by more than {error:e}"
            );
            assert!(error <= before, "{command} {level}: {error:e} after {before:e}");
            before = error;
        }
        assert!(smallest <= before, "{command}: {smallest:e} after {before:e}");
    }
}

#[test]
fn an_error_that_is_asked_for_is_kept() {
    for wanted in [1e-3, 1e-9] {
        let (peak, error) = peak_and_error("simulate", "near_fault", &format!("{wanted:e}"));
        assert!(error <= wanted * peak, "{wanted:e}: {error:e} of {peak}");
    }
}

#[test]
fn batch_gives_errors_beside_its_results_and_without_them_the_columns_of_old() {
    let folder = tempfile::tempdir().unwrap();
    let [cases, plain, closer, again] =
        ["cases.csv", "plain.csv", "closer.csv", "again.csv"].map(|name| folder.path().join(name));
    let mut text = CASE_TITLES.to_owned();
    for index in 0..200 {
        text += &format!(
            "{index},full,15,clutched-pair,0.5,0.85,sine,{},{},20\n",
            1.0 + 0.02 * f64::from(index),
            1.5 + f64::from(index % 7)
        );
    }
    fs::write(&cases, text).unwrap();
    let run = |out: &Path, more: &[&str]| {
        let output = well(sprag(&[&["batch", cases.to_str().unwrap(), "--out", out.to_str().unwrap()], more].concat()));
        (fs::read_to_string(out).unwrap(), said(&output))
    };
    let (plain, _) = run(&plain, &[]);
    let (tight, _) = run(&closer, &["--accuracy", "tight", "--threads", "1"]);
    assert_eq!(run(&again, &["--accuracy", "tight", "--threads", "2"]).0, tight, "errors do not depend on the number of threads");
    let columns = "id,outcome,peak_rotation,peak_acceleration,impacts,first_impact_time,end_time";
    assert_eq!(plain.lines().next(), Some(columns));
    let with = format!("{columns},outcome_certain,peak_rotation_error,peak_acceleration_error,first_impact_time_error");
    assert_eq!(tight.lines().next(), Some(&*with));
    for (without, with) in plain.lines().zip(tight.lines()).skip(1) {
        // Without errors lanes follow the cases: the same to rounding.
        let (fields, plain): (Vec<&str>, Vec<&str>) = (with.split(',').collect(), without.split(',').collect());
        assert_eq!((fields.len(), plain.len()), (11, 7));
        for (ours, theirs) in plain.iter().zip(&fields) {
            let same = match (ours.parse::<f64>(), theirs.parse::<f64>()) {
                (Ok(ours), Ok(theirs)) => (ours - theirs).abs() <= 1e-9 * theirs.abs(),
                _ => ours == theirs,
            };
            assert!(same, "the result itself is the same: {without}, {with}");
        }
        assert_eq!(fields[2].is_empty(), fields[8].is_empty(), "{with}");
        if !fields[8].is_empty() {
            let (peak, error): (f64, f64) = (fields[2].parse().unwrap(), fields[8].parse().unwrap());
            assert!(error > 0.0 && error < 1e-9 * peak.max(1.0), "{with}");
        }
    }
    // Plenty of time buys everything, and says so.
    let (most, line) = run(&again, &["--time-budget", "3600"]);
    assert!(line.contains("--accuracy tight"), "{line}");
    assert_eq!(most, tight);
}

#[test]
fn a_time_budget_promises_no_error_where_every_block_overturns() {
    let folder = tempfile::tempdir().unwrap();
    let (cases, out) = (folder.path().join("cases.csv"), folder.path().join("out.csv"));
    fs::write(&cases, format!("{CASE_TITLES}one,full,15,none,0,0.85,sine,1,20,20\n")).unwrap();
    let output = sprag(&["batch", cases.to_str().unwrap(), "--out", out.to_str().unwrap(), "--time-budget", "3600"]);
    let line = said(&output);
    assert!(output.status.success() && fs::read_to_string(&out).unwrap().contains("one,overturned"), "{line}");
    assert!(line.contains("--accuracy tight takes some") && line.contains("no peak has an error"), "{line}");
    assert!(!line.contains("relative error"), "{line}");
}

#[test]
fn too_little_time_is_said_with_what_it_affords() {
    let folder = tempfile::tempdir().unwrap();
    let (cases, out) = (folder.path().join("cases.csv"), folder.path().join("out.csv"));
    let row = ",full,15,clutched-pair,0.5,0.85,sine,2.5,3,20\n";
    fs::write(&cases, (0..60_000).fold(CASE_TITLES.to_owned(), |text, index| text + &index.to_string() + row)).unwrap();
    let output = sprag(&[
        "batch",
        cases.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
        "--time-budget",
        "0.001",
        "--accuracy",
        "1e-12",
    ]);
    assert_eq!(output.status.code(), Some(2));
    let line = said(&output);
    assert_eq!(line.trim_end().lines().count(), 1, "{line}");
    assert!(line.contains("--time-budget") && line.contains(" s "), "{line}");
    assert!(!out.exists());
}

#[test]
fn levels_that_make_no_sense_are_refused() {
    let scene = scene("figure05");
    for (arguments, word) in [
        (&["simulate", &scene, "--accuracy", "loose"] as &[&str], "fast, normal, tight"),
        (&["simulate", &scene, "--accuracy=-1"], "fast, normal, tight"),
        (&["simulate", &scene, "--time-budget", "0"], "0.001"),
        (&["simulate", &scene, "--time-budget", "nan"], "0.001"),
        (&["batch", "cases.csv", "--out", "x.csv", "--accuracy", "fast", "--tolerance", "1e-9"], "cannot be used with"),
        (&["simulate", &scene, "--set", "accuracy.level=\"fast\"", "--set", "accuracy.tolerance=1e-9"], "accuracy.level"),
        (&["accuracy", &scene, "--smallest-step", "1"], "must be a number from 3e-5 to 0.1"),
        (&["record", "r.csv", "--slenderness-deg", "90"], "must be a number above 0 and below 90"),
        (&["record", "r.csv", "--dt", "one"], "must be a number from 1e-5 to 1"),
        (&["board", "watch", "--qemu", "--seconds", "-1"], "must be a number above 0"),
        (&["board", "watch", "--qemu", "--seconds", "nan"], "must be a number above 0"),
        (&["design", &scene, "--margin", "much"], "must be a number"),
    ] {
        let output = sprag(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", said(&output));
        assert!(said(&output).contains(word), "{arguments:?}: {}", said(&output));
    }
}

#[test]
fn the_study_writes_its_tables_and_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("study");
    let scene = scene("figure05");
    well(sprag(&["accuracy", &scene, "--cells", "2", "--smallest-step", "0.03", "--out", out.to_str().unwrap()]));
    let mut files: Vec<_> = fs::read_dir(&out).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
    files.sort();
    for file in ["accuracy.csv", "accuracy.md", "order.svg", "sines.svg", "summary.json", "work_precision.svg"] {
        assert!(files.iter().any(|known| known == file), "{file} among {files:?}");
    }
    let summary = summary(&out);
    assert_eq!((&summary["command"], &summary["cells"]), (&"accuracy".into(), &4.into()));
    let runs = summary["runs"].as_array().unwrap();
    assert!(runs.iter().any(|run| run["on_pareto_front"] == true));
    for method in ["semi-implicit-euler", "runge-kutta-4", "taylor", "closed-form"] {
        assert!(runs.iter().any(|run| run["method"] == method && run["nanoseconds_per_s"].as_f64().unwrap() > 0.0), "{method}");
    }
    let beyond = sprag(&["accuracy", &scene, "--set", "device.2.engagement=\"rigid\"", "--out", out.to_str().unwrap()]);
    assert_eq!(beyond.status.code(), Some(2));
    assert!(said(&beyond).contains("device.2"), "{}", said(&beyond));
}

#[test]
fn a_time_budget_counts_all_specimens_and_is_not_said_to_suffice_where_it_does_not() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let (controller, place) = (scene("controller"), ["--out", out.to_str().unwrap()]);
    let specimens = |count: &str, budget: &[&str]| {
        sprag(&[&["loop", &controller, "--monte-carlo", count, "--time-budget"], budget, &place].concat())
    };
    let refused = specimens("1000000000", &["1"]);
    let line = said(&refused);
    assert_eq!(refused.status.code(), Some(2), "{line}");
    assert!(
        line.contains("--time-budget: the work with its error estimates takes some") && line.matches('\n').count() == 1,
        "{line}"
    );
    // The same with time enough says what it is going to do, and does it.
    let done = specimens("2", &["3600", "--accuracy", "fast"]);
    assert!(done.status.success() && said(&done).contains("--accuracy fast affords"), "{}", said(&done));
    let scene = scene("near_fault");
    let other = folder.path().join("other");
    let late = sprag(&["simulate", &scene, "--time-budget", "0.001", "--out", other.to_str().unwrap()]);
    let line = said(&late);
    assert!(late.status.success() && line.contains("--time-budget 0.001 does not suffice for --accuracy fast"), "{line}");
}

/// The first specimen is the scene's own: it comes to what the loop itself comes to.
#[test]
fn specimens_of_a_loop_are_as_accurate_as_the_loop() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    well(sprag(&[
        "loop",
        &scene("controller"),
        "--set",
        "run.free_time_s=0",
        "--set",
        "controller.rate_hz=500",
        "--accuracy",
        "tight",
        "--monte-carlo",
        "1",
        "--out",
        out.to_str().unwrap(),
    ]));
    let run = &summary(&out)["runs"][0];
    let [own, specimen] = [&run["peak_rotation"], &run["monte_carlo"]["peak_rotation_median"]].map(|peak| peak.as_f64().unwrap());
    assert!((own - specimen).abs() <= 1e-12 * own, "{own} {specimen}");
}
