//! Power cuts at every byte, wear through many stores, and rot.

use super::*;
use crate::settings::Item;
use embedded_storage::nor_flash::{ErrorType, NorFlashErrorKind, ReadNorFlash};
use std::vec;
use std::vec::Vec;

/// Of a sector: three slots and a bit.
const SECTOR: usize = 4 * SLOT_WORDS * 3 + 60;

/// NOR flash whose power lasts for so many bytes; a write in words of `WRITE` bytes can only clear bits.
#[derive(Clone, Debug)]
struct Nor<const WRITE: usize> {
    bytes: Vec<u8>,
    power: usize,
    random: u32,
    erased: u32,
    /// Words read.
    read: u32,
}

impl<const WRITE: usize> Nor<WRITE> {
    fn new() -> Nor<WRITE> {
        Nor { bytes: vec![0xff; 2 * SECTOR], power: usize::MAX, random: 1, erased: 0, read: 0 }
    }

    fn dice(&mut self) -> u8 {
        self.random = self.random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.random >> 24) as u8
    }

    fn powered(&self, power: usize, random: u32) -> Nor<WRITE> {
        Nor { power, random, ..self.clone() }
    }
}

impl<const WRITE: usize> ErrorType for Nor<WRITE> {
    type Error = NorFlashErrorKind;
}

impl<const WRITE: usize> ReadNorFlash for Nor<WRITE> {
    const READ_SIZE: usize = WRITE;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), NorFlashErrorKind> {
        if self.power == 0 {
            return Err(NorFlashErrorKind::Other);
        }
        self.read += bytes.len().div_ceil(4) as u32;
        let from = offset as usize;
        assert!(from.is_multiple_of(WRITE) && bytes.len().is_multiple_of(WRITE) && bytes.len() <= 64);
        bytes.copy_from_slice(&self.bytes[from..from + bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        2 * SECTOR
    }
}

impl<const WRITE: usize> NorFlash for Nor<WRITE> {
    const WRITE_SIZE: usize = WRITE;
    const ERASE_SIZE: usize = SECTOR;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), NorFlashErrorKind> {
        let (from, to) = (from as usize, to as usize);
        assert!(from.is_multiple_of(SECTOR) && to == from + SECTOR && to <= 2 * SECTOR);
        self.erased += 1;
        for place in from..to {
            if self.power > 0 {
                self.bytes[place] = 0xff;
                self.power -= 1;
            } else if self.dice() & 1 == 1 {
                self.bytes[place] = self.dice();
            }
        }
        if self.power > 0 { Ok(()) } else { Err(NorFlashErrorKind::Other) }
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), NorFlashErrorKind> {
        let from = offset as usize;
        assert!(from.is_multiple_of(WRITE) && bytes.len().is_multiple_of(WRITE));
        for (place, byte) in (from..).zip(bytes) {
            if self.power == 0 {
                // What is left of the word under way gets some of its bits.
                if !place.is_multiple_of(WRITE) || place == from {
                    self.bytes[place] &= byte | self.dice();
                }
                return Err(NorFlashErrorKind::Other);
            }
            assert_eq!(self.bytes[place], 0xff, "written twice");
            self.bytes[place] &= byte;
            self.power -= 1;
        }
        Ok(())
    }
}

/// Settings that differ by `number`.
fn settings(number: u32) -> Settings {
    let mut settings = Settings::default();
    settings.set(Item::OverrunTicks.index(), number + 1).unwrap();
    settings.set(Item::Size.index(), (1.0 + number as f32).to_bits()).unwrap();
    settings
}

/// A store that holds the settings of the last of `numbers`.
fn stored<const WRITE: usize>(numbers: core::ops::Range<u32>) -> Nor<WRITE> {
    let mut store = Store::open(Nor::<WRITE>::new()).0;
    for number in numbers {
        assert_eq!(store.store(&settings(number)), Ok(()));
    }
    store.release()
}

/// After whatever happened: `flash` has one of `possible`, has it still once room was made, in both sectors, and takes new settings.
fn survives<const WRITE: usize>(flash: &Nor<WRITE>, possible: &[Option<Settings>]) -> Option<Settings> {
    let (mut store, found) = Store::open(flash.powered(usize::MAX, flash.random));
    assert!(possible.contains(&found));
    assert_eq!(store.flash.bytes, flash.bytes, "opening changes nothing");
    let erased = store.flash.erased;
    store.mend();
    assert_eq!((store.flash.erased, Store::open(store.flash.clone()).1), (erased, found), "mending never erases");
    store.make_room();
    assert!(found.is_none() || [0, 1].iter().all(|which| store.newest(*which) == found), "one copy only");
    let erased = store.flash.erased;
    let (mut store, again) = Store::open(store.release());
    assert_eq!(again, found);
    store.make_room();
    assert_eq!(store.flash.erased, erased, "making room twice does no more than once");
    assert_eq!(store.store(&settings(999)), Ok(()));
    assert_eq!(store.flash.erased, erased, "storing never erases");
    assert_eq!(Store::open(store.release()).1, Some(settings(999)));
    found
}

#[test]
fn what_is_stored_is_found() {
    let (store, found) = Store::open(Nor::<4>::new());
    assert_eq!((found, store.flash.erased), (None, 0));
    assert_eq!(Store::open(stored::<4>(0..1)).1, Some(settings(0)));
    assert_eq!(Store::open(stored::<2>(0..2)).1, Some(settings(1)));
    assert_eq!(Store::open(stored::<1>(0..3)).1, Some(settings(2)));
}

#[test]
fn a_power_cut_while_storing_leaves_the_old_or_the_new() {
    fn cut<const WRITE: usize>(before: u32) {
        let flash = stored::<WRITE>(0..before);
        let old = before.checked_sub(1).map(settings);
        let (mut seen_old, mut seen_new) = (0, 0);
        for power in 1..2 * SLOT_BYTES as usize {
            let (mut store, found) = Store::open(flash.powered(usize::MAX, power as u32));
            assert_eq!(found, old);
            store.flash.power = power;
            assert_eq!(store.store(&settings(before)), Err(StoreError::Flash), "{power}");
            let found = survives(&store.release(), &[old, Some(settings(before))]);
            if found == old { seen_old += 1 } else { seen_new += 1 }
        }
        // The first copy decides.
        assert!((SLOT_BYTES - 6..SLOT_BYTES + 6).contains(&seen_old) && seen_new >= SLOT_BYTES - 6, "{seen_old} {seen_new}");
    }
    cut::<4>(0);
    cut::<4>(1);
    cut::<2>(2);
    cut::<1>(2);
}

#[test]
fn a_power_cut_while_room_is_made_loses_nothing() {
    let full = stored::<4>(0..3);
    let made = |flash| {
        let (mut store, _) = Store::open(flash);
        store.make_room();
        store
    };
    assert_eq!(made(full.powered(usize::MAX, 1)).flash.erased, 2);
    // Two erases and two copies.
    for power in 1..2 * (SECTOR + SLOT_BYTES as usize) {
        let flash = made(full.powered(power, power as u32)).release();
        assert_eq!(survives(&flash, &[Some(settings(2))]), Some(settings(2)), "{power}");
    }
    // Once more after a cut, at another instant.
    for power in (1..2 * SECTOR).step_by(37) {
        let mut flash = full.powered(power, power as u32);
        for next in [SECTOR / 3, SECTOR / 2, SECTOR + 11] {
            flash = made(flash).release().powered(next, next as u32);
        }
        assert_eq!(survives(&flash, &[Some(settings(2))]), Some(settings(2)), "{power}");
    }
}

#[test]
fn two_hundred_stores_in_a_row() {
    let mut store = Store::open(Nor::<4>::new()).0;
    for number in 0..200 {
        let before = store.flash.clone();
        match store.store(&settings(number)) {
            Ok(()) => assert_eq!(store.flash.erased, before.erased, "storing never erases"),
            full => {
                assert_eq!((full, &store.flash.bytes), (Err(StoreError::Full), &before.bytes));
                store.make_room();
                assert_eq!(store.store(&settings(number)), Ok(()));
            }
        }
    }
    // Two copies fit between erases of both.
    assert!(store.flash.erased <= 2 * 100);
    assert_eq!(Store::open(store.release()).1, Some(settings(199)));
}

/// However often was stored, a start reads little and erases nothing.
#[test]
fn opening_costs_the_same_whatever_the_flash_holds() {
    let slots = (SECTOR / SLOT_BYTES as usize) as u32;
    let cost = |flash: Nor<4>| {
        let (store, found) = Store::open(Nor { read: 0, ..flash });
        assert_eq!((store.flash.erased, found.is_some()), (0, true));
        store.flash.read
    };
    for count in 1..=3 {
        // A word of each blank slot, two headers, one copy.
        let read = cost(stored::<4>(0..count));
        assert!(read <= 2 * slots + 2 * 4 + SLOT_WORDS as u32, "{count} copies: {read} words");
    }
    // Nothing is worse than copies that have all rotted but the oldest: each is read once.
    let mut rotten = stored::<4>(0..3);
    for slot in 1..3 {
        for sector in [0, SECTOR] {
            rotten.bytes[sector + (slot + 1) * SLOT_BYTES as usize - 1] ^= 1;
        }
    }
    let read = cost(rotten);
    assert!(read <= 2 * slots * (SLOT_WORDS as u32 + 2 * 4), "{read} words");
}

/// As docs/firmware.md says of the sectors of 16 KiB of the F405: so often settings are stored between two times that the processor stalls.
#[test]
fn a_sector_of_16_kib_takes_29_copies() {
    assert_eq!(0x4000 / SLOT_BYTES, 29);
}

#[test]
fn a_flipped_bit_in_one_copy_is_survived() {
    let flash = stored::<4>(0..2);
    let newest = SLOT_BYTES as usize..2 * SLOT_BYTES as usize;
    for sector in [0, SECTOR] {
        for place in newest.clone() {
            let mut rotten = flash.clone();
            rotten.bytes[sector + place] ^= 1 << (place % 8);
            assert_eq!(survives(&rotten, &[Some(settings(1))]), Some(settings(1)));
        }
    }
}

#[test]
fn copies_of_another_build_are_not_taken() {
    let mut flash = stored::<4>(0..3);
    for slot in 0..3 {
        for sector in [0, SECTOR] {
            flash.bytes[sector + slot * SLOT_BYTES as usize + 4] ^= 1;
        }
    }
    survives(&flash, &[None]);
}

#[test]
fn rubbish_is_erased_only_where_there_is_no_room() {
    let mut rubbish = Nor::<4>::new();
    for place in 0..2 * SECTOR {
        rubbish.bytes[place] = rubbish.dice();
    }
    survives(&rubbish, &[None]);
    // Beside a sector that holds the settings.
    for sector in [0, SECTOR] {
        let mut flash = stored::<4>(0..1);
        flash.bytes[sector..sector + SECTOR].copy_from_slice(&rubbish.bytes[..SECTOR]);
        assert_eq!(survives(&flash, &[Some(settings(0))]), Some(settings(0)));
    }
}
