//! What the firmware in the emulator logs, decoded.

use std::fs;
use std::path::{Path, PathBuf};

use defmt_decoder::{DecodeError, Locations, Table};

use super::line::DeviceError;

/// A log on its way: where the firmware writes it, and what it needs to be read.
pub struct Log {
    table: Table,
    locations: Option<Locations>,
    folder: tempfile::TempDir,
}

impl Log {
    /// Log of the firmware in `image`.
    ///
    /// # Errors
    /// [`DeviceError::Build`] where it was built without logs, or for another version of them.
    pub fn new(image: &Path) -> Result<Log, DeviceError> {
        let failed = |error: &dyn std::fmt::Display| DeviceError::Build(format!("{}: {error}", image.display()));
        let bytes = fs::read(image).map_err(|error| failed(&error))?;
        let table = Table::parse(&bytes).map_err(|error| failed(&error))?;
        let table = table.ok_or_else(|| failed(&"built without logs: --features log"))?;
        let locations = table.get_locations(&bytes).ok();
        let folder = tempfile::tempdir().map_err(|error| failed(&error))?;
        Ok(Log { table, locations, folder })
    }

    /// The file into which the firmware writes.
    pub fn path(&self) -> PathBuf {
        self.folder.path().join("log")
    }

    /// One line for each entry.
    ///
    /// # Errors
    /// [`DeviceError::Build`] for bytes that are no log of this image.
    pub fn read(&self) -> Result<Vec<String>, DeviceError> {
        let bytes = fs::read(self.path()).unwrap_or_default();
        let mut decoder = self.table.new_stream_decoder();
        decoder.received(&bytes);
        let mut lines = Vec::new();
        loop {
            match decoder.decode() {
                Ok(frame) => {
                    let place = self.locations.as_ref().and_then(|locations| locations.get(&frame.index()));
                    let place = place.map_or_else(String::new, |place| {
                        let file = place.file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
                        format!(" ({file}:{})", place.line)
                    });
                    lines.push(format!("{}{place}", frame.display(false)));
                }
                Err(DecodeError::UnexpectedEof) => return Ok(lines),
                Err(DecodeError::Malformed) if self.table.encoding().can_recover() => {}
                Err(DecodeError::Malformed) => return Err(DeviceError::Build("its log cannot be decoded".to_owned())),
            }
        }
    }
}
