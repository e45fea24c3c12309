//! Writing results: beside their place first, then renamed into it, so that nothing half-written is ever left there.
//!
//! Nothing is lost:
//! - Links are followed, an existing file keeps its mode, and a read-only one is refused, whoever asks.
//! - Devices and pipes are written through, as every program does.
//! - An input of a command is never its output.
//! - Results are replaced only by those of the same command and the same input ([`Subject`]: scene or study as resolved, options that change
//!   results, contents of the files that are read), and else where `--overwrite` asks for it, then all of them. [`ResultFolder`] finds out by `summary.json`,
//!   [`claim_file`] by the file itself. A file that Sprag did not write is another's.

use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;

mod folder;
mod formats;
mod picture;
mod same_file;
mod subject;
mod summary;
mod table;
mod target;

#[cfg(test)]
mod tests;

pub use folder::{Claim, ResultFolder, remove_empty_folders};
pub use formats::{Formats, FormatsError};
pub use same_file::{is_at, is_standard_output};
pub use subject::{Digest, Subject, difference};
pub use summary::{Maker, SCHEMA_VERSION, Summary, VERSION, Versioned};
pub use table::RowTaker;
use target::Written;
pub use target::{claim_file, open_stream, remove_unfinished};

/// What to do about results that are there.
const REPLACE: &str = "--overwrite replaces it, or give another place for the new one";

fn is_input(input: &Path) -> String {
    format!("cannot be written: it is {}, which the command reads; give another place", input.display())
}

/// A result that could not be written.
#[derive(Debug, thiserror::Error)]
#[error("{}: {reason}", path.display())]
pub struct OutputError {
    /// The file or folder.
    pub path: PathBuf,
    /// Reason, in words.
    pub reason: String,
}

impl OutputError {
    /// The result at `path`, for `error`.
    pub fn new(path: &Path, error: &io::Error) -> OutputError {
        OutputError { path: path.to_owned(), reason: format!("cannot be written: {error}") }
    }
}

/// Files of one command that appear together, once all of them are written.
#[derive(Debug, Default)]
pub struct Results {
    /// With the places that were asked for.
    files: Vec<(PathBuf, Written)>,
    /// Files of the results before that would contradict these.
    obsolete: Vec<PathBuf>,
    notes: Vec<String>,
}

impl Results {
    /// Writes `path` through `fill`, beside its place for now.
    ///
    /// # Errors
    /// [`OutputError`] when the folder cannot be written, or the disk is full.
    pub fn add(
        &mut self,
        path: &Path,
        fill: impl FnOnce(&mut BufWriter<&mut std::fs::File>) -> io::Result<()>,
    ) -> Result<(), OutputError> {
        self.add_by(path, |file| fill(file).map_err(|error| OutputError::new(path, &error)))
    }

    /// Writes `path` through `fill`, which fails for reasons of its own too, as [`Results::add`] does.
    ///
    /// # Errors
    /// Those of `fill` and of [`Results::add`].
    pub fn add_by<E: From<OutputError>>(
        &mut self,
        path: &Path,
        fill: impl FnOnce(&mut BufWriter<&mut std::fs::File>) -> Result<(), E>,
    ) -> Result<(), E> {
        let failed = |error: io::Error| OutputError::new(path, &error);
        let mut written = Written::new(path)?;
        let mut writer = BufWriter::new(written.file());
        fill(&mut writer)?;
        writer.flush().map_err(failed)?;
        drop(writer);
        written.seal().map_err(failed)?;
        self.files.push((path.to_owned(), written));
        Ok(())
    }

    /// Writes `value` to `path` as JSON for people, as [`Results::add`] does.
    ///
    /// # Errors
    /// A value that has no JSON, and those of [`Results::add`].
    pub fn add_json(&mut self, path: &Path, value: &impl Serialize) -> Result<(), OutputError> {
        self.add(path, |file| {
            serde_json::to_writer_pretty(&mut *file, value).map_err(io::Error::other)?;
            file.write_all(b"\n")
        })
    }

    /// Removes the file at `path`, if there is one and it is not written anew, when the others are put in their places: it would contradict
    /// them.
    pub fn remove(&mut self, path: PathBuf) {
        self.obsolete.push(path);
    }

    /// Puts every file in its place.
    ///
    /// # Errors
    /// [`OutputError`] when a file cannot be renamed.
    pub fn commit(self) -> Result<(), OutputError> {
        for path in self.obsolete.into_iter().filter(|path| self.files.iter().all(|(written, _)| written != path)) {
            match std::fs::remove_file(&path) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(OutputError::new(&path, &error)),
                _ => {}
            }
        }
        self.files.into_iter().try_for_each(|(_, written)| written.commit())
    }

    /// Puts every file in its place, and writes to `err` what the reader of the files should know, in a line each.
    ///
    /// # Errors
    /// The errors of [`Results::commit`].
    pub fn commit_with_notes(mut self, err: &mut impl Write) -> Result<(), OutputError> {
        let notes = std::mem::take(&mut self.notes);
        self.commit()?;
        for note in notes {
            let _ = writeln!(err, "sprag: {note}");
        }
        Ok(())
    }
}
