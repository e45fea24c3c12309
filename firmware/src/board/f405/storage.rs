//! Sectors 1 to 3 of the flash, for the settings and for which firmware has run: see `memory.x`.

use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash};
use stm32f4xx_hal::flash::{FlashExt, LockedFlash};
use stm32f4xx_hal::pac;

/// Offset of sector 1 in the flash.
const START: u32 = 0x4000;
/// Bytes of a sector.
const SECTOR: u32 = 0x4000;
/// Number of the first sector.
const FIRST: u8 = 1;
/// How many there are.
const SECTORS: u32 = 3;

/// The sectors.
pub struct Storage {
    flash: LockedFlash,
    /// They have been changed since the caches were emptied.
    changed: bool,
}

/// What went wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error {
    /// Beyond the sectors.
    OutOfBounds,
    /// Not at whole words, or not of whole sectors.
    NotAligned,
    /// The flash did not take it.
    Refused,
}

impl NorFlashError for Error {
    fn kind(&self) -> NorFlashErrorKind {
        match self {
            Error::OutOfBounds => NorFlashErrorKind::OutOfBounds,
            Error::NotAligned => NorFlashErrorKind::NotAligned,
            Error::Refused => NorFlashErrorKind::Other,
        }
    }
}

impl Storage {
    /// Of a chip whose flash nothing else programs.
    pub fn new() -> Storage {
        // SAFETY: the application calls the board's `flash` once. Beside it only the start of the clocks uses the registers, for the
        // latency, which programming leaves alone.
        Storage { flash: LockedFlash::new(unsafe { pac::FLASH::steal() }), changed: false }
    }

    fn within(from: u32, length: usize) -> Result<(), Error> {
        let inside =
            u32::try_from(length).ok().and_then(|length| from.checked_add(length)).is_some_and(|end| end <= SECTORS * SECTOR);
        if inside { Ok(()) } else { Err(Error::OutOfBounds) }
    }

    /// What the caches hold of the sectors is old: they are emptied, which the chip allows only while they are off.
    fn forget_cached() {
        // SAFETY: as in `new`.
        let flash = unsafe { pac::FLASH::steal() };
        let before = flash.acr().read();
        flash.acr().modify(|_, w| w.dcen().clear_bit().icen().clear_bit());
        flash.acr().modify(|_, w| w.dcrst().set_bit().icrst().set_bit());
        flash.acr().modify(|_, w| w.dcrst().clear_bit().icrst().clear_bit());
        flash.acr().modify(|_, w| w.dcen().bit(before.dcen().bit()).icen().bit(before.icen().bit()));
    }
}

impl ErrorType for Storage {
    type Error = Error;
}

impl ReadNorFlash for Storage {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Error> {
        Storage::within(offset, bytes.len())?;
        if core::mem::take(&mut self.changed) {
            Storage::forget_cached();
        }
        let start = (START + offset) as usize;
        let stored = FlashExt::read(&self.flash).get(start..start + bytes.len()).ok_or(Error::OutOfBounds)?;
        for (to, from) in bytes.iter_mut().zip(stored) {
            *to = *from;
        }
        Ok(())
    }

    fn capacity(&self) -> usize {
        (SECTORS * SECTOR) as usize
    }
}

impl NorFlash for Storage {
    const WRITE_SIZE: usize = 4;
    const ERASE_SIZE: usize = SECTOR as usize;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Error> {
        Storage::within(from, to.checked_sub(from).ok_or(Error::OutOfBounds)? as usize)?;
        if !(from.is_multiple_of(SECTOR) && to.is_multiple_of(SECTOR)) {
            return Err(Error::NotAligned);
        }
        self.changed = true;
        let mut flash = self.flash.unlocked();
        let done = (from / SECTOR..to / SECTOR).all(|sector| flash.erase(FIRST + sector as u8).is_ok());
        if done { Ok(()) } else { Err(Error::Refused) }
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Error> {
        Storage::within(offset, bytes.len())?;
        if !(offset.is_multiple_of(4) && bytes.len().is_multiple_of(4)) {
            return Err(Error::NotAligned);
        }
        self.changed = true;
        self.flash.unlocked().program((START + offset) as usize, bytes.iter()).map_err(|_| Error::Refused)
    }
}
