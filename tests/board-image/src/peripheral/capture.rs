//! TIM5's capture of the slow internal oscillator: channel 4 of an F4, whose input TIM5_OR selects (RM0090, sections 18.4.21 and 7.2.11),
//! channel 1 of a G4, by TIM5_TISEL (RM0440, TIM2 to TIM5).

use super::counter::Counter;
use crate::model::Model;
use crate::time::SECOND;

const SR: u32 = 0x10;
const CCER: u32 = 0x20;

/// Where a channel's registers and bits are.
#[derive(Clone, Copy, Debug)]
struct Layout {
    /// Register, mask and value that make the oscillator the input.
    source: (u32, u32, u32),
    /// Register of the mode, and where its four bits are.
    mode: (u32, u32),
    on: u32,
    value: u32,
    came: u32,
    missed: u32,
}

const F405: Layout =
    Layout { source: (0x50, 0xC0, 0x40), mode: (0x1C, 8), on: 1 << 12, value: 0x40, came: 1 << 4, missed: 1 << 12 };
const G474: Layout = Layout { source: (0x5C, 0x0F, 1), mode: (0x18, 0), on: 1, value: 0x34, came: 1 << 1, missed: 1 << 9 };

/// The channel.
#[derive(Clone, Debug)]
pub struct Capture {
    layout: Layout,
    /// Since when it captures.
    since: Option<u64>,
    /// Captures that have been read.
    read: u64,
}

impl Capture {
    /// As after a reset.
    pub fn new(model: Model) -> Capture {
        Capture { layout: if model == Model::F405 { F405 } else { G474 }, since: None, read: 0 }
    }

    /// Edges to a capture, where the registers of `timer` have the channel capture the oscillator.
    fn edges(&self, timer: &Counter) -> Option<u64> {
        let (source, mask, value) = self.layout.source;
        let (mode, place) = self.layout.mode;
        let mode = timer.register(mode) >> place & 15;
        let captures = timer.register(source) & mask == value && mode & 3 == 1 && timer.register(CCER) & self.layout.on != 0;
        captures.then_some(1 << (mode >> 2))
    }

    /// A register of `timer` has been written to.
    pub fn written(&mut self, offset: u32, value: u32, timer: &Counter, slow: Option<u64>, now: u64) {
        if offset == SR && value & self.layout.missed == 0 {
            self.read = self.captures(timer, slow, now).map_or(0, |(count, _)| count);
        }
        let captures = self.edges(timer).is_some();
        if !captures || self.since.is_none() {
            (self.since, self.read) = (captures.then_some(now), 0);
        }
    }

    /// Captures so far, and when the last one was; `slow` is the oscillator's rate, 1/s, if it runs.
    fn captures(&self, timer: &Counter, slow: Option<u64>, now: u64) -> Option<(u64, u64)> {
        let (since, edges, slow) = (self.since?, u128::from(self.edges(timer)?), u128::from(slow?));
        let count = u128::from(now - since) * slow / (edges * u128::from(SECOND));
        Some((count as u64, since + (count * edges * u128::from(SECOND) / slow) as u64))
    }

    /// A load from a register that the channel has to do with; `clock` is the rate of the timer's, 1/s.
    pub fn read(&mut self, offset: u32, timer: &Counter, slow: Option<u64>, clock: u64, now: u64) -> Option<u32> {
        let (count, at) = self.captures(timer, slow, now).unwrap_or_default();
        let new = count.saturating_sub(self.read);
        if offset == self.layout.value && new > 0 {
            // What was missed stays so until the flag is cleared.
            self.read = if new > 1 { self.read } else { count };
            return Some(timer.count(clock, at) as u32);
        }
        let (came, missed) = (if new > 0 { self.layout.came } else { 0 }, if new > 1 { self.layout.missed } else { 0 });
        (offset == SR).then_some(came | missed)
    }
}
