//! In a program without serial ports there are devices in the emulator only.

use sprag_report::part::Missing;

use super::line::{DeviceError, Line};
use crate::part::SERIAL;

/// Refuses to open a port.
///
/// # Errors
/// [`DeviceError::Port`].
pub fn open(name: &str) -> Result<Box<dyn Line>, DeviceError> {
    Err(DeviceError::Port { port: name.to_owned(), reason: Missing(SERIAL).to_string() })
}
