//! The tables of `sprag batch`: rows of texts are cases, and the columns of their results.

use std::fmt;
use std::io::Read;

use csv::StringRecord;
use sprag_shared::structure::REST_SPEED;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::DeviceKind;

use super::case::{Case, PulseShape};

/// The header of a case file.
pub const CASE_COLUMNS: &str =
    "id,geometry,slenderness_deg,device,mass_ratio,restitution,pulse,frequency_ratio,amplitude_ratio,free_time";

/// The header of a result file.
pub const RESULT_COLUMNS: &str = "id,outcome,peak_rotation,peak_acceleration,impacts,first_impact_time,end_time";

/// What follows [`RESULT_COLUMNS`] where errors are asked for: whether the outcome is beyond doubt, and absolute errors.
pub const ERROR_COLUMNS: &str = "outcome_certain,peak_rotation_error,peak_acceleration_error,first_impact_time_error";

/// Where a row stands in its file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Line of a text, from 1.
    Line(u64),
    /// Row of a table without lines, from 1.
    Row(u64),
}

impl fmt::Display for Place {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Line(line) => write!(out, "line {line}"),
            Place::Row(row) => write!(out, "row {row}"),
        }
    }
}

/// A row that cannot be a case, or a file that cannot be a table of them.
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    /// A column is missing from the header.
    #[error("column `{column}` is missing; the header must be {CASE_COLUMNS}")]
    MissingColumn {
        /// Name of the column.
        column: &'static str,
    },
    /// A column that stands there twice.
    #[error("column `{column}` is there twice; the header must be {CASE_COLUMNS}")]
    RepeatedColumn {
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
    #[error("{place}: {column} is `{}`, but must be {range}", shown(.value))]
    Value {
        /// Where its row stands.
        place: Place,
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

impl From<csv::Error> for TableError {
    fn from(error: csv::Error) -> TableError {
        TableError::Malformed {
            line: error.position().map_or(1, csv::Position::line),
            message: match error.kind() {
                csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
                    format!("{len} fields, but the header has {expected_len}")
                }
                csv::ErrorKind::Utf8 { .. } => "not UTF-8 text".to_owned(),
                _ => error.to_string(),
            },
        }
    }
}

/// Where the columns of cases stand in the rows of a file: in any order.
#[derive(Clone, Debug)]
pub struct CaseColumns([usize; 10]);

impl CaseColumns {
    /// The columns below these titles.
    ///
    /// # Errors
    /// [`TableError::MissingColumn`], [`TableError::UnknownColumn`], [`TableError::RepeatedColumn`].
    pub fn of(titles: &StringRecord) -> Result<CaseColumns, TableError> {
        let mut columns = [0; 10];
        for (at, column) in columns.iter_mut().zip(CASE_COLUMNS.split(',')) {
            let mut places = titles.iter().enumerate().filter(|(_, title)| title.trim() == column);
            *at = places.next().ok_or(TableError::MissingColumn { column })?.0;
            if places.next().is_some() {
                return Err(TableError::RepeatedColumn { column });
            }
        }
        match titles.iter().enumerate().find(|(at, _)| !columns.contains(at)) {
            Some((_, title)) => Err(TableError::UnknownColumn { column: title.trim().to_owned() }),
            None => Ok(CaseColumns(columns)),
        }
    }

    /// The id of `row`, and its case.
    ///
    /// # Errors
    /// [`TableError::Value`] names the place, the column, the value and what it may be.
    pub fn case<'a>(&self, row: &'a StringRecord, place: Place) -> Result<(&'a str, Case), TableError> {
        let [id, geometry, slenderness_deg, device, mass_ratio, restitution, pulse, frequency_ratio, amplitude_ratio, free_time] =
            self.0.map(|at| trimmed(row.get(at).unwrap_or_default()));
        let number = |column, value: &str, allowed: fn(f64) -> bool, range| match value.parse::<f64>() {
            Ok(number) if number.is_finite() && allowed(number) => Ok(number),
            _ => Err(TableError::Value { place, column, value: value.to_owned(), range }),
        };
        let geometries = [("full", Geometry::Full), ("slender", Geometry::Slender)];
        let devices = [("none", DeviceKind::None), ("inerter", DeviceKind::Inerter), ("clutched-pair", DeviceKind::ClutchedPair)];
        let pulses = [("sine", PulseShape::Sine), ("cosine", PulseShape::Cosine)];
        let case = Case {
            geometry: choice(place, "geometry", geometry, &geometries, "full or slender")?,
            slenderness: number("slenderness_deg", slenderness_deg, |a| a > 0.0 && a < 90.0, "above 0 and below 90 degrees")?
                .to_radians(),
            device: choice(place, "device", device, &devices, "none, inerter or clutched-pair")?,
            mass_ratio: number("mass_ratio", mass_ratio, |s| (0.0..=1e4).contains(&s), "from 0 to 10000")?,
            restitution: number("restitution", restitution, |e| (0.0..=1.0).contains(&e), "from 0 to 1")?,
            pulse: choice(place, "pulse", pulse, &pulses, "sine or cosine")?,
            frequency_ratio: number("frequency_ratio", frequency_ratio, |w| (1e-3..=1e4).contains(&w), "from 0.001 to 10000")?,
            amplitude_ratio: number("amplitude_ratio", amplitude_ratio, |a| a.abs() <= 1e6, "from -1e6 to 1e6")?,
            free_time: number("free_time", free_time, |t| (0.0..=1e6).contains(&t), "from 0 to 1e6")?,
            rest_speed: REST_SPEED,
        };
        Ok((id, case))
    }
}

/// `text` without spaces around it; most have none, and `trim` looks at characters.
#[inline]
fn trimmed(text: &str) -> &str {
    let plain = |byte: Option<&u8>| byte.is_none_or(u8::is_ascii_graphic);
    let bytes = text.as_bytes();
    if plain(bytes.first()) && plain(bytes.last()) { text } else { text.trim() }
}

fn choice<T: Copy>(
    place: Place,
    column: &'static str,
    value: &str,
    names: &[(&str, T)],
    range: &'static str,
) -> Result<T, TableError> {
    let found = names.iter().find(|(name, _)| *name == value).map(|(_, choice)| *choice);
    found.ok_or_else(|| TableError::Value { place, column, value: value.to_owned(), range })
}

/// Reads all cases of a CSV file with their ids, in order. Columns may stand in any order.
///
/// # Errors
/// [`TableError`] names the line, the column, the value and what it may be.
pub fn read_cases(source: impl Read) -> Result<Vec<(String, Case)>, TableError> {
    let mut reader = csv::Reader::from_reader(source);
    let columns = CaseColumns::of(reader.headers()?)?;
    let mut cases = Vec::new();
    let mut row = StringRecord::new();
    while reader.read_record(&mut row)? {
        let line = row.position().map_or(0, csv::Position::line);
        let (id, case) = columns.case(&row, Place::Line(line))?;
        cases.push((id.to_owned(), case));
    }
    if cases.is_empty() { Err(TableError::Empty) } else { Ok(cases) }
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
