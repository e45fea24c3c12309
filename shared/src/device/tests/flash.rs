//! Flash in memory, for whatever tests a device: this crate, the tests of the workspace and a fuzz target have this file as a module.

use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashErrorKind, ReadNorFlash};
use std::vec;
use std::vec::Vec;

/// Room for two copies of the settings, so that it is soon full.
const SECTOR: usize = 1120;

/// Two sectors, written in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Flash {
    bytes: Vec<u8>,
    /// How often it has been written or erased.
    changes: u32,
    /// It takes nothing more.
    pub broken: bool,
}

impl Default for Flash {
    fn default() -> Flash {
        Flash { bytes: vec![0xff; 2 * SECTOR], changes: 0, broken: false }
    }
}

impl ErrorType for Flash {
    type Error = NorFlashErrorKind;
}

impl ReadNorFlash for Flash {
    const READ_SIZE: usize = 4;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), NorFlashErrorKind> {
        let from = offset as usize;
        bytes.copy_from_slice(&self.bytes[from..from + bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.bytes.len()
    }
}

impl NorFlash for Flash {
    const WRITE_SIZE: usize = 4;
    const ERASE_SIZE: usize = SECTOR;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), NorFlashErrorKind> {
        self.changes += 1;
        self.bytes[from as usize..to as usize].fill(0xff);
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), NorFlashErrorKind> {
        if self.broken {
            return Err(NorFlashErrorKind::Other);
        }
        self.changes += 1;
        for (place, byte) in self.bytes[offset as usize..].iter_mut().zip(bytes) {
            *place &= byte;
        }
        Ok(())
    }
}
