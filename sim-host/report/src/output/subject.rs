//! What results are of: by this they differ from results of other commands and other scenes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::OutputError;

/// Digest of the contents of a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Digest {
    bytes: u64,
    crc32: String,
}

impl Digest {
    /// Digest of the file at `path`.
    ///
    /// # Errors
    /// When it cannot be read, or is no regular file: a pipe would be waited for, and is empty when it has been read.
    pub fn of(path: &Path) -> std::io::Result<Digest> {
        if !std::fs::metadata(path)?.is_file() {
            return Err(std::io::Error::new(std::io::ErrorKind::InvalidInput, "not a regular file"));
        }
        Ok(Digest::of_bytes(&std::fs::read(path)?))
    }

    /// Digest of `bytes`.
    pub fn of_bytes(bytes: &[u8]) -> Digest {
        let crc32 = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(bytes);
        Digest { bytes: bytes.len() as u64, crc32: format!("{crc32:08x}") }
    }
}

/// What results are of, by the names that `summary.json` has for it. Results of one subject may take each other's place unasked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Subject {
    /// Subcommand.
    pub command: String,
    /// Scene or study as resolved, with its seeds, and options that change the results.
    #[serde(flatten)]
    pub input: Map<String, Value>,
    /// Files that it reads, and what is in them.
    #[serde(default)]
    pub files: BTreeMap<String, Digest>,
}

impl Subject {
    /// Of a subcommand without an input; [`Subject::with`] adds what it has.
    pub fn new(command: &str, files: BTreeMap<String, Digest>) -> Subject {
        Subject { command: command.to_owned(), input: Map::new(), files }
    }

    /// With `value`, which `summary.json` calls `name`.
    ///
    /// # Errors
    /// [`OutputError`] when `value` cannot be written as JSON: a path that is not Unicode.
    pub fn with(mut self, name: &str, value: &impl Serialize) -> Result<Subject, OutputError> {
        // Through text, as `summary.json` is written and read.
        let value = serde_json::to_string(value).and_then(|text| serde_json::from_str(&text)).map(|mut value: Value| {
            value.sort_all_objects();
            value
        });
        let failed = |error: serde_json::Error| OutputError {
            path: PathBuf::from("summary.json"),
            reason: format!("cannot be written: {name}: {error}"),
        };
        self.input.insert(name.to_owned(), value.map_err(failed)?);
        Ok(self)
    }

    /// The name of the first thing that `page`, a result's, has otherwise; with `any_accuracy` not of accuracies.
    pub fn difference(&self, page: &Value, any_accuracy: bool) -> Option<String> {
        let mut ours = serde_json::to_value(self).unwrap_or_default();
        let mut theirs = page.clone();
        if any_accuracy {
            forget_accuracy(&mut ours);
            forget_accuracy(&mut theirs);
        }
        let Value::Object(ours) = ours else { return None };
        // A scene says more of what is other than the files that it reads.
        let (files, others): (Vec<_>, Vec<_>) = ours.iter().partition(|(name, _)| *name == "files");
        others.into_iter().chain(files).find_map(|(name, ours)| {
            let nothing = if ours.is_object() { Value::Object(Map::new()) } else { Value::Null };
            difference(name, ours, theirs.get(name).unwrap_or(&nothing))
        })
    }
}

fn forget_accuracy(value: &mut Value) {
    match value {
        Value::Object(object) => {
            object.remove("accuracy");
            object.values_mut().for_each(forget_accuracy);
        }
        Value::Array(array) => array.iter_mut().for_each(forget_accuracy),
        _ => {}
    }
}

/// The name of the first value below `name` in which `ours` is not `theirs`.
pub fn difference(name: &str, ours: &Value, theirs: &Value) -> Option<String> {
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

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn the_first_difference_is_named() {
        let ours = json!({"block": {"size_m": 2.0}, "device": [{"kind": "none"}]});
        let of = |other: Value| difference("scene", &ours, &other);
        assert_eq!(of(ours.clone()), None);
        let other = json!({"block": {"size_m": 2.5}, "device": [{"kind": "none"}]});
        assert_eq!(of(other).as_deref(), Some("scene.block.size_m"));
        let other = json!({"block": {"size_m": 2.0}, "device": [{"kind": "inerter"}]});
        assert_eq!(of(other).as_deref(), Some("scene.device.0.kind"));
        let other = json!({"block": {"size_m": 2.0}, "device": []});
        assert_eq!(of(other).as_deref(), Some("scene.device"));
    }

    #[cfg(unix)]
    #[test]
    fn digests_are_of_regular_files() {
        let file = tempfile::NamedTempFile::new().unwrap();
        assert_eq!(Digest::of(file.path()).unwrap(), Digest::of_bytes(b""));
        // As empty, but a device: a pipe would be waited for.
        assert!(Digest::of(Path::new("/dev/null")).is_err());
    }

    #[test]
    fn only_what_a_subject_names_is_compared() {
        let files = |text: &str| BTreeMap::from([("a.csv".to_owned(), Digest::of_bytes(text.as_bytes()))]);
        let scene = json!({"block": 1, "accuracy": {"level": "fast"}});
        let subject = Subject::new("map", files("1")).with("scene", &scene).unwrap();
        let page = |subject: &Subject| {
            let mut page = serde_json::to_value(subject).unwrap();
            page["version"] = json!("0");
            page
        };
        assert_eq!(subject.difference(&page(&subject), false), None);
        assert_eq!(serde_json::from_value::<Subject>(serde_json::to_value(&subject).unwrap()).unwrap(), subject);
        let other = Subject::new("map", files("2")).with("scene", &scene).unwrap();
        assert_eq!(subject.difference(&page(&other), false).as_deref(), Some("files.a.csv.crc32"));
        let other = json!({"block": 1, "accuracy": {"level": "tight"}});
        let other = Subject::new("map", files("1")).with("scene", &other).unwrap();
        assert_eq!(subject.difference(&page(&other), false).as_deref(), Some("scene.accuracy.level"));
        assert_eq!(subject.difference(&page(&other), true), None);
        // A page of nothing that is read need not say so.
        let none = Subject::new("map", BTreeMap::new()).with("option", &None::<u8>).unwrap();
        assert_eq!(none.difference(&json!({"command": "map"}), false), None);
        assert_eq!(none.difference(&json!({"command": "loop"}), false).as_deref(), Some("command"));
    }
}
