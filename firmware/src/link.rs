//! The link task: frames in, answers and reports out.

use core::sync::atomic::{AtomicU32, Ordering};

use crate::board::{Board, Flash, Line, Recordings, Selected};
use crate::last_words;
use crate::log::{info, warn};
use crate::{stack, tick};
use heapless::Deque;
use sprag_shared::device::recorder::{Recorder, Taken};
use sprag_shared::device::{Answer, Surroundings};
use sprag_shared::link::reset_cause::Cause;
use sprag_shared::link::{Deframer, MAX_FRAME, Mishap, Pace, Reply, Request, Started, TickReport, encode};
use sprag_shared::settings::store::Store;

/// Reports that wait for the link at most.
const REPORTS: usize = 4;

static LOST_REPORTS: AtomicU32 = AtomicU32::new(0);

/// Reports from the control task to the link.
pub struct Outbox {
    reports: Deque<TickReport, REPORTS>,
}

impl Outbox {
    /// An empty one.
    pub const fn new() -> Outbox {
        Outbox { reports: Deque::new() }
    }

    /// Adds a report; where the link is too slow the new one is lost, and counted.
    pub fn put(&mut self, report: TickReport) {
        if self.reports.push_back(report).is_err() {
            LOST_REPORTS.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// The oldest one.
    pub fn take(&mut self) -> Option<TickReport> {
        self.reports.pop_front()
    }
}

/// What is in flash.
pub struct Stored {
    /// The settings.
    pub settings: Store<Flash>,
    /// The recordings of earthquakes.
    pub recorder: Recorder<Recordings>,
}

/// Pieces of work that the recorder does between two looks at the line, at most.
const RECORDED_AT_ONCE: u32 = 2;

/// µs by which programming may take longer than the data sheet says, and in which it begins.
const RECORDING_MARGIN: u32 = 15;

/// What the link task owns.
pub struct Link {
    line: <Selected as Board>::Line,
    stored: &'static mut Stored,
    around: Surroundings,
    program_end: u32,
    deframer: Deframer,
    /// The frame on its way out and how much of it is gone.
    frame: [u8; MAX_FRAME],
    length: usize,
    gone: usize,
    /// What is to be said before anything else.
    next: Option<(u8, Reply)>,
    /// Who says when a tick is, as of the last request.
    pace: Option<Pace>,
}

impl Link {
    /// With what is to be said about the start, of a sealed program that ends before `program_end` (0 without a seal).
    pub fn new(
        line: <Selected as Board>::Line,
        stored: &'static mut Stored,
        started: &Started,
        around: Surroundings,
        program_end: u32,
        pace: Option<Pace>,
    ) -> Link {
        Link {
            line,
            stored,
            around,
            program_end,
            deframer: Deframer::new(),
            frame: [0; MAX_FRAME],
            length: 0,
            gone: 0,
            next: Some((0, Reply::Started(*started))),
            pace,
        }
    }

    /// The address behind the program, where it has a seal.
    pub fn program_end(&self) -> u32 {
        self.program_end
    }

    /// Writes the settings where a power cut has left one copy of them only.
    pub fn mend(&mut self) {
        self.stored.settings.mend();
    }

    /// Writes what is to be kept of an earthquake, as `take` gives it, as long as the longest stall ends before the next tick. Whether there
    /// was anything.
    pub fn record(&mut self, mut take: impl FnMut() -> Option<Taken>) -> bool {
        let in_time = || tick::is_further_than(Selected::PROGRAMMING_STALL + RECORDING_MARGIN);
        (0..RECORDED_AT_ONCE).take_while(|_| in_time() && self.stored.recorder.work(&mut take)).count() > 0
    }

    /// The recorder, where it is to erase a sector now: not before the last answer is handed to the line, for it may take seconds.
    pub fn erasing(&mut self) -> Option<&mut Recorder<Recordings>> {
        (self.has_room() && self.stored.recorder.erases()).then_some(&mut self.stored.recorder)
    }

    /// Whether the processor may sleep until the next interrupt: bytes that come raise none, and where they make the ticks each counts.
    pub fn may_sleep(&self) -> bool {
        self.pace != Some(Pace::Sample)
    }

    /// Whether a report can be sent now.
    pub fn has_room(&self) -> bool {
        self.length == 0 && self.next.is_none()
    }

    /// Moves what can be moved: a `report` (only while there [is room](Link::has_room)), the last answer, what has come. `ask` hands a
    /// request to the device. Whether anything moved.
    pub fn pump(
        &mut self,
        report: Option<TickReport>,
        mut ask: impl FnMut(&Request, &mut Stored, &Surroundings) -> (Answer, Option<Pace>),
    ) -> bool {
        let mut moved = self.send();
        if let Some(report) = report {
            self.pack(0, &Reply::Tick(report));
            moved = true;
        }
        if self.length == 0
            && let Some((tag, reply)) = self.next.take()
        {
            self.pack(tag, &reply);
            moved = true;
        }
        moved |= self.send();
        // An answer that waits must go before the next request is heard.
        while self.next.is_none() {
            let mut byte = [0];
            if self.line.read(&mut byte) == 0 {
                break;
            }
            moved = true;
            match self.deframer.feed::<Request>(byte[0]) {
                None => {}
                Some(Err(_)) => {
                    warn!("a bad frame");
                    self.around.bad_frames = self.around.bad_frames.saturating_add(1);
                }
                Some(Ok(received)) => {
                    self.around.lost_reports = LOST_REPORTS.load(Ordering::Relaxed);
                    // It takes as long as half a period, and only this one reports.
                    if matches!(received.message, Request::State) {
                        self.around.stack = stack::deepest();
                    }
                    self.around.locked = !Selected::jumper_is_closed();
                    self.around.protection = Selected::protection(self.program_end);
                    let (answer, pace) = ask(&received.message, self.stored, &self.around);
                    self.pace = pace;
                    self.act(received.tag, answer);
                }
            }
        }
        moved
    }

    /// The device's host has said nothing for too long: asks the device to continue without it.
    pub fn desert(&mut self, mut ask: impl FnMut(&Request, &mut Stored, &Surroundings) -> (Answer, Option<Pace>)) {
        warn!("the host is gone: detached");
        (_, self.pace) = ask(&Request::Detach, self.stored, &self.around);
    }

    fn act(&mut self, tag: u8, answer: Answer) {
        match answer {
            Answer::Reply(reply) | Answer::Restarted(reply) | Answer::SelfTest(reply) => self.next = Some((tag, reply)),
            Answer::Sample if self.pace == Some(Pace::Sample) => tick::pend(),
            // Has been done before this is reported.
            Answer::Sample | Answer::Change(_) | Answer::Recorder | Answer::Protect => {}
            Answer::Rehearse(mishap) => rehearse(mishap),
        }
    }

    fn pack(&mut self, tag: u8, reply: &Reply) {
        // Every reply fits; the tests of the link encode the longest.
        self.length = encode(tag, reply, &mut self.frame).unwrap_or(0);
        self.gone = 0;
    }

    fn send(&mut self) -> bool {
        let left = self.frame.get(self.gone..self.length).unwrap_or_default();
        if left.is_empty() {
            return false;
        }
        let sent = self.line.write(left);
        self.gone += sent;
        if self.gone >= self.length {
            (self.length, self.gone) = (0, 0);
        }
        sent > 0
    }
}

/// Makes something go wrong on purpose, in images that are for that.
fn rehearse(mishap: Mishap) {
    info!("a rehearsal");
    match mishap {
        Mishap::Reset => last_words::leave(Cause::Software, 0, &[]),
        #[cfg(feature = "board-qemu")]
        Mishap::Panic => panic!("rehearsed"),
        #[cfg(feature = "board-qemu")]
        Mishap::HardFault => cortex_m::asm::udf(),
        #[cfg(feature = "board-qemu")]
        Mishap::Dawdle(counts) => crate::control::DAWDLE.store(counts, Ordering::Relaxed),
        #[cfg(feature = "board-qemu")]
        Mishap::PowerCut(bytes) => crate::board::qemu::cut_power_after(bytes),
        #[cfg(not(feature = "board-qemu"))]
        _ => {}
    }
}
