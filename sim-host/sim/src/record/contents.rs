//! What a reader finds in a file, before units and time step are settled.

use super::error::RecordError;
use super::number::BadField;
use super::units::{StatedUnits, Units};
use super::warning::Warning;

/// Layout of a record file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// PEER acceleration file (`.AT2`): header lines with NPTS and DT, then values row by row.
    PeerAt2,
    /// USGS SMC: text, integer and real headers, comments, then fixed columns.
    UsgsSmc,
    /// SimCenter JSON: an object with `dT`, `data_x` and `data_y`.
    SimCenterJson,
    /// Text with a time column.
    Table,
    /// Text with acceleration values only, any number per line.
    Values,
    /// No file: samples in memory.
    Array,
}

impl Format {
    /// Short name for listings.
    pub fn name(self) -> &'static str {
        match self {
            Format::PeerAt2 => "PEER AT2",
            Format::UsgsSmc => "USGS SMC",
            Format::SimCenterJson => "SimCenter JSON",
            Format::Table => "table",
            Format::Values => "values",
            Format::Array => "array",
        }
    }
}

/// A time step as a file states it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StatedStep {
    /// The step (s).
    pub value_s: f64,
    /// Value of the last printed digit (s): 0.0001 for `.0050`.
    pub resolution_s: f64,
}

impl StatedStep {
    /// Whether `step_s` is what was stated, up to the rounding of the print.
    pub(super) fn agrees_with(&self, step_s: f64) -> bool {
        (step_s - self.value_s).abs() <= 0.5 * self.resolution_s * (1.0 + 1e-6)
    }
}

/// What the file says about itself, to be compared with what it holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Header {
    /// Title or first lines, without blanks at the ends; empty if there are none.
    pub title: String,
    /// Stated number of samples.
    pub samples: Option<u64>,
    /// Stated peak (m/s²): the largest value or the largest magnitude, files differ.
    pub peak_m_s2: Option<f64>,
    /// Stated time step, from a header or from a time column.
    pub time_step: Option<StatedStep>,
}

/// The samples of a file in the file's own units, and what the file says of them.
pub(super) struct Contents {
    pub format: Format,
    pub values: Vec<f64>,
    pub units: Option<Units>,
    /// The stated peak is in file units here.
    pub header: Header,
    pub start_time_s: f64,
    pub component: Option<String>,
    pub warnings: Vec<Warning>,
}

impl Contents {
    pub(super) fn new(format: Format) -> Contents {
        Contents {
            format,
            values: Vec::new(),
            units: None,
            header: Header::default(),
            start_time_s: 0.0,
            component: None,
            warnings: Vec::new(),
        }
    }
}

/// The error for a bad field at a line counted from 0.
pub(super) fn bad_field(name: &str, index: usize, field: BadField) -> RecordError {
    let (file, line, value) = (name.to_owned(), index + 1, field.text);
    if field.not_finite { RecordError::NotFinite { file, line, value } } else { RecordError::NotANumber { file, line, value } }
}

/// Units from header lines, given with their index from 0. Lines that say `units` go before mere hints.
pub(super) fn header_units(name: &str, lines: &[(usize, &str)]) -> Result<Option<Units>, RecordError> {
    let mut found = None;
    for (index, line) in lines {
        match super::units::stated_in(line) {
            Some(StatedUnits::Known(units)) => found = Some(units),
            Some(StatedUnits::Unknown(value)) if found.is_none() => {
                reject_other_quantity(name, *index, line)?;
                return Err(RecordError::UnknownUnits { file: name.to_owned(), line: index + 1, value });
            }
            _ => {}
        }
    }
    Ok(found)
}

/// Refuses header lines that announce a velocity, a displacement or a spectrum.
pub(super) fn reject_other_quantity(name: &str, index: usize, line: &str) -> Result<(), RecordError> {
    let upper = line.to_uppercase();
    let other = ["VELOCITY", "DISPLACEMENT", "SPECTR"].into_iter().find(|word| upper.contains(word));
    match other {
        Some(quantity) if !upper.contains("ACCEL") => Err(RecordError::NotAcceleration {
            file: name.to_owned(),
            line: index + 1,
            quantity: match quantity {
                "VELOCITY" => "velocity",
                "DISPLACEMENT" => "displacement",
                _ => "a spectrum",
            }
            .to_owned(),
        }),
        _ => Ok(()),
    }
}
