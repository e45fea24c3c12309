//! `sprag record`: reads, checks and describes ground motion records.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use sprag_report::output::Versioned;
use sprag_report::progress::Progress;
use sprag_report::text_table::{TextTable, number};
use sprag_shared::math;
use sprag_sim::keys::bounds::Bounds;
use sprag_sim::record::intensity::uniform_duration_s;
use sprag_sim::record::{Intensity, Record, RecordSummary, STANDARD_GRAVITY_M_S2};

use super::context::{Completion, Context, Run};
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
    #[arg(long, value_name = "A", value_parser = super::number(Bounds { low: Some((0.0, false)), high: Some((90.0, false)) }))]
    pub slenderness_deg: Option<f64>,
    #[command(flatten)]
    pub reading: ReadArguments,
}

/// One file's entry in the JSON output.
#[derive(Serialize)]
#[serde(untagged)]
enum Entry {
    Description(Description),
    Failure { file: String, error: String },
}

impl Entry {
    fn description(&self) -> Option<&Description> {
        if let Entry::Description(description) = self { Some(description) } else { None }
    }
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

impl Run for RecordArguments {
    /// In JSON the reason why a file cannot be read is in its object.
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        let options = self.reading.options();
        let progress = Progress::new("files");
        progress.begin(self.files.len() as u64);
        let read = |file: &PathBuf| match Record::read(file, &options) {
            Ok(record) => Entry::Description(Description::of(&record, self.slenderness_deg)),
            Err(error) => Entry::Failure { file: file.to_string_lossy().into_owned(), error: error.to_string() },
        };
        let entries: Vec<Entry> = self.files.iter().map(read).inspect(|_| progress.step()).collect();
        progress.finish();
        let described: Vec<&Description> = entries.iter().filter_map(Entry::description).collect();
        if self.json {
            context.print_json(&entries.iter().map(Versioned::new).collect::<Vec<_>>());
        } else {
            if !described.is_empty() {
                context.print(table(&described).for_terminal());
            }
            for description in &described {
                for warning in &description.read.warnings {
                    context.note(format_args!("warning: {}: {warning}", description.read.file));
                }
            }
            for entry in &entries {
                if let Entry::Failure { error, .. } = entry {
                    context.note(error);
                }
            }
        }
        Ok(match described.len() {
            0 => Completion::Refused,
            count => Completion::of(count == entries.len()),
        })
    }
}

fn table(described: &[&Description]) -> TextTable {
    let mut headings = vec!["file", "dt (s)", "samples", "PGA (g)", "PGV (m/s)", "PGD (m)", "Arias (m/s)", "D5-95 (s)"];
    headings.extend(described.iter().any(|description| description.t_uni_s.is_some()).then_some("t_uni (s)"));
    let mut table = TextTable::new(1, headings);
    for description in described {
        let mut row = vec![
            description.read.file.clone(),
            description.read.dt_s.to_string(),
            description.read.samples.to_string(),
            number(description.read.pga_m_s2 / STANDARD_GRAVITY_M_S2, 4),
            number(description.pgv_m_s, 3),
            number(description.pgd_m, 3),
            number(description.arias_m_s, 3),
            number(description.d5_95_s, 2),
        ];
        row.extend(description.t_uni_s.map(|seconds| number(seconds, 3)));
        table.row(row);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run_line(line: &[&str]) -> (i32, String, String) {
        crate::line::run(&[&["record"], line].concat())
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
        assert_eq!((status, err.as_str()), (1, ""));
        let entries: serde_json::Value = serde_json::from_str(&out).unwrap();
        assert_eq!(entries[0]["error"], format!("{bad}: line 3: `oops` where a number is due"));
        assert_eq!(entries[0]["file"], bad);
        let number = |key: &str| entries[1][key].as_f64().unwrap_or_else(|| panic!("{key}"));
        assert_eq!((number("dt_s"), number("samples"), number("pga_m_s2")), (0.5, 4.0, 4.0));
        // |a| > u during 1.5 (1 − u/4) s, with u = g tan 10°.
        assert!((number("t_uni_s") - 1.5 * (1.0 - 9.80665 * 0.176_326_980_708 / 4.0)).abs() < 1e-9);
        assert!((number("arias_m_s") - std::f64::consts::PI / (2.0 * 9.80665) * 16.0).abs() < 1e-9);
        assert!(entries.as_array().unwrap().iter().all(|entry| entry["schema_version"] == 1), "{out}");
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
        assert_eq!((status, rows.len(), errors.len()), (1, 3, 1));
        assert!(rows.iter().all(|row| row.chars().count() == rows[0].chars().count()), "{out}");
        assert!(errors[0].starts_with(&format!("sprag: {bad}: line 3")), "{err}");
        // Nothing is left to describe.
        assert_eq!(run_line(&[&bad]).0, 2);
    }

    #[test]
    fn arguments_out_of_range_are_refused() {
        for line in [["--slenderness-deg", "90"], ["--dt", "0"], ["--units", "furlong"], ["--dt", "NaN"]] {
            let words = ["sprag", "record", "file"].into_iter().chain(line).map(Into::into).collect::<Vec<_>>();
            assert!(crate::line::read(&words).is_err(), "{line:?}");
        }
    }
}
