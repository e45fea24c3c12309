//! What a row of a file says.

use std::str::FromStr;

use csv::StringRecord;
use sprag_shared::observers::outcome::Outcome;
use sprag_sim::accuracy::ErrorEstimate;

/// Outcome of a run that failed.
pub const FAILED: &str = "failed";

/// The fields of a row, one after another.
#[derive(Debug)]
pub struct RowFields<'a> {
    names: &'a [String],
    record: &'a StringRecord,
    next: usize,
}

impl<'a> RowFields<'a> {
    /// Those of `record`, below columns of these names.
    pub fn new(names: &'a [String], record: &'a StringRecord) -> RowFields<'a> {
        RowFields { names, record, next: 0 }
    }

    /// The next as it stands; empty beyond the last.
    pub fn text(&mut self) -> &'a str {
        self.next += 1;
        self.record.get(self.next - 1).unwrap_or_default()
    }

    /// Passes over the next `count`.
    pub fn skip(&mut self, count: usize) {
        self.next += count;
    }

    /// The next, which must be `expected`.
    ///
    /// # Errors
    /// What both are.
    pub fn require(&mut self, expected: &str) -> Result<(), String> {
        let field = self.text();
        if field == expected { Ok(()) } else { Err(format!("`{field}` should be `{expected}`")) }
    }

    /// The next as a number.
    ///
    /// # Errors
    /// What it is instead, and of which column.
    pub fn number<N: FromStr>(&mut self) -> Result<N, String> {
        let field = self.text();
        let column = self.names.get(self.next - 1).map_or("", String::as_str);
        field.parse().map_err(|_| format!("`{field}` is no number for {column}"))
    }

    /// The next as a number, or none where it is empty.
    ///
    /// # Errors
    /// The errors of [`RowFields::number`].
    pub fn maybe(&mut self) -> Result<Option<f64>, String> {
        if self.record.get(self.next).is_none_or(str::is_empty) {
            self.next += 1;
            return Ok(None);
        }
        self.number().map(Some)
    }

    /// The next as an outcome; none where the run failed.
    ///
    /// # Errors
    /// What it is instead.
    pub fn outcome(&mut self) -> Result<Option<Outcome>, String> {
        match self.text() {
            FAILED => Ok(None),
            name => Outcome::from_name(name).map(Some).ok_or_else(|| format!("`{name}` is no outcome")),
        }
    }

    /// The next four as an error; none where the first is empty.
    ///
    /// # Errors
    /// The errors of [`RowFields::number`].
    pub fn error_estimate(&mut self) -> Result<Option<ErrorEstimate>, String> {
        match self.text() {
            "" => Ok(None),
            certain => Ok(Some(ErrorEstimate {
                outcome_certain: certain == "true",
                peak_rotation: self.number()?,
                peak_acceleration: self.number()?,
                first_impact_time: self.number()?,
            })),
        }
    }
}
