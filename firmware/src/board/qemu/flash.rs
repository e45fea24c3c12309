//! Flash, played by memory that a reset does not clear, which can lose power in the middle of a write.

use core::cell::UnsafeCell;
use core::sync::atomic::{AtomicU32, Ordering};

use super::lose_power;
use crate::memory::Lasting;
use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashErrorKind as Error, ReadNorFlash};

/// Bytes of a sector; the board's have 16 KiB, which would only take longer to fill.
const SECTOR: usize = 4096;

/// Memory holds this from the first start on.
const USED: u32 = 0xF1A5_4000;

/// No power cut is due.
const NEVER: u32 = u32::MAX;

/// Sectors for the settings and which firmware has run, and for recordings: as many as fit into the memory.
const SETTINGS: usize = 3;
const RECORDINGS: usize = 14;

struct Sectors<const COUNT: usize> {
    mark: Lasting<u32>,
    bytes: UnsafeCell<[[u8; SECTOR]; COUNT]>,
}

// SAFETY: there is one `Flash` of each, and only it looks inside.
unsafe impl<const COUNT: usize> Sync for Sectors<COUNT> {}

impl<const COUNT: usize> Sectors<COUNT> {
    const fn new() -> Sectors<COUNT> {
        Sectors { mark: Lasting::new(), bytes: UnsafeCell::new([[0; SECTOR]; COUNT]) }
    }
}

#[unsafe(link_section = ".uninit.FLASH")]
static OF_SETTINGS: Sectors<SETTINGS> = Sectors::new();

#[unsafe(link_section = ".uninit.RECORDINGS")]
static OF_RECORDINGS: Sectors<RECORDINGS> = Sectors::new();

/// Bytes that will still be written before the supply fails.
static LEFT: AtomicU32 = AtomicU32::new(NEVER);

/// Lets the supply fail after so many more bytes have been written.
pub fn cut_power_after(bytes: u32) {
    LEFT.store(bytes, Ordering::Relaxed);
}

/// A flash of so many sectors.
pub struct Flash<const COUNT: usize>(&'static Sectors<COUNT>);

/// That of the settings.
pub type Settings = Flash<SETTINGS>;

/// That of the recordings.
pub type Recordings = Flash<RECORDINGS>;

/// The flash of the settings. To be called once.
pub fn settings() -> Settings {
    Flash::of(&OF_SETTINGS)
}

/// The flash of the recordings. To be called once.
pub fn recordings() -> Recordings {
    Flash::of(&OF_RECORDINGS)
}

impl<const COUNT: usize> Flash<COUNT> {
    fn of(sectors: &'static Sectors<COUNT>) -> Flash<COUNT> {
        let mut flash = Flash(sectors);
        // SAFETY: a word holds any bits.
        if unsafe { sectors.mark.read() } != USED {
            flash.bytes().fill(0xFF);
            sectors.mark.write(USED);
        }
        flash
    }

    fn bytes(&mut self) -> &mut [u8] {
        // SAFETY: there is one of each, borrowed for as long as the bytes are.
        unsafe { &mut *self.0.bytes.get() }.as_flattened_mut()
    }
}

impl<const COUNT: usize> ErrorType for Flash<COUNT> {
    type Error = Error;
}

impl<const COUNT: usize> ReadNorFlash for Flash<COUNT> {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Error> {
        let start = offset as usize;
        let from = self.bytes().get(start..start.saturating_add(bytes.len())).ok_or(Error::OutOfBounds)?;
        bytes.copy_from_slice(from);
        Ok(())
    }

    fn capacity(&self) -> usize {
        COUNT * SECTOR
    }
}

impl<const COUNT: usize> NorFlash for Flash<COUNT> {
    const WRITE_SIZE: usize = 1;
    const ERASE_SIZE: usize = SECTOR;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Error> {
        self.bytes().get_mut(from as usize..to as usize).ok_or(Error::OutOfBounds)?.fill(0xFF);
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Error> {
        let start = offset as usize;
        let into = self.bytes().get_mut(start..start.saturating_add(bytes.len())).ok_or(Error::OutOfBounds)?;
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
