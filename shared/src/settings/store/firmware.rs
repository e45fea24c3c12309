//! Which firmware has run: versions beside the settings, in a third sector that is never erased, so that going back to an older one is seen.

use embedded_storage::nor_flash::NorFlash;

use super::{BLANK, Store};

/// Bytes of a version: its word and the complement.
const ENTRY: u32 = 8;

/// Versions that are kept at most, one for each step upward.
const MOST: u32 = 128;

/// As a word that grows with it.
fn number([major, minor, patch]: [u8; 3]) -> u32 {
    u32::from_be_bytes([0, major, minor, patch])
}

impl<F: NorFlash> Store<F> {
    /// The highest version that has run here, this `own` one included, which is noted down if there was none as high. A flash of two
    /// sectors notes nothing. Not to be called where the supply may fail: what is torn then is passed over.
    #[inline(never)]
    pub fn note_firmware(&mut self, own: [u8; 3]) -> [u8; 3] {
        let start = 2 * F::ERASE_SIZE as u32;
        if self.flash.capacity() < 3 * F::ERASE_SIZE {
            return own;
        }
        let (mut highest, mut free) = (None, None);
        for place in (start..).step_by(ENTRY as usize).take(MOST as usize) {
            match [self.read_at(place), self.read_at(place + 4)] {
                [Some(BLANK), Some(BLANK)] => {
                    free = Some(place);
                    break;
                }
                [Some(word), Some(other)] if other == !word => highest = highest.max(Some(word)),
                _ => {}
            }
        }
        let own_number = number(own);
        if highest.is_none_or(|highest| highest < own_number)
            && let Some(place) = free
        {
            // What fails is tried again at the next start.
            let _ = self.write(place, own_number).and_then(|()| self.write(place + 4, !own_number));
        }
        let [_, highest @ ..] = highest.unwrap_or_default().max(own_number).to_be_bytes();
        highest
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_storage::nor_flash::{ErrorType, NorFlashErrorKind, ReadNorFlash};
    use std::vec;
    use std::vec::Vec;

    const SECTOR: usize = 2 * super::super::SLOT_BYTES as usize;

    /// Flash of some sectors that takes so many words more.
    #[derive(Clone)]
    struct Words {
        bytes: Vec<u8>,
        left: usize,
    }

    impl Words {
        fn of(sectors: usize) -> Words {
            Words { bytes: vec![0xFF; sectors * SECTOR], left: usize::MAX }
        }
    }

    impl ErrorType for Words {
        type Error = NorFlashErrorKind;
    }

    impl ReadNorFlash for Words {
        const READ_SIZE: usize = 4;

        fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), NorFlashErrorKind> {
            bytes.copy_from_slice(&self.bytes[offset as usize..][..bytes.len()]);
            Ok(())
        }

        fn capacity(&self) -> usize {
            self.bytes.len()
        }
    }

    impl NorFlash for Words {
        const WRITE_SIZE: usize = 4;
        const ERASE_SIZE: usize = SECTOR;

        fn erase(&mut self, _: u32, _: u32) -> Result<(), NorFlashErrorKind> {
            panic!("versions are never erased");
        }

        fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), NorFlashErrorKind> {
            self.left = self.left.checked_sub(1).ok_or(NorFlashErrorKind::Other)?;
            assert!(offset as usize >= 2 * SECTOR, "among the settings");
            self.bytes[offset as usize..][..bytes.len()].copy_from_slice(bytes);
            Ok(())
        }
    }

    #[test]
    fn an_older_firmware_finds_the_newer_ones_version() {
        let mut flash = Words::of(3);
        let mut start = |version| {
            let mut store = Store::open(flash.clone()).0;
            let highest = store.note_firmware(version);
            let written = store.flash.left != flash.left;
            flash = Words { left: usize::MAX, ..store.release() };
            (highest, written)
        };
        assert_eq!(start([0, 1, 0]), ([0, 1, 0], true));
        assert_eq!(start([0, 1, 0]), ([0, 1, 0], false));
        assert_eq!(start([1, 0, 2]), ([1, 0, 2], true));
        assert_eq!(start([0, 255, 9]), ([1, 0, 2], false));
        assert_eq!(start([1, 0, 3]), ([1, 0, 3], true));
        assert_eq!(start([0, 1, 0]), ([1, 0, 3], false));
    }

    #[test]
    fn a_version_that_was_torn_is_written_again_behind() {
        let mut store = Store::open(Words { left: 1, ..Words::of(3) }).0;
        assert_eq!(store.note_firmware([2, 0, 0]), [2, 0, 0]);
        let mut store = Store::open(Words { left: usize::MAX, ..store.release() }).0;
        assert_eq!(store.note_firmware([1, 0, 0]), [1, 0, 0]);
        assert_eq!(store.note_firmware([0, 0, 1]), [1, 0, 0]);
    }

    #[test]
    fn a_full_sector_and_one_that_is_not_there_change_nothing() {
        let mut store = Store::open(Words::of(3)).0;
        for patch in 0..=255 {
            assert_eq!(store.note_firmware([0, 0, patch]), [0, 0, patch]);
        }
        assert_eq!(store.note_firmware([0, 0, 1]), [0, 0, MOST as u8 - 1]);
        assert_eq!(Store::open(Words::of(2)).0.note_firmware([3, 2, 1]), [3, 2, 1]);
    }
}
