//! Bank 2 of the flash, for the settings, which firmware has run and the recordings: see `memory.x`.
//!
//! The flash programs double words, each once, with check bits. A word of the settings takes a double word of its own, beside its
//! complement, so that a sector of 16 KiB is 16 pages of 2 KiB; recordings, whose pages have checksums, are written as they are. Bank 1, from
//! which the processor runs, is free meanwhile.

use core::sync::atomic::{AtomicBool, Ordering};

use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashErrorKind as Error, ReadNorFlash, check_erase, check_read, check_write,
};
use stm32g4::stm32g474 as pac;

/// First address of the flash, and of its bank 2.
const FLASH: u32 = 0x0800_0000;
const BANK_2: u32 = 0x0804_0000;
/// Bytes of a page.
const PAGE: u32 = 2048;
/// Bytes of a sector, as the store sees it, …
const SECTOR: u32 = 0x4000;
/// … and in the flash.
const SECTOR_IN_FLASH: u32 = 2 * SECTOR;
/// How many there are.
const SECTORS: u32 = 3;

const KEYS: [u32; 2] = [0x4567_0123, 0xCDEF_89AB];

/// Offset in bank 2 at which recordings begin, and its end.
const RECORDINGS: u32 = SECTORS * SECTOR_IN_FLASH;
const BANK: u32 = 0x4_0000;

/// A double word had more wrong bits than its check bits can mend.
static BROKEN: AtomicBool = AtomicBool::new(false);

fn flash() -> &'static pac::flash::RegisterBlock {
    // SAFETY: the block lies at this address for ever. Beside the storage only the start writes its registers, before there is one.
    unsafe { &*pac::FLASH::ptr() }
}

/// The address of a double word that was found broken, if one was.
pub fn broken_word() -> Option<u32> {
    let found = flash().eccr().read();
    let bank = if found.bk_ecc().bit_is_set() { BANK_2 } else { FLASH };
    found.eccd().bit_is_set().then(|| bank + found.addr_ecc().bits())
}

/// Whether an address is in bank 2, which is all settings and recordings.
pub fn holds(address: u32) -> bool {
    (BANK_2..BANK_2 + BANK).contains(&address)
}

/// The word that is being read is broken.
pub fn note_broken() {
    BROKEN.store(true, Ordering::Relaxed);
    flash().eccr().modify(|_, w| w.eccd().set_bit());
}

/// The sectors.
pub struct Storage {
    /// They have been changed since the cache was emptied.
    changed: bool,
}

impl Storage {
    /// Of a chip whose flash nothing else programs.
    pub fn new() -> Storage {
        Storage { changed: false }
    }

    /// The word at an offset, if it is as it was programmed.
    fn word(offset: u32) -> Result<u32, Error> {
        match double(2 * offset) {
            Some([u32::MAX, u32::MAX]) => Ok(u32::MAX),
            Some([word, other]) if other == !word => Ok(word),
            _ => Err(Error::Other),
        }
    }
}

/// Does `work` with the registers unlocked, unless the flash is one bank (option DBANK).
fn unlocked(work: impl FnOnce(&'static pac::flash::RegisterBlock) -> Result<(), Error>) -> Result<(), Error> {
    let flash = flash();
    if flash.optr().read().dbank().bit_is_clear() {
        return Err(Error::Other);
    }
    for key in KEYS {
        // SAFETY: the keys are what the register takes.
        flash.keyr().write(|w| unsafe { w.bits(key) });
    }
    let done = work(flash);
    flash.cr().modify(|_, w| w.lock().set_bit());
    done
}

/// Clears the flags of errors by writing 1.
fn clear(flash: &pac::flash::RegisterBlock) {
    // SAFETY: writing back what was read clears the flags that were set.
    flash.sr().modify(|r, w| unsafe { w.bits(r.bits()) });
}

/// Waits for the end of what the flash does; its errors.
fn finish(flash: &pac::flash::RegisterBlock) -> Result<(), Error> {
    while flash.sr().read().bsy().bit_is_set() {}
    let state = flash.sr().read();
    let refused = state.progerr().bit_is_set()
        || state.wrperr().bit_is_set()
        || state.pgaerr().bit_is_set()
        || state.sizerr().bit_is_set()
        || state.pgserr().bit_is_set();
    if refused { Err(Error::Other) } else { Ok(()) }
}

/// Erases pages of bank 2.
fn erase_pages(pages: core::ops::Range<u32>) -> Result<(), Error> {
    unlocked(|flash| {
        let done = pages.into_iter().try_for_each(|page| {
            clear(flash);
            // SAFETY: the page exists.
            flash.cr().modify(|_, w| unsafe { w.per().set_bit().bker().set_bit().pnb().bits(page as u8) });
            flash.cr().modify(|_, w| w.strt().set_bit());
            finish(flash)
        });
        flash.cr().modify(|_, w| w.per().clear_bit().bker().clear_bit());
        done
    })
}

/// Programs double words from an offset in bank 2 on.
fn program(offset: u32, doubles: impl Iterator<Item = [u32; 2]>) -> Result<(), Error> {
    unlocked(|flash| {
        clear(flash);
        flash.cr().modify(|_, w| w.pg().set_bit());
        let done = (offset..).step_by(8).zip(doubles).try_for_each(|(offset, [first, second])| {
            let place = (BANK_2 + offset) as *mut u32;
            // SAFETY: within bank 2, where no program is, and aligned to 8 bytes; the flash takes both halves together.
            unsafe {
                place.write_volatile(first);
                place.add(1).write_volatile(second);
            }
            finish(flash)
        });
        flash.cr().modify(|_, w| w.pg().clear_bit());
        done
    })
}

/// Four bytes as a word.
fn word_of(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte))
}

/// The double word at an offset in bank 2; nothing where its check bits cannot mend it.
fn double(offset: u32) -> Option<[u32; 2]> {
    let place = (BANK_2 + offset) as *const u32;
    BROKEN.store(false, Ordering::Relaxed);
    // SAFETY: within the flash, aligned, and any bits are words.
    let double = unsafe { [place.read_volatile(), place.add(1).read_volatile()] };
    // The NMI comes with the word, or soon after it.
    let broken = broken_word().is_some() || BROKEN.load(Ordering::Relaxed);
    (!broken).then_some(double)
}

/// What the cache holds of bank 2 is old: it is emptied, which the chip allows only while it is off.
fn forget_cached() {
    let acr = flash().acr();
    acr.modify(|_, w| w.dcen().clear_bit());
    acr.modify(|_, w| w.dcrst().set_bit());
    acr.modify(|_, w| w.dcrst().clear_bit());
    acr.modify(|_, w| w.dcen().set_bit());
}

impl ErrorType for Storage {
    type Error = Error;
}

impl ReadNorFlash for Storage {
    const READ_SIZE: usize = 4;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Error> {
        check_read(self, offset, bytes.len())?;
        if core::mem::take(&mut self.changed) {
            forget_cached();
        }
        for (place, to) in (offset..).step_by(4).zip(bytes.chunks_exact_mut(4)) {
            to.copy_from_slice(&Storage::word(place)?.to_le_bytes());
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
        check_erase(self, from, to)?;
        self.changed = true;
        erase_pages(2 * from / PAGE..2 * to / PAGE)
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Error> {
        check_write(self, offset, bytes.len())?;
        self.changed = true;
        program(2 * offset, bytes.chunks_exact(4).map(word_of).map(|word| [word, !word]))
    }
}

/// The recordings of earthquakes: the rest of bank 2.
pub struct Recordings {
    /// They have been changed since the cache was emptied.
    changed: bool,
}

impl Recordings {
    /// Of a chip whose flash nothing else programs.
    pub fn new() -> Recordings {
        Recordings { changed: false }
    }
}

impl ErrorType for Recordings {
    type Error = Error;
}

impl ReadNorFlash for Recordings {
    const READ_SIZE: usize = 8;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Error> {
        check_read(self, offset, bytes.len())?;
        if core::mem::take(&mut self.changed) {
            forget_cached();
        }
        for (place, to) in (RECORDINGS + offset..).step_by(8).zip(bytes.chunks_exact_mut(8)) {
            let [first, second] = double(place).ok_or(Error::Other)?;
            to.iter_mut().zip(first.to_le_bytes().into_iter().chain(second.to_le_bytes())).for_each(|(to, byte)| *to = byte);
        }
        Ok(())
    }

    fn capacity(&self) -> usize {
        (BANK - RECORDINGS) as usize
    }
}

impl NorFlash for Recordings {
    const WRITE_SIZE: usize = 8;
    const ERASE_SIZE: usize = PAGE as usize;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Error> {
        check_erase(self, from, to)?;
        self.changed = true;
        erase_pages((RECORDINGS + from) / PAGE..(RECORDINGS + to) / PAGE)
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Error> {
        check_write(self, offset, bytes.len())?;
        self.changed = true;
        program(
            RECORDINGS + offset,
            bytes.chunks_exact(8).map(|double| {
                let (first, second) = double.split_at_checked(4).unwrap_or_default();
                [word_of(first), word_of(second)]
            }),
        )
    }
}
