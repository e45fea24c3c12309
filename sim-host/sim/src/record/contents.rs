//! What a reader finds in a file, before units and time step are settled.

use super::error::RecordError;
use super::number::BadField;
use super::units::{StatedUnits, Units, hinted_in, said_in};
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

/// Share of a stated step by which a more exact one may differ from it: instruments have rates near round ones, and `.01` may be 0.00977.
const LARGEST_ROUNDING: f64 = 0.05;

impl StatedStep {
    /// Whether `step_s` is what was stated, up to the rounding of the print.
    pub(super) fn agrees_with(&self, step_s: f64) -> bool {
        (step_s - self.value_s).abs() <= (0.5 * self.resolution_s * (1.0 + 1e-6)).min(LARGEST_ROUNDING * self.value_s)
    }
}

/// What the file says about itself, to be compared with what it holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Header {
    /// Title or first lines, without blanks at the ends; empty if there are none.
    pub title: String,
    /// Stated number of samples; none where rows of unequal steps were resampled, with which it was compared.
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

/// Units from header lines, given with their index from 0. Lines that say `units` go before mere hints, of which a remark may be one; none
/// where several are stated.
pub(super) fn header_units(name: &str, lines: &[(usize, &str)]) -> Result<Option<Units>, RecordError> {
    for look in [said_in, hinted_in] {
        let (mut known, mut unknown) = (Vec::new(), None);
        for (index, line) in lines {
            match look(line) {
                Some(StatedUnits::Known(units)) => known.push(units),
                Some(StatedUnits::Unknown(value)) => unknown = unknown.or(Some((*index, *line, value))),
                None => {}
            }
        }
        if let [first, rest @ ..] = known.as_slice() {
            return Ok(rest.iter().all(|units| units == first).then_some(*first));
        }
        if let Some((index, line, value)) = unknown {
            reject_other_quantity(name, index, line)?;
            return Err(RecordError::UnknownUnits { file: name.to_owned(), line: index + 1, value });
        }
    }
    Ok(None)
}

/// Refuses samples that are still to be multiplied by a factor, as K-NET has them: `Scale Factor 3920(gal)/6182761`.
pub(super) fn reject_scale_factor(name: &str, lines: &[(usize, &str)]) -> Result<(), RecordError> {
    let scaled = |(_, line): &&(usize, &str)| line.to_lowercase().contains("scale factor") && line.contains('/');
    lines.iter().find(scaled).map_or(Ok(()), |(index, line)| {
        let problem =
            format!("`{}`: samples are not multiplied by a factor; write them in one of {}", line.trim(), Units::ALLOWED);
        Err(RecordError::Malformed { file: name.to_owned(), line: index + 1, problem })
    })
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
