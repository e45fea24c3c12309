//! What a device answers.

use embedded_storage::nor_flash::NorFlash;

use super::{Answer, Change, Device, Mailbox, Surroundings};
use crate::control::controller::Decision;
use crate::control::sensing::sample::Sample;
use crate::control::supervisor::Phase;
use crate::link::{
    Done, Identity, LOG_BLOCK, LogBlock, LogEntry, Pace, Refusal, Reply, Request, State, TickSample, WORD_BLOCK, Words,
};
use crate::settings::store::Store;
use crate::settings::{COUNT, LAYOUT, SettingError};

impl Device {
    /// Answers a request, and changes settings where it asks to: for those that have no task that must run meanwhile.
    pub fn answer_storing<F: NorFlash>(&mut self, request: &Request, store: &mut Store<F>, around: &Surroundings) -> Answer {
        match self.answer(request, around) {
            Answer::Change(change) => {
                let prepared = change.prepare(self.wanted(change), around.least_period, |settings| store.store_erasing(settings));
                self.install(change, &prepared)
            }
            answer => answer,
        }
    }

    /// Answers a request.
    pub fn answer(&mut self, request: &Request, around: &Surroundings) -> Answer {
        if around.locked && needs_jumper(request) {
            return Answer::Reply(Reply::Refused(Refusal::NoJumper));
        }
        let reply = match *request {
            Request::Identify => Reply::Identity(self.identity(around)),
            Request::State => Reply::State(self.report_state(around)),
            Request::Read { first } => self.read(first),
            Request::Write(words) => self.write(&words),
            Request::Apply { check, store } => match self.busy() {
                Some(busy) => busy,
                None => return Answer::Change(Change::Draft { check, store }),
            },
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
                Phase::Armed => return self.test_itself(),
                phase => Reply::Refused(Refusal::Busy(phase)),
            },
            Request::Stream { every } => {
                (self.stream, self.until_report) = (every, every);
                Reply::Done(Done::AsAsked)
            }
            Request::Attach { pace } => return self.attach(pace),
            Request::Detach if self.attached.is_some() => return Answer::Change(Change::Detach),
            Request::Detach => Reply::Done(Done::AsAsked),
            Request::Sample(sample) => return self.take(sample),
            Request::Recorder | Request::Recorded { .. } => return Answer::Recorder,
            Request::EraseRecordings => match self.busy() {
                Some(busy) => busy,
                None => return Answer::Recorder,
            },
            Request::Rehearse(mishap) if around.rehearsal => return Answer::Rehearse(mishap),
            Request::Rehearse(_) => Reply::Refused(Refusal::NotHere),
            Request::Protect => match self.busy() {
                Some(busy) => busy,
                None if around.sealed => return Answer::Protect,
                None => Reply::Refused(Refusal::NotSealed),
            },
        };
        Answer::Reply(reply)
    }

    /// Whether nothing moves that the clutches are to act upon.
    pub fn rests(&self) -> bool {
        self.busy().is_none()
    }

    /// In motion nothing may change but the clutches.
    pub(super) fn busy(&self) -> Option<Reply> {
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

    /// From the beginning, with a test of the clutches and, where they are its own, of the sensors: what they have said before is nothing new.
    fn test_itself(&mut self) -> Answer {
        self.restart();
        let done = Reply::Done(Done::AsAsked);
        if self.attached.is_some() {
            return Answer::Reply(done);
        }
        self.hear(None);
        Answer::SelfTest(done)
    }

    fn attach(&mut self, pace: Pace) -> Answer {
        if let Some(busy) = self.busy() {
            return Answer::Reply(busy);
        }
        self.hear(Some(pace));
        self.restart();
        Answer::Restarted(Reply::Done(Done::AsAsked))
    }

    /// Samples come from the link, or from its own sensors.
    pub(super) fn hear(&mut self, from: Option<Pace>) {
        self.attached = from;
        self.mailbox = Mailbox::new();
        (self.sample, self.number, self.heard, self.silent) = (Sample::default(), 0, false, 0);
    }

    /// From the beginning, with the event log of before.
    pub(super) fn restart(&mut self) {
        self.controller.restart(&mut self.state);
        self.decision = Decision::before(self.safe_command());
    }

    fn read(&self, first: u16) -> Reply {
        let mut words = Words { first, count: 0, words: [0; WORD_BLOCK] };
        for (place, index) in words.words.iter_mut().zip(first..=u16::MAX) {
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
        for (&word, index) in words.words.iter().zip(words.first..=u16::MAX).take(usize::from(words.count)) {
            if let Err(error) = self.draft.set(index, word) {
                return Reply::Refused(refusal(error));
            }
        }
        Reply::Done(Done::AsAsked)
    }

    fn identity(&self, around: &Surroundings) -> Identity {
        Identity {
            version: around.version,
            build: around.build,
            board: around.board,
            counter_hz: around.counter_hz,
            settings: COUNT as u16,
            layout: LAYOUT,
            check: self.check,
            rehearsal: around.rehearsal,
            highest: around.highest,
            sealed: around.sealed,
            jumper: !around.locked,
            protection: around.protection,
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
            attached: self.attached,
        }
    }

    fn log(&self, from: u32) -> LogBlock {
        let (entries, total) = self.logged(from);
        let mut block = LogBlock { from: total, count: 0, total, entries: [LogEntry::default(); LOG_BLOCK] };
        for (place, (number, entry)) in block.entries.iter_mut().zip(entries) {
            block.from = block.from.min(number);
            *place = LogEntry::from(entry);
            block.count += 1;
        }
        block
    }
}

/// What changes the device, moves its clutches or takes it out of service: for somebody who stands at it.
fn needs_jumper(request: &Request) -> bool {
    matches!(
        request,
        Request::Write(_)
            | Request::Apply { .. }
            | Request::SelfTest
            | Request::Attach { .. }
            | Request::EraseRecordings
            | Request::Protect
    )
}

pub(super) fn refusal(error: SettingError) -> Refusal {
    match error {
        SettingError::NoSuch { index } => Refusal::NoSuchSetting(index),
        SettingError::OutOfRange { index, .. } => Refusal::OutOfRange(index),
        SettingError::Contradiction { index, other } => Refusal::Contradiction(index, other),
        // Of a controller made into settings, which is not done here.
        SettingError::NotRepresentable => Refusal::NotHere,
    }
}
