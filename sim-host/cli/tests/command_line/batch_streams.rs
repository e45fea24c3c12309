//! A batch is a stream: windows, files of either kind, standard input and output, and what becomes of a bad row, a closed pipe and an old result.

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, Output, Stdio};

use sprag_report::columns::{Column, CsvWriter, parquet_of_csv, read_parquet};

use super::{CASE_TITLES, command, refused, said, sprag, well};

/// More cases than one thread has in memory at one time, and fewer than three have.
const MANY: usize = 10_000;

/// A row of a case file; most blocks do not move, and some overturn.
fn row(index: usize) -> String {
    let amplitude = if index.is_multiple_of(50) { 3.0 } else { 0.75 };
    format!("{index},slender,15.5,none,0,0.85,sine,{},{amplitude},{}\n", 1.0 + index as f64 * 1e-3, index % 4)
}

fn table(rows: std::ops::Range<usize>) -> String {
    rows.fold(CASE_TITLES.to_owned(), |text, index| text + &row(index))
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn batch(cases: &Path, out: &Path, more: &[&str]) -> Output {
    sprag(&[&["batch", text(cases), "--out", text(out)], more].concat())
}

/// The results of `cases`.
fn results(cases: &Path, more: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("results.csv");
    well(batch(cases, &out, more));
    fs::read_to_string(out).unwrap()
}

/// The command with both ends of its pipes.
fn piped(arguments: &[&str], folder: &Path) -> Child {
    let mut command = command(arguments);
    command.current_dir(folder).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// The columns of cases.
fn columns(column: impl Fn(&'static str) -> Column) -> Vec<Column> {
    CASE_TITLES.trim_end().split(',').map(column).collect()
}

/// `csv` as Parquet.
fn parquet(csv: &str, columns: &[Column], path: &Path) {
    parquet_of_csv(csv.as_bytes(), columns, &[], File::create(path).unwrap()).unwrap();
}

/// Numbers as numbers, and the id as a whole one.
fn typed() -> Vec<Column> {
    columns(|title| match title {
        "id" => Column::count(title),
        "geometry" | "device" | "pulse" => Column::text(title),
        title => Column::number(title).or_nothing(),
    })
}

#[test]
fn windows_give_the_bytes_of_one_window() {
    let folder = tempfile::tempdir().unwrap();
    let cases = folder.path().join("cases.csv");
    fs::write(&cases, table(0..MANY)).unwrap();
    let one = results(&cases, &["--threads", "3"]);
    assert_eq!(one.lines().count(), MANY + 1);
    assert!(one.contains(",overturned-") && one.contains(",no-rocking,"));
    for threads in ["1", "2"] {
        assert!(results(&cases, &["--threads", threads]) == one, "{threads}");
    }
    // A window that is just full, and the end of the file after it.
    let full = 4096;
    fs::write(&cases, table(0..full)).unwrap();
    let lines: Vec<&str> = one.split_inclusive('\n').collect();
    assert!(results(&cases, &["--threads", "1"]) == lines[..=full].concat());
}

#[test]
fn parquet_is_csv_with_types() {
    let folder = tempfile::tempdir().unwrap();
    let [plain, with_types, as_texts, other_order, back] =
        ["cases.csv", "cases.parquet", "texts.Parquet", "order.parquet", "results.parquet"].map(|name| folder.path().join(name));
    let csv = table(0..MANY);
    fs::write(&plain, &csv).unwrap();
    let expected = results(&plain, &[]);
    parquet(&csv, &typed(), &with_types);
    parquet(&csv, &columns(Column::text), &as_texts);
    let turned = csv.lines().fold(String::new(), |mut text, line| {
        let fields: Vec<&str> = line.split(',').rev().collect();
        writeln!(text, "{}", fields.join(",")).unwrap();
        text
    });
    parquet(&turned, &typed().into_iter().rev().collect::<Vec<_>>(), &other_order);
    for cases in [with_types, as_texts, other_order] {
        assert!(results(&cases, &[]) == expected, "{}", cases.display());
    }
    for more in [&[] as &[&str], &["--accuracy", "fast"]] {
        well(batch(&plain, &back, &[more, &["--overwrite"]].concat()));
        let expected = results(&plain, more);
        let kind = |title: &str| match title {
            "id" | "outcome" | "outcome_certain" => Column::text(title),
            "impacts" => Column::count(title),
            title => Column::number(title).or_nothing(),
        };
        let columns: Vec<Column> = expected.lines().next().unwrap().split(',').map(kind).collect();
        let mut found = CsvWriter::new(columns.clone(), Vec::new()).unwrap();
        assert_eq!(read_parquet(File::open(&back).unwrap(), &columns, &mut found).unwrap(), MANY as u64);
        assert!(found.finish().unwrap() == expected.as_bytes(), "{more:?}");
    }
}

#[test]
fn standard_input_and_output_are_files_like_any() {
    let folder = tempfile::tempdir().unwrap();
    let cases = folder.path().join("cases.csv");
    fs::write(&cases, table(0..MANY)).unwrap();
    let expected = results(&cases, &[]);
    let through = |out: &str| {
        let mut command = command(&["batch", "-", "--out", out]);
        command.current_dir(&folder).stdin(File::open(&cases).unwrap()).output().unwrap()
    };
    let whole = through("-");
    assert!(whole.status.success() && whole.stdout == expected.as_bytes(), "{}", said(&whole));
    assert!(cfg!(not(unix)) || through("/dev/stdout").stdout == expected.as_bytes());
    let results = folder.path().join("results.csv");
    well(through("results.csv"));
    assert!(fs::read_to_string(&results).unwrap() == expected);
    // What cannot be read twice cannot be compared.
    fs::write(&results, "kept").unwrap();
    let declined = through("results.csv");
    assert_eq!(declined.status.code(), Some(2));
    assert!(said(&declined).contains("--overwrite") && said(&declined).contains("standard input"), "{}", said(&declined));
    assert_eq!(fs::read_to_string(&results).unwrap(), "kept");
    let out = tempfile::tempdir().unwrap();
    let to = out.path().join("results.csv");
    refused(&["batch", "-", "--out", text(&to), "--time-budget", "9"], out.path(), &["--time-budget", "standard input", "twice"]);
}

#[test]
fn results_come_before_the_input_has_ended() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = piped(&["batch", "-", "--out", "-", "--threads", "1"], folder.path());
    let mut input = child.stdin.take().unwrap();
    input.write_all(table(0..MANY / 2).as_bytes()).unwrap();
    let mut output = BufReader::new(child.stdout.take().unwrap());
    let mut lines = String::new();
    output.read_line(&mut lines).unwrap();
    output.read_line(&mut lines).unwrap();
    assert!(lines.lines().nth(1).is_some_and(|line| line.starts_with("0,")), "{lines}");
    // Both pipes are full before all is written.
    let more = std::thread::spawn(move || (MANY / 2..MANY).try_for_each(|index| input.write_all(row(index).as_bytes())).unwrap());
    output.read_to_string(&mut lines).unwrap();
    more.join().unwrap();
    assert!(child.wait().unwrap().success());
    assert_eq!(lines.lines().count(), MANY + 1);
}

#[test]
fn a_late_bad_row_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    fs::create_dir(&out).unwrap();
    let late = 9_000;
    let good = table(0..MANY);
    let bad = good.replace(&row(late), &row(late).replace("none", "nothing"));
    let [csv, with_types] = ["cases.csv", "cases.parquet"].map(|name| folder.path().join(name));
    fs::write(&csv, &bad).unwrap();
    parquet(&bad, &typed(), &with_types);
    for threads in ["1", "3"] {
        for result in ["results.csv", "results.parquet"].map(|name| out.join(name)) {
            let refuse = |cases: &Path, words: &[&str]| {
                refused(&["batch", text(cases), "--out", text(&result), "--threads", threads], &out, words);
            };
            refuse(&csv, &["cases.csv: line 9002: device is `nothing`, but must be none, inerter or clutched-pair"]);
            refuse(&with_types, &["cases.parquet: row 9001: device is `nothing`"]);
        }
    }
    // A stream has what came before, the same on any number of threads.
    let [one, three] = ["1", "3"].map(|threads| sprag(&["batch", text(&csv), "--out", "-", "--threads", threads]));
    assert!(one.status.code() == Some(2) && one.stdout == three.stdout && said(&one) == said(&three), "{}", said(&one));
    let whole = {
        fs::write(&csv, &good).unwrap();
        results(&csv, &[])
    };
    let lines = one.stdout.iter().filter(|byte| **byte == b'\n').count();
    assert!(whole.as_bytes().starts_with(&one.stdout) && (late - 100..=late + 1).contains(&lines), "{lines}");
    // Of the first rows nothing is there to be written, not even titles.
    fs::write(&csv, table(0..1).replace("none", "nothing")).unwrap();
    assert_eq!(sprag(&["batch", text(&csv), "--out", "-"]).stdout, b"");
}

#[test]
fn a_closed_pipe_ends_it_quietly() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("cases.csv"), table(0..20 * MANY)).unwrap();
    let mut child = piped(&["batch", "cases.csv", "--out", "-", "--quiet"], folder.path());
    let mut first = String::new();
    BufReader::new(child.stdout.take().unwrap()).read_line(&mut first).unwrap();
    let ended = child.wait_with_output().unwrap();
    assert_eq!((ended.status.code(), said(&ended).as_str()), (Some(0), ""));
    assert!(first.starts_with("id,outcome,"), "{first}");
}

#[test]
fn parquet_results_are_replaced_by_those_of_the_same_cases() {
    let folder = tempfile::tempdir().unwrap();
    let [cases, out] = ["cases.csv", "results.parquet"].map(|name| folder.path().join(name));
    fs::write(&cases, table(0..100)).unwrap();
    well(batch(&cases, &out, &[]));
    let first = fs::read(&out).unwrap();
    well(batch(&cases, &out, &["--threads", "1"]));
    assert!(fs::read(&out).unwrap() == first, "the same bytes");
    for (other, more) in [(table(0..99), &[] as &[&str]), (table(1..101), &[]), (table(0..100), &["--accuracy", "fast"])] {
        fs::write(&cases, other).unwrap();
        let declined = batch(&cases, &out, more);
        assert_eq!(declined.status.code(), Some(2));
        assert!(said(&declined).contains("--overwrite"), "{}", said(&declined));
        assert!(fs::read(&out).unwrap() == first);
    }
    // A bad row is what is wrong, and not the file that is there.
    fs::write(&cases, table(0..100).replacen("none", "nothing", 1)).unwrap();
    assert!(said(&batch(&cases, &out, &[])).contains("line 2: device"));
}

/// What `child` leaves that is told to end; its input stays open until it has.
#[cfg(unix)]
fn terminated(mut child: Child) -> Output {
    super::terminal::signal("-TERM", child.id());
    let input = child.stdin.take();
    let ended = child.wait_with_output().unwrap();
    drop(input);
    ended
}

/// Even when it waits for its input, and is ended where it is.
#[cfg(unix)]
#[test]
fn termination_leaves_nothing_beside_the_place_of_results() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = piped(&["batch", "-", "--out", "results.csv", "--threads", "1"], folder.path());
    let input = child.stdin.as_mut().unwrap();
    input.write_all(table(0..MANY).as_bytes()).unwrap();
    let files = || fs::read_dir(&folder).unwrap().count();
    while files() == 0 && child.try_wait().unwrap().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    assert_eq!(files(), 1);
    let ended = terminated(child);
    assert_eq!((ended.status.code(), files()), (Some(143), 0), "{}", said(&ended));
    assert!(said(&ended).ends_with("sprag: interrupted; nothing was written\n"), "{}", said(&ended));
}

/// What has gone through standard output is written, whatever becomes of the rest.
#[cfg(unix)]
#[test]
fn an_interrupted_stream_says_that_rows_may_have_been_written() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = piped(&["batch", "-", "--out", "-", "--threads", "1"], folder.path());
    let input = child.stdin.as_mut().unwrap();
    // More than is worked out at one time, and not so much more that it waits for results to be read.
    input.write_all(table(0..MANY / 2).as_bytes()).unwrap();
    let mut first = String::new();
    BufReader::new(child.stdout.as_mut().unwrap()).read_line(&mut first).unwrap();
    assert!(first.starts_with("id,outcome,"), "{first}");
    let ended = terminated(child);
    assert_eq!(ended.status.code(), Some(143), "{}", said(&ended));
    assert!(said(&ended).ends_with("sprag: interrupted; some rows may have been written\n"), "{}", said(&ended));
}
