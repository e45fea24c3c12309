//! TOML documents as the types of a scene or a study.

use serde_path_to_error::{Segment, Track};
use toml::de::{DeArray, DeTable};

use super::error::SceneError;
use crate::keys::Described;
use crate::keys::bounds::{Outside, outside};

/// Reads `T` from the TOML `text` of a file called `origin`.
///
/// # Errors
/// [`SceneError::Syntax`] and [`SceneError::Range`] with the line and the key.
pub fn from_text<T: Described>(text: &str, origin: &str) -> Result<T, SceneError> {
    read(table(text, origin)?, origin, |path| line_of(text, path))
}

/// `error` with the line of its key in the TOML `text` of its file, if it is about a range.
pub fn with_line(mut error: SceneError, text: &str) -> SceneError {
    if let SceneError::Range { line: line @ None, key, .. } = &mut error {
        // Below a key a parameter may be named, after a colon.
        let key = key.split(':').next().unwrap_or_default();
        *line = line_of(text, &key.split('.').map(str::to_owned).collect::<Vec<_>>());
    }
    error
}

/// Reads `T` from a table that is no longer what the file `origin` says, so that only keys are named.
///
/// # Errors
/// [`SceneError::Syntax`] and [`SceneError::Range`] with the key.
pub fn from_table<T: Described>(table: toml::Table, origin: &str) -> Result<T, SceneError> {
    read(table, origin, |_| None)
}

/// The table of the TOML `text` of a file called `origin`.
///
/// # Errors
/// [`SceneError::Syntax`] with the line.
pub fn table(text: &str, origin: &str) -> Result<toml::Table, SceneError> {
    text.parse().map_err(|error: toml::de::Error| {
        let line = error.span().map(|span| line_at(text, span.start));
        // What the library says of an integer that only 128 bits hold is no sentence; this is what it says of longer ones.
        let message = if error.message().contains("` as i128, expected") { "integer number overflowed" } else { error.message() };
        SceneError::syntax(origin, line, "", message)
    })
}

fn read<T: Described>(table: toml::Table, origin: &str, line: impl Fn(&[String]) -> Option<usize>) -> Result<T, SceneError> {
    let outside = outside(&table, T::schema());
    let mut track = Track::new();
    let tracked = serde_path_to_error::Deserializer::new(toml::Value::Table(table), &mut track);
    // The types are compiled for one deserializer, whatever is below it: for toml's and the tracker's they are two thirds of this package.
    let mut document = <dyn erased_serde::Deserializer<'_>>::erase(tracked);
    let read = erased_serde::deserialize(&mut document);
    drop(document);
    let path = track.path();
    let keys: Vec<String> = path.iter().map_while(key_of).collect();
    // A number of another kind may be outside a range too, which says more.
    let is_told = |outside: &Outside| read.is_ok() || outside.path == keys;
    if let Some(Outside { path, value, range }) = outside.filter(is_told) {
        return Err(SceneError::Range { origin: origin.to_owned(), line: line(&path), key: path.join("."), value, range });
    }
    read.map_err(|error| {
        // Where toml knows no line it says below the message in which key.
        let message = error.to_string();
        let message = message.split_once("\nin `").map_or(message.as_str(), |(message, _)| message);
        let stranger = keys.first().filter(|_| keys.len() == 1 && message.starts_with("unknown field `"));
        match stranger.and_then(|key| Some((key.clone(), T::stranger(key)?))) {
            Some((key, whose)) => {
                let message = format!("{key} is {whose}");
                SceneError::Syntax { origin: origin.to_owned(), line: line(&keys), key: Some(key), message }
            }
            None => SceneError::syntax(origin, line(&keys), &path.to_string(), message),
        }
    })
}

/// The name of a key or the number of an element.
fn key_of(segment: &Segment) -> Option<String> {
    match segment {
        Segment::Map { key } => Some(key.clone()),
        Segment::Seq { index } => Some(index.to_string()),
        Segment::Enum { .. } | Segment::Unknown => None,
    }
}

/// The line of `text`, from 1, with the last key of `path` that it has.
fn line_of(text: &str, path: &[String]) -> Option<usize> {
    let document = DeTable::parse(text).ok()?;
    let mut at = None;
    let mut table = Some(document.get_ref());
    let mut list: Option<&DeArray<'_>> = None;
    for part in path {
        let value = match (table, list) {
            (Some(table), _) => table.get_key_value(part.as_str()).map(|(name, value)| (name.span(), value)),
            (None, Some(list)) => part.parse().ok().and_then(|index: usize| list.get(index)).map(|value| (value.span(), value)),
            (None, None) => None,
        };
        let Some((span, value)) = value else { break };
        at = Some(span.start);
        (table, list) = (value.get_ref().as_table(), value.get_ref().as_array());
    }
    at.map(|at| line_at(text, at))
}

fn line_at(text: &str, byte: usize) -> usize {
    text.as_bytes()[..byte.min(text.len())].iter().filter(|byte| **byte == b'\n').count() + 1
}
