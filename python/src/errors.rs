//! The exceptions of the package, from the errors of the crates below.

use std::fmt::Display;

use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use sprag_cli::board::line::DeviceError;
use sprag_shared::structure::error::ParameterError;
use sprag_sim::closed_loop::LoopFailure;
use sprag_sim::closed_loop::run::LoopError;
use sprag_sim::map::cell::CellError;
use sprag_sim::record::RecordError;
use sprag_sim::scene::SceneError;
use sprag_sim::scene::error::KeyPath;
use sprag_sim::scene::ground::GroundError;
use sprag_sim::simulation::RunError;
use sprag_studies::accuracy_study::study::StudyError as AccuracyError;
use sprag_studies::cloud::study::StudyError as CloudError;
use sprag_studies::design::error::DesignError;
use sprag_studies::map::study::MapError;

/// `sprag.InputError`: what is wrong, and where it is known the key, its value and what it may be.
pub fn input(message: &str, key: Option<&str>, value: Option<&str>, range: Option<&str>) -> PyErr {
    Python::attach(|py| {
        // A value that is a number is given as one.
        let value = value.map(|text| match text.parse::<f64>() {
            Ok(number) => number.into_pyobject(py).map(|number| number.into_any().unbind()).unwrap_or_else(|_| py.None()),
            Err(_) => text.into_pyobject(py).map(|text| text.into_any().unbind()).unwrap_or_else(|_| py.None()),
        });
        raised(py, "InputError", (message, key, value, range))
    })
}

/// `sprag.RunError`: valid input from which no result came.
pub fn failed(message: impl Display) -> PyErr {
    Python::attach(|py| raised(py, "RunError", (message.to_string(),)))
}

/// `sprag.BoardError`: a board that does not answer, or refuses.
pub fn silent(error: DeviceError) -> PyErr {
    Python::attach(|py| raised(py, "BoardError", (error.to_string(),)))
}

/// The exception `name` of the package.
fn raised<'py>(py: Python<'py>, name: &str, arguments: impl pyo3::call::PyCallArgs<'py>) -> PyErr {
    let class = py.import("sprag.errors").and_then(|module| module.getattr(name));
    class.and_then(|class| class.call1(arguments)).map_or_else(|error| error, PyErr::from_value)
}

/// `sprag.InputError` for a `value` of `key` that is not within its `range`.
pub fn range(key: &str, value: impl Display, range: &str) -> PyErr {
    let value = value.to_string();
    input(&format!("{key} is {value}, but must be {range}"), Some(key), Some(&value), Some(range))
}

/// `sprag.InputError` for a `key` that is `needed`.
pub fn missing(key: &str, needed: &str) -> PyErr {
    input(&format!("{key} is missing: {needed}"), Some(key), None, Some(needed))
}

/// `sprag.InputError` with a message alone.
pub fn refused(message: impl Display) -> PyErr {
    input(&message.to_string(), None, None, None)
}

/// As an exception.
pub trait Raise {
    /// The exception.
    fn raise(self) -> PyErr;
}

/// Leaves out the option of the command that advice ends with.
fn without_option(words: &mut String) {
    let Some((before, _)) = words.split_once(" --") else { return };
    let before = [" or by", " or"].iter().find_map(|join| before.strip_suffix(join)).unwrap_or(before);
    *words = before.trim_end_matches([',', ';']).to_owned();
}

impl Raise for SceneError {
    fn raise(mut self) -> PyErr {
        match &mut self {
            SceneError::Range { range: words, .. } | SceneError::Missing { needed: words, .. } => without_option(words),
            SceneError::Conflict { key, reason, .. } => {
                *key = key.trim_start_matches("--set ").to_owned();
                without_option(reason);
            }
            SceneError::Syntax { .. } | SceneError::Unreadable { .. } | SceneError::TooLarge { .. } => {}
        }
        let message = self.to_string();
        match &self {
            SceneError::Range { key, value, range, .. } => input(&message, Some(key), Some(value), Some(range)),
            SceneError::Missing { key, needed, .. } => input(&message, Some(key), None, Some(needed)),
            SceneError::Conflict { key, .. } => input(&message, Some(key), None, None),
            SceneError::Syntax { key: Some(key), message: words, .. } => {
                // A value of another kind.
                let found = words.strip_prefix(key.as_str()).and_then(|words| words.strip_prefix(" is "));
                let (value, range) = found.and_then(|found| found.rsplit_once(", but must be ")).unzip();
                input(&message, Some(key), value, range)
            }
            SceneError::Syntax { key: None, .. } => input(&message, None, None, None),
            SceneError::Unreadable { .. } | SceneError::TooLarge { .. } => input(&message, None, None, None),
        }
    }
}

/// `words` on a record with the arguments of `Record.read` in the place of the command's options.
pub fn by_argument(words: &str) -> String {
    let here = |words: String, (option, argument): (&str, &str)| words.replace(option, argument);
    let options = [
        ("--dt 0.005", "time_step_s=0.005"),
        ("--dt", "time_step_s"),
        ("--units", "units"),
        ("--component", "component"),
        ("--resample", "resample_to_s"),
    ];
    options.into_iter().fold(words.to_owned(), here)
}

impl Raise for RecordError {
    fn raise(self) -> PyErr {
        let message = by_argument(&self.to_string());
        match &self {
            RecordError::TimeStepRange { value, lowest, highest, .. } => {
                let (value, range) = (value.to_string(), format!("{lowest} s to {highest} s"));
                input(&message, Some("time_step_s"), Some(&value), Some(&range))
            }
            RecordError::AccelerationTooLarge { sample, value, limit, .. } => {
                let (key, value, range) =
                    (format!("acceleration.{}", sample - 1), value.to_string(), format!("up to {limit:e} m/s2"));
                input(&message, Some(&key), Some(&value), Some(&range))
            }
            RecordError::TooFewSamples { samples, .. } => {
                input(&message, Some("acceleration"), Some(&samples.to_string()), Some("2 samples or more"))
            }
            other => input(&message, other.key(), None, None),
        }
    }
}

impl Raise for GroundError {
    fn raise(self) -> PyErr {
        let message = by_argument(&self.to_string());
        match self {
            GroundError::Scene(error) => error.raise(),
            GroundError::Record { key, .. } => input(&message, key.as_ref().map(|KeyPath { key, .. }| key.as_str()), None, None),
        }
    }
}

impl Raise for ParameterError {
    fn raise(self) -> PyErr {
        let value = self.value.to_string();
        input(&self.to_string(), Some(self.parameter), Some(&value), Some(self.range))
    }
}

impl Raise for RunError {
    fn raise(self) -> PyErr {
        match self {
            RunError::Interrupted => PyKeyboardInterrupt::new_err(()),
            RunError::Parameter { error, .. } => error.raise(),
            RunError::TooManySamples { interval, .. } => {
                input(&self.to_string(), Some("output.interval_s"), Some(&interval.to_string()), None)
            }
            RunError::OtherGround { .. } => input(&self.to_string(), Some("support_record"), None, None),
            RunError::Stopped { .. } | RunError::NoEffects { .. } | RunError::LiftedOff { .. } => failed(self),
        }
    }
}

impl Raise for MapError {
    fn raise(self) -> PyErr {
        match self {
            MapError::Cell(error) => error.raise(),
            MapError::Rows(_) => failed(self),
        }
    }
}

impl Raise for CellError {
    fn raise(self) -> PyErr {
        match self {
            CellError::Scene { error, .. } => (*error).raise(),
            CellError::Ground { error, .. } => (*error).raise(),
            CellError::Interrupted => PyKeyboardInterrupt::new_err(()),
            CellError::Run { .. } | CellError::Block { .. } => failed(self),
        }
    }
}

impl Raise for CloudError {
    fn raise(self) -> PyErr {
        match self {
            CloudError::File(error) => error.raise(),
            CloudError::Structure { index, .. } => input(&self.to_string(), Some(&format!("structure.{index}.set")), None, None),
        }
    }
}

impl Raise for AccuracyError {
    fn raise(self) -> PyErr {
        match self {
            AccuracyError::Parameter(error) => error.raise(),
            AccuracyError::Interrupted => PyKeyboardInterrupt::new_err(()),
        }
    }
}

/// The assumption of a design that is this `option` of the command.
pub fn assumption(option: &str) -> String {
    match option {
        "face-width" => "face_width_modules".to_owned(),
        "allowable-stress" => "allowable_stress_mpa".to_owned(),
        option => option.replace('-', "_"),
    }
}

/// `words` on a design with the names of its assumptions here in the place of the command's options.
pub fn by_assumption(words: &str) -> String {
    let here = |words: String, option: &str| words.replace(&format!("--{option}"), &assumption(option));
    ["teeth", "face-width", "allowable-stress"].into_iter().fold(words.to_owned(), here)
}

impl Raise for DesignError {
    fn raise(self) -> PyErr {
        let message = self.to_string();
        match self {
            DesignError::Range { option, value, range: allowed } => range(&assumption(option), value, allowed),
            DesignError::UnknownDevice { name, known } => range("devices", format_args!("{name:?}"), &format!("one of {known}")),
            DesignError::NoDevice { .. } => input(&message, Some("device"), None, None),
            DesignError::NoRun { .. } | DesignError::NeverRocks { .. } | DesignError::NoGear { .. } => {
                failed(by_assumption(&message))
            }
            DesignError::Scene(error) => error.raise(),
            DesignError::Interrupted => PyKeyboardInterrupt::new_err(()),
        }
    }
}

impl Raise for LoopFailure {
    fn raise(self) -> PyErr {
        match self {
            LoopFailure::Parameter(error) => error.raise(),
            LoopFailure::Loop(LoopError::Interrupted) => PyKeyboardInterrupt::new_err(()),
            LoopFailure::Loop(LoopError::Stopped(stopped)) => failed(stopped),
        }
    }
}
