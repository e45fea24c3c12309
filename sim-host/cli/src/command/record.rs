//! `sprag record`: reads, checks and describes ground motion records.

use std::io::{self, Write};
use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use sprag_report::progress::Progress;
use sprag_shared::math;
use sprag_sim::record::intensity::uniform_duration_s;
use sprag_sim::record::{Intensity, Record, RecordSummary, STANDARD_GRAVITY_M_S2};

use super::BAD_INPUT;
use super::record_arguments::ReadArguments;

/// Read, check and describe ground motion records.
#[derive(Args, Clone, Debug)]
#[command(
    after_help = "Examples:\n  sprag record near_fault.csv\n  sprag record --json --slenderness-deg 10 RSN181_IMPVALL.H_H-E06230.AT2\n  \
    sprag record --units cm/s2 --dt 0.01 la03.dat\n\n\
    Read are PEER AT2, USGS SMC, SimCenter JSON, CSV and plain text. A file's own units and time step go before --units and --dt."
)]
pub struct RecordArguments {
    /// Record files; FILE#NAME takes one component of a file with several.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Print a JSON array, one object per file, instead of a table.
    #[arg(long)]
    pub json: bool,
    /// Slenderness in degrees, above 0 and below 90, for the uniform duration: the time during which the ground
    /// acceleration exceeds g tan(slenderness).
    #[arg(long, value_name = "A", value_parser = slenderness)]
    pub slenderness_deg: Option<f64>,
    /// What the files do not say.
    #[command(flatten)]
    pub reading: ReadArguments,
}

fn slenderness(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().map_err(|_| "a number is due".to_owned())?;
    if value > 0.0 && value < 90.0 { Ok(value) } else { Err("above 0 and below 90 degrees are allowed".to_owned()) }
}

/// One file's entry in the JSON output.
#[derive(Serialize)]
#[serde(untagged)]
enum Entry {
    Description(Description),
    Failure { file: String, error: String },
}

/// A record in numbers; the fields are those of the JSON output.
#[derive(Serialize)]
struct Description {
    #[serde(flatten)]
    read: RecordSummary,
    pgv_m_s: f64,
    pgd_m: f64,
    arias_m_s: f64,
    d5_95_s: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    t_uni_s: Option<f64>,
}

impl Description {
    fn of(record: &Record, slenderness_deg: Option<f64>) -> Description {
        let intensity = Intensity::of(record);
        let threshold = |degrees: f64| STANDARD_GRAVITY_M_S2 * math::tan(degrees.to_radians());
        Description {
            read: RecordSummary::of(record, &record.name),
            pgv_m_s: intensity.pgv_m_s,
            pgd_m: intensity.pgd_m,
            arias_m_s: intensity.arias_m_s,
            d5_95_s: intensity.d5_95_s,
            t_uni_s: slenderness_deg
                .map(|degrees| uniform_duration_s(&record.acceleration_m_s2, record.time_step_s, threshold(degrees))),
        }
    }
}

/// Runs the command and returns its exit status: 0, or 2 if a file could not be read. In text output the reasons go
/// to `err`, in JSON output into the file's object.
pub fn run(arguments: &RecordArguments, out: &mut impl Write, err: &mut impl Write) -> i32 {
    let options = arguments.reading.options();
    let progress = Progress::new("files");
    progress.begin(arguments.files.len() as u64);
    let entries: Vec<Entry> = arguments
        .files
        .iter()
        .map(|file| match Record::read(file, &options) {
            Ok(record) => Entry::Description(Description::of(&record, arguments.slenderness_deg)),
            Err(error) => Entry::Failure { file: file.to_string_lossy().into_owned(), error: error.to_string() },
        })
        .inspect(|_| progress.step())
        .collect();
    progress.finish();
    // What keeps it from being written is reported where standard output is.
    let _ = if arguments.json { write_json(&entries, out) } else { write_text(&entries, out, err) };
    if entries.iter().any(|entry| matches!(entry, Entry::Failure { .. })) { BAD_INPUT } else { 0 }
}

fn write_json(entries: &[Entry], out: &mut impl Write) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, entries)?;
    writeln!(out)
}

fn write_text(entries: &[Entry], out: &mut impl Write, err: &mut impl Write) -> io::Result<()> {
    let described: Vec<&Description> = entries
        .iter()
        .filter_map(|entry| if let Entry::Description(description) = entry { Some(description) } else { None })
        .collect();
    let with_duration = described.iter().any(|description| description.t_uni_s.is_some());
    let mut titles = vec!["file", "dt (s)", "samples", "PGA (g)", "PGV (m/s)", "PGD (m)", "Arias (m/s)", "D5-95 (s)"];
    titles.extend(with_duration.then_some("t_uni (s)"));
    let mut table = vec![titles.into_iter().map(str::to_owned).collect::<Vec<String>>()];
    for description in &described {
        let mut row = vec![
            description.read.file.clone(),
            description.read.dt_s.to_string(),
            description.read.samples.to_string(),
            format!("{:.4}", description.read.pga_m_s2 / STANDARD_GRAVITY_M_S2),
            format!("{:.3}", description.pgv_m_s),
            format!("{:.3}", description.pgd_m),
            format!("{:.3}", description.arias_m_s),
            format!("{:.2}", description.d5_95_s),
        ];
        row.extend(description.t_uni_s.map(|seconds| format!("{seconds:.3}")));
        table.push(row);
    }
    let mut written = Ok(());
    if !described.is_empty() {
        let columns = table[0].len();
        let widths: Vec<usize> =
            (0..columns).map(|column| table.iter().map(|row| row[column].chars().count()).max().unwrap_or(0)).collect();
        written = table.iter().try_for_each(|row| {
            let (name, numbers) = row.split_at(1);
            let numbers: String = numbers.iter().zip(&widths[1..]).map(|(cell, width)| format!("  {cell:>width$}")).collect();
            writeln!(out, "{:<width$}{numbers}", name[0], width = widths[0])
        });
    }
    for description in &described {
        for warning in &description.read.warnings {
            let _ = writeln!(err, "sprag: warning: {}: {warning}", description.read.file);
        }
    }
    for entry in entries {
        if let Entry::Failure { error, .. } = entry {
            let _ = writeln!(err, "sprag: {error}");
        }
    }
    written
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        arguments: RecordArguments,
    }

    fn run_line(line: &[&str]) -> (i32, String, String) {
        let parsed = Line::try_parse_from([&["record"], line].concat()).unwrap_or_else(|error| panic!("{error}"));
        let (mut out, mut err) = (Vec::new(), Vec::new());
        let status = run(&parsed.arguments, &mut out, &mut err);
        (status, String::from_utf8(out).unwrap(), String::from_utf8(err).unwrap())
    }

    fn folder() -> (tempfile::TempDir, String, String) {
        let folder = tempfile::tempdir().unwrap();
        let (good, bad) = (folder.path().join("good.csv"), folder.path().join("bad.csv"));
        std::fs::write(&good, "# time_s,acc_m_s2\n0.0,0\n0.5,4\n1.0,-4\n1.5,0\n").unwrap();
        std::fs::write(&bad, "# time_s,acc_m_s2\n0.0,0\n0.5,oops\n").unwrap();
        let name = |path: PathBuf| path.to_str().unwrap().to_owned();
        (folder, name(good), name(bad))
    }

    #[test]
    fn json_has_the_contract_fields_and_an_error_beside_good_files() {
        let (_folder, good, bad) = folder();
        let (status, out, err) = run_line(&["--json", "--slenderness-deg", "10", &bad, &good]);
        assert_eq!((status, err.as_str()), (2, ""));
        let entries: serde_json::Value = serde_json::from_str(&out).unwrap();
        assert_eq!(entries[0]["error"], format!("{bad}: line 3: `oops` where a number is due"));
        assert_eq!(entries[0]["file"], bad);
        let number = |key: &str| entries[1][key].as_f64().unwrap_or_else(|| panic!("{key}"));
        assert_eq!((number("dt_s"), number("samples"), number("pga_m_s2")), (0.5, 4.0, 4.0));
        // |a| > u during 1.5 (1 − u/4) s, with u = g tan 10°.
        assert!((number("t_uni_s") - 1.5 * (1.0 - 9.80665 * 0.176_326_980_708 / 4.0)).abs() < 1e-9);
        assert!((number("arias_m_s") - std::f64::consts::PI / (2.0 * 9.80665) * 16.0).abs() < 1e-9);
        for key in ["pgv_m_s", "pgd_m", "d5_95_s"] {
            assert!(number(key) > 0.0, "{key}");
        }
        assert!(entries[1]["warnings"].is_array() && entries[1].get("error").is_none());
        let (status, out, _) = run_line(&["--json", &good]);
        assert!(status == 0 && !out.contains("t_uni_s"));
    }

    #[test]
    fn text_is_aligned_and_errors_go_to_the_error_stream() {
        let (_folder, good, bad) = folder();
        let (status, out, err) = run_line(&[&good, &bad, &good]);
        let rows: Vec<&str> = out.lines().collect();
        let errors: Vec<&str> = err.lines().filter(|line| !line.starts_with("sprag: warning: ")).collect();
        assert_eq!((status, rows.len(), errors.len()), (2, 3, 1));
        assert!(rows.iter().all(|row| row.chars().count() == rows[0].chars().count()), "{out}");
        assert!(errors[0].starts_with(&format!("sprag: {bad}: line 3")), "{err}");
    }

    #[test]
    fn arguments_out_of_range_are_refused() {
        for line in [["--slenderness-deg", "90"], ["--dt", "0"], ["--units", "furlong"], ["--dt", "NaN"]] {
            assert!(Line::try_parse_from([&["record", "file"][..], &line[..]].concat()).is_err(), "{line:?}");
        }
    }
}
