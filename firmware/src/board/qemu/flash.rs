//! Three sectors of flash, played by memory that a reset does not clear, which can lose power in the middle of a write.

use core::cell::UnsafeCell;
use core::sync::atomic::{AtomicU32, Ordering};

use super::lose_power;
use crate::memory::Lasting;
use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash};

/// Bytes of a sector; the board's have 16 KiB, which would only take longer to fill.
const SECTOR: usize = 4096;
/// Of all.
const BYTES: usize = 3 * SECTOR;

/// Memory holds this from the first start on.
const USED: u32 = 0xF1A5_4000;

/// No power cut is due.
const NEVER: u32 = u32::MAX;

#[unsafe(link_section = ".uninit.FLASH_MARK")]
static MARK: Lasting<u32> = Lasting::new();

struct Sectors(UnsafeCell<[u8; BYTES]>);

// SAFETY: there is one `Flash`, and only it looks inside.
unsafe impl Sync for Sectors {}

#[unsafe(link_section = ".uninit.FLASH")]
static SECTORS: Sectors = Sectors(UnsafeCell::new([0; BYTES]));

/// Bytes that will still be written before the supply fails.
static LEFT: AtomicU32 = AtomicU32::new(NEVER);

/// Lets the supply fail after so many more bytes have been written.
pub fn cut_power_after(bytes: u32) {
    LEFT.store(bytes, Ordering::Relaxed);
}

/// The flash.
pub struct Flash(());

impl Flash {
    /// To be called once.
    pub fn new() -> Flash {
        let mut flash = Flash(());
        // SAFETY: a word holds any bits.
        if unsafe { MARK.read() } != USED {
            flash.bytes().fill(0xFF);
            MARK.write(USED);
        }
        flash
    }

    fn bytes(&mut self) -> &mut [u8; BYTES] {
        // SAFETY: there is one `Flash`, borrowed for as long as the bytes are.
        unsafe { &mut *SECTORS.0.get() }
    }
}

/// Outside of the sectors.
#[derive(Debug)]
pub struct OutOfBounds;

impl NorFlashError for OutOfBounds {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::OutOfBounds
    }
}

impl ErrorType for Flash {
    type Error = OutOfBounds;
}

impl ReadNorFlash for Flash {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), OutOfBounds> {
        let start = offset as usize;
        let from = self.bytes().get(start..start.saturating_add(bytes.len())).ok_or(OutOfBounds)?;
        bytes.copy_from_slice(from);
        Ok(())
    }

    fn capacity(&self) -> usize {
        BYTES
    }
}

impl NorFlash for Flash {
    const WRITE_SIZE: usize = 1;
    const ERASE_SIZE: usize = SECTOR;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), OutOfBounds> {
        self.bytes().get_mut(from as usize..to as usize).ok_or(OutOfBounds)?.fill(0xFF);
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), OutOfBounds> {
        let start = offset as usize;
        let into = self.bytes().get_mut(start..start.saturating_add(bytes.len())).ok_or(OutOfBounds)?;
        for (into, byte) in into.iter_mut().zip(bytes) {
            let left = LEFT.load(Ordering::Relaxed);
            if left == 0 {
                LEFT.store(NEVER, Ordering::Relaxed);
                lose_power();
            }
            if left != NEVER {
                LEFT.store(left - 1, Ordering::Relaxed);
            }
            // Programming clears bits and sets none.
            *into &= byte;
        }
        Ok(())
    }
}
