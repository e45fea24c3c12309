//! What can be wrong with a record file, said so that it can be repaired.

use std::io;

use super::units::Units;

/// Reasons why a record could not be read.
///
/// Every message is one line that names the file, the line where there is one, the offending value and what is
/// allowed.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The operating system would not open or read the file.
    #[error("{file}: cannot be read: {source}")]
    Unreadable {
        /// File as named by the caller.
        file: String,
        /// What the operating system said.
        source: io::Error,
    },
    /// A folder was given in place of a file.
    #[error("{file}: is a folder; name the record files inside it")]
    Folder {
        /// File as named by the caller.
        file: String,
    },
    /// A pipe, a socket or a device was given in place of a file.
    #[error("{file}: is a pipe or a device; records are read from files")]
    NotAFile {
        /// File as named by the caller.
        file: String,
    },
    /// The file is larger than [`super::MAXIMUM_FILE_BYTES`].
    #[error("{file}: {bytes} bytes; a record file may have up to {limit} bytes")]
    TooLarge {
        /// File as named by the caller.
        file: String,
        /// Size found, or the number of bytes after which reading was given up.
        bytes: u64,
        /// Largest size allowed.
        limit: u64,
    },
    /// The bytes are not text.
    #[error("{file}: line {line}: byte 0x{byte:02x} is not text; records are read from plain text (ASCII, UTF-8 or Latin-1)")]
    Binary {
        /// File as named by the caller.
        file: String,
        /// Line of the byte, from 1.
        line: usize,
        /// The byte that text does not have.
        byte: u8,
    },
    /// There is no number in the file, or fewer than two samples.
    #[error("{file}: {samples} sample(s); a record needs at least 2")]
    TooFewSamples {
        /// File as named by the caller.
        file: String,
        /// Samples found.
        samples: usize,
    },
    /// Something stands where a number is due.
    #[error("{file}: line {line}: `{value}` where a number is due")]
    NotANumber {
        /// File as named by the caller.
        file: String,
        /// Line, from 1.
        line: usize,
        /// The text found, shortened.
        value: String,
    },
    /// A NaN, an infinity or a number too large for f64.
    #[error("{file}: line {line}: `{value}` is not finite; every sample must be a finite number")]
    NotFinite {
        /// File as named by the caller.
        file: String,
        /// Line, from 1.
        line: usize,
        /// The text found, shortened.
        value: String,
    },
    /// A sample beyond [`super::MAXIMUM_ACCELERATION_M_S2`].
    #[error(
        "{file}: sample {sample} is {value:e} m/s2; accelerations up to {limit:e} m/s2 are allowed (wrong columns or units?)"
    )]
    AccelerationTooLarge {
        /// File as named by the caller.
        file: String,
        /// Sample number, from 1.
        sample: usize,
        /// The acceleration found (m/s²).
        value: f64,
        /// Largest magnitude allowed (m/s²).
        limit: f64,
    },
    /// Commas that seem to be decimal marks, where commas may part fields as well, or beside points.
    #[error(
        "{file}: line {line}: decimal commas: they cannot be distinguished from commas between fields, or points stand beside them; write decimal points and nothing for thousands, or part the fields by semicolons"
    )]
    DecimalCommas {
        /// File as named by the caller.
        file: String,
        /// First line with such a comma, from 1.
        line: usize,
    },
    /// A row of a table has another number of columns than the rows before.
    #[error("{file}: line {line}: {found} column(s) where {expected} are due")]
    RaggedRow {
        /// File as named by the caller.
        file: String,
        /// Line, from 1.
        line: usize,
        /// Columns found.
        found: usize,
        /// Columns of the first row.
        expected: usize,
    },
    /// Neither the file nor the caller says what unit the samples have.
    #[error("{file}: no units in the file, or several: say them with --units ({})", Units::ALLOWED)]
    MissingUnits {
        /// File as named by the caller.
        file: String,
    },
    /// The file names a unit that is not one of acceleration.
    #[error("{file}: line {line}: unit {value} is not known ({})", Units::ALLOWED)]
    UnknownUnits {
        /// File as named by the caller.
        file: String,
        /// Line, from 1.
        line: usize,
        /// The unit as written.
        value: String,
    },
    /// The times are in another unit than s or ms.
    #[error("{file}: line {line}: times in {value} are not read; allowed are s and ms")]
    UnknownTimeUnit {
        /// File as named by the caller.
        file: String,
        /// Line, from 1.
        line: usize,
        /// The unit found.
        value: String,
    },
    /// The header says that the file holds another quantity, such as velocity.
    #[error("{file}: line {line}: the header says {quantity}; only acceleration histories are read")]
    NotAcceleration {
        /// File as named by the caller.
        file: String,
        /// Line, from 1.
        line: usize,
        /// What the header says.
        quantity: String,
    },
    /// Neither the file nor the caller says what the time step is.
    #[error("{file}: no time step in the file: say it in seconds with --dt, for example --dt 0.005")]
    MissingTimeStep {
        /// File as named by the caller.
        file: String,
    },
    /// A time step outside [`super::TIME_STEP_RANGE_S`].
    #[error("{file}: time step {value} s; allowed are {lowest} s to {highest} s")]
    TimeStepRange {
        /// File as named by the caller.
        file: String,
        /// The step found (s).
        value: f64,
        /// Smallest step allowed (s).
        lowest: f64,
        /// Largest step allowed (s).
        highest: f64,
    },
    /// The time column does not advance by equal steps.
    #[error(
        "{file}: line {line}: time advances by {found} s where the mean step is {expected} s; equal steps are needed, or ask for linear resampling with --resample"
    )]
    UnequalSteps {
        /// File as named by the caller.
        file: String,
        /// Line where the axis first leaves the equal steps, from 1.
        line: usize,
        /// Step found there (s).
        found: f64,
        /// Mean step of the column (s).
        expected: f64,
    },
    /// Time does not advance at all, so it cannot be resampled either.
    #[error("{file}: line {line}: time advances by {found} s; it must increase from row to row")]
    TimeNotIncreasing {
        /// File as named by the caller.
        file: String,
        /// Line, from 1.
        line: usize,
        /// Step found there (s).
        found: f64,
    },
    /// Resampling would give more samples than [`super::MAXIMUM_SAMPLES`].
    #[error("{file}: resampling to {time_step_s} s would give {samples:.0} samples; {limit} are allowed")]
    TooManySamples {
        /// File as named by the caller.
        file: String,
        /// The step asked for (s).
        time_step_s: f64,
        /// Samples it would give.
        samples: f64,
        /// Largest number allowed.
        limit: usize,
    },
    /// The file has several components and the one asked for is not among them, or none was asked for.
    #[error("{file}: component {asked}: choose with --component, or write FILE#NAME; the file has {available}")]
    Component {
        /// File as named by the caller.
        file: String,
        /// What was asked for; `(none chosen)` if nothing was.
        asked: String,
        /// The components that can be chosen.
        available: String,
    },
    /// A structural part of the format is missing or malformed.
    #[error("{file}: line {line}: {problem}")]
    Malformed {
        /// File as named by the caller.
        file: String,
        /// Line, from 1.
        line: usize,
        /// What is wrong and what is due.
        problem: String,
    },
}

impl RecordError {
    /// The key of a `[[ground]]` table, or of a study's `[record]`, that says what the file does not; named as the option is in
    /// the message.
    pub fn key(&self) -> Option<&'static str> {
        match self {
            RecordError::MissingTimeStep { .. } => Some("time_step_s"),
            RecordError::MissingUnits { .. } => Some("units"),
            RecordError::Component { .. } => Some("component"),
            RecordError::UnequalSteps { .. } => Some("resample_to_s"),
            _ => None,
        }
    }
}
