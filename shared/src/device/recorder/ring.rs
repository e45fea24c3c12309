//! The last ticks in memory, and when they are worth keeping. The control task adds a record at every tick; what is to be kept is taken by a
//! task that has time.

use super::record::pack;
use crate::control::supervisor::Phase;
use crate::device::Device;

/// Records that the ring holds, a power of two.
pub const RECORDS: usize = 2048;

/// Ticks before the block's first motion that are kept.
pub const BEFORE: u32 = 1000;

/// Ticks that the block must stand for a recording to end while the ground still shakes; where nothing moves any more it ends at once.
pub const AFTER: u32 = 2000;

/// Ticks in Fault after which a motion is not believed any more: what is recorded of it may be that of a sensor that is dead.
const IN_FAULT: u32 = 20_000;

/// Of a recording, what is the same at every tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source {
    /// From tick to tick, s.
    pub period: f32,
    /// CRC-32 of the settings in force.
    pub check: u32,
    /// A host said what the sensors read.
    pub attached: bool,
}

/// What is to be kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Taken {
    /// A tick.
    Record {
        /// Its number, counted from the start of the device.
        tick: u32,
        /// Its [record](super::record).
        words: [u32; 2],
        /// What it is a tick of.
        source: Source,
    },
    /// The block stands again.
    End,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    /// Nothing is kept.
    Waiting,
    /// What comes is kept.
    Recording,
    /// No more comes, but not all has been taken.
    Ending,
}

/// The ring.
// What each tick touches comes first, where an instruction reaches it.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Ring {
    /// Of the last record.
    tick: u32,
    /// Records that there ever were, wrapping.
    head: u32,
    state: State,
    /// The next to be taken, counted as `head`; meaningless while waiting.
    tail: u32,
    /// Where the recording ends, while it does.
    end: u32,
    /// Ticks for which the block has stood, and ticks in Fault.
    stood: u32,
    failed: u32,
    source: Source,
    records: [[u32; 2]; RECORDS],
}

impl Ring {
    /// An empty one.
    pub const fn new() -> Ring {
        Ring {
            tick: 0,
            head: 0,
            state: State::Waiting,
            tail: 0,
            end: 0,
            stood: 0,
            failed: 0,
            source: Source { period: 0.0, check: 0, attached: false },
            records: [[0; 2]; RECORDS],
        }
    }

    /// What the last tick of `device` came to, if there was one since.
    #[inline]
    pub fn note(&mut self, device: &Device) {
        if device.ticks == self.tick {
            return;
        }
        self.tick = device.ticks;
        if let Some(place) = self.records.get_mut(self.head as usize % RECORDS) {
            *place = pack(&device.decision, device.sample.engaged);
        }
        self.head = self.head.wrapping_add(1);
        if self.state != State::Waiting || device.decision.phase == Phase::Rocking {
            self.judge(device);
        }
    }

    /// Whether the recording begins or ends with the last tick.
    #[inline(never)]
    fn judge(&mut self, device: &Device) {
        let phase = device.decision.phase;
        let moves = !device.decision.estimate.standing;
        self.failed = if phase == Phase::Fault { self.failed.saturating_add(1) } else { 0 };
        let moves = moves && (phase == Phase::Rocking || (self.failed > 0 && self.failed < IN_FAULT));
        self.stood = if moves { 0 } else { self.stood.saturating_add(1) };
        match self.state {
            State::Waiting if moves => {
                let before = self.head.wrapping_sub(1).min(BEFORE);
                self.tail = self.head.wrapping_sub(before + 1);
                let attached = device.attached.is_some();
                self.source = Source { period: device.controller.instruments.period, check: device.check, attached };
                self.state = State::Recording;
            }
            State::Waiting => {}
            // Nothing of what has come meanwhile is lost: it continues.
            State::Ending if moves => self.state = State::Recording,
            State::Recording if self.stood >= AFTER || !matches!(phase, Phase::Rocking | Phase::Fault) => {
                (self.state, self.end) = (State::Ending, self.head);
            }
            State::Recording | State::Ending => {}
        }
        let waiting = self.head.wrapping_sub(self.tail);
        if self.state != State::Waiting && waiting > RECORDS as u32 {
            self.tail = self.head.wrapping_sub(RECORDS as u32);
        }
    }

    /// The next of what is to be kept, if there is something.
    pub fn take(&mut self) -> Option<Taken> {
        match self.state {
            State::Waiting => None,
            // Ticks that found no room may have gone beyond the end.
            State::Ending if self.end.wrapping_sub(self.tail) as i32 <= 0 => {
                self.state = State::Waiting;
                Some(Taken::End)
            }
            _ if self.tail == self.head => None,
            _ => {
                let words = *self.records.get(self.tail as usize % RECORDS)?;
                let tick = self.tick.wrapping_sub(self.head.wrapping_sub(self.tail).wrapping_sub(1));
                self.tail = self.tail.wrapping_add(1);
                Some(Taken::Record { tick, words, source: self.source })
            }
        }
    }
}

impl Default for Ring {
    fn default() -> Ring {
        Ring::new()
    }
}
