//! The device around the controller: what it receives over the link, what it retains over a reset, what it shows.
//!
//! Two tasks share it. The control task ticks it and never waits; the link asks it for answers in between.
//!
//! The room imports `math`, `structure`, `control`, `settings` and `link`.

mod answers;
pub mod beginning;
mod change;
pub mod clock_check;
pub mod coil;
pub mod coil_test;
pub mod conditions;
pub mod counter;
pub mod inertial;
pub mod light;
mod mailbox;
pub mod pull_in;
pub mod recorder;
pub mod retained;
pub mod retained_log;
#[cfg(test)]
mod tests;

pub use change::{Change, Prepared};
pub use mailbox::Mailbox;

use crate::control::controller::{Circumstances, Controller, ControllerState, Decision};
use crate::control::monitor::coil::CoilReading;
use crate::control::monitor::fault::{Fault, Recovery};
use crate::control::sensing::sample::Sample;
use crate::control::supervisor::Phase;
use crate::control::supervisor::event_log::{Entry, Kind};
use crate::control::ticks::ticks;
use crate::link::reset_cause::Cause;
use crate::link::{Mishap, Pace, Protection, Reply, TickReport};
use crate::settings::{Item, Settings};
use beginning::Beginning;
use light::Shown;
use retained::{MOST_RESTARTS, Retained};

/// For how long the first whole sample after a reset is waited for, before the controller starts from the beginning, s: twice what an
/// ICM-42688-P takes that has to be configured anew.
const RESUME_PATIENCE: f32 = 0.1;

/// For how long a device must have worked well before its restarts are forgotten, s.
const GOOD_TIME: f32 = 1.0;

/// After so long without a sample an attached device takes its host to be gone, s.
pub const HOST_SILENCE: f32 = 5.0;

/// What surrounds a device, for [`State`](crate::link::State) and [`Identity`](crate::link::Identity).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Surroundings {
    /// Version of the firmware.
    pub version: [u8; 3],
    /// Build.
    pub build: [u8; 8],
    /// Board.
    pub board: [u8; 12],
    /// Rate of the counter, 1/s.
    pub counter_hz: u32,
    /// Shortest period of the controller that the board has time for, s.
    pub least_period: f32,
    /// Whether the image takes requests for fault injection.
    pub rehearsal: bool,
    /// The commissioning jumper is open: it is not to be changed, tested or attached.
    pub locked: bool,
    /// Highest version of a firmware that has run on the board.
    pub highest: [u8; 3],
    /// The image has a seal.
    pub sealed: bool,
    /// What the flash is protected against.
    pub protection: Protection,
    /// Cause of the start.
    pub cause: Cause,
    /// Frames that were not whole or not known.
    pub bad_frames: u32,
    /// Reports that found no room on the line.
    pub lost_reports: u32,
    /// Deepest stack, bytes.
    pub stack: u32,
}

/// Answer to a request.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answer {
    /// To be sent.
    Reply(Reply),
    /// A sample has come: where samples say when a tick is, now is one.
    Sample,
    /// Other settings: to be [prepared](Change::prepare) from those of [`Device::wanted`] while the control task runs, and then given to
    /// [`Device::install`].
    Change(Change),
    /// The flight recorder's to answer.
    Recorder,
    /// A fault to be injected.
    Rehearse(Mishap),
    /// The flash is to be protected.
    Protect,
    /// The sensors are to test themselves, from before the next tick on; to be answered.
    SelfTest(Reply),
    /// The period may be another now: to be answered, and the timer set.
    Restarted(Reply),
}

/// A controller with its settings and state.
// What each tick touches comes first, where an instruction reaches it.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Device {
    sample: Sample,
    decision: Decision,
    coils: [CoilReading; 2],
    ticks: u32,
    good: u32,
    number: u32,
    /// Ticks without a sample since it was attached.
    silent: u32,
    worst_cost: u32,
    worst_lateness: u32,
    waited: u32,
    stream: u16,
    until_report: u16,
    restarts: u8,
    attached: Option<Pace>,
    /// A sample has come from the link since it was attached.
    heard: bool,
    clear: bool,
    /// The settings in force are those that a reset would find.
    lasting: bool,
    /// Storing failed: flash may hold what is kept here or what was to be stored.
    doubtful: bool,
    /// Why it may not run without a host.
    barred: Option<Fault>,
    resuming: Option<Retained>,
    controller: Controller,
    state: ControllerState,
    mailbox: Mailbox,
    /// Of their words: to compute it takes longer than the control task may be held up.
    check: u32,
    settings: Settings,
    draft: Settings,
    /// What a reset would find, unless that is in doubt.
    kept: Settings,
}

impl Device {
    /// A device that starts as `beginning` says, and resumes from the state `retained` over a reset, if any.
    // Not inlined, and not a `Result`: the value is large, and must be made where it stays.
    #[inline(never)]
    pub fn new(beginning: &Beginning, retained: Option<&Retained>) -> Device {
        let Beginning { settings, controller, barred } = beginning;
        let restarts = retained.map_or(0, |retained| retained.restarts.saturating_add(1));
        let may = |last: &&Retained| last.deciding && restarts <= MOST_RESTARTS && (barred.is_none() || last.attached.is_some());
        Device {
            settings: *settings,
            check: settings.check(),
            draft: *settings,
            kept: *settings,
            doubtful: false,
            lasting: true,
            barred: *barred,
            resuming: retained.filter(may).copied(),
            waited: 0,
            decision: Decision::before(controller.supervisor.safe()),
            controller: *controller,
            state: controller.start(),
            sample: Sample::default(),
            number: 0,
            heard: false,
            mailbox: Mailbox::new(),
            ticks: 0,
            good: 0,
            restarts,
            attached: retained.and_then(|retained| retained.attached),
            silent: 0,
            stream: 0,
            until_report: 0,
            clear: false,
            coils: Default::default(),
            worst_cost: 0,
            worst_lateness: 0,
        }
    }

    /// The settings in force.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Why it may not run without a host, if it may not.
    pub fn barred(&self) -> Option<Fault> {
        self.barred
    }

    /// Has it stand aside for a `fault` of the board that was found beside the ticks, until a new start does not find it.
    #[inline(never)]
    pub fn accuse(&mut self, fault: Fault) {
        if self.barred.is_none_or(|barred| barred.recovery() != Recovery::ByStart) {
            (self.barred, self.resuming) = (Some(fault), None);
        }
    }

    /// Where what must not change while it is in force lies: address and bytes of the controller and of its settings.
    pub fn constants(&self) -> [(usize, usize); 2] {
        let controller = (core::ptr::from_ref(&self.controller).addr(), size_of::<Controller>());
        [controller, (core::ptr::from_ref(&self.settings).addr(), size_of::<Settings>())]
    }

    /// Notes a warning in the event log.
    #[inline(never)]
    pub fn warn(&mut self, fault: Fault) {
        self.note(Kind::Warning(fault.code()));
    }

    fn note(&mut self, kind: Kind) {
        self.state.note(Entry { tick: self.ticks, kind, rotation: 0.0, velocity: 0.0 });
    }

    /// Who says when a tick is, if samples come from the link.
    pub fn attached(&self) -> Option<Pace> {
        self.attached
    }

    /// Whether the host to which it is attached has been silent for [`HOST_SILENCE`]: it is to be detached, as by
    /// [`Request::Detach`](crate::link::Request::Detach).
    pub fn deserted(&self) -> bool {
        self.attached.is_some() && self.silent as f32 * self.controller.instruments.period > HOST_SILENCE
    }

    /// Whether it resumes where it was before a reset.
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

    /// For how long it waits for its sensors' first readings, s: for that long they may test themselves.
    pub fn patience(&self) -> f32 {
        self.settings.real(Item::BootTime)
    }

    /// Period of the controller, s.
    pub fn period(&self) -> f32 {
        self.controller.instruments.period
    }

    /// Slots of the light since the start, counted in whole ticks; they begin anew when the count of ticks does.
    pub fn light_slot(&self) -> u32 {
        self.ticks / light::slot_ticks(self.controller.instruments.period)
    }

    /// What the light is to show.
    pub fn shown(&self) -> Shown {
        let Decision { phase, fault, .. } = self.decision;
        Shown { phase, fault: fault.map(Fault::code), attached: self.attached.is_some() }
    }

    /// Decision of the last tick.
    pub fn decision(&self) -> &Decision {
        &self.decision
    }

    /// Clutches engaged in the safe state, of the board's own: less what a fault of theirs forbids. Those of a host are somewhere else.
    pub fn safe_command(&self) -> [bool; 2] {
        let supervisor = &self.controller.supervisor;
        if self.attached.is_some() { supervisor.safe() } else { supervisor.safe_now(self.state.supervisor()) }
    }

    /// What the coils' currents said, before the tick that shall know it. Nobody asks while samples come from the link.
    pub fn note_coils(&mut self, coils: [CoilReading; 2]) {
        self.coils = coils;
    }

    /// Each pulse shall try the switches of its coil, one by one.
    pub fn tests_coils(&self) -> bool {
        self.attached.is_none() && self.state.supervisor().tests_coils()
    }

    /// One tick, `lateness` (s, 0 in time) after its time. `read` fills in what the board's own sensors say; it is not asked while samples
    /// come from the link.
    #[inline]
    pub fn tick(&mut self, read: impl FnOnce(&mut Sample), lateness: f32) {
        if let (None, Some(fault)) = (self.attached, self.barred) {
            read(&mut self.sample);
            self.stand_aside(fault);
            return;
        }
        let mut circumstances = Circumstances { lateness, ..Circumstances::default() };
        let given = match self.attached {
            None => {
                read(&mut self.sample);
                circumstances.coils = self.coils.map(|coil| coil.report);
                if self.coils.iter().any(|coil| coil.closed.is_some()) {
                    let period = self.controller.instruments.period;
                    circumstances.closed = self.coils.map(|coil| coil.closed.map(|ticks| ticks as f32 * period));
                }
                None
            }
            Some(Pace::Timer) => self.mailbox.newest(),
            Some(Pace::Sample) => self.mailbox.oldest(),
        };
        self.silent = self.silent.saturating_add(1);
        if let Some(given) = &given {
            (self.sample, self.number, self.heard, self.silent) = (given.sample, given.number, true, 0);
            circumstances = given.circumstances();
            if lateness > circumstances.lateness {
                circumstances.lateness = lateness;
            }
        } else if self.attached.is_some() && self.decision.phase == Phase::Fault {
            // While nobody says what the clutches do they cannot be blamed for it.
            self.sample.engaged = self.decision.command;
        }
        if self.attached.is_some() && !self.heard && self.resuming.is_none() {
            // The controller starts with the first sample, on the device as on the desk.
            return;
        }
        circumstances.requests.clear |= self.clear;
        self.clear = false;
        self.ticks = self.ticks.wrapping_add(1);
        if self.resuming.is_some() {
            let whole = if self.attached.is_none() { self.controller.supervisor.whole(&self.sample) } else { given.is_some() };
            if !self.go_on(whole) {
                return;
            }
        }
        self.decision = self.controller.tick(&mut self.state, &self.sample, circumstances);
        if self.restarts > 0 {
            self.good = self.good.saturating_add(1);
            if self.good as f32 * self.controller.instruments.period > GOOD_TIME {
                self.restarts = 0;
            }
        }
    }

    /// A tick of a device that may not run by itself.
    #[inline(never)]
    fn stand_aside(&mut self, fault: Fault) {
        self.clear = false;
        self.ticks = self.ticks.wrapping_add(1);
        self.state.set_clock(self.ticks);
        if self.decision.fault != Some(fault) {
            self.note(Kind::Fault(fault.code()));
        }
        self.decision = Decision { phase: Phase::Fault, fault: Some(fault), ..Decision::before(self.safe_command()) };
    }

    /// Resumes where it was before a reset, once there is a `whole` sample; `false` while there is none. Only then is a sensor that gives
    /// nothing more stale.
    fn go_on(&mut self, whole: bool) -> bool {
        let Some(retained) = &self.resuming else { return true };
        if whole {
            let Retained { calibration, spins, ground_drift, .. } = retained;
            self.controller.resume(&mut self.state, calibration, *spins, *ground_drift, &self.sample);
        } else if self.waited < ticks(RESUME_PATIENCE, self.controller.instruments.period) {
            self.waited += 1;
            self.state.set_clock(self.ticks);
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

    /// State to be retained over a reset.
    pub fn retained(&self) -> Retained {
        match &self.resuming {
            Some(retained) => Retained { restarts: self.restarts, ..*retained },
            None => Retained {
                calibration: *self.state.calibration(),
                spins: self.state.spins(),
                ground_drift: self.state.ground_drift(),
                counts: self.sample.encoder.counts,
                // By other settings it must not resume.
                deciding: self.lasting && matches!(self.decision.phase, Phase::Armed | Phase::Rocking),
                attached: self.attached,
                restarts: self.restarts,
            },
        }
    }

    /// Whether a sample from the link waits.
    pub fn has_sample(&self) -> bool {
        !self.mailbox.is_empty()
    }
}
