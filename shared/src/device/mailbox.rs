//! Samples on their way from the link to the control task.

use heapless::Deque;

use crate::link::TickSample;

/// Samples that wait at most.
const ROOM: usize = 4;

/// Queue of samples.
#[derive(Clone, Debug, Default)]
pub struct Mailbox {
    waiting: Deque<TickSample, ROOM>,
    newest: Option<u32>,
    refused: u32,
}

impl Mailbox {
    /// Before the first.
    pub const fn new() -> Mailbox {
        Mailbox { waiting: Deque::new(), newest: None, refused: 0 }
    }

    /// Takes a sample, unless one as new or newer has been there: a frame that came twice or after its successor. Numbers wrap.
    pub fn put(&mut self, sample: TickSample) {
        let new = self.newest.is_none_or(|newest| sample.number.wrapping_sub(newest) as i32 > 0);
        // Where there is no room the control task lags behind; what is missing it will notice.
        if new && self.waiting.push_back(sample).is_ok() {
            self.newest = Some(sample.number);
        } else {
            self.refused = self.refused.saturating_add(1);
        }
    }

    /// The oldest one.
    pub fn oldest(&mut self) -> Option<TickSample> {
        self.waiting.pop_front()
    }

    /// The newest one; those before it are dropped.
    pub fn newest(&mut self) -> Option<TickSample> {
        let newest = self.waiting.pop_back();
        self.waiting.clear();
        newest
    }

    /// Whether one waits.
    pub fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }

    /// Number of samples that were not taken.
    pub fn refused(&self) -> u32 {
        self.refused
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::sensing::sample::Sample;

    fn numbered(number: u32) -> TickSample {
        TickSample { number, sample: Sample::default(), lateness: 0.0, clear: false }
    }

    #[test]
    fn doubled_and_late_samples_are_dropped() {
        let mut mailbox = Mailbox::new();
        for number in [u32::MAX, u32::MAX, 0, u32::MAX - 1, 2, 1] {
            mailbox.put(numbered(number));
        }
        let taken: std::vec::Vec<u32> = core::iter::from_fn(|| mailbox.oldest()).map(|sample| sample.number).collect();
        assert_eq!(taken, [u32::MAX, 0, 2]);
        assert_eq!(mailbox.refused(), 3);
    }

    #[test]
    fn the_newest_counts_and_the_room_ends() {
        let mut mailbox = Mailbox::new();
        for number in 0..10 {
            mailbox.put(numbered(number));
        }
        assert_eq!(mailbox.refused(), 6);
        assert_eq!(mailbox.newest().map(|sample| sample.number), Some(3));
        assert!(mailbox.is_empty() && mailbox.newest().is_none());
        // What found no room may come again.
        mailbox.put(numbered(4));
        assert!(!mailbox.is_empty());
    }
}
