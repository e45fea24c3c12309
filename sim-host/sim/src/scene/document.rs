//! TOML documents as the types of a scene or a study.

use serde_path_to_error::{Path, Segment, Track};
use toml::de::{DeArray, DeTable};

use super::error::{KeyPath, SceneError};
use crate::keys::Described;
use crate::keys::bounds::{Outside, outside};

/// Reads `T` from the TOML `text` of a file called `origin`.
///
/// # Errors
/// [`SceneError::Syntax`] with the line and the key, [`SceneError::Range`] with the key.
pub fn from_text<T: Described>(text: &str, origin: &str) -> Result<T, SceneError> {
    read(table(text, origin)?, origin, |path| line_of(text, path))
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
        SceneError::syntax(origin, line, "", error.message())
    })
}

fn read<T: Described>(table: toml::Table, origin: &str, line: impl FnOnce(&Path) -> Option<usize>) -> Result<T, SceneError> {
    let outside = outside(&table, T::schema());
    let mut track = Track::new();
    let tracked = serde_path_to_error::Deserializer::new(toml::Value::Table(table), &mut track);
    // The types are compiled for one deserializer, whatever is below it: for toml's and the tracker's they are two thirds of this package.
    let mut document = <dyn erased_serde::Deserializer<'_>>::erase(tracked);
    let read = erased_serde::deserialize(&mut document);
    drop(document);
    let document = read.map_err(|error| {
        let path = track.path();
        // Where toml knows no line it says below the message in which key.
        let message = error.to_string();
        let message = message.split_once("\nin `").map_or(message.as_str(), |(message, _)| message);
        SceneError::syntax(origin, line(&path), &path.to_string(), message)
    })?;
    match outside {
        None => Ok(document),
        Some(Outside { path, value, range }) => {
            Err(KeyPath { origin: origin.to_owned(), key: path.join(".") }.range(value, &range))
        }
    }
}

/// The line of `text`, from 1, with the last key of `path` that it has.
fn line_of(text: &str, path: &Path) -> Option<usize> {
    let document = DeTable::parse(text).ok()?;
    let mut at = None;
    let mut table = Some(document.get_ref());
    let mut list: Option<&DeArray<'_>> = None;
    for segment in path.iter() {
        let value = match segment {
            Segment::Map { key } => {
                table.and_then(|table| table.get_key_value(key.as_str())).map(|(name, value)| (name.span(), value))
            }
            Segment::Seq { index } => list.and_then(|list| list.get(*index)).map(|value| (value.span(), value)),
            Segment::Enum { .. } | Segment::Unknown => None,
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
