//! Results in the place of what is there already.

#![cfg(unix)]

use std::collections::BTreeMap;
use std::fs::{self, Permissions};
use std::io::{Read, Write};
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::{Claim, OutputError, ResultFolder, Results, Subject, claim_file, is_standard_output, open_stream};
use crate::columns::{Column, RowWriter, Table, TableError};

fn written(path: &Path, text: &str) -> Result<(), OutputError> {
    let mut results = Results::default();
    results.add(path, |file| file.write_all(text.as_bytes()))?;
    results.commit()
}

/// Squares from 0 up.
struct Squares(u32);

impl Table for Squares {
    fn columns(&self) -> Vec<Column> {
        vec![Column::count("number"), Column::number("square")]
    }

    fn rows(&self, writer: &mut dyn RowWriter) -> Result<(), TableError> {
        (0..self.0).try_for_each(|number| writer.row(&[number.into(), f64::from(number * number).into()]))
    }
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn is_link(path: &Path) -> bool {
    path.symlink_metadata().unwrap().is_symlink()
}

#[test]
fn links_are_followed_to_files_that_are_there_and_to_those_that_are_not() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("deep")).unwrap();
    fs::write(at("deep/file"), "old").unwrap();
    symlink("deep/file", at("link")).unwrap();
    symlink("link", at("again")).unwrap();
    symlink("deep/new", at("dangling")).unwrap();
    written(&at("again"), "new").unwrap();
    written(&at("dangling"), "made").unwrap();
    assert_eq!(fs::read_to_string(at("deep/file")).unwrap(), "new");
    assert_eq!(fs::read_to_string(at("deep/new")).unwrap(), "made");
    assert!(is_link(&at("link")) && is_link(&at("again")) && is_link(&at("dangling")));
    // To itself.
    symlink("circle", at("circle")).unwrap();
    assert!(written(&at("circle"), "x").is_err() && is_link(&at("circle")));
    assert_eq!(names(folder.path()), ["again", "circle", "dangling", "deep", "link"]);
}

#[test]
fn modes_are_kept_and_read_only_files_too() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("file");
    fs::write(&path, "old").unwrap();
    for mode in [0o600, 0o664, 0o755] {
        fs::set_permissions(&path, Permissions::from_mode(mode)).unwrap();
        written(&path, "new").unwrap();
        assert_eq!(path.metadata().unwrap().permissions().mode() & 0o7777, mode);
    }
    fs::set_permissions(&path, Permissions::from_mode(0o444)).unwrap();
    let refused = written(&path, "other").unwrap_err().to_string();
    assert!(refused.contains("file: cannot be written: it is read-only"), "{refused}");
    assert_eq!(fs::read_to_string(&path).unwrap(), "new");
    let refused = written(folder.path(), "x").unwrap_err().to_string();
    assert!(refused.contains("it is a folder"), "{refused}");
    assert_eq!(names(folder.path()), ["file"]);
}

#[test]
fn pipes_are_written_through_once_all_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("pipe");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let path = pipe.clone();
    let reader = std::thread::spawn(move || {
        let mut text = String::new();
        fs::File::open(path).unwrap().read_to_string(&mut text).unwrap();
        text
    });
    let mut results = Results::default();
    assert!(results.add(&pipe, |_| Err(std::io::Error::other("half"))).is_err());
    written(&pipe, "through").unwrap();
    assert_eq!(reader.join().unwrap(), "through");
    assert_eq!(names(folder.path()), ["pipe"]);
    assert!(!pipe.metadata().unwrap().is_file());
}

#[test]
fn one_file_is_replaced_by_its_like_or_when_asked_and_never_when_it_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let [path, link, none] = ["file", "link", "none"].map(|name| folder.path().join(name));
    fs::write(&path, "text").unwrap();
    symlink("file", &link).unwrap();
    let refused = claim_file(&path, &[], false, |_| false).unwrap_err().to_string();
    assert!(refused.contains("--overwrite"), "{refused}");
    claim_file(&path, &[], false, |file| file.buffer().is_empty()).unwrap();
    claim_file(&path, &[], true, |_| false).unwrap();
    claim_file(&none, &[&path], false, |_| false).unwrap();
    for (out, input) in [(&path, &path), (&link, &path), (&path, &link)] {
        let refused = claim_file(out, &[input], true, |_| true).unwrap_err().to_string();
        assert!(refused.contains("which the command reads"), "{refused}");
    }
    // An empty file has nothing to lose.
    fs::write(&path, "").unwrap();
    claim_file(&path, &[], false, |_| false).unwrap();
    claim_file(Path::new("/dev/null"), &[Path::new("/dev/null")], false, |_| false).unwrap();
    assert!(open_stream(Path::new("/dev/null")).unwrap().is_some() && open_stream(&path).unwrap().is_none());
    assert!(is_standard_output(Path::new("-")) && !is_standard_output(&path));
    assert_eq!(names(folder.path()), ["file", "link"]);
}

fn claim(command: &str, scene: &Value) -> Claim<'static> {
    let subject = Subject::new(command, BTreeMap::new()).with("scene", scene).unwrap();
    Claim { subject, page: "summary.json", names: &["map", "loop"], inputs: Vec::new() }
}

fn open(folder: &Path, overwrite: bool, claim: &Claim<'_>) -> Result<(), String> {
    ResultFolder::new(folder.to_owned(), overwrite).open(claim).map_err(|error| error.to_string())
}

#[test]
fn results_are_replaced_by_their_like_or_when_asked() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let ours = claim("map", &json!({"size": 2.0}));
    let others = [
        (claim("loop", &json!({"size": 2.0})), "holds results of `sprag map`"),
        (claim("map", &json!({"size": 2.5})), "scene.size differs"),
    ];
    for page in ["summary.json", "map.run.json", "map-2-of-3.run.json"] {
        fs::write(at(page), serde_json::to_string(&ours.subject).unwrap()).unwrap();
        fs::write(at("map.csv"), "").unwrap();
        open(folder.path(), false, &ours).unwrap();
        for (other, says) in &others {
            let refused = open(folder.path(), false, other).unwrap_err();
            assert!(refused.contains(says) && refused.contains("--overwrite"), "{page}: {refused}");
            open(folder.path(), true, other).unwrap();
        }
        fs::remove_file(at(page)).unwrap();
    }
    // What no page says to be a result is another's, and so is a page that is not.
    for name in ["map.csv", "map-1-of-2.csv", "loop-2.svg", "summary.json", "map.run.json"] {
        let folder = tempfile::tempdir().unwrap();
        for text in ["", "{}", "[1]"] {
            fs::write(folder.path().join(name), text).unwrap();
            let refused = open(folder.path(), false, &ours).unwrap_err();
            assert!(refused.contains(name) && refused.contains("--overwrite"), "{refused}");
            open(folder.path(), true, &ours).unwrap();
        }
    }
    // Other files are nobody's concern.
    let folder = tempfile::tempdir().unwrap();
    for name in ["notes.md", "map.toml", "mapped.csv", "map.csv.unfinished", "map-notes.md", "history.csv"] {
        fs::write(folder.path().join(name), "").unwrap();
    }
    open(folder.path(), false, &ours).unwrap();
}

#[test]
fn of_a_run_that_is_overwritten_no_result_stays() {
    let folder = tempfile::tempdir().unwrap();
    let (before, now) = (claim("map", &json!(1)), claim("map", &json!(2)));
    let ours = [
        "loop-2.svg",
        "loop.png",
        "map-1-of-2.csv",
        "map-1-of-2.run.json",
        "map-1-of-2.svg",
        "map.csv",
        "notes.md",
        "summary.json",
    ];
    let overwrite = |claim: &Claim<'_>| {
        ours.iter().for_each(|name| fs::write(folder.path().join(name), "").unwrap());
        fs::write(folder.path().join("summary.json"), serde_json::to_string(&before.subject).unwrap()).unwrap();
        let mut opened = ResultFolder::new(folder.path().to_owned(), true);
        opened.open(claim).unwrap();
        let mut results = Results::default();
        results.add(&opened.join("map.csv"), |file| file.write_all(b"new")).unwrap();
        opened.replaced().iter().for_each(|path| results.remove(path.clone()));
        results.commit().unwrap();
        assert_eq!(fs::read(opened.join("map.csv")).unwrap(), b"new");
        names(folder.path())
    };
    assert_eq!(overwrite(&now), ["map-1-of-2.csv", "map-1-of-2.run.json", "map.csv", "notes.md", "summary.json"]);
    // A read-only file is nobody's to replace.
    fs::write(folder.path().join("loop-3.svg"), "").unwrap();
    fs::set_permissions(folder.path().join("loop-3.svg"), Permissions::from_mode(0o444)).unwrap();
    assert!(overwrite(&now).contains(&"loop-3.svg".to_owned()));
    fs::remove_file(folder.path().join("loop-3.svg")).unwrap();
    // Of the same input they are true.
    assert_eq!(overwrite(&before), ours);
    // Those of another command may be anybody's.
    assert_eq!(overwrite(&claim("loop", &json!(1))), ours);
}

#[test]
fn results_that_come_meanwhile_are_not_replaced_unasked() {
    let folder = tempfile::tempdir().unwrap();
    let (ours, other) = (claim("map", &json!(1)), claim("map", &json!(2)));
    let opened = [false, true].map(|overwrite| {
        let mut opened = ResultFolder::new(folder.path().to_owned(), overwrite);
        opened.open(&ours).unwrap();
        opened.check_again().unwrap();
        opened
    });
    let meanwhile = |claim: &Claim<'_>| {
        fs::write(folder.path().join("summary.json"), serde_json::to_string(&claim.subject).unwrap()).unwrap();
        opened.each_ref().map(|folder| folder.check_again().map_err(|error| error.to_string()))
    };
    let [refused, overwritten] = meanwhile(&other);
    assert!(refused.unwrap_err().contains("scene differs; --overwrite replaces it") && overwritten.is_ok());
    assert_eq!(meanwhile(&ours), [Ok(()), Ok(())]);
}

#[test]
fn an_input_is_never_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("record.csv"), "").unwrap();
    symlink("record.csv", at("map.csv")).unwrap();
    let inputs: Vec<PathBuf> = vec![at("record.csv")];
    let refused = open(folder.path(), true, &Claim { inputs, ..claim("map", &json!(1)) }).unwrap_err();
    assert!(refused.contains("map.csv") && refused.contains("record.csv, which the command reads"), "{refused}");
}

#[test]
fn folders_that_stay_empty_are_removed_and_others_stay() {
    let root = tempfile::tempdir().unwrap();
    let ours = claim("map", &json!(1));
    let deep = root.path().join("a/b/c");
    drop(ResultFolder::new(deep.clone(), false));
    let mut folder = ResultFolder::new(deep.clone(), false);
    folder.open(&ours).unwrap();
    folder.make("d/e").unwrap();
    assert!(deep.join("d/e").is_dir());
    drop(folder);
    assert_eq!(names(root.path()), [""; 0]);
    let mut folder = ResultFolder::new(deep.clone(), false);
    folder.open(&ours).unwrap();
    written(&folder.join("map.csv"), "1").unwrap();
    drop(folder);
    assert!(deep.join("map.csv").is_file());
    // One that was there, empty, is not this command's to remove.
    fs::create_dir(root.path().join("own")).unwrap();
    open(&root.path().join("own"), false, &ours).unwrap();
    assert!(root.path().join("own").is_dir());
    let refused = open(&deep.join("map.csv/out"), false, &ours).unwrap_err();
    assert!(refused.contains("map.csv is a file, not a folder"), "{refused}");
}

#[test]
fn a_table_whose_rows_come_one_by_one_is_the_same_and_one_that_fails_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let table = Squares(3000);
    let mut results = Results::default();
    results.add_table(folder.path(), "whole", &table, &[], "csv".parse().unwrap()).unwrap();
    let mut add_rows = |name: &str, count: u32| {
        results.add_rows(&folder.path().join(name), &table.columns(), |row| {
            (0..count).try_for_each(|number| row(&[number.into(), f64::from(number * number).into()]))?;
            if count < table.0 { row(&["text".into()]) } else { Ok(()) }
        })
    };
    add_rows("rows.csv", table.0).unwrap();
    let error = add_rows("failed.csv", 10).unwrap_err().to_string();
    assert!(error.contains("failed.csv: cannot be written: row 11"), "{error}");
    results.commit().unwrap();
    assert_eq!(names(folder.path()), ["rows.csv", "whole.csv"]);
    let [whole, rows] = ["whole.csv", "rows.csv"].map(|name| fs::read(folder.path().join(name)).unwrap());
    assert!(!whole.is_empty() && whole == rows);
}
