//! Tests that prove a bound by trying every input: run when what they prove has changed since they last passed, and every night.

use crate::stop::Stop;
use std::{
    fs, io,
    path::{Path, PathBuf},
};

/// The part of the name that all these tests have in common.
pub const NAME: &str = "exhaustive::every_";

/// What they prove something about, from the root: all of the core's arithmetic, and the tests themselves.
const SOURCES: [&str; 2] = ["shared/src/math", "tests/tests/motion/sine_exhaustive.rs"];

/// The file that holds the checksum of the sources with which they last passed, from the root.
const PASSED: &str = "tests/tests/motion/sine_exhaustive.passed";

/// The CRC-32 of the names and contents of the sources, as hexadecimal digits and a line break.
///
/// # Errors
/// If a source cannot be read.
pub fn checksum(root: &Path) -> Result<String, Stop> {
    let mut files = Vec::new();
    SOURCES
        .iter()
        .try_for_each(|source| collect(&root.join(source), &mut files))
        .map_err(|error| Stop::failed(error.to_string()))?;
    files.sort();
    let mut hasher = crc32fast::Hasher::new();
    for file in files {
        let bytes = fs::read(&file).map_err(|error| Stop::failed(format!("{}: {error}", file.display())))?;
        hasher.update(file.strip_prefix(root).unwrap_or(&file).as_os_str().as_encoded_bytes());
        hasher.update(&bytes);
    }
    Ok(format!("{:08x}\n", hasher.finalize()))
}

/// Adds the files of a path: itself, or all below it.
fn collect(path: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    if path.is_dir() {
        return fs::read_dir(path)?.try_for_each(|entry| collect(&entry?.path(), files));
    }
    files.push(path.to_owned());
    Ok(())
}

/// Whether they have passed with the sources of that checksum.
pub fn passed(root: &Path, checksum: &str) -> bool {
    fs::read_to_string(root.join(PASSED)).is_ok_and(|passed| passed == checksum)
}

/// Keeps the checksum of sources with which they have passed.
///
/// # Errors
/// If the file cannot be written.
pub fn keep(root: &Path, checksum: &str) -> Result<(), Stop> {
    fs::write(root.join(PASSED), checksum).map_err(|error| Stop::failed(format!("{PASSED}: {error}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_change_of_a_source_is_seen() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        let sine = root.join(SOURCES[0]).join("deeper/sine.rs");
        fs::create_dir_all(sine.parent().unwrap()).unwrap();
        fs::create_dir_all(root.join(SOURCES[1]).parent().unwrap()).unwrap();
        fs::write(root.join(SOURCES[1]), "test").unwrap();
        fs::write(&sine, "x").unwrap();
        let before = checksum(root).unwrap();
        assert!(!passed(root, &before));
        keep(root, &before).unwrap();
        assert!(passed(root, &checksum(root).unwrap()));
        fs::write(&sine, "y").unwrap();
        assert!(!passed(root, &checksum(root).unwrap()));
        fs::write(&sine, "x").unwrap();
        fs::rename(&sine, sine.with_file_name("cosine.rs")).unwrap();
        assert!(!passed(root, &checksum(root).unwrap()));
    }
}
