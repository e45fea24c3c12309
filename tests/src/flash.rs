//! Flash in memory, for a [`Store`](sprag_shared::settings::store::Store) on the host.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashErrorKind, ReadNorFlash};

const SECTOR: usize = 4096;

/// Two sectors, written in words.
#[derive(Clone, Debug)]
pub struct Flash {
    bytes: Vec<u8>,
    changes: Arc<AtomicU32>,
}

impl Default for Flash {
    fn default() -> Flash {
        Flash { bytes: vec![0xff; 2 * SECTOR], changes: Arc::default() }
    }
}

impl Flash {
    /// How often it has been written or erased, also for whoever has handed it over.
    pub fn changes(&self) -> Arc<AtomicU32> {
        self.changes.clone()
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
        self.changes.fetch_add(1, Ordering::Relaxed);
        self.bytes[from as usize..to as usize].fill(0xff);
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), NorFlashErrorKind> {
        self.changes.fetch_add(1, Ordering::Relaxed);
        for (place, byte) in self.bytes[offset as usize..].iter_mut().zip(bytes) {
            *place &= byte;
        }
        Ok(())
    }
}
