//! What makes rows what they are.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::error::LongRunError;
use super::shard::Shard;

/// What rows come from. Two runs with the same origin have the same rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Origin {
    /// Subcommand.
    pub command: String,
    /// Version of Sprag.
    pub version: String,
    /// Scene or study as resolved, with its seeds.
    pub input: Value,
    /// Files that it reads, and what is in them.
    pub files: BTreeMap<String, Digest>,
    /// Rows of the whole run.
    pub rows: usize,
}

/// Which contents a file has.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Digest {
    bytes: u64,
    crc32: String,
}

impl Digest {
    /// Of the file at `path`.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn of(path: &Path) -> std::io::Result<Digest> {
        Ok(Digest::of_bytes(&std::fs::read(path)?))
    }

    /// Of `bytes`.
    pub fn of_bytes(bytes: &[u8]) -> Digest {
        let crc32 = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(bytes);
        Digest { bytes: bytes.len() as u64, crc32: format!("{crc32:08x}") }
    }
}

impl Origin {
    /// Of `input` for a subcommand of this version.
    ///
    /// # Errors
    /// When `input` cannot be told in JSON.
    pub fn new(
        command: &str,
        input: &impl Serialize,
        files: BTreeMap<String, Digest>,
        rows: usize,
    ) -> Result<Origin, serde_json::Error> {
        let version = env!("CARGO_PKG_VERSION").to_owned();
        Ok(Origin { command: command.to_owned(), version, input: serde_json::to_value(input)?, files, rows })
    }

    /// The name of the first thing that `other` has otherwise.
    pub fn difference(&self, other: &Origin) -> Option<String> {
        let of = |origin: &Origin| serde_json::to_value(origin).unwrap_or_default();
        difference("", &of(self), &of(other))
    }
}

/// The name of the first value below `name` in which `ours` is not `theirs`.
fn difference(name: &str, ours: &Value, theirs: &Value) -> Option<String> {
    let below = |key: &str| if name.is_empty() { key.to_owned() } else { format!("{name}.{key}") };
    match (ours, theirs) {
        _ if ours == theirs => None,
        (Value::Object(ours), Value::Object(theirs)) => {
            let mut keys: Vec<&String> = ours.keys().chain(theirs.keys()).collect();
            keys.sort();
            let at = |key: &String| [ours, theirs].map(|object| object.get(key).cloned().unwrap_or_default());
            keys.into_iter().find_map(|key| {
                let [ours, theirs] = at(key);
                difference(&below(key), &ours, &theirs)
            })
        }
        (Value::Array(ours), Value::Array(theirs)) if ours.len() == theirs.len() => {
            let mut pairs = ours.iter().zip(theirs).enumerate();
            pairs.find_map(|(index, (ours, theirs))| difference(&below(&index.to_string()), ours, theirs))
        }
        _ => Some(name.to_owned()),
    }
}

/// The page beside a file of rows: where they come from, and how they were made.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Ledger {
    /// What the rows come from.
    #[serde(flatten)]
    pub origin: Origin,
    /// Which of them are in the file.
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
    use super::*;

    #[test]
    fn the_first_difference_is_named() {
        let origin = |input: Value| Origin::new("map", &input, BTreeMap::new(), 12).unwrap();
        let ours = origin(serde_json::json!({"block": {"size_m": 2.0}, "device": [{"kind": "none"}]}));
        assert_eq!(ours.difference(&ours.clone()), None);
        let other = origin(serde_json::json!({"block": {"size_m": 2.5}, "device": [{"kind": "none"}]}));
        assert_eq!(ours.difference(&other).as_deref(), Some("input.block.size_m"));
        let other = origin(serde_json::json!({"block": {"size_m": 2.0}, "device": [{"kind": "inerter"}]}));
        assert_eq!(ours.difference(&other).as_deref(), Some("input.device.0.kind"));
        let other = origin(serde_json::json!({"block": {"size_m": 2.0}, "device": []}));
        assert_eq!(ours.difference(&other).as_deref(), Some("input.device"));
        let other = Origin { rows: 13, ..ours.clone() };
        assert_eq!(ours.difference(&other).as_deref(), Some("rows"));
    }
}
