//! What summaries of results say of the records behind them.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Display;

use serde::Serialize;

use super::{Record, intensity};

/// Most warnings that are printed one by one.
const MOST_LINES: usize = 8;

/// A record that was read: its entry in the `records` of every `summary.json`, and of `sprag record --json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RecordSummary {
    /// The file, as the user wrote it.
    pub file: String,
    /// Layout of the file.
    pub format: &'static str,
    /// Component taken, if the file has names for several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub component: Option<String>,
    /// Units of the samples in the file.
    pub units: String,
    /// Time step, s.
    pub dt_s: f64,
    /// Number of samples.
    pub samples: usize,
    /// max |a|, before any factor, m/s².
    pub pga_m_s2: f64,
    /// What a person should look at, a line each.
    pub warnings: Vec<String>,
}

impl RecordSummary {
    /// Of `record`, which the user calls `file`.
    pub fn of(record: &Record, file: impl Display) -> RecordSummary {
        RecordSummary {
            file: file.to_string(),
            format: record.format.name(),
            component: record.component.clone(),
            units: record.units.to_string(),
            dt_s: record.time_step_s,
            samples: record.acceleration_m_s2.len(),
            pga_m_s2: intensity::peak(&record.acceleration_m_s2),
            warnings: record.warnings.iter().map(ToString::to_string).collect(),
        }
    }
}

/// Every warning of `records`, `FILE: …`, each once.
pub fn every_warning(records: &[RecordSummary]) -> Vec<String> {
    let mut seen = BTreeSet::new();
    let of = |record: &RecordSummary| -> Vec<String> {
        record.warnings.iter().map(|warning| format!("{}: {warning}", record.file)).collect()
    };
    records.iter().flat_map(of).filter(|line| seen.insert(line.clone())).collect()
}

/// The warnings of `records` as lines for a screen, `FILE: …`: all of a few, else those of the rarest kinds and how many more
/// there are.
pub fn warning_lines(records: &[RecordSummary]) -> Vec<String> {
    let mut all: Vec<(&str, &str)> = Vec::new();
    for record in records {
        all.extend(record.warnings.iter().map(|warning| (record.file.as_str(), warning.as_str())));
    }
    let total = all.len();
    if total > MOST_LINES {
        // What is said of nearly every record must not hide what is said of one.
        let mut kinds = BTreeMap::<String, usize>::new();
        all.iter().for_each(|(_, warning)| *kinds.entry(kind(warning)).or_default() += 1);
        all.sort_by_key(|(_, warning)| kinds[&kind(warning)]);
    }
    let shown = if total > MOST_LINES { MOST_LINES - 1 } else { total };
    let mut lines: Vec<String> = all.iter().take(shown).map(|(file, warning)| format!("{file}: {warning}")).collect();
    if total > shown {
        let files = records.iter().filter(|record| !record.warnings.is_empty()).count();
        lines.push(format!("{} more warnings; summary.json has all {total} of {files} records", total - shown));
    }
    lines
}

/// Its first word: warnings of one kind begin alike.
fn kind(warning: &str) -> String {
    warning.split(|c: char| !c.is_alphabetic()).find(|word| !word.is_empty()).unwrap_or_default().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::ReadOptions;

    #[test]
    fn a_few_warnings_are_printed_and_many_are_counted() {
        let record = Record::parse("a.csv", b"time_s,acc_g\n0,0\n0.01,50\n0.02,0\n", &ReadOptions::default()).unwrap();
        let summary = RecordSummary::of(&record, "a.csv");
        assert!(summary.warnings.iter().any(|warning| warning.contains("check the units")), "{summary:?}");
        let each = summary.warnings.len();
        let lines = warning_lines(std::slice::from_ref(&summary));
        assert!(lines.len() == each && lines.iter().all(|line| line.starts_with("a.csv: ")), "{lines:?}");
        let mut odd = summary.clone();
        (odd.file, odd.warnings) = ("odd.csv".to_owned(), vec!["clipped: 7 samples".to_owned()]);
        let mixed = warning_lines(&[vec![summary.clone(); 50], vec![odd], vec![summary.clone(); 50]].concat());
        assert_eq!((mixed.len(), mixed[0].as_str()), (MOST_LINES, "odd.csv: clipped: 7 samples"));
        assert_eq!(every_warning(&vec![summary.clone(); 200]), lines);
        let many = warning_lines(&vec![summary; 200]);
        let last = format!("{} more warnings; summary.json has all {} of 200 records", 200 * each - MOST_LINES + 1, 200 * each);
        assert_eq!((many.len(), many.last()), (MOST_LINES, Some(&last)));
        assert!(warning_lines(&[]).is_empty());
    }
}
