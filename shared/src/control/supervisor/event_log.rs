//! The last things that happened, for whoever looks afterwards.

use super::interface::Phase;
use crate::control::monitor::fault::{Fault, Wheel};
use heapless::Deque;
use heapless::deque::Iter;

/// Kind of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The command to engage was sent.
    Engaged(Wheel),
    /// The command to open was sent.
    Released(Wheel),
    /// The supervisor entered this phase.
    Phase(Phase),
    /// A fault arose, by its [`Fault::code`].
    Fault(u16),
    /// One that is not acted upon arose, by its code.
    Warning(u16),
    /// New biases were found.
    Calibrated,
    /// The device started anew, for the cause of this number on the link; ticks count from 0 again.
    Started(u8),
    /// The clutches have passed a proof test.
    Tested,
}

impl Kind {
    /// The fault behind a fault or a warning.
    pub fn fault(self) -> Option<Fault> {
        match self {
            Kind::Fault(code) | Kind::Warning(code) => Fault::from_code(code),
            _ => None,
        }
    }
}

/// Entry of the event log.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// Tick of the controller, wrapping.
    pub tick: u32,
    /// Kind of the event.
    pub kind: Kind,
    /// Estimated θ then, rad; whatever the estimator said, so perhaps not finite.
    pub rotation: f32,
    /// Estimated θ̇ then, rad/s; as `rotation`.
    pub velocity: f32,
}

/// The last `N` entries, `N` at least 1.
#[derive(Clone, Debug)]
pub struct EventLog<const N: usize> {
    ring: Deque<Entry, N>,
    count: u32,
}

impl<const N: usize> EventLog<N> {
    /// Fails to compile where there is no room for any entry.
    const HOLDS_SOMETHING: () = assert!(N > 0);

    /// An empty one.
    pub const fn new() -> EventLog<N> {
        let () = Self::HOLDS_SOMETHING;
        EventLog { ring: Deque::new(), count: 0 }
    }

    /// Adds `entry`, in the place of the oldest where the log is full.
    pub fn push(&mut self, entry: Entry) {
        if self.ring.is_full() {
            self.ring.pop_front();
        }
        // There is room now, so nothing can be handed back.
        let _ = self.ring.push_back(entry);
        self.count = self.count.saturating_add(1);
    }

    /// Adds the entries of before a reset to a log that is empty, of which there have been `count` ever.
    pub fn go_on(&mut self, entries: impl Iterator<Item = Entry>, count: u32) {
        entries.for_each(|entry| self.push(entry));
        self.count = count;
    }

    /// From the oldest to the newest.
    pub fn iter(&self) -> Iter<'_, Entry> {
        self.ring.iter()
    }

    /// How many there ever were, saturating: what exceeds the length of [`EventLog::iter`] is lost.
    pub fn count(&self) -> u32 {
        self.count
    }
}

impl<const N: usize> Default for EventLog<N> {
    fn default() -> EventLog<N> {
        EventLog::new()
    }
}

impl<const N: usize> PartialEq for EventLog<N> {
    fn eq(&self, other: &EventLog<N>) -> bool {
        self.count == other.count && self.iter().eq(other.iter())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::mem::size_of;
    use std::vec::Vec;

    fn entry(tick: u32) -> Entry {
        Entry { tick, kind: Kind::Released(Wheel::First), rotation: 0.0, velocity: 0.0 }
    }

    #[test]
    fn the_oldest_goes_first() {
        let mut log = EventLog::<4>::new();
        assert_eq!(log.iter().count(), 0);
        for tick in 0..11 {
            log.push(entry(tick));
            let ticks: Vec<u32> = log.iter().map(|entry| entry.tick).collect();
            assert_eq!(ticks, (tick.saturating_sub(3)..=tick).collect::<Vec<u32>>());
            assert_eq!(log.count(), tick + 1);
        }
    }

    #[test]
    fn a_count_at_its_end_stays_and_the_log_continues() {
        let mut log = EventLog::<4>::new();
        log.count = u32::MAX - 2;
        for tick in u32::MAX - 5..u32::MAX {
            log.push(entry(tick));
        }
        assert_eq!(log.count(), u32::MAX);
        let ticks: Vec<u32> = log.iter().map(|entry| entry.tick).collect();
        assert_eq!(ticks, (u32::MAX - 4..u32::MAX).collect::<Vec<u32>>());
    }

    #[test]
    fn equal_where_they_hold_the_same() {
        let (mut first, mut second) = (EventLog::<2>::new(), EventLog::<2>::new());
        first.push(entry(1));
        assert!(first != second);
        second.push(entry(1));
        assert!(first == second);
        assert_eq!(second.iter().count(), 1);
    }

    #[test]
    fn an_entry_is_four_words() {
        assert_eq!(size_of::<Entry>(), 16);
    }

    #[test]
    fn a_code_finds_its_fault() {
        assert_eq!(Kind::Warning(61).fault(), Some(Fault::Overrun));
        assert_eq!(Kind::Fault(9).fault(), None);
        assert_eq!(Kind::Calibrated.fault(), None);
    }
}
