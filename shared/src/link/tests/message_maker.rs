//! Every message there can be, made of any words.

use crate::control::controller::Decision;
use crate::control::estimation::estimate::{Deviation, Estimate};
use crate::control::law::Wish;
use crate::control::monitor::fault::Fault;
use crate::control::sensing::calibration::Calibration;
use crate::control::sensing::sample::{Count, Reading, Sample};
use crate::control::supervisor::Phase;
use crate::link::reset_cause::Cause;
use crate::link::*;
use crate::math::sign::Sign;

/// Kinds of requests.
pub const REQUESTS: usize = 18;
/// Kinds of replies.
pub const REPLIES: usize = 10;

/// In the order of their numbers.
pub const CAUSES: [Cause; 7] =
    [Cause::PowerOn, Cause::BrownOut, Cause::Pin, Cause::Watchdog, Cause::Software, Cause::Panic, Cause::HardFault];

/// As [`CAUSES`].
pub const WISHES: [Wish; 3] = [Wish::Release, Wish::Resist, Wish::Hold];

/// As [`CAUSES`].
pub const ACTIVITIES: [RecorderActivity; 4] =
    [RecorderActivity::Looking, RecorderActivity::Ready, RecorderActivity::Writing, RecorderActivity::Erasing];

/// Codes of the faults that messages are made of. Not [`Fault::ALL`]: a new fault must not change the recorded frames.
const FAULTS: [u16; 31] =
    [11, 12, 13, 14, 15, 21, 22, 23, 24, 25, 31, 32, 33, 34, 35, 41, 42, 43, 44, 45, 51, 52, 53, 54, 55, 56, 57, 61, 62, 71, 72];

/// Words, one after the other, from the beginning again after the last.
pub struct Source<'a> {
    words: &'a [u32],
    next: usize,
}

impl Source<'_> {
    pub fn new(words: &[u32]) -> Source<'_> {
        Source { words, next: 0 }
    }

    fn word(&mut self) -> u32 {
        self.next += 1;
        self.words[(self.next - 1) % self.words.len()]
    }

    fn byte(&mut self) -> u8 {
        self.word() as u8
    }

    fn bytes<const N: usize>(&mut self) -> [u8; N] {
        core::array::from_fn(|_| self.byte())
    }

    /// Large where the word is large: a number near 0 is short.
    fn signed(&mut self) -> i32 {
        (self.word() ^ 1 << 31) as i32
    }

    fn float(&mut self) -> f32 {
        f32::from_bits(self.word())
    }

    fn floats<const N: usize>(&mut self) -> [f32; N] {
        core::array::from_fn(|_| self.float())
    }

    fn truth(&mut self) -> bool {
        self.word() & 1 == 1
    }

    fn one_of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.word() as usize % choices.len()]
    }

    fn reading(&mut self) -> Reading {
        Reading { value: self.float(), number: self.word() }
    }

    fn sample(&mut self) -> Sample {
        Sample {
            gyroscope: self.reading(),
            block_accelerometer: [self.reading(), self.reading()],
            ground_accelerometer: [self.reading(), self.reading()],
            encoder: Count { counts: self.signed(), number: self.word() },
            engaged: [self.truth(), self.truth()],
        }
    }

    fn fault(&mut self) -> Option<Fault> {
        self.truth().then(|| Fault::from_code(self.one_of(&FAULTS)).unwrap())
    }

    fn calibration(&mut self) -> Calibration {
        Calibration { gyroscope: self.float(), block: self.floats(), ground: self.floats(), encoder_zero: self.signed() }
    }

    fn decision(&mut self) -> Decision {
        let [rotation, velocity, push, ground_rate] = self.floats();
        let deviation = Deviation { rotation: self.float(), velocity: self.float(), push: self.float(), ground: self.float() };
        Decision {
            command: [self.truth(), self.truth()],
            estimate: Estimate {
                rotation,
                velocity,
                side: self.one_of(&[Sign::Positive, Sign::Negative]),
                push,
                ground: self.floats(),
                ground_rate,
                standing: self.truth(),
                deviation,
            },
            wish: self.one_of(&WISHES),
            phase: self.one_of(&Phase::ALL),
            fault: self.fault(),
        }
    }

    fn block(&mut self) -> Words {
        Words { first: self.word() as u16, count: self.byte(), words: core::array::from_fn(|_| self.word()) }
    }

    fn log_entry(&mut self) -> LogEntry {
        LogEntry { tick: self.word(), rotation: self.float(), velocity: self.float(), kind: self.bytes() }
    }
}

/// The request of this number.
pub fn request(variant: usize, source: &mut Source<'_>) -> Request {
    match variant {
        0 => Request::Identify,
        1 => Request::State,
        2 => Request::Read { first: source.word() as u16 },
        3 => Request::Write(source.block()),
        4 => Request::Apply { check: source.word(), store: source.truth() },
        5 => Request::Discard,
        6 => Request::Log { from: source.word() },
        7 => Request::Clear,
        8 => Request::SelfTest,
        9 => Request::Stream { every: source.word() as u16 },
        10 => Request::Attach { pace: source.one_of(&[Pace::Timer, Pace::Sample]) },
        11 => Request::Detach,
        12 => {
            let (number, sample) = (source.word(), source.sample());
            Request::Sample(TickSample { number, sample, lateness: source.float(), clear: source.truth() })
        }
        13 => Request::Rehearse(match source.word() % 5 {
            0 => Mishap::Dawdle(source.word()),
            1 => Mishap::Reset,
            2 => Mishap::Panic,
            3 => Mishap::HardFault,
            _ => Mishap::PowerCut(source.word()),
        }),
        14 => Request::Recorder,
        15 => Request::Recorded { offset: source.word() },
        16 => Request::EraseRecordings,
        _ => Request::Protect,
    }
}

/// The reply of this number.
pub fn reply(variant: usize, source: &mut Source<'_>) -> Reply {
    match variant {
        0 => Reply::Started(Started {
            cause: source.one_of(&CAUSES),
            resumed: source.truth(),
            stored: source.truth(),
            restarts: source.byte(),
            length: source.byte(),
            place: source.word(),
            file: source.bytes(),
        }),
        1 => Reply::Tick(TickReport {
            tick: source.word(),
            sample: source.word(),
            decision: source.decision(),
            cost: source.word(),
            lateness: source.word(),
        }),
        2 => Reply::Identity(Identity {
            version: source.bytes(),
            build: source.bytes(),
            board: source.bytes(),
            counter_hz: source.word(),
            settings: source.word() as u16,
            layout: source.word(),
            check: source.word(),
            rehearsal: source.truth(),
            highest: source.bytes(),
            sealed: source.truth(),
            jumper: source.truth(),
            protection: Protection { reading: source.truth(), writing: source.truth() },
        }),
        3 => Reply::State(State {
            phase: source.one_of(&Phase::ALL),
            fault: source.fault(),
            ticks: source.word(),
            calibration: source.calibration(),
            log_count: source.word(),
            worst_cost: source.word(),
            worst_lateness: source.word(),
            bad_frames: source.word(),
            lost_reports: source.word(),
            stack: source.word(),
            cause: source.one_of(&CAUSES),
            attached: source.one_of(&[None, Some(Pace::Timer), Some(Pace::Sample)]),
        }),
        4 => Reply::Words(source.block()),
        5 => Reply::Log(LogBlock {
            from: source.word(),
            count: source.byte(),
            total: source.word(),
            entries: core::array::from_fn(|_| source.log_entry()),
        }),
        6 => Reply::Done(source.one_of(&[Done::AsAsked, Done::Stored])),
        7 => {
            let (index, other) = (source.word() as u16, source.word() as u16);
            let (phase, check) = (source.one_of(&Phase::ALL), source.word());
            Reply::Refused(source.one_of(&[
                Refusal::Busy(phase),
                Refusal::NoSuchSetting(index),
                Refusal::OutOfRange(index),
                Refusal::Contradiction(index, other),
                Refusal::Check(check),
                Refusal::FlashFull,
                Refusal::FlashFailed,
                Refusal::NotHere,
                Refusal::TooFast { period: f32::from_bits(check), least: f32::from_bits(check) },
                Refusal::NoJumper,
                Refusal::NotSealed,
            ]))
        }
        8 => Reply::Recorder(RecorderState {
            pages: source.word() as u16,
            next: source.word() as u16,
            goes_round: source.truth(),
            activity: source.one_of(&ACTIVITIES),
            lost: source.word(),
            refused: source.word() as u16,
        }),
        _ => Reply::Recorded(Recorded {
            offset: source.word(),
            count: source.byte(),
            bytes: core::array::from_fn(|_| source.bytes()),
        }),
    }
}
