//! The CSV files of `sprag batch`: cases in, results out.

use std::io::{Read, Write};

use serde::Deserialize;
use sprag_shared::structure::REST_SPEED;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::DeviceKind;

use super::case::{Case, CaseResult, PulseShape};
use crate::accuracy::ErrorEstimate;

/// The header of a case file.
pub const CASE_COLUMNS: &str =
    "id,geometry,slenderness_deg,device,mass_ratio,restitution,pulse,frequency_ratio,amplitude_ratio,free_time";

/// The header of a result file.
pub const RESULT_COLUMNS: &str = "id,outcome,peak_rotation,peak_acceleration,impacts,first_impact_time,end_time";

/// What follows [`RESULT_COLUMNS`] where errors are asked for: whether the outcome is beyond doubt, and absolute errors.
pub const ERROR_COLUMNS: &str = "outcome_certain,peak_rotation_error,peak_acceleration_error,first_impact_time_error";

/// A row that cannot be a case, or a file that cannot be a table of them.
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    /// A column is missing from the header.
    #[error("column `{column}` is missing; the header must be {CASE_COLUMNS}")]
    MissingColumn {
        /// Name of the column.
        column: &'static str,
    },
    /// A column nobody knows.
    #[error("unknown column `{}`; the header must be {CASE_COLUMNS}", shown(.column))]
    UnknownColumn {
        /// Name of the column.
        column: String,
    },
    /// A value that is not of the column's kind or not in its range.
    #[error("line {line}: {column} is `{}`, but must be {range}", shown(.value))]
    Value {
        /// Line in the file, from 1.
        line: u64,
        /// Column.
        column: &'static str,
        /// Value as written.
        value: String,
        /// What it may be.
        range: &'static str,
    },
    /// Not a CSV file.
    #[error("line {line}: {message}")]
    Malformed {
        /// Line in the file, from 1.
        line: u64,
        /// What is wrong.
        message: String,
    },
    /// No row.
    #[error("the file has no cases")]
    Empty,
}

/// Characters of a value that a message shows.
const LONGEST_SHOWN: usize = 60;

/// A field as a message of one line shows it: a quoted one may hold any characters, line ends among them.
pub fn shown(field: &str) -> String {
    let mut shown: String = field.chars().take(LONGEST_SHOWN).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if field.chars().nth(LONGEST_SHOWN).is_some() {
        shown.push('…');
    }
    shown
}

#[derive(Deserialize)]
struct Row<'a> {
    id: &'a str,
    geometry: &'a str,
    slenderness_deg: &'a str,
    device: &'a str,
    mass_ratio: &'a str,
    restitution: &'a str,
    pulse: &'a str,
    frequency_ratio: &'a str,
    amplitude_ratio: &'a str,
    free_time: &'a str,
}

fn number(
    line: u64,
    column: &'static str,
    value: &str,
    allowed: impl Fn(f64) -> bool,
    range: &'static str,
) -> Result<f64, TableError> {
    match value.trim().parse::<f64>() {
        Ok(number) if number.is_finite() && allowed(number) => Ok(number),
        _ => Err(TableError::Value { line, column, value: value.to_owned(), range }),
    }
}

fn choice<T: Copy>(
    line: u64,
    column: &'static str,
    value: &str,
    names: &[(&str, T)],
    range: &'static str,
) -> Result<T, TableError> {
    names.iter().find(|(name, _)| *name == value.trim()).map(|(_, choice)| *choice).ok_or_else(|| TableError::Value {
        line,
        column,
        value: value.to_owned(),
        range,
    })
}

/// Reads cases with their ids, in order. Columns may stand in any order.
///
/// # Errors
/// [`TableError`] names the line, the column, the value and what it may be.
pub fn read_cases(source: impl Read) -> Result<Vec<(String, Case)>, TableError> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(source);
    let malformed = |error: csv::Error| TableError::Malformed {
        line: error.position().map_or(1, csv::Position::line),
        message: match error.kind() {
            csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
                format!("{len} fields, but the header has {expected_len}")
            }
            csv::ErrorKind::Utf8 { .. } => "not UTF-8 text".to_owned(),
            _ => error.to_string(),
        },
    };
    let header = reader.headers().map_err(malformed)?.clone();
    for column in CASE_COLUMNS.split(',') {
        if !header.iter().any(|name| name == column) {
            return Err(TableError::MissingColumn { column });
        }
    }
    if let Some(column) = header.iter().find(|name| !CASE_COLUMNS.split(',').any(|known| known == *name)) {
        return Err(TableError::UnknownColumn { column: column.to_owned() });
    }
    let mut cases = Vec::new();
    let mut record = csv::StringRecord::new();
    while reader.read_record(&mut record).map_err(malformed)? {
        let line = record.position().map_or(0, csv::Position::line);
        let row: Row<'_> = record.deserialize(Some(&header)).map_err(malformed)?;
        cases.push((row.id.to_owned(), row.case(line)?));
    }
    if cases.is_empty() { Err(TableError::Empty) } else { Ok(cases) }
}

impl Row<'_> {
    fn case(&self, line: u64) -> Result<Case, TableError> {
        let device = [("none", DeviceKind::None), ("inerter", DeviceKind::Inerter), ("clutched-pair", DeviceKind::ClutchedPair)];
        Ok(Case {
            geometry: choice(
                line,
                "geometry",
                self.geometry,
                &[("full", Geometry::Full), ("slender", Geometry::Slender)],
                "full or slender",
            )?,
            slenderness: number(
                line,
                "slenderness_deg",
                self.slenderness_deg,
                |a| a > 0.0 && a < 90.0,
                "above 0 and below 90 degrees",
            )?
            .to_radians(),
            device: choice(line, "device", self.device, &device, "none, inerter or clutched-pair")?,
            mass_ratio: number(line, "mass_ratio", self.mass_ratio, |s| (0.0..=1e4).contains(&s), "from 0 to 10000")?,
            restitution: number(line, "restitution", self.restitution, |e| (0.0..=1.0).contains(&e), "from 0 to 1")?,
            pulse: choice(
                line,
                "pulse",
                self.pulse,
                &[("sine", PulseShape::Sine), ("cosine", PulseShape::Cosine)],
                "sine or cosine",
            )?,
            frequency_ratio: number(
                line,
                "frequency_ratio",
                self.frequency_ratio,
                |w| (1e-3..=1e4).contains(&w),
                "from 0.001 to 10000",
            )?,
            amplitude_ratio: number(line, "amplitude_ratio", self.amplitude_ratio, |a| a.abs() <= 1e6, "from -1e6 to 1e6")?,
            free_time: number(line, "free_time", self.free_time, |t| (0.0..=1e6).contains(&t), "from 0 to 1e6")?,
            rest_speed: REST_SPEED,
        })
    }
}

/// Writes one result as a row of [`RESULT_COLUMNS`], with its error as in [`ERROR_COLUMNS`] if there is one. Numbers read back to the
/// same f64; the peaks of an overturned block and the impact of one that had none are empty, and so are their errors.
///
/// # Errors
/// The errors of `out`.
pub fn write_result(out: &mut impl Write, id: &str, result: &CaseResult, error: Option<&ErrorEstimate>) -> std::io::Result<()> {
    let mut row = csv::Writer::from_writer(Vec::new());
    let number = |value: f64| format!("{value:?}");
    let peak = |value: f64| if result.outcome.overturned() { String::new() } else { number(value) };
    let impact = |value: f64| result.first_impact_time.map_or_else(String::new, |_| number(value));
    let mut fields = vec![
        id.to_owned(),
        result.outcome.name().to_owned(),
        peak(result.peak_rotation),
        peak(result.peak_acceleration),
        result.impacts.to_string(),
        result.first_impact_time.map_or_else(String::new, number),
        number(result.end_time),
    ];
    if let Some(error) = error {
        fields.extend([
            error.outcome_certain.to_string(),
            peak(error.peak_rotation),
            peak(error.peak_acceleration),
            impact(error.first_impact_time),
        ]);
    }
    row.write_record(fields).map_err(std::io::Error::other)?;
    out.write_all(&row.into_inner().map_err(|error| error.into_error())?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whatever_a_field_holds_a_message_is_one_line() {
        let row = "1,full,20,none,0.5,0.85,sine,2,2";
        let long = "x".repeat(100_000);
        for (column, value, expected) in [
            ("free_time", "\"a\r\nb\u{85}\u{2028}c\"", "`a  b"),
            ("free_time", &long, "x…`"),
            ("\"free\ntime\"", "20", "missing"),
            ("free_time,\"new\nline\"", "20,1", "`new line`"),
        ] {
            let header = CASE_COLUMNS.replace("free_time", column);
            let error = read_cases(format!("{header}\n{row},{value}\n").as_bytes()).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
            assert!(error.lines().count() == 1 && !error.contains('\r') && error.len() < 400, "{error}");
        }
    }
}
