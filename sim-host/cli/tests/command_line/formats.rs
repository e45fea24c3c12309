//! Tables and pictures of `sprag map` and `sprag cloud` in every format: the same values to the bits, the same bytes, and characters
//! that the font has.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;

use super::studies::on_any_threads;
use super::{errors, said, scene, sprag, summary};

/// A device's name that CSV has to quote.
const QUOTED: &str = "device.1.name=\"one, \\\"inerter\\\"\"";

/// Expects that a run ends well and says nothing on the side.
fn silent(output: &Output) {
    assert!(output.status.success() && errors(&said(output)).is_empty(), "{}", said(output));
}

/// Runs `sprag` with `--out`, expects that it ends well and says nothing on the side, and gives the names of its files.
fn written(arguments: &[&str], out: &Path) -> Vec<String> {
    silent(&sprag(&[arguments, &["--out", out.to_str().unwrap()]].concat()));
    let mut names: Vec<String> =
        fs::read_dir(out).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// A small map, a cut and a cloud, each in a folder of its own.
pub fn studies(folder: &Path) -> [PathBuf; 3] {
    let outs = ["map", "cut", "cloud"].map(|name| folder.join(name));
    let scene = scene("figure08");
    let map = ["map", &scene, "--set", "map.x.cells=24", "--set", "map.y.cells=20", "--set", QUOTED];
    let names = ["acceleration.png", "acceleration.svg", "map.csv", "map.parquet", "map.png", "map.run.json", "map.svg"];
    assert_eq!(written(&map, &outs[0]), [&names[..], &["rotation.png", "rotation.svg", "summary.json"]].concat());
    let names = ["cut.png", "cut.svg", "map.csv", "map.parquet", "map.run.json", "summary.json"];
    assert_eq!(written(&["map", &scene, "--cut"], &outs[1]), names);
    let records = folder.join("records");
    fs::create_dir_all(&records).unwrap();
    for (number, peak) in [0.1, 0.2, 0.25, -0.3, 0.35, 0.4, -0.5, 0.7].into_iter().enumerate() {
        let sample = |step: u32| if (100..150).contains(&step) { peak } else { 0.0 };
        let lines: String = (0..400).map(|step| format!("{:?},{:?}\n", f64::from(step) * 0.01, sample(step))).collect();
        fs::write(records.join(format!("{number}.csv")), format!("# time_s,acc_g\n{lines}")).unwrap();
    }
    let study = super::scene("cloud");
    let names = written(&["cloud", &study, "--records", records.to_str().unwrap()], &outs[2]);
    for name in ["runs", "demand", "fragility", "ranking"] {
        assert!([".csv", ".parquet"].iter().all(|ending| names.contains(&format!("{name}{ending}"))), "{names:?}");
    }
    assert!(names.contains(&"demand.png".to_owned()) && names.contains(&"fragility.svg".to_owned()), "{names:?}");
    outs
}

/// The fields of a Parquet file as CSV would have them, titles first.
fn fields(reader: &SerializedFileReader<fs::File>) -> Vec<Vec<String>> {
    let text = |field: &Field| match field {
        Field::Null => String::new(),
        // The shortest that reads back: equal texts are equal bits.
        Field::Double(number) => format!("{number:?}"),
        Field::ULong(count) => count.to_string(),
        Field::Str(text) => text.clone(),
        other => panic!("{other:?}"),
    };
    let titles = reader.metadata().file_metadata().schema_descr().columns().iter().map(|column| column.name().to_owned());
    let rows = reader.get_row_iter(None).unwrap();
    let rows = rows.map(|row| row.unwrap().get_column_iter().map(|(_, field)| text(field)).collect());
    std::iter::once(titles.collect()).chain(rows).collect()
}

/// Parquet files of `folder`.
pub fn parquet_files(folder: &Path) -> Vec<PathBuf> {
    let paths = fs::read_dir(folder).unwrap().map(|file| file.unwrap().path());
    paths.filter(|path| path.extension().is_some_and(|ending| ending == "parquet")).collect()
}

#[test]
fn parquet_holds_what_csv_holds_and_what_made_it() {
    let folder = tempfile::tempdir().unwrap();
    let outs = studies(folder.path());
    for (out, (command, keys)) in outs.iter().zip([
        ("map", &["command", "scene", "version"][..]),
        ("map", &["command", "scene", "version"]),
        ("cloud", &["command", "seed", "structures", "study", "version"]),
    ]) {
        let summary = summary(out);
        for path in parquet_files(out) {
            let reader = SerializedFileReader::new(fs::File::open(&path).unwrap()).unwrap();
            let csv = csv::ReaderBuilder::new().has_headers(false).from_path(path.with_extension("csv")).unwrap();
            let csv: Vec<Vec<String>> = csv.into_records().map(|row| row.unwrap().iter().map(str::to_owned).collect()).collect();
            assert!(csv.len() > 1 && fields(&reader) == csv, "{}", path.display());
            let metadata = reader.metadata().file_metadata().key_value_metadata().unwrap();
            let names: Vec<&str> = metadata.iter().map(|pair| pair.key.as_str()).collect();
            assert_eq!(names, keys);
            assert_eq!(metadata[0].value.as_deref(), Some(command));
            for pair in metadata.iter().filter(|pair| ["scene", "structures", "study"].contains(&pair.key.as_str())) {
                let value: serde_json::Value = serde_json::from_str(pair.value.as_deref().unwrap()).unwrap();
                assert_eq!(value, summary[&pair.key]);
            }
        }
    }
}

#[test]
fn files_do_not_depend_on_the_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene("figure08");
    let line = ["map", &scene, "--set", "map.x.cells=90", "--set", "map.y.cells=20"];
    on_any_threads(folder.path(), &line, silent, &["map.csv", "map.parquet", "map.svg", "map.png", "rotation.png"]);
}

#[test]
fn formats_are_those_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene("figure08");
    let map = |formats| ["map", &scene, "--set", "map.x.cells=5", "--set", "map.y.cells=4", "--formats", formats];
    assert_eq!(written(&map("csv"), &folder.path().join("csv")), ["map.csv", "map.run.json", "summary.json"]);
    let names = ["acceleration.png", "map.csv", "map.png", "map.run.json", "rotation.png", "summary.json"];
    assert_eq!(written(&map("png,csv"), &folder.path().join("png")), names);
    for (formats, words) in [("svg,png", "csv cannot be left out"), ("csv,pdf", "`pdf` is not a format")] {
        let output = sprag(&map(formats));
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && message.contains(words), "{message}");
    }
}

#[test]
fn what_the_font_of_pictures_lacks_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene("near_fault");
    let out = folder.path().to_str().unwrap();
    let output = sprag(&["simulate", &scene, "--png", "--set", "title=\u{5730}\u{9707}", "--out", out]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && message.contains("history.png: the font has no `\u{5730}`, `\u{9707}`"), "{message}");
}
