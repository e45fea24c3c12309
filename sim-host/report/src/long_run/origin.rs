//! What makes rows what they are.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::error::LongRunError;
use super::shard::Shard;
use crate::output::{Subject, difference};

/// What rows come from. Two runs with the same origin have the same rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Origin {
    /// Command and input.
    #[serde(flatten)]
    pub subject: Subject,
    /// Version of Sprag.
    pub version: String,
    /// Rows of the whole run.
    pub rows: usize,
}

impl Origin {
    /// Of the `rows` rows of `subject`, made by this version.
    pub fn new(subject: Subject, rows: usize) -> Origin {
        Origin { subject, version: env!("CARGO_PKG_VERSION").to_owned(), rows }
    }

    /// The name of the first thing that `other` has otherwise.
    pub fn difference(&self, other: &Origin) -> Option<String> {
        let of = |origin: &Origin| serde_json::to_value(origin).unwrap_or_default();
        difference("", &of(self), &of(other))
    }
}

/// The page beside a file of rows: where they come from, and how they were made.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Ledger {
    /// What the rows come from.
    #[serde(flatten)]
    pub origin: Origin,
    /// Shard of the rows in the file.
    pub shard: String,
    /// The command lines that worked on them.
    pub command_lines: Vec<Vec<String>>,
}

impl Ledger {
    /// A page for the rows of `shard`, made by this process.
    pub fn new(origin: Origin, shard: Shard) -> Ledger {
        let command_line = std::env::args().collect();
        Ledger { origin, shard: shard.to_string(), command_lines: vec![command_line] }
    }

    /// The page at `path`.
    ///
    /// # Errors
    /// [`LongRunError::File`] when it cannot be read.
    pub fn read(path: &Path) -> Result<Ledger, LongRunError> {
        let text = std::fs::read_to_string(path).map_err(|error| LongRunError::file(path, &error))?;
        serde_json::from_str(&text).map_err(|error| LongRunError::file(path, &format!("not the page of a run: {error}")))
    }

    /// Refuses rows of another origin than `origin`; `path` is where this page was read.
    ///
    /// # Errors
    /// [`LongRunError::OtherRun`] names what differs.
    pub fn require(&self, origin: &Origin, path: &Path) -> Result<(), LongRunError> {
        match self.origin.difference(origin) {
            None => Ok(()),
            Some(what) => Err(LongRunError::OtherRun { path: path.to_owned(), what }),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    #[test]
    fn a_page_reads_back_and_names_what_differs() {
        let subject = Subject::new("map", BTreeMap::new()).with("scene", &serde_json::json!({"size_m": 0.1})).unwrap();
        let ours = Origin::new(subject, 12);
        let page = serde_json::to_string(&Ledger::new(ours.clone(), Shard::WHOLE)).unwrap();
        let read: Ledger = serde_json::from_str(&page).unwrap();
        assert_eq!((&read.origin, read.shard.as_str()), (&ours, "1/1"));
        assert_eq!(ours.difference(&read.origin), None);
        assert_eq!(ours.difference(&Origin { rows: 13, ..ours.clone() }).as_deref(), Some("rows"));
        let mut other = ours.clone();
        other.subject.input["scene"]["size_m"] = 0.2.into();
        assert_eq!(ours.difference(&other).as_deref(), Some("scene.size_m"));
    }
}
