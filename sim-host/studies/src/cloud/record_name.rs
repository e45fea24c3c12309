//! What tables call records, so that each has a name of its own.

use std::path::{Path, PathBuf};

use super::folder::shown;

/// A record that wants a name.
#[derive(Clone, Debug)]
pub struct Unnamed {
    /// What it is called where no other is called so.
    pub short: String,
    /// Path of its file, as it was given.
    pub path: PathBuf,
    /// By what others are known to be of the [same file](same_file).
    pub file: PathBuf,
    /// What it is beside others of its file.
    pub part: Option<String>,
}

/// `path` without links: the same for a file, however it is named.
pub fn same_file(path: &Path) -> PathBuf {
    std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

/// The names of `records`: the short one, or the whole path where another file is called so, and the part where another is of the same file.
pub fn names(records: &[Unnamed]) -> Vec<String> {
    let name = |(index, record): (usize, &Unnamed)| {
        let others = || records.iter().enumerate().filter(move |(other, _)| *other != index).map(|(_, other)| other);
        let called_so = others().any(|other| other.short == record.short && other.file != record.file);
        let name = if called_so { shown(&record.path) } else { record.short.clone() };
        match &record.part {
            Some(part) if others().any(|other| other.file == record.file) => format!("{name}, {part}"),
            _ => name,
        }
    };
    records.iter().enumerate().map(name).collect()
}
