//! In a program that cannot decode logs there are none.

use std::path::{Path, PathBuf};

use sprag_report::part::Missing;

use super::line::DeviceError;
use crate::part::DEFMT;

/// A log on its way: there is none.
pub enum Log {}

impl Log {
    /// Refuses to read that of the firmware in `image`.
    ///
    /// # Errors
    /// [`DeviceError::Image`].
    pub fn new(image: &Path) -> Result<Log, DeviceError> {
        Err(DeviceError::Image { path: image.to_owned(), reason: Missing(DEFMT).to_string() })
    }

    /// Never called.
    pub fn path(&self) -> PathBuf {
        match *self {}
    }

    /// Never called.
    ///
    /// # Errors
    /// None.
    pub fn read(&self) -> Result<Vec<String>, DeviceError> {
        match *self {}
    }
}
