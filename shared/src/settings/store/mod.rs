//! Settings in flash, twice, so that a power cut at any instant leaves one good copy.
//!
//! Two sectors, each a row of slots of one copy: mark, layout, sequence number, words, and a CRC-32 over all of it. Storing programs the
//! next blank slot of the first sector and then of the second, and never erases, since that stops the processor for longer than a watchdog
//! waits. Only [`Store::open`] erases, at boot: a sector without room, after seeing to it that the other one holds the newest copy.

use crc::{CRC_32_ISO_HDLC, Crc, NoTable};
use embedded_storage::nor_flash::NorFlash;

use super::limits::allows;
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
/// Without a table: flash is scarcer than the milliseconds of a boot.
const CRC: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

/// CRC-32 of words.
pub(super) fn checksum(words: &[u32]) -> u32 {
    let mut digest = CRC.digest();
    for word in words {
        digest.update(&word.to_le_bytes());
    }
    digest.finalize()
}

/// Why settings were not stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StoreError {
    /// A sector has no blank slot. Nothing was changed; opening the store anew, at the next boot, makes room.
    Full,
    /// The flash refused, or does not read as it was written. The settings in force before or these are found at the next boot.
    Flash,
}

/// What is known of a sector.
#[derive(Clone, Copy, Debug, Default)]
struct Sector {
    /// Sequence number and slot of its newest good copy.
    newest: Option<(u32, u32)>,
    /// Its first slot holds a good copy, as that of every sector that was properly erased and taken into use does.
    begun: bool,
    /// The first of its last slots, which are blank.
    next: u32,
}

impl Sector {
    fn holds(&self, sequence: u32) -> bool {
        self.newest.is_some_and(|(newest, _)| newest == sequence)
    }
}

/// What is in a slot.
enum Slot {
    Blank,
    Good(u32),
    /// Torn, rotten, or of another build.
    Spent,
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

    /// Finds the newest good copy, and sees to it that both sectors hold it and have room for another: for that it may erase, so it must be
    /// called before a watchdog runs. `None` where there is no copy of this build's settings.
    pub fn open(flash: F) -> (Store<F>, Option<Settings>) {
        let mut store = Store { flash, sectors: [Sector::default(); 2], sequence: 0 };
        store.sectors = [0, 1].map(|which| store.scan(which));
        let [first, second] = store.sectors;
        // The first one where both hold it.
        let newest = [(0, first), (1, second)]
            .into_iter()
            .filter_map(|(which, sector)| sector.newest.map(|(sequence, slot)| (sequence, 1 - which, slot)))
            .max();
        let found = newest.and_then(|(sequence, other, slot)| Some((sequence, other, store.load(1 - other, slot)?)));
        let Some((sequence, other, settings)) = found else {
            for (which, sector) in [(0, first), (1, second)] {
                if sector.next >= Self::SLOTS {
                    store.erase(which);
                }
            }
            return (store, None);
        };
        store.sequence = sequence;
        // The one that lags behind goes first, so that the other can then rely on it.
        for which in [other, 1 - other] {
            store.renew(which, &settings);
        }
        (store, Some(settings))
    }

    /// Adds `settings` to both sectors. Programs blank flash only.
    ///
    /// # Errors
    /// [`StoreError`].
    pub fn store(&mut self, settings: &Settings) -> Result<(), StoreError> {
        if self.sectors.iter().any(|sector| sector.next >= Self::SLOTS) {
            return Err(StoreError::Full);
        }
        self.sequence = self.sequence.wrapping_add(1);
        self.append(0, self.sequence, settings)?;
        self.append(1, self.sequence, settings)
    }

    /// How many times settings can be stored before the store must be opened anew.
    pub fn room(&self) -> u32 {
        let [first, second] = &self.sectors;
        Self::SLOTS.saturating_sub(first.next.max(second.next))
    }

    /// Gives the flash back.
    pub fn release(self) -> F {
        self.flash
    }

    /// Has a sector hold `settings`, the newest copy, with room for another.
    fn renew(&mut self, which: usize, settings: &Settings) {
        let sequence = self.sequence;
        let (own, other) = (self.sector(which), self.sector(1 - which));
        let needed = if own.holds(sequence) { 1 } else { 2 };
        // One whose first slot is not good may be blank because an erase was cut short, and not keep what is written to it.
        if (!own.begun || own.next + needed > Self::SLOTS) && other.holds(sequence) {
            self.erase(which);
        }
        if !self.sector(which).holds(sequence) {
            // What fails leaves the other sector as it is.
            let _ = self.append(which, sequence, settings);
        }
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
        self.know(which, Sector { next: if done { 0 } else { Self::SLOTS }, ..Sector::default() });
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
        match self.inspect(which, slot) {
            Ok(Slot::Good(found)) if found == sequence => {
                let begun = sector.begun || slot == 0;
                self.know(which, Sector { newest: Some((sequence, slot)), begun, next: slot + 1 });
                Ok(())
            }
            _ => Err(StoreError::Flash),
        }
    }

    fn write(&mut self, address: u32, word: u32) -> Result<(), StoreError> {
        self.flash.write(address, &word.to_le_bytes()).map_err(|_| StoreError::Flash)
    }

    fn read(&mut self, address: u32) -> Result<u32, StoreError> {
        let mut bytes = [0; 4];
        self.flash.read(address, &mut bytes).map_err(|_| StoreError::Flash)?;
        Ok(u32::from_le_bytes(bytes))
    }

    fn scan(&mut self, which: usize) -> Sector {
        let mut sector = Sector::default();
        for slot in 0..Self::SLOTS {
            match self.inspect(which, slot) {
                Ok(Slot::Blank) => continue,
                Ok(Slot::Good(sequence)) => {
                    sector.begun |= slot == 0;
                    if sector.newest.is_none_or(|(newest, _)| sequence >= newest) {
                        sector.newest = Some((sequence, slot));
                    }
                }
                // What cannot be read cannot be relied upon.
                Ok(Slot::Spent) | Err(_) => {}
            }
            sector.next = slot + 1;
        }
        sector
    }

    /// Looks at a slot, word by word.
    fn inspect(&mut self, which: usize, slot: u32) -> Result<Slot, StoreError> {
        let (mut blank, mut good, mut sequence) = (true, true, 0);
        let mut digest = CRC.digest();
        for place in 0..SLOT_WORDS - 1 {
            let word = self.read(Self::address(which, slot, place))?;
            blank &= word == BLANK;
            good &= match place {
                0 => word == MARK,
                1 => word == LAYOUT,
                2 => {
                    sequence = word;
                    true
                }
                _ => allows(place - HEADER, word) == Some(true),
            };
            if good {
                digest.update(&word.to_le_bytes());
            } else if !blank {
                return Ok(Slot::Spent);
            }
        }
        let last = self.read(Self::address(which, slot, SLOT_WORDS - 1))?;
        Ok(match (blank && last == BLANK, good && last == digest.finalize()) {
            (true, _) => Slot::Blank,
            (_, true) => Slot::Good(sequence),
            _ => Slot::Spent,
        })
    }

    fn load(&mut self, which: usize, slot: u32) -> Option<Settings> {
        let mut words = [0; COUNT];
        for (place, word) in words.iter_mut().enumerate() {
            *word = self.read(Self::address(which, slot, HEADER + place)).ok()?;
        }
        Settings::from_words(&words).ok()
    }
}

#[cfg(test)]
mod tests;
