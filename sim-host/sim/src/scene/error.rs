//! What can be wrong with a scene.

use sprag_shared::structure::error::{Number, ParameterError};

/// A scene that cannot be read, in one line.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// The file cannot be read.
    #[error("{origin}: {message}")]
    Unreadable {
        /// File.
        origin: String,
        /// Message of the parser.
        message: String,
    },
    /// The file is too large to be a scene.
    #[error("{origin}: {bytes} bytes are too large for a scene; at most 1 MiB is read")]
    TooLarge {
        /// File.
        origin: String,
        /// Size of the file, bytes.
        bytes: u64,
    },
    /// Not TOML, an unknown key, or a value of another kind.
    #[error("{}: {message}", place(origin, *line))]
    Syntax {
        /// File.
        origin: String,
        /// Line, from 1.
        line: Option<usize>,
        /// Key, with dots, where it is known.
        key: Option<String>,
        /// What is wrong.
        message: String,
    },
    /// A value outside its range.
    #[error("{}: {key} is {value}, but must be {range}", place(origin, *line))]
    Range {
        /// File.
        origin: String,
        /// Line, from 1, where the value is as the file has it.
        line: Option<usize>,
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
        /// Reason, in words.
        reason: String,
    },
}

/// The place of a value, from which errors about it are made.
#[derive(Debug, Clone)]
pub struct KeyPath {
    /// File.
    pub origin: String,
    /// Key, with dots.
    pub key: String,
}

impl KeyPath {
    /// `value` is outside `range`.
    pub fn range(self, value: f64, range: &str) -> SceneError {
        self.outside(Number(value).to_string(), range)
    }

    /// A parameter below this key is outside its range.
    pub fn parameter(self, error: &ParameterError) -> SceneError {
        let key = format!("{}: {}", self.key, error.parameter);
        KeyPath { key, ..self }.range(error.value, error.range)
    }

    /// `value`, as messages show it, is outside `range`.
    pub fn outside(self, value: String, range: &str) -> SceneError {
        SceneError::Range { origin: self.origin, line: None, key: self.key, value, range: range.to_owned() }
    }

    /// Something is needed here.
    pub fn missing(self, needed: &str) -> SceneError {
        SceneError::Missing { origin: self.origin, key: self.key, needed: needed.to_owned() }
    }

    /// Something here contradicts something else.
    pub fn conflict(self, reason: &str) -> SceneError {
        SceneError::Conflict { origin: self.origin, key: self.key, reason: reason.to_owned() }
    }

    /// Refuses a list that has one of its `values` twice.
    ///
    /// # Errors
    /// [`SceneError::Conflict`] at the second of them.
    pub fn once<T: PartialEq>(self, values: &[T]) -> Result<(), SceneError> {
        match (1..values.len()).find(|&index| values[..index].contains(&values[index])) {
            Some(index) => Err(KeyPath { key: format!("{}.{index}", self.key), ..self }.conflict("this value is there already")),
            None => Ok(()),
        }
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
    /// What is wrong with the key `path` ("" for the whole file), in the words of the TOML library, as one line; with the number of the line
    /// where it is known.
    pub fn syntax(origin: &str, line: Option<usize>, path: &str, message: &str) -> SceneError {
        let message = one_line(message);
        let path = dotted(path);
        let words = in_words(&message).or_else(|| with_what_is_meant(&message));
        let key = (!matches!(path.as_str(), "" | ".")).then(|| path.clone());
        let message = match (words, path.as_str()) {
            (None, "" | ".") => message,
            (None, path) => format!("{path}: {message}"),
            (Some(words), "" | ".") => format!("the scene {words}"),
            (Some(words), path) => format!("{path} {words}"),
        };
        SceneError::Syntax { origin: origin.to_owned(), line, key, message }
    }
}

/// `device.1.kind` for `device[1].kind`, as `--set` and every other message have it, on one line whatever its keys are.
fn dotted(path: &str) -> String {
    let shown = |letter: char| if letter.is_control() { letter.escape_default().to_string() } else { letter.to_string() };
    path.replace('[', ".").replace(']', "").chars().map(shown).collect()
}

/// A complaint about a key or a word that does not exist, with the one that may be meant; `None` where none is near, and for any other.
fn with_what_is_meant(message: &str) -> Option<String> {
    let (is_key, rest) = match message.strip_prefix("unknown field `") {
        Some(rest) => (true, rest),
        None => (false, message.strip_prefix("unknown variant `")?),
    };
    let (given, expected) = rest.split_once('`')?;
    let meant = nearest(given, expected.split('`').skip(1).step_by(2))?;
    Some(if is_key { format!("is not a key; did you mean `{meant}`?") } else { format!("is {given:?}; did you mean {meant:?}?") })
}

/// The one of `known` that was probably meant by `given`: about a third of its letters, at most, are other ones.
pub fn nearest<'a>(given: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let distance = |word: &str| strsim::osa_distance(&given.to_lowercase(), word);
    let nearest = known.min_by_key(|word| distance(word))?;
    (3 * distance(nearest) <= nearest.chars().count() + 2).then_some(nearest)
}

/// A complaint about the kind of a value, `invalid type: integer `5`, expected f64`, in the words of a person; `None` for any other.
fn in_words(message: &str) -> Option<String> {
    if message.starts_with("invalid length ") && message.contains(", expected struct ") {
        return Some("is a list, but must be a table".to_owned());
    }
    // What a choice of words says of a table.
    if message.starts_with("wanted exactly 1 element, ") {
        return Some("is a table, but must be a text in quotes".to_owned());
    }
    let (found, wanted) = message.strip_prefix("invalid type: ")?.split_once(", expected ")?;
    let found = match found {
        "map" => "a table".to_owned(),
        "sequence" => "a list".to_owned(),
        // What a choice of words says of any number.
        "unit variant" => "no text".to_owned(),
        other => ["string ", "integer ", "floating point ", "boolean "]
            .iter()
            .find_map(|kind| other.strip_prefix(kind))
            .map_or_else(|| other.to_owned(), |value| value.trim_matches('`').to_owned()),
    };
    let is_whole = wanted.starts_with(['u', 'i']) && wanted[1..].parse::<u8>().is_ok() || wanted == "usize";
    // What is left of an integer that TOML has no room for: a floating-point number, or a text.
    let is_long = found.trim_matches('"').parse::<f64>().is_ok_and(|number| number.abs() >= 9_223_372_036_854_775_808.0);
    let wanted = match wanted {
        "f64" => "a number",
        "a string" | "path string" | "string only" => "a text in quotes",
        "a sequence" => "a list; of tables name one by its number, from 0, as in ground.0.scale",
        "a map" => "a table",
        "a boolean" => "true or false",
        _ if wanted.starts_with("struct ") => "a table",
        _ if is_whole && is_long => "a whole number below 2^63",
        _ if is_whole => "a whole number",
        other => other,
    };
    Some(format!("is {found}, but must be {wanted}"))
}

/// `origin`, with the line where it is known.
fn place(origin: &str, line: Option<usize>) -> String {
    line.map_or_else(|| origin.to_owned(), |line| format!("{origin}:{line}"))
}

/// Folds a message into one line.
pub fn one_line(message: &str) -> String {
    message.split_whitespace().collect::<Vec<_>>().join(" ")
}
