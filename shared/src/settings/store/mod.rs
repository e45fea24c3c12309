//! Settings in flash, twice, so that a power cut at any instant leaves one good copy.
//!
//! Two sectors, each a row of slots of one copy: mark, layout, sequence number, words, and a CRC-32 over all of it. Storing programs the
//! next blank slot of the first sector and then of the second. Opening only reads, from the newest copy backward, and little: a start in
//! the middle of an earthquake cannot wait. Erasing stops the processor for longer than that, so only [`Store::make_room`] does it, when
//! somebody asks for it: a sector without room, after seeing to it that the other one holds the newest copy.

mod firmware;

use crc::{CRC_32_ISO_HDLC, Crc, Table};
use embedded_storage::nor_flash::NorFlash;

use super::{COUNT, LAYOUT, Settings};

/// At the beginning of a copy.
const MARK: u32 = u32::from_le_bytes(*b"SPRG");
/// Mark, layout, sequence number.
const HEADER: usize = 3;
/// Of a slot: header, words, CRC.
const SLOT_WORDS: usize = HEADER + COUNT + 1;
/// Length of a slot, bytes.
pub const SLOT_BYTES: u32 = 4 * SLOT_WORDS as u32;
const BLANK: u32 = u32::MAX;
/// A table of 1 KiB: a flash full of copies that have rotted is looked through in milliseconds, too.
pub(crate) static CRC: Crc<u32, Table<1>> = Crc::<u32, Table<1>>::new(&CRC_32_ISO_HDLC);

/// CRC-32 of words.
pub(super) fn checksum(words: &[u32]) -> u32 {
    let mut digest = CRC.digest();
    for word in words {
        digest.update(&word.to_le_bytes());
    }
    digest.finalize()
}

/// Reasons why settings were not stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StoreError {
    /// A sector has no blank slot. Nothing was changed; [`Store::make_room`] makes room.
    Full,
    /// The flash refused, or does not read as it was written. The settings in force before or these are found at the next boot.
    Flash,
}

/// What is known of a sector.
#[derive(Clone, Copy, Debug, Default)]
struct Sector {
    /// Sequence number and slot of what says that it is its newest copy; read back as good where this store wrote it or opened with it.
    newest: Option<(u32, u32)>,
    /// The first of its last slots, which begin blank.
    next: u32,
    /// This store has erased it.
    erased: bool,
}

/// The settings of a controller in the first two erase sectors of `F`, which is to have a write size of 1, 2 or 4 bytes.
#[derive(Clone, Debug)]
pub struct Store<F> {
    flash: F,
    sectors: [Sector; 2],
    /// Of the newest copy; 0 before the first.
    sequence: u32,
}

impl<F: NorFlash> Store<F> {
    /// Slots of a sector. Fails to compile for a flash that this store does not suit.
    const SLOTS: u32 = {
        assert!(4 % F::WRITE_SIZE == 0 && 4 % F::READ_SIZE == 0, "read and write in words");
        let slots = F::ERASE_SIZE as u32 / SLOT_BYTES;
        assert!(slots >= 2, "room for the copy in force and the next one");
        slots
    };

    /// Finds the newest good copy, and changes nothing: one word of each blank slot is read, and the copies from the newest one backward
    /// until one is good. `None` where there is no copy of this build's settings.
    pub fn open(flash: F) -> (Store<F>, Option<Settings>) {
        let mut store = Store { flash, sectors: [Sector::default(); 2], sequence: 0 };
        let mut below = [0, 1].map(|which| store.used(which));
        for (sector, next) in store.sectors.iter_mut().zip(below) {
            sector.next = next;
        }
        loop {
            let candidates = [0, 1].map(|which| store.copy_below(which, below));
            let [first, second] = candidates;
            // The first one where both are of an age.
            let (which, chosen) = if first.map(|(sequence, _)| sequence) >= second.map(|(sequence, _)| sequence) {
                (0, first)
            } else {
                (1, second)
            };
            let Some((sequence, slot)) = chosen else { return (store, None) };
            if let Some(settings) = store.load(which, slot) {
                store.sequence = sequence;
                for (sector, candidate) in store.sectors.iter_mut().zip(candidates) {
                    sector.newest = candidate;
                }
                return (store, Some(settings));
            }
            if let Some(below) = below.get_mut(which) {
                *below = slot;
            }
        }
    }

    /// Adds `settings` to both sectors. Programs blank flash only.
    pub fn store(&mut self, settings: &Settings) -> Result<(), StoreError> {
        if !(self.takes(0) && self.takes(1)) {
            return Err(StoreError::Full);
        }
        self.sequence = self.sequence.wrapping_add(1);
        self.append(0, self.sequence, settings)?;
        self.append(1, self.sequence, settings)
    }

    /// As [`Store::store`], but [makes room](Store::make_room) first where there is none.
    ///
    /// # Errors
    /// [`StoreError`]: a sector without room cannot be erased.
    pub fn store_erasing(&mut self, settings: &Settings) -> Result<(), StoreError> {
        match self.store(settings) {
            Err(StoreError::Full) => {
                self.make_room();
                self.store(settings)
            }
            done => done,
        }
    }

    /// Sees to it that both sectors hold the newest copy and have room for another. Erases, which may stop the processor for a second a
    /// sector: not to be done where anything waits for it.
    pub fn make_room(&mut self) {
        self.renew_both(true);
    }

    /// Writes the newest copy where it is missing, as after a power cut, if that needs no erasing.
    pub fn mend(&mut self) {
        self.renew_both(false);
    }

    /// Gives the flash back.
    pub fn release(self) -> F {
        self.flash
    }

    fn renew_both(&mut self, erasing: bool) {
        let copies = [0, 1].map(|which| self.newest(which));
        let Some(settings) = copies.into_iter().flatten().next() else {
            for which in [0, 1] {
                if erasing && !self.takes(which) {
                    self.erase(which);
                }
            }
            return;
        };
        // The one that lags behind goes first, so that the other can then rely on it.
        let first = usize::from(copies.first().is_some_and(Option::is_some));
        for which in [first, 1 - first] {
            self.renew(which, &settings, erasing);
        }
    }

    /// Has a sector hold `settings`, the newest copy, and with `erasing` have room for another.
    fn renew(&mut self, which: usize, settings: &Settings, erasing: bool) {
        let has = self.newest(which).is_some();
        if erasing
            && !(self.takes(which) && (has || self.sector(which).next + 2 <= Self::SLOTS))
            && self.newest(1 - which).is_some()
        {
            self.erase(which);
        }
        if self.newest(which).is_none() && self.takes(which) {
            // What fails leaves the other sector as it is.
            let _ = self.append(which, self.sequence, settings);
        }
    }

    /// The newest copy of all, as a sector holds it.
    fn newest(&mut self, which: usize) -> Option<Settings> {
        let (sequence, slot) = self.sector(which).newest?;
        if sequence == self.sequence { self.load(which, slot) } else { None }
    }

    /// Whether a copy can be added to a sector. One whose first slot is not good may be blank because an erase was cut short, and not keep
    /// what is written to it: that is risked only while there is nothing to lose.
    fn takes(&mut self, which: usize) -> bool {
        let mut next = self.sector(which).next;
        while next < Self::SLOTS && !self.is_blank(which, next) {
            next += 1;
        }
        self.know(which, Sector { next, ..self.sector(which) });
        let nothing_to_lose = self.sectors.iter().all(|sector| sector.newest.is_none());
        let clean = next == 0 && self.sector(which).erased;
        next < Self::SLOTS && (clean || nothing_to_lose || self.load(which, 0).is_some())
    }

    fn sector(&self, which: usize) -> Sector {
        self.sectors.get(which).copied().unwrap_or_default()
    }

    fn know(&mut self, which: usize, sector: Sector) {
        if let Some(place) = self.sectors.get_mut(which) {
            *place = sector;
        }
    }

    fn address(which: usize, slot: u32, word: usize) -> u32 {
        which as u32 * F::ERASE_SIZE as u32 + slot * SLOT_BYTES + 4 * word as u32
    }

    fn erase(&mut self, which: usize) {
        let from = Self::address(which, 0, 0);
        let done = self.flash.erase(from, from + F::ERASE_SIZE as u32).is_ok();
        self.know(which, Sector { next: if done { 0 } else { Self::SLOTS }, erased: done, ..Sector::default() });
    }

    /// Writes a copy to the next blank slot and reads it back.
    fn append(&mut self, which: usize, sequence: u32, settings: &Settings) -> Result<(), StoreError> {
        let sector = self.sector(which);
        let slot = sector.next;
        if slot >= Self::SLOTS {
            return Err(StoreError::Full);
        }
        // Whatever becomes of it, the slot is not blank any more.
        self.know(which, Sector { next: slot + 1, ..sector });
        let mut digest = CRC.digest();
        let header = [MARK, LAYOUT, sequence];
        for (place, word) in header.iter().chain(settings.words()).enumerate() {
            digest.update(&word.to_le_bytes());
            self.write(Self::address(which, slot, place), *word)?;
        }
        self.write(Self::address(which, slot, SLOT_WORDS - 1), digest.finalize())?;
        if self.header(which, slot) != Some(sequence) || self.load(which, slot).as_ref() != Some(settings) {
            return Err(StoreError::Flash);
        }
        self.know(which, Sector { newest: Some((sequence, slot)), next: slot + 1, ..sector });
        Ok(())
    }

    fn write(&mut self, address: u32, word: u32) -> Result<(), StoreError> {
        self.flash.write(address, &word.to_le_bytes()).map_err(|_| StoreError::Flash)
    }

    /// What cannot be read is not blank, and no copy.
    fn read(&mut self, which: usize, slot: u32, place: usize) -> Option<u32> {
        self.read_at(Self::address(which, slot, place))
    }

    fn read_at(&mut self, address: u32) -> Option<u32> {
        let mut bytes = [0; 4];
        self.flash.read(address, &mut bytes).ok()?;
        Some(u32::from_le_bytes(bytes))
    }

    /// Slots of a sector before its last ones, which begin blank.
    fn used(&mut self, which: usize) -> u32 {
        (0..Self::SLOTS).rev().find(|slot| self.read(which, *slot, 0) != Some(BLANK)).map_or(0, |slot| slot + 1)
    }

    fn is_blank(&mut self, which: usize, slot: u32) -> bool {
        (0..SLOT_WORDS).all(|place| self.read(which, slot, place) == Some(BLANK))
    }

    /// The sequence number in a slot that says it holds a copy of this build's settings.
    fn header(&mut self, which: usize, slot: u32) -> Option<u32> {
        let is_one = self.read(which, slot, 0) == Some(MARK) && self.read(which, slot, 1) == Some(LAYOUT);
        if is_one { self.read(which, slot, 2) } else { None }
    }

    /// Sequence number and slot of the last such slot of a sector below one.
    fn copy_below(&mut self, which: usize, below: [u32; 2]) -> Option<(u32, u32)> {
        let below = below.get(which).copied().unwrap_or_default();
        (0..below).rev().find_map(|slot| Some((self.header(which, slot)?, slot)))
    }

    /// The settings in a slot, if it holds a good copy.
    fn load(&mut self, which: usize, slot: u32) -> Option<Settings> {
        let mut digest = CRC.digest();
        let mut words = [0; COUNT];
        for place in 0..SLOT_WORDS - 1 {
            let word = self.read(which, slot, place)?;
            if place == 0 && word != MARK || place == 1 && word != LAYOUT {
                return None;
            }
            digest.update(&word.to_le_bytes());
            if let Some(to) = place.checked_sub(HEADER).and_then(|place| words.get_mut(place)) {
                *to = word;
            }
        }
        let good = self.read(which, slot, SLOT_WORDS - 1) == Some(digest.finalize());
        if good { Settings::from_words(&words).ok() } else { None }
    }
}

#[cfg(test)]
mod tests;
