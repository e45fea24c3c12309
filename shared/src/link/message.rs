//! What is said over the link. Times in s, counts wrapping.

use serde::{Deserialize, Serialize};

use super::reset_cause::Cause;
use crate::control::controller::{Circumstances, Decision};
use crate::control::monitor::fault::{Fault, Wheel};
use crate::control::sensing::calibration::Calibration;
use crate::control::sensing::sample::Sample;
use crate::control::supervisor::Phase;
use crate::control::supervisor::event_log::{Entry, Kind};

/// Words of settings in one message.
pub const WORD_BLOCK: usize = 16;

/// Entries of the event log in one message.
pub const LOG_BLOCK: usize = 3;

/// Parts of 32 bytes of what the flight recorder holds in one message.
pub const RECORDED_PARTS: usize = 3;

/// To the device.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Request {
    /// Who it is: [`Reply::Identity`].
    Identify,
    /// Ask for the state: [`Reply::State`].
    State,
    /// Settings from this one on: [`Reply::Words`].
    Read {
        /// Index of the first.
        first: u16,
    },
    /// Changes the draft of the settings; nothing else changes.
    Write(Words),
    /// Makes the draft the settings and starts the controller anew with them. Only while it is Armed or in Calibrate (or has not got that
    /// far, or stopped with a fault): never while the block rocks.
    Apply {
        /// CRC-32 of the draft's words, as the sender believes it to be.
        check: u32,
        /// Also write them to flash.
        store: bool,
    },
    /// Makes the settings the draft.
    Discard,
    /// The event log from this entry on: [`Reply::Log`].
    Log {
        /// Number of the first, counted from the start of the device.
        from: u32,
    },
    /// Leave Fault.
    Clear,
    /// Self-test and calibration once more; only while Armed.
    SelfTest,
    /// Report every so many ticks, or never (0).
    Stream {
        /// Ticks.
        every: u16,
    },
    /// Take samples from the link in the place of the device's own sensors, from a new start of the controller on; where settings could be
    /// applied.
    Attach {
        /// Who says when a tick is.
        pace: Pace,
    },
    /// Use the device's own sensors again, from a new start of the controller on, with the settings that are in flash. Never refused; nothing
    /// changes in a device that is not attached.
    Detach,
    /// Readings of the sensors.
    Sample(TickSample),
    /// A fault to inject; refused by images that do not take such requests.
    Rehearse(Mishap),
    /// How the flight recorder is: [`Reply::Recorder`].
    Recorder,
    /// Ask for the bytes of the flight recorder: [`Reply::Recorded`].
    Recorded {
        /// Where, bytes from its beginning; a multiple of 8.
        offset: u32,
    },
    /// Erases all recordings, once the last one is whole; only while nothing moves. Given up where something moves before it is done.
    EraseRecordings,
    /// Protects the program in flash against writing, and the whole flash against being read out by a probe, from the next power-on on. Only
    /// erasing the whole chip undoes it.
    Protect,
}

/// Who says when an attached device ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Pace {
    /// The device's timer; a sample that has not come is missing.
    Timer,
    /// The samples: one tick each. For lines that cannot keep up with the clock.
    Sample,
}

/// Words of the settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Words {
    /// Index of the first.
    pub first: u16,
    /// How many of them count.
    pub count: u8,
    /// The words.
    pub words: [u32; WORD_BLOCK],
}

/// Readings of one tick.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TickSample {
    /// Counts up; a number that is not newer than the last is dropped.
    pub number: u32,
    /// The sensors.
    pub sample: Sample,
    /// How late the tick shall be taken to be, s.
    pub lateness: f32,
    /// Ask to leave Fault.
    pub clear: bool,
}

impl TickSample {
    /// Inputs of the controller besides the sample.
    pub fn circumstances(&self) -> Circumstances {
        let requests = crate::control::supervisor::Requests { clear: self.clear };
        Circumstances { lateness: self.lateness, requests, ..Circumstances::default() }
    }
}

/// Faults that can be injected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Mishap {
    /// The control task takes this much longer at the next tick, counts of the device's counter.
    Dawdle(u32),
    /// A reset.
    Reset,
    /// A panic.
    Panic,
    /// An instruction that the processor cannot carry out.
    HardFault,
    /// The supply fails after so many more bytes have been written to flash; the memory is lost.
    PowerCut(u32),
}

/// From the device.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Reply {
    /// Report of a start, unasked.
    Started(Started),
    /// Report of a tick, unasked.
    Tick(TickReport),
    /// Who it is.
    Identity(Identity),
    /// State of the device.
    State(State),
    /// Settings.
    Words(Words),
    /// Entries of the event log.
    Log(LogBlock),
    /// Acknowledgement of a request that has been done.
    Done(Done),
    /// Refusal of a request.
    Refused(Refusal),
    /// State of the flight recorder.
    Recorder(RecorderState),
    /// Bytes of the flight recorder.
    Recorded(Recorded),
}

/// Report of a start.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Started {
    /// Cause of the start.
    pub cause: Cause,
    /// It went on where it was, with the calibration of before.
    pub resumed: bool,
    /// The settings came from flash; otherwise they are the defaults.
    pub stored: bool,
    /// Resets in a row without a second of good work between them.
    pub restarts: u8,
    /// A text left by a panic: how many bytes count.
    pub length: u8,
    /// Where it panicked, or the address of a HardFault.
    pub place: u32,
    /// End of the panic's file name.
    pub file: [u8; 32],
}

/// One tick of the controller.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TickReport {
    /// Ticks since the device started.
    pub tick: u32,
    /// Number of the last sample from the link.
    pub sample: u32,
    /// Decision of the tick.
    pub decision: Decision,
    /// What the tick took, counts of the device's counter.
    pub cost: u32,
    /// How late it began, same counts.
    pub lateness: u32,
}

/// Who a device is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// Version of the firmware.
    pub version: [u8; 3],
    /// Build, as hexadecimal digits.
    pub build: [u8; 8],
    /// Board's name, filled up with zeros.
    pub board: [u8; 12],
    /// Rate of the device's counter, 1/s.
    pub counter_hz: u32,
    /// Number of settings.
    pub settings: u16,
    /// Which setting each word is: the `LAYOUT` of the settings of its build.
    pub layout: u32,
    /// CRC-32 of the settings' words.
    pub check: u32,
    /// Whether the image takes requests for fault injection.
    pub rehearsal: bool,
    /// Highest version of a firmware that has run on it: above its own, it has gone back to an older one.
    pub highest: [u8; 3],
    /// The image has a seal, so that a changed bit of the program is found.
    pub sealed: bool,
    /// The commissioning jumper is closed.
    pub jumper: bool,
    /// What its flash is protected against.
    pub protection: Protection,
}

/// What a flash is protected against.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Protection {
    /// Being read out by a probe.
    pub reading: bool,
    /// Protection against writes to the program.
    pub writing: bool,
}

/// State of a device.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// The last tick's.
    pub phase: Phase,
    /// And why, in Fault.
    pub fault: Option<Fault>,
    /// Ticks since the start.
    pub ticks: u32,
    /// Biases in use.
    pub calibration: Calibration,
    /// Entries that the event log has ever had.
    pub log_count: u32,
    /// Longest tick since the start, counts.
    pub worst_cost: u32,
    /// Largest lateness since the start, counts.
    pub worst_lateness: u32,
    /// Frames that were not whole or not known.
    pub bad_frames: u32,
    /// Reports that found no room on the line.
    pub lost_reports: u32,
    /// Deepest stack since the start, bytes.
    pub stack: u32,
    /// Cause of the last start.
    pub cause: Cause,
    /// A host says what its sensors read: it protects nothing.
    pub attached: Option<Pace>,
}

/// Entries of the event log.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LogBlock {
    /// Number of the first one here, counted from the start.
    pub from: u32,
    /// How many of them count.
    pub count: u8,
    /// Entries that the log has ever had.
    pub total: u32,
    /// Entries of the block.
    pub entries: [LogEntry; LOG_BLOCK],
}

/// An entry of the event log on its way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LogEntry {
    /// Tick.
    pub tick: u32,
    /// θ, rad.
    pub rotation: f32,
    /// θ̇, rad/s.
    pub velocity: f32,
    /// What happened and to what: [`Kind`] as two numbers.
    pub kind: [u8; 2],
}

/// Activity of the flight recorder.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum RecorderActivity {
    /// After a start it looks for its last page.
    Looking,
    /// It waits for an earthquake.
    Ready,
    /// A page is being written.
    Writing,
    /// It erases, or will.
    Erasing,
}

/// State of the flight recorder.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RecorderState {
    /// Pages that there are.
    pub pages: u16,
    /// The page that is written next; none is left where it is not below `pages`.
    pub next: u16,
    /// The oldest page makes room for the newest; otherwise what is there is kept.
    pub goes_round: bool,
    /// Activity of the flight recorder.
    pub activity: RecorderActivity,
    /// Ticks since the start that found no room.
    pub lost: u32,
    /// Pages since the start that the flash did not take.
    pub refused: u16,
}

/// A piece of what the flight recorder holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Recorded {
    /// Where it begins, bytes from the beginning.
    pub offset: u32,
    /// How many of them count: fewer only at the end.
    pub count: u8,
    /// The bytes.
    pub bytes: [[u8; 32]; RECORDED_PARTS],
}

/// Kinds of acknowledgement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Done {
    /// The request.
    AsAsked,
    /// Settings are in force and in flash.
    Stored,
}

/// Reasons why a request is refused.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Refusal {
    /// Only at rest: not in this state.
    Busy(Phase),
    /// There is no such setting.
    NoSuchSetting(u16),
    /// A value outside its range.
    OutOfRange(u16),
    /// Two settings that do not go together.
    Contradiction(u16, u16),
    /// The draft is not what the sender believes it to be.
    Check(u32),
    /// The flash takes no more until the device has been restarted.
    FlashFull,
    /// The flash does not take it.
    FlashFailed,
    /// Not by this image, or not in this mode.
    NotHere,
    /// The board cannot tick so often.
    TooFast {
        /// What `instruments.period` was to be, s.
        period: f32,
        /// The least that it may be on this board, s.
        least: f32,
    },
    /// The commissioning jumper is open.
    NoJumper,
    /// The program has no seal, and shall not be protected so.
    NotSealed,
}

impl From<&Entry> for LogEntry {
    fn from(entry: &Entry) -> LogEntry {
        let wheel = |wheel: Wheel| u8::from(wheel == Wheel::Second);
        let kind = match entry.kind {
            Kind::Engaged(of) => [0, wheel(of)],
            Kind::Released(of) => [1, wheel(of)],
            Kind::Phase(phase) => [2, phase as u8],
            Kind::Fault(code) => [3, code as u8],
            Kind::Warning(code) => [4, code as u8],
            Kind::Calibrated => [5, 0],
            Kind::Started(cause) => [6, cause],
            Kind::Tested => [7, 0],
        };
        LogEntry { tick: entry.tick, rotation: entry.rotation, velocity: entry.velocity, kind }
    }
}

impl LogEntry {
    /// The entry, if it is one.
    pub fn entry(&self) -> Option<Entry> {
        let [kind, of] = self.kind;
        let wheel = || Wheel::ALL.get(usize::from(of)).copied();
        let kind = match kind {
            0 => Kind::Engaged(wheel()?),
            1 => Kind::Released(wheel()?),
            2 => Kind::Phase(Phase::ALL.get(usize::from(of)).copied()?),
            3 => Kind::Fault(of.into()),
            4 => Kind::Warning(of.into()),
            5 => Kind::Calibrated,
            6 => Kind::Started(of),
            7 => Kind::Tested,
            _ => return None,
        };
        Some(Entry { tick: self.tick, kind, rotation: self.rotation, velocity: self.velocity })
    }
}
