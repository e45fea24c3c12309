//! Recorded ground motions: files of every common format, read into one [`Record`] in SI units.
//!
//! The layout is recognised by content, the name's ending is a hint only. Units and time step come from the file;
//! where the file is silent they come from [`ReadOptions`]; where both are silent the reading fails. Nothing is
//! resampled, cut or corrected without being asked for. `docs/records.md` describes formats and numbers.

mod at2;
pub mod checks;
mod columns;
mod contents;
mod decimal_comma;
mod error;
mod event_date;
pub mod intensity;
mod number;
mod resample;
mod simcenter;
mod smc;
mod summary;
mod table;
mod text;
mod time_axis;
mod units;
mod vertical;
mod warning;

use std::fmt;
use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

pub use contents::{Format, Header, StatedStep};
pub use error::RecordError;
pub use event_date::EventDate;
pub use intensity::Intensity;
pub use summary::{RecordSummary, every_warning, warning_lines};
pub use units::{STANDARD_GRAVITY_M_S2, Units};
pub use warning::Warning;

use contents::Contents;
use sprag_ensemble::shaken::Samples;

/// Largest file that is read: 64 MiB, some 200 times a long record at 200 samples per second.
pub const MAXIMUM_FILE_BYTES: u64 = 64 << 20;
/// Largest number of samples that resampling may produce.
pub const MAXIMUM_SAMPLES: usize = 32 << 20;
/// Largest magnitude of a sample (m/s²): some 10 000 g, far beyond any ground motion, small enough to be squared.
pub const MAXIMUM_ACCELERATION_M_S2: f64 = 1e5;
/// Shortest and longest time step (s).
pub const TIME_STEP_RANGE_S: (f64, f64) = (1e-5, 1.0);

/// The component to take from a file that has several: a name (`x`, `acc_ns`) or a number counted from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Component(String);

impl Component {
    /// The file and the component that `FILE#NAME` means; none if a file of the whole name exists, or none called FILE.
    pub fn of_path(path: &Path) -> Option<(PathBuf, Component)> {
        let name = path.to_string_lossy();
        let (file, component) = name.rsplit_once('#').filter(|(file, _)| !path.exists() && Path::new(file).is_file())?;
        Some((PathBuf::from(file), Component::from(component)))
    }

    /// Position among the labels of a file: the same name, a word that only one of the names has, or the number; case does not matter.
    fn position_in(&self, labels: &[&str]) -> Option<usize> {
        let asked = self.0.to_lowercase();
        let same = |label: &&str| label.to_lowercase() == asked;
        let word = |label: &&str| label.to_lowercase().split(|c: char| !c.is_alphanumeric()).any(|word| word == asked);
        let number = || asked.parse::<usize>().ok().filter(|number| (1..=labels.len()).contains(number)).map(|number| number - 1);
        let mut having = labels.iter().enumerate().filter(|(_, label)| word(label)).map(|(at, _)| at);
        let only = || having.next().filter(|_| having.next().is_none());
        labels.iter().position(same).or_else(only).or_else(number)
    }
}

impl From<&str> for Component {
    fn from(text: &str) -> Component {
        Component(text.trim().to_owned())
    }
}

impl fmt::Display for Component {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

/// What the caller knows of a file. The file's own words go first; see the fields.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// Units for files that do not state theirs. If the file states others, its own are used and a warning says so.
    pub units: Option<Units>,
    /// Time step (s) for files that do not state theirs. If it agrees with a stated step to that step's last digit,
    /// it is taken as the more exact one; otherwise the stated one is used and a warning says so.
    pub time_step_s: Option<f64>,
    /// Component of files that have several.
    pub component: Option<Component>,
    /// Resample linearly to this step (s), also where the time column has unequal steps.
    pub resample_to_s: Option<f64>,
}

/// A ground acceleration history with equal time steps, in SI units.
///
/// Sample `i` belongs to the time `start_time_s + i * time_step_s`; between samples the acceleration is linear.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// The file as named by the caller.
    pub name: String,
    /// Layout of the file.
    pub format: Format,
    /// Time step (s), within [`TIME_STEP_RANGE_S`].
    pub time_step_s: f64,
    /// Time of the first sample (s); 0 unless the file has a time column that starts elsewhere.
    pub start_time_s: f64,
    /// Ground acceleration (m/s²), at least two finite samples.
    pub acceleration_m_s2: Vec<f64>,
    /// Units of the samples in the file.
    pub units: Units,
    /// What the file says of itself.
    pub header: Header,
    /// Component taken, if the file has names for several.
    pub component: Option<String>,
    /// What a person should look at, in the order of reading and checking.
    pub warnings: Vec<Warning>,
}

impl Record {
    /// Reads a record file. `FILE#NAME` takes component NAME of FILE, if no file of the whole name exists.
    ///
    /// # Errors
    ///
    /// Every variant of [`RecordError`]; each is one line that names the file. Files above [`MAXIMUM_FILE_BYTES`]
    /// are refused before they are read.
    pub fn read(path: impl AsRef<Path>, options: &ReadOptions) -> Result<Record, RecordError> {
        let path = path.as_ref();
        let name = path.to_string_lossy().into_owned();
        if let Some((file, component)) = Component::of_path(path) {
            let options = ReadOptions { component: Some(component), ..options.clone() };
            return Record::parse(&name, &file_bytes(&file, &name)?, &options);
        }
        Record::parse(&name, &file_bytes(path, &name)?, options)
    }

    /// Reads a record from the bytes of a file called `name`. Any bytes give a record or an error.
    ///
    /// # Errors
    ///
    /// Those of [`Record::read`] but for the ones of the file system.
    pub fn parse(name: &str, bytes: &[u8], options: &ReadOptions) -> Result<Record, RecordError> {
        let bytes_present = bytes.len() as u64;
        if bytes_present > MAXIMUM_FILE_BYTES {
            return Err(RecordError::TooLarge { file: name.to_owned(), bytes: bytes_present, limit: MAXIMUM_FILE_BYTES });
        }
        let text = text::decode(name, bytes)?;
        let lines = text::lines(&text);
        let ending = name.split('#').next().and_then(|file| file.rsplit('.').next()).unwrap_or("").to_lowercase();
        if text.trim_start().starts_with('{') || ending == "json" {
            return finish(name, simcenter::read(name, &text, options.component.as_ref())?, options);
        }
        let with_points = decimal_comma::with_points(name, &lines)?;
        let lines: Vec<&str> = match &with_points {
            Some(with_points) => with_points.iter().map(String::as_str).collect(),
            None => lines,
        };
        let mut contents = if smc::recognises(&lines) || ending == "smc" {
            smc::read(name, &lines)?
        } else if let Some(counts_line) = at2::counts_line(&lines).filter(|line| !table::follows(name, &lines[*line..])) {
            at2::read(name, &lines, counts_line)?
        } else {
            table::read(name, &lines, options)?
        };
        if with_points.is_some() {
            contents.warnings.push(Warning::DecimalCommas);
        }
        finish(name, contents, options)
    }

    /// A record of `samples` in memory, in `units`, every `time_step_s`; `name` is what messages call it.
    ///
    /// # Errors
    ///
    /// [`RecordError`] for fewer than two samples, one that is not finite or too large, and a time step outside [`TIME_STEP_RANGE_S`].
    pub fn of_samples(name: &str, time_step_s: f64, units: Units, samples: Vec<f64>) -> Result<Record, RecordError> {
        let options = ReadOptions { time_step_s: Some(time_step_s), ..ReadOptions::default() };
        finish(name, Contents { values: samples, units: Some(units), ..Contents::new(Format::Array) }, &options)
    }

    /// Time from the first to the last sample (s).
    pub fn duration_s(&self) -> f64 {
        self.acceleration_m_s2.len().saturating_sub(1) as f64 * self.time_step_s
    }
}

fn file_bytes(path: &Path, name: &str) -> Result<Vec<u8>, RecordError> {
    let unreadable = |source| RecordError::Unreadable { file: name.to_owned(), source };
    let metadata = std::fs::metadata(path).map_err(unreadable)?;
    if metadata.is_dir() {
        return Err(RecordError::Folder { file: name.to_owned() });
    }
    // Opening a pipe waits for somebody who writes into it.
    if !metadata.is_file() {
        return Err(RecordError::NotAFile { file: name.to_owned() });
    }
    let too_large = |bytes| RecordError::TooLarge { file: name.to_owned(), bytes, limit: MAXIMUM_FILE_BYTES };
    if metadata.len() > MAXIMUM_FILE_BYTES {
        return Err(too_large(metadata.len()));
    }
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(unreadable)?;
    file.take(MAXIMUM_FILE_BYTES + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > MAXIMUM_FILE_BYTES {
        return Err(too_large(bytes.len() as u64));
    }
    Ok(bytes)
}

/// Refuses a time step outside [`TIME_STEP_RANGE_S`].
fn check_time_step(name: &str, value: f64) -> Result<(), RecordError> {
    let (lowest, highest) = TIME_STEP_RANGE_S;
    if (lowest..=highest).contains(&value) {
        Ok(())
    } else {
        Err(RecordError::TimeStepRange { file: name.to_owned(), value, lowest, highest })
    }
}

/// Settles units and time step, converts to SI and checks the result.
fn finish(name: &str, contents: Contents, options: &ReadOptions) -> Result<Record, RecordError> {
    let file = || name.to_owned();
    let mut warnings = contents.warnings;
    if contents.values.len() < 2 {
        return Err(RecordError::TooFewSamples { file: file(), samples: contents.values.len() });
    }
    let time_step_s = match (contents.header.time_step, options.time_step_s) {
        (None, None) => return Err(RecordError::MissingTimeStep { file: file() }),
        (None, Some(given)) => given,
        (Some(stated), Some(given)) if stated.agrees_with(given) => given,
        (Some(stated), given) => {
            if let Some(given_s) = given {
                // The step after resampling is none of the file's.
                let of_file = !warnings.iter().any(|warning| matches!(warning, Warning::Resampled { .. }));
                warnings.push(Warning::TimeStepNotUsed { given_s, stated_s: of_file.then_some(stated.value_s) });
            }
            stated.value_s
        }
    };
    check_time_step(name, time_step_s)?;
    let units = contents.units.or(options.units).ok_or_else(|| RecordError::MissingUnits { file: file() })?;
    if let Some(given) = options.units.filter(|given| *given != units) {
        warnings.push(Warning::UnitsNotUsed { given, stated: units });
    }
    if let (None, Some(asked)) = (&contents.component, &options.component) {
        warnings.push(Warning::ComponentNotUsed { asked: asked.to_string() });
    }
    let acceleration_m_s2: Vec<f64> = contents.values.iter().map(|value| units.to_m_s2(*value)).collect();
    // What is not a number is not below it either.
    let allowed = |value: &f64| value.abs() <= MAXIMUM_ACCELERATION_M_S2;
    if let Some(sample) = acceleration_m_s2.iter().position(|value| !allowed(value)) {
        let value = acceleration_m_s2[sample];
        return Err(RecordError::AccelerationTooLarge {
            file: file(),
            sample: sample + 1,
            value,
            limit: MAXIMUM_ACCELERATION_M_S2,
        });
    }
    let mut record = Record {
        name: file(),
        format: contents.format,
        time_step_s,
        start_time_s: contents.start_time_s,
        acceleration_m_s2,
        units,
        header: Header { peak_m_s2: contents.header.peak_m_s2.map(|peak| units.to_m_s2(peak)), ..contents.header },
        component: contents.component,
        warnings,
    };
    let found = checks::check(&record);
    record.warnings.extend(found);
    match options.resample_to_s {
        Some(step_s) if step_s != record.time_step_s => record.resample(step_s),
        _ => Ok(record),
    }
}

impl From<&Record> for Samples {
    /// In units of g, as blocks in lanes take it.
    fn from(record: &Record) -> Samples {
        Samples::new(record.time_step_s, record.acceleration_m_s2.iter().map(|a| a / STANDARD_GRAVITY_M_S2).collect())
    }
}
