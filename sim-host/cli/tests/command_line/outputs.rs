//! What is there already when results are written: inputs, devices, pipes, links, read-only files, and other results.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use super::long_runs::{SLOW, begun, files, folders, grown, map};
use super::studies::folder_of_pulses;
use super::{CASE_TITLES, SHORT_SCENE, command, errors, pulse, refused, said, scene, sprag, well};

/// Expects exit code 2 and one line with `words` beside warnings.
fn declined(output: &Output, words: &[&str]) {
    let said = said(output);
    let [line] = errors(&said)[..] else { panic!("one line: {said}") };
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(line.starts_with("sprag: ") && words.iter().all(|word| line.contains(word)), "{words:?}: {said}");
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn one_case() -> String {
    format!("{CASE_TITLES}one,full,15,none,0,0.85,sine,2,2,60\n")
}

fn cases(folder: &Path) -> std::path::PathBuf {
    let cases = folder.join("cases.csv");
    fs::write(&cases, one_case()).unwrap();
    cases
}

/// A scene with a record beside it.
fn short_scene(folder: &Path) -> std::path::PathBuf {
    fs::create_dir_all(folder).unwrap();
    fs::write(folder.join("own.csv"), pulse(0.4)).unwrap();
    let scene = folder.join("scene.toml");
    fs::write(&scene, SHORT_SCENE).unwrap();
    scene
}

#[test]
fn an_input_is_never_an_output() {
    let folder = tempfile::tempdir().unwrap();
    let cases = cases(folder.path());
    let batch = |out: &Path| sprag(&["batch", text(&cases), "--out", text(out), "--overwrite"]);
    declined(&batch(&cases), &["cases.csv", "which the command reads"]);
    #[cfg(unix)]
    {
        let link = folder.path().join("link.csv");
        std::os::unix::fs::symlink(&cases, &link).unwrap();
        declined(&batch(&link), &["link.csv", "cases.csv, which the command reads"]);
        let hard = folder.path().join("hard.csv");
        fs::hard_link(&cases, &hard).unwrap();
        declined(&batch(&hard), &["hard.csv", "which the command reads"]);
    }
    assert_eq!(fs::read_to_string(&cases).unwrap(), one_case());
    // A record that is called like a result of the command.
    let scene = short_scene(folder.path());
    let record = folder.path().join("history.csv");
    fs::write(&record, pulse(0.4)).unwrap();
    let line = ["simulate", text(&scene), "--record", text(&record), "--out", text(folder.path()), "--overwrite"];
    declined(&sprag(&line), &["history.csv", "which the command reads"]);
    assert_eq!(fs::read_to_string(&record).unwrap(), pulse(0.4));
    let records = ["--records", text(&record), "--out", text(folder.path()), "--overwrite"];
    let study = folder.path().join("study.toml");
    fs::write(&study, "").unwrap();
    let named = folder.path().join("runs.csv");
    fs::rename(&record, &named).unwrap();
    let line = [&["cloud", text(&study), "--records", text(&named)], &records[2..]].concat();
    declined(&sprag(&line), &["runs.csv", "which the command reads"]);
    assert_eq!(fs::read_to_string(&named).unwrap(), pulse(0.4));
}

#[cfg(unix)]
#[test]
fn devices_and_pipes_are_written_through_and_links_followed() {
    use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let cases = cases(folder.path());
    let batch = |out: &Path| sprag(&["batch", text(&cases), "--out", text(out)]);
    well(batch(&at("plain.csv")));
    let plain = fs::read(at("plain.csv")).unwrap();

    // Through a link, so that not even a mistake could take the place of the device.
    symlink("/dev/null", at("null")).unwrap();
    well(batch(&at("null")));
    assert!(at("null").symlink_metadata().unwrap().is_symlink());
    assert!(Path::new("/dev/null").metadata().unwrap().file_type().is_char_device());

    assert!(Command::new("mkfifo").arg(at("pipe")).status().unwrap().success());
    let reader = Command::new("cat").arg(at("pipe")).stdout(Stdio::piped()).spawn().unwrap();
    well(batch(&at("pipe")));
    assert_eq!(reader.wait_with_output().unwrap().stdout, plain);
    assert!(at("pipe").metadata().unwrap().file_type().is_fifo());

    symlink("plain.csv", at("link.csv")).unwrap();
    well(batch(&at("link.csv")));
    assert!(at("link.csv").symlink_metadata().unwrap().is_symlink());

    // Only the owner of the machine makes device nodes.
    let node = at("node");
    if Command::new("mknod").arg(&node).args(["c", "1", "3"]).stderr(Stdio::null()).status().is_ok_and(|status| status.success())
    {
        well(batch(&node));
        assert!(node.metadata().unwrap().file_type().is_char_device());
    }

    fs::set_permissions(at("plain.csv"), fs::Permissions::from_mode(0o640)).unwrap();
    well(batch(&at("plain.csv")));
    assert_eq!(at("plain.csv").metadata().unwrap().permissions().mode() & 0o777, 0o640);
    fs::set_permissions(at("plain.csv"), fs::Permissions::from_mode(0o444)).unwrap();
    let overwriting = sprag(&["batch", text(&cases), "--out", text(&at("plain.csv")), "--overwrite"]);
    declined(&overwriting, &["plain.csv", "read-only"]);
    assert_eq!(fs::read(at("plain.csv")).unwrap(), plain);
}

/// Into a pipe and into a file of the shell: the motion and nothing else.
#[cfg(target_os = "linux")]
#[test]
fn standard_output_takes_a_result() {
    let folder = tempfile::tempdir().unwrap();
    let motion = folder.path().join("motion.csv");
    well(sprag(&["synthesize", "--out", text(&motion)]));
    let plain = fs::read(&motion).unwrap();
    let piped = sprag(&["synthesize", "--out", "/dev/stdout"]);
    assert!(piped.stdout == plain && said(&piped).contains("samples"), "{}", said(&piped));
    let quiet = sprag(&["synthesize", "--out", "-", "--quiet"]);
    assert!(quiet.stdout == plain && said(&quiet).is_empty(), "{}", said(&quiet));
    let redirected = folder.path().join("redirected.csv");
    let file = fs::File::create(&redirected).unwrap();
    well(command(&["synthesize", "--out", "/dev/stdout"]).stdout(file).output().unwrap());
    assert!(fs::read(&redirected).unwrap() == plain);
    assert!(Path::new("/dev/stdout").symlink_metadata().unwrap().is_symlink());
}

#[test]
fn single_results_are_replaced_by_the_same_command_or_when_asked() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let cases = cases(folder.path());
    let results = at("results.csv");
    let batch = |more: &[&str]| sprag(&[&["batch", text(&cases), "--out", text(&results)], more].concat());
    well(batch(&[]));
    well(batch(&[]));
    // With other columns, of other cases, and what is no result.
    declined(&batch(&["--accuracy", "fast"]), &["results.csv", "the same input and options", "--overwrite"]);
    fs::write(&cases, one_case().replace("one,full", "two,full")).unwrap();
    declined(&batch(&[]), &["results.csv", "--overwrite"]);
    assert!(fs::read_to_string(&results).unwrap().contains("\none,"));
    well(batch(&["--overwrite"]));
    assert!(fs::read_to_string(&results).unwrap().contains("\ntwo,"));
    fs::write(&results, "my notes").unwrap();
    declined(&batch(&[]), &["results.csv", "--overwrite"]);
    assert_eq!(fs::read_to_string(&results).unwrap(), "my notes");

    let motion = at("motion.csv");
    let synthesize = |more: &[&str]| sprag(&[&["synthesize", "--out", text(&motion)], more].concat());
    well(synthesize(&[]));
    well(synthesize(&[]));
    let other = synthesize(&["--seed", "9"]);
    assert!(other.status.code() == Some(2) && said(&other).contains("--overwrite"), "{}", said(&other));
    well(synthesize(&["--seed", "9", "--overwrite"]));
}

#[test]
fn folders_are_replaced_by_the_same_command_of_the_same_scene_or_when_asked() {
    let folder = tempfile::tempdir().unwrap();
    let scene = short_scene(folder.path());
    let out = folder.path().join("out");
    let run = |command: &str, more: &[&str]| sprag(&[&[command, text(&scene), "--out", text(&out)], more].concat());
    let history = || fs::read(out.join("history.csv")).unwrap();
    well(run("simulate", &[]));
    let first = history();
    well(run("simulate", &[]));
    let changed = ["--set", "block.restitution=0.8"];
    declined(&run("simulate", &changed), &["out: it holds results", "scene.block.restitution differs", "--overwrite"]);
    let axes = ["--x", "block.restitution=0.7:0.9:2", "--cut"];
    declined(&run("map", &axes), &["out: it holds results of `sprag simulate`", "--overwrite"]);
    // A record of the same name that is another.
    fs::write(folder.path().join("own.csv"), pulse(0.41)).unwrap();
    declined(&run("simulate", &[]), &["files.own.csv", "--overwrite"]);
    assert!(history() == first);
    well(run("simulate", &[&changed[..], &["--overwrite"]].concat()));
    assert!(history() != first);
    well(run("simulate", &changed));
    // What a time budget affords may change from day to day.
    well(run("simulate", &[&changed[..], &["--time-budget", "2"]].concat()));
    well(run("simulate", &[&changed[..], &["--time-budget", "3"]].concat()));
    declined(&run("simulate", &changed), &["scene.accuracy", "--overwrite"]);

    // The user's own.
    for name in ["summary.json", "history.csv", "history.svg"] {
        let own = folder.path().join("own");
        fs::create_dir_all(&own).unwrap();
        fs::write(own.join(name), "{\"mine\": true}").unwrap();
        declined(&sprag(&["simulate", text(&scene), "--out", text(&own)]), &[name, "--overwrite"]);
        assert_eq!(fs::read_to_string(own.join(name)).unwrap(), "{\"mine\": true}");
        fs::remove_dir_all(&own).unwrap();
    }
    // Scenes of one name in two folders share the default folder.
    let other = short_scene(&folder.path().join("other"));
    fs::write(&other, SHORT_SCENE.replace("size_m = 2", "size_m = 3")).unwrap();
    let here = |scene: &Path| command(&["simulate", text(scene)]).current_dir(folder.path()).output().unwrap();
    well(here(&scene));
    declined(&here(&other), &["out/scene", "scene.block.size_m differs"]);
}

#[test]
fn a_finished_map_is_not_replaced_by_another_scene_its_shards_or_its_resumption() {
    let (_root, out, _) = folders();
    let few = ["--set", "map.x.cells=4", "--set", "map.y.cells=3", "--formats", "csv,svg"];
    well(map(&out, &few).output().unwrap());
    let before = files(&out);
    let other = [&few[..], &["--set", "block.restitution=0.9"]].concat();
    for more in [&[][..], &["--resume"], &["--restart"], &["--shard", "1/2"], &["--merge", "1"]] {
        declined(&map(&out, &other).args(more).output().unwrap(), &["scene.block.restitution differs", "--overwrite"]);
    }
    let simulate = sprag(&["simulate", &scene("figure08"), "--out", text(&out)]);
    declined(&simulate, &["it holds results of `sprag map`"]);
    assert_eq!(files(&out), before);
    well(map(&out, &few).output().unwrap());
    assert_eq!(files(&out), before);
    well(map(&out, &other).arg("--overwrite").output().unwrap());
    assert_ne!(files(&out), before);
}

/// A run that ends after its rows and before its pictures, here because the summary cannot be written, leaves the results before whole.
#[test]
fn results_of_two_runs_are_never_mixed() {
    let folder = tempfile::tempdir().unwrap();
    let records = folder_of_pulses(folder.path());
    let (figure, study, out) = (scene("figure08"), scene("cloud"), folder.path().join("out"));
    let few = ["--set", "map.x.cells=4", "--set", "map.y.cells=3", "--refine", "--evaluations", "20"];
    let commands = [[&["map", &figure][..], &few].concat(), vec!["cloud", &study, "--records", &records]];
    for (command, table) in commands.into_iter().zip(["map", "runs"]) {
        let run = |more: &[&str]| sprag(&[&command[..], &["--formats", "csv,svg", "--out", text(&out)], more].concat());
        let [rows, ledger, summary] = [format!("{table}.csv"), format!("{table}.run.json"), "summary.json".to_owned()];
        let read = || [&rows, &ledger].map(|name| fs::read(out.join(name)).unwrap());
        let read_only = |only| {
            let mut mode = fs::metadata(out.join(&summary)).unwrap().permissions();
            mode.set_readonly(only);
            fs::set_permissions(out.join(&summary), mode).unwrap();
        };
        run(&[]);
        let before = read();
        let other = ["--set", "block.restitution=0.7", "--overwrite", "--resume"];
        read_only(true);
        declined(&run(&other[..3]), &["summary.json", "read-only"]);
        assert_eq!(read(), before, "{table}");
        // Its own rows are kept.
        assert!(out.join(format!("{rows}.unfinished")).exists(), "{table}");
        read_only(false);
        run(&other);
        assert_ne!(read(), before, "{table}");
        assert!(!out.join(format!("{rows}.unfinished")).exists(), "{table}");
        fs::remove_dir_all(&out).unwrap();
    }
}

#[test]
fn cloud_and_optimise_have_folders_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let records = folder_of_pulses(folder.path());
    for command in ["cloud", "optimise"] {
        let mut line = Command::new(env!("CARGO_BIN_EXE_sprag"));
        line.current_dir(folder.path()).args([command, &scene(command), "--formats", "csv", "--records", &records]);
        let output = line.output().unwrap();
        assert!(folder.path().join(format!("out/{command}-{command}/summary.json")).is_file(), "{}", said(&output));
        // The same again, and a study of another scene.
        assert_eq!(line.output().unwrap().status.code(), output.status.code());
        declined(
            &line.args(["--set", "block.restitution=0.9"]).output().unwrap(),
            &["sprag", "restitution differs", "--overwrite"],
        );
    }
}

#[test]
fn a_command_that_fails_leaves_no_folder() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let inside = file.join("out");
    refused(&["simulate", &scene("figure05"), "--out", text(&inside)], &inside, &["file is a file, not a folder"]);
    refused(&["simulate", &scene("figure05"), "--out", text(&file)], &inside, &["file is a file, not a folder"]);
    // The folder is made, and the work fails.
    let out = folder.path().join("made/out");
    let image = ["--qemu", "--firmware", "nowhere.elf"];
    let controller = scene("controller");
    let line = [&["hil", &controller, "--set", "run.free_time_s=0", "--out", text(&out)], &image[..]].concat();
    refused(&line, &out, &["nowhere.elf"]);
    assert!(!folder.path().join("made").exists());
}

/// A process that works on rows keeps them, whatever another is asked to throw away.
#[cfg(unix)]
#[test]
fn a_restart_does_not_touch_the_rows_of_a_running_process() {
    let (root, whole, shared) = folders();
    let slow = [&SLOW[..], &["--formats", "csv,svg"]].concat();
    well(map(&whole, &slow).output().unwrap());
    let signal = |name: &str, id: u32| {
        super::terminal::signal(name, id);
        // Every thread has stopped before the rows are read.
        let stopped = |task: &Path| fs::read_to_string(task).map_or(true, |stat| stat.contains(") T ") || stat.contains(") Z "));
        let tasks = || fs::read_dir(format!("/proc/{id}/task")).into_iter().flatten().flatten();
        while name == "-STOP" && !tasks().all(|task| stopped(&task.path().join("stat"))) {
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
    };
    let first = map(&shared, &slow).args(["--threads", "1"]).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    begun(&shared);
    signal("-STOP", first.id());
    if !shared.join("map.csv").exists() {
        for more in [&["--restart"][..], &["--resume"], &[]] {
            declined(&map(&shared, &slow).args(more).output().unwrap(), &["map.csv.unfinished", "another process works on it"]);
        }
    }
    signal("-CONT", first.id());
    well(first.wait_with_output().unwrap());
    assert!(files(&whole) == files(&shared));

    let records = folder_of_pulses(root.path());
    let tried = root.path().join("tried");
    let run = |more: &[&str]| {
        let optimise = ["optimise", &scene("optimise"), "--formats", "csv", "--records", &records, "--out", text(&tried)];
        let mut command = command(&[&optimise, more].concat());
        command.stdout(Stdio::null()).stderr(Stdio::piped());
        command
    };
    let first = run(&["--threads", "1"]).spawn().unwrap();
    grown(&tried, ["tried.csv.unfinished", "summary.json"]);
    signal("-STOP", first.id());
    let rows = tried.join("tried.csv.unfinished");
    if let Ok(before) = fs::read(&rows) {
        declined(&run(&["--restart"]).output().unwrap(), &["another process works on it"]);
        assert!(fs::read(&rows).unwrap() == before);
    }
    signal("-CONT", first.id());
    let ended = first.wait_with_output().unwrap();
    assert!(tried.join("summary.json").exists() && !rows.exists(), "{}", said(&ended));
}
