//! The event log in memory that a reset does not clear: a slot for each entry, which says itself whether it is whole.
//!
//! An entry is written once, into the slot that its number names, so that a reset in the middle of it costs this entry and the oldest one.

use super::Device;
use crate::control::supervisor::LOG_ENTRIES;
use crate::control::supervisor::event_log::{Entry, Kind};
use crate::link::LogEntry;
use crate::link::reset_cause::Cause;
use crate::math::fnv::{FOLD_BASIS, fold};

/// Words of a slot.
pub const SLOT_WORDS: usize = 6;

/// All slots, as memory holds them.
pub type Slots = [[u32; SLOT_WORDS]; LOG_ENTRIES];

/// An entry, counted from the first that there ever was, as words.
pub fn words(number: u32, entry: &Entry) -> [u32; SLOT_WORDS] {
    let LogEntry { tick, rotation, velocity, kind: [kind, of] } = LogEntry::from(entry);
    let mut words = [number, tick, rotation.to_bits(), velocity.to_bits(), u32::from(kind) | u32::from(of) << 8, 0];
    let check = check(&words);
    let [.., last] = &mut words;
    *last = check;
    words
}

/// The slot of an entry.
pub fn slot(number: u32) -> usize {
    number as usize % LOG_ENTRIES
}

fn check(words: &[u32; SLOT_WORDS]) -> u32 {
    words.iter().take(SLOT_WORDS - 1).fold(FOLD_BASIS, |digest, word| fold(digest, *word))
}

/// The entry of such words and its number, if they have survived.
fn of(words: &[u32; SLOT_WORDS]) -> Option<(u32, Entry)> {
    let &[number, tick, rotation, velocity, kind, last] = words;
    if last != check(words) {
        return None;
    }
    let [kind, of, ..] = kind.to_le_bytes();
    let entry = LogEntry { tick, rotation: f32::from_bits(rotation), velocity: f32::from_bits(velocity), kind: [kind, of] };
    Some((number, entry.entry()?))
}

/// The entries that have survived, the oldest first, and how many there ever were.
pub fn survivors(slots: &Slots) -> (impl Iterator<Item = Entry>, u32) {
    let newest = slots.iter().filter_map(of).map(|(number, _)| number).max();
    let count = newest.map_or(0, |newest| newest.saturating_add(1));
    let numbers = count.saturating_sub(LOG_ENTRIES as u32)..count;
    let entries =
        numbers.filter_map(|number| of(slots.get(slot(number))?).filter(|(own, _)| *own == number).map(|(_, entry)| entry));
    (entries, count)
}

impl Device {
    /// Continues the event log that has survived a reset for this cause, if one has, and notes the new start in it.
    pub fn remember(&mut self, slots: &Slots, cause: Cause) {
        let (entries, count) = survivors(slots);
        if count > 0 {
            self.state.continue_log(entries, count);
            self.state.note(Entry { tick: 0, kind: Kind::Started(cause as u8), rotation: 0.0, velocity: 0.0 });
        }
    }

    /// Entries that the event log ever had.
    pub fn log_count(&self) -> u32 {
        self.state.supervisor().log.count()
    }

    /// Entries of the event log from this number on, with their numbers; how many there ever were.
    pub fn logged(&self, from: u32) -> (impl Iterator<Item = (u32, &Entry)>, u32) {
        let log = &self.state.supervisor().log;
        let count = log.count();
        let held = log.iter();
        let oldest = count.saturating_sub(held.len() as u32);
        ((oldest..).zip(held).skip(from.saturating_sub(oldest) as usize), count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::supervisor::event_log::EventLog;
    use std::vec::Vec;

    fn entry(tick: u32) -> Entry {
        Entry { tick, kind: Kind::Warning(71), rotation: 0.5, velocity: -0.25 }
    }

    /// Cut off after any word, all entries but the one that is written and the one in whose place it goes are there, in order.
    #[test]
    fn a_reset_in_the_middle_of_writing_costs_one_entry() {
        let mut slots: Slots = [[0xA5A5_5A5A; SLOT_WORDS]; LOG_ENTRIES];
        assert_eq!(survivors(&slots).1, 0, "memory after power-on");
        assert_eq!(survivors(&[[0; SLOT_WORDS]; LOG_ENTRIES]).1, 0, "memory that was cleared");
        for number in 0..200_u32 {
            let new = words(number, &entry(1000 + number));
            for cut in 0..SLOT_WORDS {
                let mut torn = slots;
                torn[slot(number)][..cut].copy_from_slice(&new[..cut]);
                let (entries, count) = survivors(&torn);
                let found: Vec<u32> = entries.map(|entry| entry.tick).collect();
                // Where nothing of it is written, the oldest is there still.
                let oldest = number.saturating_sub(if cut == 0 { 64 } else { 63 });
                assert_eq!((found, count), ((oldest..number).map(|number| 1000 + number).collect(), number), "cut after {cut}");
            }
            slots[slot(number)] = new;
        }
        let (entries, count) = survivors(&slots);
        let mut log = EventLog::<LOG_ENTRIES>::new();
        log.go_on(entries, count);
        assert_eq!((log.count(), log.iter().count()), (200, LOG_ENTRIES));
        assert_eq!(log.iter().next(), Some(&entry(1136)));
    }

    #[test]
    fn a_changed_bit_costs_its_entry_only() {
        let mut slots: Slots = core::array::from_fn(|number| words(number as u32, &entry(number as u32)));
        slots[20][3] ^= 1 << 9;
        let (entries, count) = survivors(&slots);
        let ticks: Vec<u32> = entries.map(|entry| entry.tick).collect();
        assert_eq!((ticks.len(), ticks.contains(&20), count), (63, false, 64));
    }

    #[test]
    fn every_cause_has_its_number() {
        assert_eq!(Cause::ALL.map(|cause| cause as u8), core::array::from_fn(|number| number as u8));
    }
}
