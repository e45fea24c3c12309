//! Sectors of the flash that are not the program's: see `memory.x`. They are programmed and erased by 32 bits at once, which the chip allows
//! above 2.7 V: below 2.8 V it is held in reset.

use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashErrorKind as Error, ReadNorFlash, check_erase, check_read, check_write,
};
use stm32f4xx_hal::flash::FlashExt;
use stm32f4xx_hal::pac;

/// The settings, in sectors 1 and 2, and which firmware has run, in sector 3.
pub type Settings = Storage<1, 3, 0x4000>;

/// The recordings of earthquakes, in sectors 6 to 11.
pub type Recordings = Storage<6, 6, 0x2_0000>;

const KEYS: [u32; 2] = [0x4567_0123, 0xCDEF_89AB];

/// First address of the flash.
const FLASH: u32 = 0x0800_0000;

/// Flags of errors, which writing 1 clears (RM0090, 3.9.6).
const ERRORS: u32 = 0xF2;

/// `SECTORS` sectors of `SECTOR` bytes each, from the one of number `FIRST` on.
pub struct Storage<const FIRST: u8, const SECTORS: u32, const SECTOR: u32> {
    flash: pac::FLASH,
    /// They have been changed since the caches were emptied.
    changed: bool,
}

impl<const FIRST: u8, const SECTORS: u32, const SECTOR: u32> Storage<FIRST, SECTORS, SECTOR> {
    /// Offset in the flash, of which only the first four sectors are small.
    const START: u32 = if FIRST < 4 { FIRST as u32 * 0x4000 } else { (FIRST as u32 - 4) * 0x2_0000 };

    /// To be called once for each; nothing else programs the flash.
    pub fn new() -> Self {
        // SAFETY: the application uses one after the other, in one task. Beside it only the start of the clocks uses the registers, for the
        // latency, which programming leaves alone.
        Storage { flash: unsafe { pac::FLASH::steal() }, changed: false }
    }

    /// What the caches hold of the sectors is old: they are emptied, which the chip allows only while they are off.
    fn forget_cached(&self) {
        let flash = &self.flash;
        let before = flash.acr().read();
        flash.acr().modify(|_, w| w.dcen().clear_bit().icen().clear_bit());
        flash.acr().modify(|_, w| w.dcrst().set_bit().icrst().set_bit());
        flash.acr().modify(|_, w| w.dcrst().clear_bit().icrst().clear_bit());
        flash.acr().modify(|_, w| w.dcen().bit(before.dcen().bit()).icen().bit(before.icen().bit()));
    }

    /// Does `work` with the registers unlocked.
    fn unlocked(&mut self, work: impl FnOnce(&pac::FLASH) -> Result<(), Error>) -> Result<(), Error> {
        self.changed = true;
        for key in KEYS {
            // SAFETY: the keys are what the register takes.
            self.flash.keyr().write(|w| unsafe { w.bits(key) });
        }
        // SAFETY: writing 1 clears these flags and does nothing else.
        self.flash.sr().write(|w| unsafe { w.bits(ERRORS) });
        let done = work(&self.flash);
        self.flash.cr().modify(|_, w| w.pg().clear_bit().ser().clear_bit().lock().set_bit());
        done
    }

    /// Waits for the end of what the flash does; its errors.
    fn finish(flash: &pac::FLASH) -> Result<(), Error> {
        while flash.sr().read().bsy().bit_is_set() {}
        if flash.sr().read().bits() & ERRORS == 0 { Ok(()) } else { Err(Error::Other) }
    }
}

impl<const FIRST: u8, const SECTORS: u32, const SECTOR: u32> ErrorType for Storage<FIRST, SECTORS, SECTOR> {
    type Error = Error;
}

impl<const FIRST: u8, const SECTORS: u32, const SECTOR: u32> ReadNorFlash for Storage<FIRST, SECTORS, SECTOR> {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Error> {
        check_read(self, offset, bytes.len())?;
        if core::mem::take(&mut self.changed) {
            self.forget_cached();
        }
        let start = (Self::START + offset) as usize;
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

impl<const FIRST: u8, const SECTORS: u32, const SECTOR: u32> NorFlash for Storage<FIRST, SECTORS, SECTOR> {
    const WRITE_SIZE: usize = 4;
    const ERASE_SIZE: usize = SECTOR as usize;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Error> {
        check_erase(self, from, to)?;
        self.unlocked(|flash| {
            (from / SECTOR..to / SECTOR).try_for_each(|sector| {
                // SAFETY: the sector exists, and is not the program's.
                flash.cr().modify(|_, w| unsafe { w.psize().psize32().ser().set_bit().snb().bits(FIRST + sector as u8) });
                flash.cr().modify(|_, w| w.strt().set_bit());
                Self::finish(flash)
            })
        })
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Error> {
        check_write(self, offset, bytes.len())?;
        self.unlocked(|flash| {
            flash.cr().modify(|_, w| w.psize().psize32().pg().set_bit());
            (offset..).step_by(4).zip(bytes.chunks_exact(4)).try_for_each(|(offset, bytes)| {
                let word = bytes.iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte));
                let place = (FLASH + Self::START + offset) as *mut u32;
                // SAFETY: within sectors that are not the program's, and aligned.
                unsafe { place.write_volatile(word) };
                Self::finish(flash)
            })
        })
    }
}
