//! A board on a serial port.

use std::io::ErrorKind;
use std::time::Duration;

use serialport::SerialPort;
use sprag_shared::link::Pace;

use super::line::{DeviceError, Line};

/// Bits a second of the board's link.
const BAUD: u32 = 921_600;

/// Opens a port by the system's name for it.
///
/// # Errors
/// [`DeviceError::Port`].
pub fn open(name: &str) -> Result<Box<dyn Line>, DeviceError> {
    let port = serialport::new(name, BAUD).open();
    let port = port.map_err(|error| DeviceError::Port { port: name.to_owned(), reason: plain(&error) })?;
    Ok(Box::new(Serial { port, name: name.to_owned() }))
}

/// An open port.
struct Serial {
    port: Box<dyn SerialPort>,
    name: String,
}

impl Serial {
    fn failed(&self, reason: &dyn std::fmt::Display) -> DeviceError {
        DeviceError::Port { port: self.name.clone(), reason: reason.to_string() }
    }
}

/// Why a port cannot be opened; systems speak of typewriters and ioctls where a file is no port.
fn plain(error: &serialport::Error) -> String {
    let text = error.to_string();
    if ["typewriter", "ioctl"].iter().any(|word| text.contains(word)) { "is not a serial port".to_owned() } else { text }
}

impl Line for Serial {
    fn send(&mut self, bytes: &[u8]) -> Result<(), DeviceError> {
        std::io::Write::write_all(&mut self.port, bytes).map_err(|error| self.failed(&error))
    }

    fn receive(&mut self, patience: Duration) -> Result<Vec<u8>, DeviceError> {
        self.port.set_timeout(patience).map_err(|error| self.failed(&error))?;
        let mut bytes = [0; 1024];
        match std::io::Read::read(&mut self.port, &mut bytes) {
            Ok(count) => Ok(bytes[..count].to_vec()),
            Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted) => {
                Ok(Vec::new())
            }
            Err(error) => Err(self.failed(&error)),
        }
    }

    fn pace(&self) -> Pace {
        Pace::Sample
    }
}
