//! The device: settings, controller and state, ticks, and answers to requests.
//!
//! Two tasks share it. The control task ticks it and never waits; the link asks it for answers in between.

use embedded_storage::nor_flash::NorFlash;

use super::Mailbox;
use super::kept::{Kept, MOST_RESTARTS};
use super::reset::Cause;
use crate::control::controller::{Circumstances, ControllerState, Decision};
use crate::control::estimate::Estimate;
use crate::control::law::Wish;
use crate::control::sample::Sample;
use crate::control::supervisor::Phase;
use crate::link::{
    Done, Identity, LOG_BLOCK, LogBlock, LogEntry, Mishap, Pace, Refusal, Reply, Request, State, TickReport, TickSample,
    WORD_BLOCK, Words,
};
use crate::settings::assemble::AnyController;
use crate::settings::store::{Store, StoreError};
use crate::settings::wiring::Wiring;
use crate::settings::{COUNT, SettingError, Settings};

/// For how many ticks the first sample after a reset is waited for, before the controller starts from the beginning.
const RESUME_PATIENCE: u32 = 100;

/// For how long a device must have worked well before its restarts are forgotten, s.
const GOOD_TIME: f32 = 1.0;

/// What a device is told about what surrounds it, for [`State`] and [`Identity`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Surroundings {
    /// Version of the firmware.
    pub version: [u8; 3],
    /// Build.
    pub build: [u8; 8],
    /// Board.
    pub board: [u8; 12],
    /// Rate of the counter, 1/s.
    pub counter_hz: u32,
    /// The image is for rehearsals.
    pub rehearsal: bool,
    /// Why it started.
    pub cause: Cause,
    /// Frames that were not whole or not known.
    pub bad_frames: u32,
    /// Reports that found no room on the line.
    pub lost_reports: u32,
    /// Deepest stack, bytes.
    pub stack: u32,
}

/// What a request comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "there is no heap to put it on")]
pub enum Answer {
    /// To be sent.
    Reply(Reply),
    /// A sample has come: where samples say when a tick is, now is one.
    Sample,
    /// To be made to happen.
    Rehearse(Mishap),
    /// The period may be another now: to be answered, and the timer set.
    Restarted(Reply),
}

/// A controller with its settings and state.
#[derive(Clone, Debug)]
pub struct Device {
    settings: Settings,
    draft: Settings,
    controller: AnyController,
    state: ControllerState,
    resuming: Option<Kept>,
    waited: u32,
    decision: Decision,
    sample: Sample,
    number: u32,
    /// A sample has come from the link since it was attached.
    heard: bool,
    mailbox: Mailbox,
    ticks: u32,
    good: u32,
    restarts: u8,
    attached: Option<Pace>,
    stream: u16,
    until_report: u16,
    clear: bool,
    worst_cost: u32,
    worst_lateness: u32,
}

impl Device {
    /// With the `controller` of `settings`, going on with what has been `kept` over a reset, if anything.
    // Not inlined, and not a `Result`: the value is large, and must be made where it stays.
    #[inline(never)]
    pub fn new(controller: &AnyController, settings: &Settings, kept: Option<&Kept>) -> Device {
        let restarts = kept.map_or(0, |kept| kept.restarts.saturating_add(1));
        Device {
            settings: *settings,
            draft: *settings,
            resuming: kept.filter(|kept| kept.deciding && restarts <= MOST_RESTARTS).copied(),
            waited: 0,
            decision: safe(controller),
            controller: *controller,
            state: controller.start(),
            sample: Sample::default(),
            number: 0,
            heard: false,
            mailbox: Mailbox::new(),
            ticks: 0,
            good: 0,
            restarts,
            attached: kept.and_then(|kept| kept.attached),
            stream: 0,
            until_report: 0,
            clear: false,
            worst_cost: 0,
            worst_lateness: 0,
        }
    }

    /// The settings in force.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Who says when a tick is, if samples come from the link.
    pub fn attached(&self) -> Option<Pace> {
        self.attached
    }

    /// Whether it goes on where it was before a reset.
    pub fn resumes(&self) -> bool {
        self.resuming.is_some()
    }

    /// Resets in a row.
    pub fn restarts(&self) -> u8 {
        self.restarts
    }

    /// Period of the controller in counts of a counter of this rate (1/s).
    pub fn period_counts(&self, counter_hz: u32) -> u32 {
        (self.controller.instruments.period * counter_hz as f32 + 0.5) as u32
    }

    /// Since the start, s.
    pub fn seconds(&self) -> f32 {
        self.ticks as f32 * self.controller.instruments.period
    }

    /// What the last tick came to.
    pub fn decision(&self) -> &Decision {
        &self.decision
    }

    /// Clutches engaged in the safe state.
    pub fn safe_command(&self) -> [bool; 2] {
        self.controller.supervisor.safe()
    }

    /// One tick, `lateness` (s, 0 in time) after its time. `read` fills in what the board's own sensors say; it is not asked while samples
    /// come from the link.
    #[inline]
    pub fn tick(&mut self, read: impl FnOnce(&mut Sample), lateness: f32) {
        let mut circumstances = Circumstances { lateness, ..Circumstances::default() };
        let told = match self.attached {
            None => {
                read(&mut self.sample);
                None
            }
            Some(Pace::Timer) => self.mailbox.newest(),
            Some(Pace::Sample) => self.mailbox.next(),
        };
        if let Some(told) = &told {
            (self.sample, self.number, self.heard) = (told.sample, told.number, true);
            circumstances = told.circumstances();
            if lateness > circumstances.lateness {
                circumstances.lateness = lateness;
            }
        }
        if self.attached.is_some() && !self.heard && self.resuming.is_none() {
            // The controller starts with the first sample, on the device as on the desk.
            return;
        }
        circumstances.requests.clear |= self.clear;
        self.clear = false;
        self.ticks = self.ticks.wrapping_add(1);
        if self.resuming.is_some() && !self.go_on(self.attached.is_none() || told.is_some()) {
            return;
        }
        self.decision = self.controller.tick(&mut self.state, &self.sample, circumstances);
        self.good = self.good.saturating_add(1);
        if self.restarts > 0 && self.good as f32 * self.controller.instruments.period > GOOD_TIME {
            self.restarts = 0;
        }
    }

    /// Goes on where it was before a reset, once there is a `fresh` sample; `false` while there is none.
    fn go_on(&mut self, fresh: bool) -> bool {
        let Some(kept) = &self.resuming else { return true };
        if fresh {
            self.controller.resume(&mut self.state, &kept.calibration, kept.spins, &self.sample);
        } else if self.waited < RESUME_PATIENCE {
            self.waited += 1;
            return false;
        }
        self.resuming = None;
        true
    }

    /// To be called after a tick with what it took and how late it began, in counts: the report, if there shall be one.
    pub fn report(&mut self, cost: u32, lateness: u32) -> Option<TickReport> {
        self.worst_cost = self.worst_cost.max(cost);
        self.worst_lateness = self.worst_lateness.max(lateness);
        let due = if self.attached.is_some() {
            true
        } else {
            self.until_report = self.until_report.saturating_sub(1);
            let due = self.stream > 0 && self.until_report == 0;
            if due {
                self.until_report = self.stream;
            }
            due
        };
        due.then_some(TickReport { tick: self.ticks, sample: self.number, decision: self.decision, cost, lateness })
    }

    /// What shall survive a reset.
    pub fn kept(&self) -> Kept {
        match &self.resuming {
            Some(kept) => Kept { restarts: self.restarts, ..*kept },
            None => Kept {
                calibration: *self.state.calibration(),
                spins: self.state.spins(),
                counts: self.sample.encoder.counts,
                deciding: matches!(self.decision.phase, Phase::Armed | Phase::Rocking),
                attached: self.attached,
                restarts: self.restarts,
            },
        }
    }

    /// Whether a sample from the link waits.
    pub fn has_sample(&self) -> bool {
        !self.mailbox.is_empty()
    }

    /// Answers a request.
    pub fn answer<F: NorFlash>(&mut self, request: &Request, store: &mut Store<F>, around: &Surroundings) -> Answer {
        let reply = match *request {
            Request::Identify => Reply::Identity(self.identity(around)),
            Request::State => Reply::State(self.report_state(around)),
            Request::Read { first } => self.read(first),
            Request::Write(words) => self.write(&words),
            Request::Apply { check, store: keep } => return self.apply(check, keep, store),
            Request::Discard => {
                self.draft = self.settings;
                Reply::Done(Done::AsAsked)
            }
            Request::Log { from } => Reply::Log(self.log(from)),
            Request::Clear => {
                self.clear = true;
                Reply::Done(Done::AsAsked)
            }
            Request::SelfTest => match self.decision.phase {
                Phase::Armed => {
                    self.restart();
                    Reply::Done(Done::AsAsked)
                }
                phase => Reply::Refused(Refusal::Busy(phase)),
            },
            Request::Stream { every } => {
                (self.stream, self.until_report) = (every, every);
                Reply::Done(Done::AsAsked)
            }
            Request::Attach { pace } => return self.attach(Some(pace)),
            Request::Detach => return self.attach(None),
            Request::Sample(sample) => return self.take(sample),
            Request::Rehearse(mishap) if around.rehearsal => return Answer::Rehearse(mishap),
            Request::Rehearse(_) => Reply::Refused(Refusal::NotHere),
        };
        Answer::Reply(reply)
    }

    /// In motion nothing may change but the clutches.
    fn busy(&self) -> Option<Reply> {
        let rests = match self.decision.phase {
            Phase::Boot | Phase::SelfTest | Phase::Calibrate | Phase::Armed => true,
            Phase::Rocking => false,
            // A device that stands still with wrong settings must be able to get others.
            Phase::Fault => self.decision.estimate.standing,
        };
        if rests && self.resuming.is_none() { None } else { Some(Reply::Refused(Refusal::Busy(self.decision.phase))) }
    }

    fn take(&mut self, sample: TickSample) -> Answer {
        if self.attached.is_none() {
            return Answer::Reply(Reply::Refused(Refusal::NotHere));
        }
        self.mailbox.put(sample);
        Answer::Sample
    }

    fn attach(&mut self, pace: Option<Pace>) -> Answer {
        if let Some(busy) = self.busy() {
            return Answer::Reply(busy);
        }
        self.attached = pace;
        self.mailbox = Mailbox::new();
        (self.sample, self.number, self.heard) = (Sample::default(), 0, false);
        self.restart();
        Answer::Restarted(Reply::Done(Done::AsAsked))
    }

    /// From the beginning, with the event log of before.
    fn restart(&mut self) {
        self.controller.restart(&mut self.state);
        self.decision = safe(&self.controller);
    }

    fn read(&self, first: u16) -> Reply {
        let mut words = Words { first, count: 0, words: [0; WORD_BLOCK] };
        for (place, index) in words.words.iter_mut().zip(first..) {
            let Some(word) = self.settings.get(index) else { break };
            *place = word;
            words.count += 1;
        }
        if words.count == 0 { Reply::Refused(Refusal::NoSuchSetting(first)) } else { Reply::Words(words) }
    }

    fn write(&mut self, words: &Words) -> Reply {
        if let Some(busy) = self.busy() {
            return busy;
        }
        if usize::from(words.count) > WORD_BLOCK {
            return Reply::Refused(Refusal::NoSuchSetting(words.first));
        }
        for (&word, index) in words.words.iter().zip(words.first..).take(usize::from(words.count)) {
            if let Err(error) = self.draft.set(index, word) {
                return Reply::Refused(refusal(error));
            }
        }
        Reply::Done(Done::AsAsked)
    }

    fn apply<F: NorFlash>(&mut self, check: u32, keep: bool, store: &mut Store<F>) -> Answer {
        let refused = |refusal| Answer::Reply(Reply::Refused(refusal));
        if let Some(busy) = self.busy() {
            return Answer::Reply(busy);
        }
        let own = self.draft.check();
        if check != own {
            return refused(Refusal::Check(own));
        }
        let controller = match Wiring::check(&self.draft).and_then(|()| AnyController::of(&self.draft)) {
            Ok(controller) => controller,
            Err(error) => return refused(refusal(error)),
        };
        if keep {
            match store.store(&self.draft) {
                Ok(()) => {}
                Err(StoreError::Full) => return refused(Refusal::FlashFull),
                Err(StoreError::Flash) => return refused(Refusal::FlashFailed),
            }
        }
        let done = Reply::Done(if keep { Done::Stored } else { Done::AsAsked });
        if self.settings == self.draft {
            // Asked twice, or nothing new: the controller goes on.
            return Answer::Reply(done);
        }
        (self.settings, self.controller) = (self.draft, controller);
        self.restart();
        Answer::Restarted(done)
    }

    fn identity(&self, around: &Surroundings) -> Identity {
        Identity {
            version: around.version,
            build: around.build,
            board: around.board,
            counter_hz: around.counter_hz,
            settings: COUNT as u16,
            check: self.settings.check(),
            rehearsal: around.rehearsal,
        }
    }

    fn report_state(&self, around: &Surroundings) -> State {
        State {
            phase: self.decision.phase,
            fault: self.decision.fault,
            ticks: self.ticks,
            calibration: *self.state.calibration(),
            log_count: self.state.supervisor().log.count(),
            worst_cost: self.worst_cost,
            worst_lateness: self.worst_lateness,
            bad_frames: around.bad_frames,
            lost_reports: around.lost_reports,
            stack: around.stack,
            cause: around.cause,
        }
    }

    fn log(&self, from: u32) -> LogBlock {
        let log = &self.state.supervisor().log;
        let total = log.count();
        let oldest = total.saturating_sub(log.iter().count() as u32);
        let from = from.clamp(oldest, total);
        let mut block = LogBlock { from, count: 0, total, entries: [LogEntry::default(); LOG_BLOCK] };
        for (place, entry) in block.entries.iter_mut().zip(log.iter().skip((from - oldest) as usize)) {
            *place = LogEntry::from(entry);
            block.count += 1;
        }
        block
    }
}

/// Before a controller's first tick.
fn safe(controller: &AnyController) -> Decision {
    Decision {
        command: controller.supervisor.safe(),
        estimate: Estimate { standing: true, ..Estimate::default() },
        wish: Wish::Release,
        phase: Phase::Boot,
        fault: None,
    }
}

fn refusal(error: SettingError) -> Refusal {
    match error {
        SettingError::NoSuch { index } => Refusal::NoSuchSetting(index),
        SettingError::OutOfRange { index, .. } => Refusal::OutOfRange(index),
        SettingError::Contradiction { index, other } => Refusal::Contradiction(index, other),
        // Of a controller made into settings, which is not done here.
        SettingError::NotRepresentable => Refusal::NotHere,
    }
}
