//! Checks that depend on a few files alone: run when these have changed since they last passed, and every night.

use crate::stop::Stop;
use std::{
    fs, io,
    path::{Path, PathBuf},
};

/// Such checks.
#[derive(Debug)]
pub struct Passed {
    /// All that they depend on: files and folders, from the root.
    pub sources: &'static [&'static str],
    /// The file that holds the checksum of the sources with which they last passed, from the root.
    pub file: &'static str,
}

impl Passed {
    /// Runs `check` and keeps that it passed, unless it has passed with these sources and not `all` shall run. It gives whether it could
    /// check at all.
    ///
    /// # Errors
    /// The errors of the check, or if a file cannot be read or written.
    pub fn or(&self, root: &Path, all: bool, check: impl FnOnce() -> Result<bool, Stop>) -> Result<(), Stop> {
        let checksum = self.checksum(root)?;
        if !all && self.holds(root, &checksum) {
            println!("-- not run: passed with the same sources before");
            return Ok(());
        }
        if check()? { self.keep(root, &checksum) } else { Ok(()) }
    }

    /// The CRC-32 of the names and contents of the sources, as hexadecimal digits and a line break.
    ///
    /// # Errors
    /// If a source cannot be read.
    pub fn checksum(&self, root: &Path) -> Result<String, Stop> {
        let mut files = Vec::new();
        self.sources
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

    /// Whether they have passed with the sources of that checksum.
    pub fn holds(&self, root: &Path, checksum: &str) -> bool {
        fs::read_to_string(root.join(self.file)).is_ok_and(|passed| passed == checksum)
    }

    /// Keeps the checksum of sources with which they have passed.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn keep(&self, root: &Path, checksum: &str) -> Result<(), Stop> {
        fs::write(root.join(self.file), checksum).map_err(|error| Stop::failed(format!("{}: {error}", self.file)))
    }
}

/// Adds the files of a path: itself, or all below it.
fn collect(path: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    if path.is_dir() {
        return fs::read_dir(path)?.try_for_each(|entry| collect(&entry?.path(), files));
    }
    files.push(path.to_owned());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const CHECKS: Passed = Passed { sources: &["math", "test.rs"], file: "checks.passed" };

    /// Whether they would run.
    fn runs(root: &Path, all: bool, checked: bool) -> bool {
        let mut run = false;
        CHECKS
            .or(root, all, || {
                run = true;
                Ok(checked)
            })
            .unwrap();
        run
    }

    #[test]
    fn any_change_of_a_source_is_seen() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        let sine = root.join("math/deeper/sine.rs");
        fs::create_dir_all(sine.parent().unwrap()).unwrap();
        fs::write(root.join("test.rs"), "test").unwrap();
        fs::write(&sine, "x").unwrap();
        assert!(runs(root, false, true));
        assert!(!runs(root, false, true));
        fs::write(&sine, "y").unwrap();
        assert!(runs(root, false, true));
        fs::rename(&sine, sine.with_file_name("cosine.rs")).unwrap();
        assert!(runs(root, false, true));
        assert!(runs(root, true, true));
    }

    #[test]
    fn what_failed_or_could_not_be_checked_has_not_passed() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        fs::create_dir(root.join("math")).unwrap();
        fs::write(root.join("test.rs"), "test").unwrap();
        assert!(runs(root, false, false));
        assert!(CHECKS.or(root, false, || Err(Stop::failed("wrong"))).is_err());
        assert!(runs(root, false, true));
    }
}
