//! One control tick: readings in, a command for each clutch out.
//!
//! Readings, estimate, prediction, law, turn, dwell and supervisor in a row, in single precision, without a panic, a heap or a loop whose
//! length depends on data. The host simulates this code and the firmware runs it.

use super::clutch_position::{ClutchLag, ClutchPositions};
use super::model::Model;
use crate::control::estimation::estimate::Estimate;
use crate::control::estimation::prediction::predict_from;
use crate::control::estimation::{Estimator, EstimatorState};
use crate::control::law::any_law::ClutchLaw;
use crate::control::law::minimum_dwell::{Gate, GateState};
use crate::control::law::signs::Signs;
use crate::control::law::turn_taking::TurnsState;
use crate::control::law::{DRIFT_TIME, Law, Situation, Wish};
use crate::control::monitor::coil::CoilReports;
use crate::control::monitor::fault::Fault;
use crate::control::sensing::calibration::Calibration;
use crate::control::sensing::instruments::{Instruments, InstrumentsState, Measured};
use crate::control::sensing::sample::{Reading, Sample};
use crate::control::supervisor::event_log::Entry;
use crate::control::supervisor::{Biases, Phase, Requests, Supervisor, SupervisorInput, SupervisorState};
use crate::equation::body::Body;
use crate::math::fnv::Fnv;
use crate::math::sign::Sign;
use crate::structure::block::GRAVITY;
use serde::{Deserialize, Serialize};

/// g, m/s².
const STANDARD_GRAVITY: f32 = GRAVITY as f32;

/// Steps after which a rotation from the rack's travel is exact in single precision.
const NEWTON_STEPS: u32 = 4;

/// Parameters of a controller by a law `L`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controller<L = ClutchLaw> {
    /// The structure as it is believed to be.
    pub model: Model,
    /// The sensors.
    pub instruments: Instruments,
    /// The estimator.
    pub estimator: Estimator,
    /// The law.
    pub law: L,
    /// From a tick to the moment at which its command has engaged a clutch, and released one, s.
    pub horizons: Horizons,
    /// Width of the hysteresis of signs in standard deviations of the estimate.
    pub bands: f32,
    /// Both clutches are engaged while the block stands, so that a flywheel resists from the first instant of uplift to either side, without
    /// a delay. A flywheel that is taken on at rest costs nothing but the coil's holding current. Otherwise neither is.
    pub engaged_at_rest: bool,
    /// Minimum dwell.
    pub gate: Gate,
    /// From the clutches' feedback to the clutches.
    pub lag: ClutchLag,
    /// Who watches.
    pub supervisor: Supervisor,
}

/// From a tick to the moment at which its command has moved a clutch, s; 0 to 10.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Horizons {
    /// Horizon of a flywheel to be engaged.
    pub engagement: f32,
    /// Horizon of a flywheel to be released.
    pub release: f32,
}

impl Horizons {
    /// Horizons of engagement and release that both take `time` (s).
    pub const fn of(time: f32) -> Horizons {
        Horizons { engagement: time, release: time }
    }
}

/// State of the controller.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct ControllerState {
    instruments: InstrumentsState,
    estimator: EstimatorState,
    signs: Signs,
    /// The block stood at the last tick.
    stood: bool,
    turns: TurnsState,
    gate: GateState,
    clutches: ClutchPositions,
    drift: f32,
    supervisor: SupervisorState,
}

impl ControllerState {
    /// Of the supervisor, with the log of what happened.
    pub fn supervisor(&self) -> &SupervisorState {
        &self.supervisor
    }

    /// Adds to the log what happened outside of the controller.
    pub fn note(&mut self, entry: Entry) {
        self.supervisor.log.push(entry);
    }

    /// Ticks of the device before the next one, where some passed without the controller.
    pub fn set_clock(&mut self, ticks: u32) {
        self.supervisor.set_clock(ticks);
    }

    /// Continues the log of before a reset, of which there have been `count` entries ever; its own has none yet.
    pub fn continue_log(&mut self, entries: impl Iterator<Item = Entry>, count: u32) {
        self.supervisor.log.go_on(entries, count);
    }

    /// The biases that are subtracted.
    pub fn calibration(&self) -> &Calibration {
        self.supervisor.calibration()
    }

    /// Believed speeds of the flywheels as racks that moved with them, over R, 1/s.
    pub fn spins(&self) -> [f32; 2] {
        self.turns.spins
    }

    /// Velocity that the ground has lately gained, g/p ([`Situation::ground_drift`]).
    pub fn ground_drift(&self) -> f32 {
        self.drift
    }
}

/// Inputs of a tick besides the readings.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Circumstances {
    /// How late the tick came, s; 0 in time.
    pub lateness: f32,
    /// Requests of an operator.
    pub requests: Requests,
    /// What the coils' currents say, …
    pub coils: CoilReports,
    /// … and how long each clutch has just taken to close, s.
    pub closed: [Option<f32>; 2],
}

/// Decision of a tick.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Decision {
    /// Whether each clutch shall be engaged.
    pub command: [bool; 2],
    /// The motion now.
    pub estimate: Estimate,
    /// Command that the law requests.
    pub wish: Wish,
    /// State of the controller.
    pub phase: Phase,
    /// Why it is in [`Phase::Fault`], or which sensor another one stands in for.
    pub fault: Option<Fault>,
}

impl Decision {
    /// Before a controller's first tick, with this `command` in force.
    pub fn before(command: [bool; 2]) -> Decision {
        let estimate = Estimate { standing: true, ..Estimate::default() };
        Decision { command, estimate, wish: Wish::Release, phase: Phase::Boot, fault: None }
    }

    /// Hashes command, wish, phase, fault and estimate.
    pub fn feed(&self, hash: &mut Fnv) {
        let Decision { command, estimate, wish, phase, fault } = self;
        hash.byte(u8::from(command[0]) | u8::from(command[1]) << 1 | u8::from(estimate.standing) << 2 | (*wish as u8) << 3);
        hash.byte(*phase as u8);
        hash.byte(fault.map_or(0, |fault| fault.code() as u8));
        hash.number(estimate.rotation);
        hash.number(estimate.velocity);
        hash.byte(u8::from(estimate.side == Sign::Negative));
        for quantity in [estimate.push, estimate.ground[0], estimate.ground[1], estimate.ground_rate] {
            hash.number(quantity);
        }
    }
}

impl<L: Law> Controller<L> {
    /// State at power-on.
    pub fn start(&self) -> ControllerState {
        ControllerState {
            instruments: InstrumentsState::default(),
            estimator: EstimatorState::unknown(),
            signs: Signs::default(),
            stood: true,
            turns: TurnsState::default(),
            gate: GateState::default(),
            clutches: ClutchPositions::default(),
            drift: 0.0,
            supervisor: SupervisorState::default(),
        }
    }

    /// From the beginning, with the event log of before.
    // In place: a second state would be most of a microcontroller's stack.
    pub fn restart(&self, state: &mut ControllerState) {
        let ControllerState { instruments, estimator, signs, stood, turns, gate, clutches, drift, supervisor } = state;
        (*instruments, *estimator) = (InstrumentsState::default(), EstimatorState::unknown());
        (*signs, *stood, *turns) = (Signs::default(), true, TurnsState::default());
        (*gate, *clutches, *drift) = (GateState::default(), ClutchPositions::default(), 0.0);
        supervisor.restart();
    }

    /// Resumes after a reset in mid-motion, with the `calibration`, the `spins` of the flywheels and the `ground_drift` of before, and the first
    /// `sample` after it. Whether the block stands or rocks, and where, is what encoder and gyroscope say.
    pub fn resume(
        &self,
        state: &mut ControllerState,
        calibration: &Calibration,
        spins: [f32; 2],
        ground_drift: f32,
        sample: &Sample,
    ) {
        let counts = sample.encoder.counts.wrapping_sub(calibration.encoder_zero);
        let travel = counts as f32 * self.instruments.travel_per_count;
        let rate = sample.gyroscope.value - calibration.gyroscope;
        let velocity = if rate.is_finite() { rate } else { 0.0 };
        let side = Sign::of(travel, Sign::of(velocity, Sign::Positive));
        // Newton's method from upright: the lever changes little over a swing.
        let rotation = (0..NEWTON_STEPS).fold(0.0, |near, _| self.model.rotation_of_travel(travel, near, side));
        self.restart(state);
        // The tick that follows takes the same sample, after moving the estimate on by a period.
        state.estimator = EstimatorState::met(rotation - velocity * self.instruments.period, velocity);
        (state.turns.spins, state.drift) = (spins, ground_drift);
        state.clutches = ClutchPositions::met(sample.engaged);
        self.supervisor.resume(&mut state.supervisor, calibration);
    }

    /// One tick.
    #[inline]
    pub fn tick(&self, state: &mut ControllerState, sample: &Sample, circumstances: Circumstances) -> Decision {
        let estimate = self.look(state, sample);
        let (wish, wanted) = self.choose(state, &estimate, state.clutches.engaged());
        self.oversee(state, sample, circumstances, Choice { estimate, wish, wanted })
    }

    /// First part of a tick: the motion now.
    #[inline]
    pub fn look(&self, state: &mut ControllerState, sample: &Sample) -> Estimate {
        let trusted = state.supervisor.trusted();
        let seen = if trusted == [true; 4] {
            self.instruments.read(&mut state.instruments, sample, state.supervisor.calibration())
        } else {
            self.read_without(state, sample, trusted)
        };
        self.lag.step(&mut state.clutches, sample.engaged);
        let engaged = count(state.clutches.engaged());
        self.estimator.step(&mut state.estimator, &self.model, &self.instruments, &seen, engaged)
    }

    /// The readings without those of sensors that are not `trusted`, in the order of [`Sensor::ALL`](super::sensing::sensor::Sensor::ALL).
    #[inline(never)]
    fn read_without(&self, state: &mut ControllerState, sample: &Sample, trusted: [bool; 4]) -> Measured {
        let [gyroscope, _, ground, encoder] = trusted;
        let (zero, mut sample) = (state.supervisor.calibration(), *sample);
        if !ground {
            let [along, up] = sample.block_accelerometer;
            let force = [along.value - zero.block[0], up.value - zero.block[1]];
            let found = state.estimator.ground_by_block(&self.model, force, count(state.clutches.engaged()));
            let number = if found.is_some() { along.number } else { state.instruments.ground_number() };
            let [horizontal, vertical] = [STANDARD_GRAVITY * found.unwrap_or(0.0), STANDARD_GRAVITY];
            let reading = |value: f32, bias: f32| Reading { value: value + bias, number };
            sample.ground_accelerometer = [reading(horizontal, zero.ground[0]), reading(vertical, zero.ground[1])];
        }
        let mut seen = self.instruments.read_apart(&mut state.instruments, &sample, zero);
        seen.rate = seen.rate.filter(|_| gyroscope);
        seen.travel = seen.travel.filter(|_| encoder);
        seen
    }

    /// Second part: what the law wants of the motion ahead, and as commands.
    #[inline]
    pub fn choose(&self, state: &mut ControllerState, estimate: &Estimate, engaged: [bool; 2]) -> (Wish, [bool; 2]) {
        let (model, period) = (&self.model, self.instruments.period);
        let elapsed = model.parameters.frequency * period;
        state.drift = (state.drift + elapsed * estimate.ground[0]) * (1.0 - elapsed / DRIFT_TIME);
        let stood = core::mem::replace(&mut state.stood, estimate.standing);
        // The motion begins to the side that the estimator has found; noise of the time before says nothing of it.
        let before = if estimate.standing || stood { Signs::at_uplift(estimate.side) } else { state.signs };
        let (wish, wanted) = if estimate.standing {
            // Nothing needs to be worked out: the rack does not move, and the block stands where the command takes effect.
            state.turns.spin_at(model, 0.0, engaged, period);
            state.signs = before;
            let wish = match self.wish(state, estimate, &Estimate { standing: true, ..*estimate }, engaged) {
                Wish::Resist if !self.engaged_at_rest => Wish::Release,
                wish => wish,
            };
            let wanted = match wish {
                Wish::Resist => state.turns.wait(model),
                _ => state.turns.take(model, wish, state.signs.velocity, estimate),
            };
            (wish, wanted)
        } else {
            let configuration = model.configuration(estimate.side, estimate.rotation);
            state.turns.spin_at(model, model.body.to_terminal(&configuration, estimate.velocity), engaged, period);
            let ahead = if self.law.predicts() {
                // An engaged clutch can only be released, and an open one only be engaged: each question has its own delay.
                let engaging = self.horizons.engagement + state.clutches.late(&self.lag);
                let horizon = if engaged == [false; 2] { engaging } else { self.horizons.release };
                predict_from(model, &configuration, estimate, count(engaged), horizon)
            } else {
                *estimate
            };
            state.signs = before.after(estimate, &ahead, self.bands);
            let wish = self.wish(state, estimate, &ahead, engaged);
            (wish, state.turns.take(model, wish, state.signs.velocity, &ahead))
        };
        (wish, self.gate.step(&mut state.gate, wanted, estimate.standing))
    }

    /// What the law wants of the motion `ahead`. Where the block is now nobody may know: a plain inerter needs no sensor.
    #[inline(always)]
    fn wish(&self, state: &ControllerState, now: &Estimate, ahead: &Estimate, engaged: [bool; 2]) -> Wish {
        if !now.located(self.model.parameters.slenderness) {
            return Wish::Hold;
        }
        self.law.wish(&Situation {
            model: &self.model,
            estimate: *ahead,
            signs: state.signs,
            engaged,
            spins: state.turns.spins,
            ground_drift: state.drift,
        })
    }

    /// Last part: whether it may be had.
    #[inline]
    pub fn oversee(
        &self,
        state: &mut ControllerState,
        sample: &Sample,
        circumstances: Circumstances,
        choice: Choice,
    ) -> Decision {
        let Choice { estimate, wish, wanted } = choice;
        let slower = match circumstances.closed {
            [None, None] => None,
            closed => self.lag.follow(&mut state.clutches, closed),
        };
        let input = SupervisorInput {
            sample,
            wish: wanted,
            standing: estimate.standing,
            estimate: (estimate.rotation, estimate.velocity),
            lever: self.lever(state, sample, &estimate),
            lateness: circumstances.lateness,
            requests: circumstances.requests,
            coils: circumstances.coils,
            slower,
        };
        let Calibration { gyroscope, encoder_zero, .. } = *state.supervisor.calibration();
        let [.., encoder_before] = state.supervisor.trusted();
        let verdict = self.supervisor.step(&mut state.supervisor, &input);
        match verdict.biases {
            Biases::Kept => {
                // An encoder that is taken again may have lost counts, and nobody has seen its zero since.
                let [.., encoder] = state.supervisor.trusted();
                if verdict.phase == Phase::Fault || (encoder && !encoder_before) {
                    state.estimator.doubt();
                }
            }
            Biases::Measured => {
                state.instruments = InstrumentsState::default();
                state.estimator = EstimatorState::default();
            }
            Biases::Followed => {
                let new = state.supervisor.calibration();
                let counts = new.encoder_zero.wrapping_sub(encoder_zero);
                state.estimator.rebase(counts as f32 * self.instruments.travel_per_count, new.gyroscope - gyroscope);
            }
        }
        Decision { command: verdict.command, estimate, wish, phase: verdict.phase, fault: verdict.fault }
    }

    /// ℓ of the rack over ℓ at |θ| = α/2, by its count. After power-on in motion a count says nothing of it until an impact has shown where
    /// θ = 0 is.
    #[inline]
    fn lever(&self, state: &ControllerState, sample: &Sample, estimate: &Estimate) -> f32 {
        if !(state.supervisor.calibrated() || estimate.located(self.model.parameters.slenderness)) {
            return 0.0;
        }
        let counts = sample.encoder.counts.wrapping_sub(state.supervisor.calibration().encoder_zero);
        self.model.rack_lever.at(state.estimator.travelled(counts as f32 * self.instruments.travel_per_count))
    }
}

/// What the first two parts of a tick come to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// The motion now.
    pub estimate: Estimate,
    /// What the law wants.
    pub wish: Wish,
    /// The same as commands, after turns and dwell.
    pub wanted: [bool; 2],
}

/// How many flywheels are on the rack.
#[inline]
fn count(engaged: [bool; 2]) -> u8 {
    u8::from(engaged[0]) + u8::from(engaged[1])
}
