//! Writing results: beside their place first, then renamed into it, so that nothing half-written is ever left there.

use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use tempfile::NamedTempFile;

mod formats;
mod picture;
mod same_file;
mod table;

pub use formats::{Formats, FormatsError};
pub use same_file::{is_at, is_standard_output, same_file};

/// A result that could not be written.
#[derive(Debug, thiserror::Error)]
#[error("{}: {reason}", path.display())]
pub struct OutputError {
    /// The file or folder.
    pub path: PathBuf,
    /// Why.
    pub reason: String,
}

impl OutputError {
    fn new(path: &Path, error: &io::Error) -> OutputError {
        OutputError { path: path.to_owned(), reason: format!("cannot be written: {error}") }
    }
}

/// Files of one command that appear together, once all of them are written.
#[derive(Debug, Default)]
pub struct Results {
    files: Vec<(NamedTempFile, PathBuf)>,
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
        let failed = |error: io::Error| OutputError::new(path, &error);
        if path.is_dir() {
            return Err(OutputError { path: path.to_owned(), reason: "cannot be written: it is a folder".to_owned() });
        }
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let mut builder = tempfile::Builder::new();
        // Temporary files are private by default; this one becomes the user's, as far as the umask allows.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let mut file = builder.prefix(".sprag-").tempfile_in(folder).map_err(|error| OutputError {
            path: path.to_owned(),
            reason: format!("cannot be written: its folder does not exist or may not be written ({})", error.kind()),
        })?;
        let mut writer = BufWriter::new(file.as_file_mut());
        fill(&mut writer).and_then(|()| writer.flush()).map_err(failed)?;
        drop(writer);
        file.as_file().sync_all().map_err(failed)?;
        self.files.push((file, path.to_owned()));
        Ok(())
    }

    /// Writes `value` to `path` as JSON for people, as [`Results::add`] does.
    ///
    /// # Errors
    /// As there.
    pub fn add_json(&mut self, path: &Path, value: &impl Serialize) -> Result<(), OutputError> {
        self.add(path, |file| {
            serde_json::to_writer_pretty(&mut *file, value).map_err(io::Error::other)?;
            file.write_all(b"\n")
        })
    }

    /// Puts every file in its place.
    ///
    /// # Errors
    /// [`OutputError`] when a file cannot be renamed.
    pub fn commit(self) -> Result<(), OutputError> {
        for (file, path) in self.files {
            file.persist(&path).map_err(|error| OutputError::new(&path, &error.error))?;
        }
        Ok(())
    }

    /// Puts every file in its place, and tells `err` what the reader of the files should know, in a line each.
    ///
    /// # Errors
    /// As [`Results::commit`].
    pub fn commit_telling(mut self, err: &mut impl Write) -> Result<(), OutputError> {
        let notes = std::mem::take(&mut self.notes);
        self.commit()?;
        for note in notes {
            let _ = writeln!(err, "sprag: {note}");
        }
        Ok(())
    }
}

/// Makes `folder` and those above it.
///
/// # Errors
/// [`OutputError`] when that is not possible.
pub fn make_folder(folder: &Path) -> Result<(), OutputError> {
    std::fs::create_dir_all(folder).map_err(|error| OutputError::new(folder, &error))
}
