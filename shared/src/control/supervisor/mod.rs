//! Who decides: the law while everything is well, and the safe state while it is not.
//!
//! Boot → SelfTest → Calibrate → Armed ⇄ Rocking, and Fault from everywhere after Boot. Only Armed and Rocking send what the law wishes, and
//! only SelfTest and, in Armed, a proof test pulse the clutches; all else sends the safe state. [`Fault::recovery`] has the ways out of Fault.
//!
//! The room imports `structure`, `control::sensing`, `control::monitor` and `control::ticks`.

mod command_rate;
pub mod event_log;
mod following;
mod interface;
mod judge;
mod ladder;
mod motion;
mod parameters;
mod proof_test;
mod self_test;

pub use interface::{Biases, Phase, Requests, SupervisorInput, Verdict};
pub use parameters::{Parameters, SafeState};

use crate::control::monitor::actuator::{ActuatorMonitor, ActuatorState};
use crate::control::monitor::fault::{Fault, Place, Recovery, Wheel};
use crate::control::monitor::scale::Scale;
use crate::control::monitor::{Context, Findings, Monitor, MonitorState};
use crate::control::sensing::calibration::{Averaging, Calibration, Plausible};
use crate::control::sensing::required::Required;
use crate::control::sensing::sample::Sample;
use crate::control::sensing::sensor::Sensor;
use crate::control::ticks::Streak;
use crate::structure::error::ParameterError;
use command_rate::CommandRate;
use event_log::{Entry, EventLog, Kind};
use following::Following;
use judge::SOURCES;
use ladder::Ladder;
use motion::{Motion, MotionLimits};
use proof_test::ProofTest;
use self_test::SelfTest;

/// Entries that the log holds.
pub const LOG_ENTRIES: usize = 64;

/// Parameters of a supervisor, checked and in ticks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Supervisor {
    monitor: Monitor,
    actuator: ActuatorMonitor,
    motion: MotionLimits,
    required: Required,
    safe: [bool; 2],
    both_allowed: bool,
    self_test: bool,
    boot: u32,
    stillness: u32,
    calibration: u32,
    patience: u32,
    quiet: u32,
    recovery: u32,
    plausible: Plausible,
    overrun_ticks: u32,
    overrun_limit: f32,
    /// Ticks of a second.
    second: u32,
    /// Samples that are averaged for a step towards a drift, …
    averaged: u32,
    /// … and its share of the way.
    followed: f32,
    /// Averages from one proof test to the next.
    proof_interval: u32,
}

/// Where a supervisor stands; the default is before its first tick.
#[derive(Clone, Debug, Default, PartialEq)]
#[repr(C)]
pub struct SupervisorState {
    phase: Phase,
    /// Wrapping.
    tick: u32,
    cause: Option<Fault>,
    /// One of the faults since then takes a request.
    latched: bool,
    /// What each source said at the last tick.
    active: [Option<Fault>; SOURCES],
    /// Any of them said something.
    any_active: bool,
    sent: [bool; 2],
    calibration: Calibration,
    /// The gyroscope's bias was measured.
    calibrated: bool,
    /// It has resumed after a reset, so that the encoder's zero and the biases are those of before: to be measured again at rest.
    resumed: bool,
    /// The self-test was passed, or is not wanted.
    tested: bool,
    /// Ticks spent in Boot, or in SelfTest and Calibrate waiting for stillness.
    waiting: u32,
    clear_before: bool,
    late: Streak,
    good: Streak,
    monitor: MonitorState,
    actuator: ActuatorState,
    motion: Motion,
    self_test: SelfTest,
    proof: ProofTest,
    averaging: Averaging,
    following: Following,
    command_rate: CommandRate,
    ladder: Ladder,
    scale: Scale,
    /// Event log.
    pub log: EventLog<LOG_ENTRIES>,
}

impl SupervisorState {
    /// From the beginning, with the event log of before.
    pub fn restart(&mut self) {
        let SupervisorState {
            log: _,
            phase,
            tick: _,
            cause,
            latched,
            active,
            any_active,
            sent,
            calibration,
            calibrated,
            resumed,
            tested,
            waiting,
            clear_before,
            late,
            good,
            monitor,
            actuator,
            motion,
            self_test,
            proof,
            averaging,
            following,
            command_rate,
            ladder,
            scale,
        } = self;
        (*phase, *cause, *latched, *active, *any_active) = (Phase::Boot, None, false, [None; SOURCES], false);
        (*sent, *calibration, *calibrated) = ([false; 2], Calibration::default(), false);
        (*resumed, *tested) = (false, false);
        (*waiting, *clear_before, *late, *good) = (0, false, Streak::default(), Streak::default());
        *monitor = MonitorState::default();
        (*actuator, *motion) = (ActuatorState::default(), Motion::default());
        (*self_test, *proof, *averaging) = (SelfTest::default(), ProofTest::default(), Averaging::default());
        (*following, *command_rate) = (Following::default(), CommandRate::default());
        (*ladder, *scale) = (Ladder::default(), Scale::default());
    }

    /// Ticks before the next one, of a clock that also goes on while no step is taken: all entries of the log are of one clock.
    pub fn set_clock(&mut self, ticks: u32) {
        self.tick = ticks;
    }

    /// A board that measures its coils' currents shall try their switches one by one before it engages.
    pub fn tests_coils(&self) -> bool {
        self.phase == Phase::SelfTest || self.proof.goes_on()
    }

    /// What the monitor found at the last tick.
    #[inline]
    fn findings(&self) -> &Findings {
        self.monitor.findings()
    }

    /// Phase after the last tick.
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// Biases that the estimators subtract, …
    pub fn calibration(&self) -> &Calibration {
        &self.calibration
    }

    /// … and whether they were measured.
    pub fn calibrated(&self) -> bool {
        self.calibrated
    }
}

impl Supervisor {
    /// # Errors
    /// Names the first parameter outside its range.
    pub fn new(parameters: &Parameters) -> Result<Supervisor, ParameterError> {
        parameters.check()?;
        Ok(parameters.resolve())
    }

    /// Of parameters that are known to be within their ranges, as [`crate::settings`] has checked them by its own table. Others make a
    /// supervisor of little use, but no panic.
    pub fn of_checked(parameters: &Parameters) -> Supervisor {
        parameters.resolve()
    }

    /// Clutches engaged in the safe state.
    pub fn safe(&self) -> [bool; 2] {
        self.safe
    }

    /// Every sensor that is required has given a reading since the `sample` was empty.
    pub fn whole(&self, sample: &Sample) -> bool {
        let [block, ground] =
            [sample.block_accelerometer, sample.ground_accelerometer].map(|axes| axes.iter().all(|reading| reading.number != 0));
        let read = [sample.gyroscope.number != 0, block, ground, sample.encoder.number != 0];
        self.required.flags().into_iter().zip(read).all(|(required, read)| read || !required)
    }

    /// A state that skips everything before Rocking, for a run that begins with the motion; the estimators' beginning is the caller's.
    pub fn started(&self, calibration: Calibration) -> SupervisorState {
        let mut state = SupervisorState::default();
        self.resume(&mut state, &calibration);
        state.resumed = false;
        state
    }

    /// Makes a state that has just begun, after a reset in motion, skip everything before Rocking. Once nothing moves it is calibrated anew:
    /// what the encoder has missed is gone then.
    pub fn resume(&self, state: &mut SupervisorState, calibration: &Calibration) {
        (state.phase, state.calibration, state.calibrated, state.tested) = (Phase::Rocking, *calibration, true, true);
        state.following.unsure = true;
        state.resumed = true;
        state.monitor = MonitorState::expecting(self.required.flags());
    }

    /// One tick.
    pub fn step(&self, state: &mut SupervisorState, input: &SupervisorInput<'_>) -> Verdict {
        state.tick = state.tick.wrapping_add(1);
        if Scale::is_due(state.tick) {
            self.weigh_gravity(state, input);
        }
        let at_rest = state.motion.block_still >= self.quiet;
        let context = Context { calibration: &state.calibration, calibrated: state.calibrated, at_rest, lever: input.lever };
        let findings = self.monitor.step(&mut state.monitor, input.sample, &context);
        state.motion.step(&self.motion, input.sample, findings.good(), findings.shaking, &state.calibration);
        self.stand_in(state);
        let (alarm, latches) = if state.phase == Phase::Boot { (None, false) } else { self.judge(state, input) };
        let clear = input.requests.clear && !state.clear_before;
        state.clear_before = input.requests.clear;
        let mut biases = Biases::Kept;
        match (alarm, state.phase) {
            (Some(_), Phase::Fault) => {
                state.latched |= latches;
                state.good = Streak::default();
                self.leave(state, input, clear, false);
            }
            (Some(fault), _) => {
                self.fail(state, input, fault);
                state.latched |= latches;
            }
            (None, Phase::Boot) => self.boot(state, input),
            (None, Phase::SelfTest) => self.test(state, input),
            (None, Phase::Calibrate) => biases = self.calibrate(state, input),
            (None, Phase::Armed) if state.motion.quiet == 0 => enter(state, input, Phase::Rocking),
            (None, Phase::Rocking) if state.motion.quiet >= self.quiet => {
                enter(state, input, if state.resumed { Phase::Calibrate } else { Phase::Armed });
            }
            // By biases that are not to be trusted it would seem to move for good.
            (None, Phase::Rocking) if state.following.unsure && state.motion.still(self.quiet) => {
                enter(state, input, Phase::Calibrate);
            }
            (None, Phase::Armed) if self.calibrate_again(state, input) => {}
            (None, Phase::Armed) if state.proof.goes_on() => self.prove(state, input),
            (None, Phase::Armed) if state.ladder.lost.is_none() && self.follow(state, input) => {
                biases = Biases::Followed;
            }
            (None, Phase::Armed | Phase::Rocking) => {}
            (None, Phase::Fault) => {
                let missing =
                    self.required.flags().into_iter().zip(state.findings().good()).any(|(required, good)| required && !good);
                state.good.note(!missing);
                self.leave(state, input, clear, true);
            }
        }
        if let Some(wheel) = input.slower {
            log(state, input, Kind::Warning(Fault::ClosingTimeChanged(wheel).code()));
        }
        let command = self.command(state, input);
        if command != state.sent {
            for (wheel, (before, now)) in Wheel::ALL.into_iter().zip(state.sent.into_iter().zip(command)) {
                if before != now {
                    log(state, input, if now { Kind::Engaged(wheel) } else { Kind::Released(wheel) });
                }
            }
            if state.command_rate.changed(state.tick, self.second) {
                log(state, input, Kind::Warning(Fault::CommandsTooMany.code()));
            }
            state.sent = command;
        }
        let fault = if state.phase == Phase::Fault { state.cause } else { state.ladder.lost };
        Verdict { phase: state.phase, fault, command, biases }
    }

    /// What is to be sent: in a self-test the safe state until nothing moves. Never both to a block that moves, where that is not allowed:
    /// what was sent before then stays.
    fn command(&self, state: &SupervisorState, input: &SupervisorInput<'_>) -> [bool; 2] {
        match state.phase {
            Phase::Armed if state.proof.goes_on() => state.proof.command(input.wish),
            Phase::Armed | Phase::Rocking if self.too_many(input) => state.sent,
            Phase::Armed | Phase::Rocking => input.wish,
            Phase::SelfTest if self.self_test && state.motion.still(self.stillness) => state.self_test.command(),
            _ => self.safe_now(state),
        }
    }

    fn too_many(&self, input: &SupervisorInput<'_>) -> bool {
        input.wish == [true; 2] && !self.both_allowed && !input.standing
    }

    /// Has the accelerometers' scale looked at, whatever the phase.
    // Before all else of a tick, which then need not keep anything for it.
    #[cold]
    #[inline(never)]
    fn weigh_gravity(&self, state: &mut SupervisorState, input: &SupervisorInput<'_>) {
        let at_rest = state.motion.block_still >= self.quiet;
        let found = state.scale.look(input.sample, at_rest, self.motion.gravity);
        for (place, _) in Place::ALL.into_iter().zip(found).filter(|(_, found)| *found) {
            log(state, input, Kind::Warning(Fault::ScaleWrong(place).code()));
        }
    }

    #[inline(never)]
    fn fail(&self, state: &mut SupervisorState, input: &SupervisorInput<'_>, fault: Fault) {
        state.cause = Some(fault);
        state.latched = fault.recovery() == Recovery::OnRequest;
        state.good = Streak::default();
        enter(state, input, Phase::Fault);
    }

    /// Out of Fault, by itself where it `may`, or by request.
    #[inline(never)]
    fn leave(&self, state: &mut SupervisorState, input: &SupervisorInput<'_>, clear: bool, may: bool) {
        if clear && state.motion.still(self.quiet) {
            state.actuator = ActuatorState::default();
            state.late = Streak::default();
            state.tested = false;
            state.ladder = Ladder::default();
            enter(state, input, Phase::SelfTest);
        } else if may && !state.latched && state.good.lasted(self.recovery) && state.motion.block_still >= self.quiet {
            state.ladder = Ladder::default();
            enter(state, input, if state.tested { Phase::Calibrate } else { Phase::SelfTest });
        }
    }

    #[inline(never)]
    fn boot(&self, state: &mut SupervisorState, input: &SupervisorInput<'_>) {
        let findings = state.findings();
        let mut missing = None;
        for ((sensor, required), (fault, seen)) in
            Sensor::ALL.into_iter().zip(self.required.flags()).zip(findings.faults().into_iter().zip(findings.seen()))
        {
            let wrong = if seen { fault } else { Some(Fault::Stale(sensor)) };
            missing = missing.or(wrong.filter(|_| required));
        }
        state.waiting = state.waiting.saturating_add(1);
        match missing {
            None => enter(state, input, Phase::SelfTest),
            Some(fault) if state.waiting > self.boot => {
                log(state, input, Kind::Fault(fault.code()));
                self.fail(state, input, fault);
            }
            Some(_) => {}
        }
    }

    #[inline(never)]
    fn test(&self, state: &mut SupervisorState, input: &SupervisorInput<'_>) {
        let still = state.motion.still(self.stillness);
        if !self.self_test || state.self_test.step(state.sent, input.sample.engaged, input.coils, still) {
            state.tested = true;
            enter(state, input, Phase::Calibrate);
            return;
        }
        state.waiting = state.waiting.saturating_add(1);
        if state.waiting >= self.patience {
            let spent = state.waiting;
            log(state, input, Kind::Warning(Fault::SelfTestAbandoned.code()));
            enter(state, input, Phase::Calibrate);
            // It has waited long enough for both.
            state.waiting = spent;
        }
    }

    #[inline(never)]
    fn calibrate(&self, state: &mut SupervisorState, input: &SupervisorInput<'_>) -> Biases {
        if (state.resumed || state.following.unsure) && state.motion.quiet == 0 && !state.motion.still(1) {
            // The next shock must not find it waiting: what it has is good enough, as before. A bias alone is no shock.
            enter(state, input, Phase::Rocking);
            return Biases::Kept;
        }
        state.waiting = state.waiting.saturating_add(1);
        if !state.motion.still(1) {
            state.averaging = Averaging::default();
        } else {
            state.averaging.add(input.sample, state.monitor.findings().good());
        }
        if state.averaging.ticks() >= self.calibration {
            let (found, wrong) = state.averaging.finish(&state.calibration, &self.plausible, self.motion.gravity);
            let mut refused = None;
            for (sensor, _) in Sensor::ALL.into_iter().zip(wrong).filter(|(_, wrong)| *wrong) {
                let fault = Fault::Contradiction(sensor);
                let acted_upon = self.acted_upon(state, fault);
                log(state, input, if acted_upon { Kind::Fault(fault.code()) } else { Kind::Warning(fault.code()) });
                refused = refused.or(Some(fault).filter(|_| acted_upon));
            }
            if let Some(fault) = refused {
                self.fail(state, input, fault);
                return Biases::Kept;
            }
            (state.calibration, state.calibrated, state.resumed) = (found, true, false);
            state.monitor.recalibrated();
            state.following = Following::default();
            log(state, input, Kind::Calibrated);
            enter(state, input, Phase::Armed);
            return Biases::Measured;
        }
        if state.waiting >= self.patience {
            log(state, input, Kind::Warning(Fault::CalibrationAbandoned.code()));
            state.following.unsure = true;
            enter(state, input, Phase::Armed);
        }
        Biases::Kept
    }
}

#[inline(never)]
fn enter(state: &mut SupervisorState, input: &SupervisorInput<'_>, phase: Phase) {
    state.phase = phase;
    state.waiting = 0;
    state.self_test = SelfTest::default();
    if state.proof.goes_on() {
        proof_test::put_off(state, input);
    }
    state.averaging = Averaging::default();
    log(state, input, Kind::Phase(phase));
}

#[inline(never)]
fn log(state: &mut SupervisorState, input: &SupervisorInput<'_>, kind: Kind) {
    let (rotation, velocity) = input.estimate;
    state.log.push(Entry { tick: state.tick, kind, rotation, velocity });
}

#[cfg(test)]
mod tests;
