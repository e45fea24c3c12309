//! What can be wrong with a scene.

use sprag_shared::error::{Number, ParameterError};

/// A scene that cannot be read, in one line.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// The file cannot be read.
    #[error("{origin}: {message}")]
    Unreadable {
        /// File.
        origin: String,
        /// Why.
        message: String,
    },
    /// The file is too large to be a scene.
    #[error("{origin}: {bytes} bytes are too large for a scene; at most 1 MiB is read")]
    TooLarge {
        /// File.
        origin: String,
        /// Its size.
        bytes: u64,
    },
    /// Not TOML, an unknown key, or a value of another kind.
    #[error("{origin}{}: {message}", line.map_or_else(String::new, |line| format!(":{line}")))]
    Syntax {
        /// File.
        origin: String,
        /// Line, from 1.
        line: Option<usize>,
        /// What is wrong.
        message: String,
    },
    /// A value outside its range.
    #[error("{origin}: {key} is {value}, but must be {range}")]
    Range {
        /// File.
        origin: String,
        /// Key.
        key: String,
        /// Value.
        value: String,
        /// What it may be.
        range: String,
    },
    /// A value that is needed.
    #[error("{origin}: {key} is missing: {needed}")]
    Missing {
        /// File.
        origin: String,
        /// Key.
        key: String,
        /// What is needed.
        needed: String,
    },
    /// Values that contradict each other.
    #[error("{origin}: {key}: {reason}")]
    Conflict {
        /// File.
        origin: String,
        /// Key.
        key: String,
        /// Why.
        reason: String,
    },
}

/// The place of a value, from which errors about it are made.
#[derive(Debug, Clone)]
pub struct Key {
    /// File.
    pub origin: String,
    /// Key, with dots.
    pub key: String,
}

impl Key {
    /// `value` is outside `range`.
    pub fn range(self, value: f64, range: &str) -> SceneError {
        SceneError::Range { origin: self.origin, key: self.key, value: Number(value).to_string(), range: range.to_owned() }
    }

    /// A parameter below this key is outside its range.
    pub fn parameter(self, error: &ParameterError) -> SceneError {
        let key = format!("{}: {}", self.key, error.parameter);
        SceneError::Range { origin: self.origin, key, value: Number(error.value).to_string(), range: error.range.to_owned() }
    }

    /// Something is needed here.
    pub fn missing(self, needed: &str) -> SceneError {
        SceneError::Missing { origin: self.origin, key: self.key, needed: needed.to_owned() }
    }

    /// Something here contradicts something else.
    pub fn conflict(self, reason: &str) -> SceneError {
        SceneError::Conflict { origin: self.origin, key: self.key, reason: reason.to_owned() }
    }

    /// `value`, if finite and `allowed`.
    ///
    /// # Errors
    /// [`SceneError::Range`] with `range`.
    pub fn require(self, value: f64, allowed: bool, range: &str) -> Result<f64, SceneError> {
        if allowed && value.is_finite() { Ok(value) } else { Err(self.range(value, range)) }
    }
}

impl SceneError {
    /// A TOML error at key `path` ("" for the whole file) as one line, with its line number where `text` is that of the
    /// file.
    pub fn syntax(origin: &str, text: &str, path: &str, error: &toml::de::Error) -> SceneError {
        let line = error
            .span()
            .filter(|_| !text.is_empty())
            .map(|span| text.as_bytes()[..span.start.min(text.len())].iter().filter(|b| **b == b'\n').count() + 1);
        let message = one_line(error.message());
        let message = if path.is_empty() || path == "." { message } else { format!("{path}: {message}") };
        SceneError::Syntax { origin: origin.to_owned(), line, message }
    }
}

/// Folds a message into one line.
pub fn one_line(message: &str) -> String {
    message.split_whitespace().collect::<Vec<_>>().join(" ")
}
