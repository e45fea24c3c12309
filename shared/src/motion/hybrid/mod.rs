//! Event-driven integration of a block whose device has a memory: flywheels that spin on, clutches that slip, elastic clutches, delays.
//!
//! Such a system is hybrid: smooth motion in one mode, until a guard reaches zero and another mode takes over. Every
//! event is located in the dense output ([`mode_output`]), and every mode is left in one that is consistent at that instant. Ideal devices have
//! a loop of their own ([`crate::motion::ideal`]) without modes; both agree where both apply.
//!
//! As there, signs are part of the state, so that an event just handled is not found again.
//!
//! The room imports what is directly in `motion`, `motion::rest`, and every room below `motion`.

mod command;
mod crowding;
pub mod exponential;
pub mod footing;
mod hold;
mod impact;
mod instant;
pub mod mode_output;
pub mod resolve;
mod seen;
pub mod series;
mod standing;
pub mod steps;
mod terminals;
mod threshold;
mod uneventful;

pub use command::Actuator;

use crate::drivetrain::any_transmission::AnyTransmission;
use crate::drivetrain::clutch_state::{Coupling, DeviceState, GUARDS, Guard, ModeCoefficients, Terminals, UNKNOWNS};
use crate::drivetrain::transmission::{AnyPoint, EvaluationPoint, EventContext};
use crate::equation::Accelerations;
use crate::equation::any_body::AnyBody;
use crate::equation::body::Body;
use crate::equation::motion::Motion;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::method::dense_output::DenseOutput;
use crate::method::step_grid::next_stop;
use crate::motion::device_snapshot::Snapshot;
use crate::motion::observer::{Event, MonotoneInterval, Observer};
use crate::motion::state::{BlockState, Limits, Phase, Stopped};
use crate::structure::RestitutionScatter;
use crowding::{ENDLESS, GRAZE, MOST_AT_ONCE, STEPS_PER_EVENT, crowded, too_many};
use mode_output::{ModeIntegrator, ModeOutput, ModeStart, Place, Shaking};
use seen::Seen;

/// Hybrid system of a block and its device: equations, modes and guards.
#[derive(Clone, Copy, Debug)]
pub struct HybridSystem<S> {
    /// Equations of the block.
    pub body: AnyBody<S>,
    /// Transmission of the device.
    pub transmission: AnyTransmission<S>,
    /// Velocity after an impact over that before, with 0, 1 and 2 flywheels engaged through it; each 0 to 1.
    pub restitution: [S; 3],
    /// How that differs from impact to impact.
    pub scatter: RestitutionScatter,
    /// α, rad: the size of a rotation that matters.
    pub slenderness: S,
    /// pα, rad/s: the size of an angular velocity that matters.
    pub speed: S,
    /// θ̇ (rad/s) below which an impact may end in rest. Below a rounding of [`HybridSystem::speed`] plates that stick and slip would give
    /// back what impacts take.
    pub rest_speed: S,
    /// θ̇ (rad/s) below which an impact does not count.
    pub counted_speed: S,
    /// Actuator of the clutches.
    pub actuator: Actuator<S>,
}

/// State of a block with a device.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HybridState<S> {
    /// State of the block.
    pub motion: BlockState<S>,
    /// State of the device.
    pub device: DeviceState<S>,
    /// Friction holds the block: tilted, at a turn, or on its base, where clutches engaged as it started.
    pub held: bool,
    /// Accelerations of ground and support at the end of the last ground segment.
    pub ground: Accelerations<S>,
    /// The guards that are zero here, by an event just handled.
    fresh: [bool; GUARDS],
    /// Breakaway: the moving moment has just passed the holding one.
    free: bool,
    /// The sign of Eq. 10 is one that a jolt left; the acceleration does not agree with it yet.
    jolted: bool,
    /// The last impact left the block too slow for its swing to count.
    weak: bool,
}

/// Progress through a ground segment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Progress<S> {
    /// Local time in the segment, s.
    pub time: S,
    /// Fixed steps so far.
    tick: u32,
    /// Steps so far that ended in an event or stood, and those that only came to their end.
    events: u32,
    steps: u32,
    /// Steps without a gap in time before this one.
    at_once: u32,
}

impl<S: Real> Progress<S> {
    /// Others than the core have taken the block on by `time` (s), without an event; `unit` is 1/p (s).
    pub fn go_on(&mut self, time: S, unit: S) {
        self.at_once = crowded(self.at_once, time, unit);
        (self.time, self.steps) = (self.time + time, self.steps + 1);
    }
}

/// Event that ends a step.
#[derive(Clone, Copy, Debug, PartialEq)]
enum End {
    Reached,
    Turn,
    Impact,
    Overturned,
    Guard(usize),
    Stopped(usize),
}

impl<S: Real> HybridSystem<S> {
    /// A block that stands, with an idle device.
    pub fn at_rest(&self) -> HybridState<S> {
        let terminals = self.transmission.traits().on_support.then(Terminals::default);
        let mut state = HybridState { device: DeviceState { terminals, ..DeviceState::at_rest() }, ..HybridState::default() };
        self.part_at_rest(&mut state, S::ZERO, &mut ());
        state
    }

    /// A block released at θ (rad) with θ̇ (rad/s) while ground and support accelerate by `ground`.
    pub fn released_at(&self, rotation: S, velocity: S, ground: Accelerations<S>) -> HybridState<S> {
        let mut state = self.at_rest();
        let side = Sign::of(rotation, Sign::of(velocity, Sign::Positive));
        state.motion = BlockState { rotation, velocity, phase: Phase::Rocking, side, ..BlockState::default() };
        state.motion.direction = Sign::of(velocity, side.opposite());
        state.ground = ground;
        self.start(&mut state);
        state
    }

    /// Follows block and device over a ground segment from its local time 0 to `duration` (s), giving `observer`
    /// of every interval and event.
    ///
    /// # Errors
    /// [`Stopped`], with the state as it was then.
    pub fn advance<T: ModeIntegrator<S>>(
        &self,
        integrator: &T,
        state: &mut HybridState<S>,
        shaking: Shaking<'_, S>,
        duration: S,
        limits: &Limits<S>,
        observer: &mut dyn Observer<S>,
    ) -> Result<(), Stopped> {
        let mut progress = Progress::default();
        self.ground_at_start(state, shaking.at(S::ZERO), observer);
        while progress.time < duration && state.motion.phase != Phase::Overturned {
            self.step(integrator, state, (shaking, duration), &mut progress, limits, observer)?;
        }
        state.ground = shaking.at(duration);
        Ok(())
    }

    /// One step of [`HybridSystem::advance`]: at most up to the next event, or while the block stands, up to its uplift.
    ///
    /// # Errors
    /// As of [`HybridSystem::advance`].
    pub fn step<T: ModeIntegrator<S>>(
        &self,
        integrator: &T,
        state: &mut HybridState<S>,
        (shaking, duration): (Shaking<'_, S>, S),
        progress: &mut Progress<S>,
        limits: &Limits<S>,
        observer: &mut dyn Observer<S>,
    ) -> Result<(), Stopped> {
        let Progress { time, tick, events, steps, at_once } = progress;
        // 1/p.
        let unit = self.slenderness / self.speed;
        if *events >= limits.events || *at_once >= ENDLESS {
            return Err(too_many(state, *time, *at_once));
        }
        if *steps / STEPS_PER_EVENT >= limits.events {
            return Err(Stopped::TooManySteps { time: time.to_f64() });
        }
        *events += 1;
        if state.motion.phase == Phase::Rest {
            let stop = self.drive_at_rest(state, shaking, (*time, duration), observer);
            let stop = self.stands_until(state, *time, stop);
            let uplift = self.uplift_time(state, shaking, *time, stop);
            let until = uplift.map_or(stop, |(at, _)| at);
            self.stand(state, shaking, *time, until, observer);
            *time = until;
            if let Some((_, crossing)) = uplift {
                self.uplift(state, shaking.at(until), until, crossing, observer);
            } else {
                if until < duration {
                    state.ground = shaking.at(until);
                    self.carry_out_at_rest(state, until, observer);
                }
                return Ok(());
            }
        }
        if state.motion.is_outward_at(limits.overturned) {
            state.motion.phase = Phase::Overturned;
            observer.event(Event::Overturned, *time, &state.motion);
            return Ok(());
        }
        let step = integrator.step().map_or(duration, |step| next_stop(tick, step, *time, duration));
        let mut stop = self.until_due(state, *time, step);
        let (before, side) = (*time, state.motion.side);
        let grazes = *at_once >= MOST_AT_ONCE;
        if grazes {
            stop = stop.smaller(before + (S::of(GRAZE) * unit).larger(S::of(4.0) * S::EPSILON * before));
        }
        if stop <= before {
        } else if state.held && !self.has_springs(state) {
            *time = self.hold(state, shaking, before, stop, observer);
        } else if state.held {
            self.hold_springs(integrator, state, shaking, (time, stop), (limits, !grazes), observer);
        } else {
            let eventful = self.follow(integrator, state, shaking, (time, stop), (limits, !grazes), observer);
            if !eventful {
                (*events, *steps) = (*events - 1, *steps + 1);
            }
        }
        *at_once = if self.bounces(state, side) { 0 } else { crowded(*at_once, *time - before, unit) };
        self.ramps(state);
        self.command(state, *time, observer);
        if !(state.motion.rotation.is_finite() && state.motion.velocity.is_finite()) {
            return Err(Stopped::NotFinite { time: time.to_f64() });
        }
        Ok(())
    }

    /// One step, up to its first event. Returns whether there was one.
    fn follow<T: ModeIntegrator<S>>(
        &self,
        integrator: &T,
        state: &mut HybridState<S>,
        shaking: Shaking<'_, S>,
        (time, stop): (&mut S, S),
        (limits, guarded): (&Limits<S>, bool),
        observer: &mut dyn Observer<S>,
    ) -> bool {
        let motion = &state.motion;
        // Without springs a held block needs no step.
        let traits = self.transmission.traits();
        let held = traits.springs && state.held;
        let mut law = ModeCoefficients::of(motion.direction);
        self.complete_watching(&mut law, state);
        if held {
            self.hold_law(state, &mut law);
        }
        let still = traits.on_support && self.spare_standing_support(&mut law, state, shaking, (*time, stop));
        let start = ModeStart {
            system: self,
            law: &law,
            shaking,
            side: motion.side,
            place: self.place(state),
            time: *time,
            length: stop - *time,
            freed: state.free && motion.velocity == S::ZERO,
            held,
        };
        debug_assert!(state.ground == shaking.at(*time), "the ground is as it was left");
        let output = integrator.integrate(&start);
        let length = output.length();
        let mut until = length;
        let mut end = End::Reached;
        let signs_change = !output.keeps_signs(motion.direction);
        let turns = signs_change && !held;
        let turn = if turns { output.velocity_zero(length, motion.direction, motion.velocity == S::ZERO) } else { None };
        if let Some(turn) = turn {
            (until, end) = (turn, End::Turn);
        }
        let guards = if guarded && signs_change { traits.guards } else { 0 };
        for guard in 0..guards {
            if law.watch[guard] != Guard::Nothing
                && let Some(zero) = output.guard_zero(guard, until, state.fresh[guard])
                && !motion.ends_at(output.at(zero).rotation, limits)
            {
                (until, end) = (zero, End::Guard(guard));
            }
        }
        for (i, wheel) in state.device.wheels.iter().enumerate().take(traits.unknowns) {
            // Without dry friction nothing changes where a flywheel stands for an instant.
            let stops = wheel.coupling != Coupling::Locked && self.transmission.parameters.dry_of(wheel) > S::ZERO;
            if let (Some(turning), true) = (wheel.turning, stops)
                && let Some(zero) = output.unknown_zero(i, until, turning, wheel.spin == S::ZERO)
                // In a graze rounding alone stops at once what has just begun to turn.
                && (guarded || *time + zero > *time)
            {
                (until, end) = (zero, End::Stopped(i));
            }
        }
        let mut last = output.at(until);
        if let Some(turn) = turn
            && until > S::ZERO
            && motion.direction.times(last.velocity) <= S::ZERO
        {
            // What else is zero where the block turns waits for the turn: a flywheel that is held slips by the speed of the rack.
            (until, end, last) = (turn, End::Turn, output.at(turn));
        }
        // θ is monotone up to here.
        if let Some((level, before)) = motion.passes(last.rotation, limits) {
            until = output.crossing(level, before, (S::ZERO, until));
            (end, last) = (if before == motion.side { End::Impact } else { End::Overturned }, output.at(until));
        }
        let first = output.at(S::ZERO);
        let engaged = state.device.wheels.iter().any(|wheel| wheel.coupling.is_engaged());
        let interval = MonotoneInterval {
            start: *time,
            from: S::ZERO,
            to: until,
            first,
            last,
            engaged,
            side: motion.side,
            direction: motion.direction,
        };
        let seen = Seen { machine: self, output: &output, law: &law, state: &*state, shaking, time: *time };
        // What lasts no time is no motion: rounding decides whether it is there.
        if *time + until > *time {
            if held && motion.rotation == S::ZERO {
                observer.device_at_rest(&seen, &interval);
            } else {
                observer.device_interval(&seen, &interval);
            }
        }
        *time = if end == End::Reached && length == stop - *time { stop } else { *time + until };
        let motion = &mut state.motion;
        (motion.rotation, motion.velocity) = (last.rotation, last.velocity);
        if traits.unknowns > 0 {
            let unknowns = output.unknowns(until);
            let configuration = self.body.configuration(motion.side.unit(), motion.rotation);
            state.device.store(&unknowns[..traits.unknowns], self.body.to_terminal(&configuration, motion.velocity));
        }
        state.device.elapse(until);
        (state.fresh, state.free) = ([false; GUARDS], false);
        let ground = shaking.at(*time);
        state.ground = ground;
        match end {
            End::Reached => {}
            End::Turn => {
                motion.velocity = S::ZERO;
                observer.event(Event::Turn, *time, &state.motion);
                state.motion.direction = state.motion.direction.opposite();
                self.turn_terminals(state, still);
                if state.jolted {
                    self.look_at_drive(state);
                }
                self.settle(state, *time, observer);
                // What the clutches of one way let go may move the block the other way, whose clutches then hold it.
                for _ in 0..2 {
                    let direction = state.motion.direction;
                    if state.motion.velocity == S::ZERO {
                        self.turned(state);
                    }
                    if state.motion.direction == direction {
                        break;
                    }
                    self.settle(state, *time, observer);
                }
            }
            End::Impact => {
                state.motion.rotation = S::ZERO;
                *time = self.impact(state, shaking, *time, stop, observer);
            }
            End::Overturned => {
                motion.rotation = motion.side.times(limits.overturned);
                motion.phase = Phase::Overturned;
                observer.event(Event::Overturned, *time, &state.motion);
            }
            End::Guard(index) => {
                match law.watch[index] {
                    Guard::Stuck(_) | Guard::HeldDown(..) => {
                        self.break_away(state, *time, observer);
                        return true;
                    }
                    Guard::Command(_) if state.jolted => state.jolted = false,
                    Guard::Command(_) => motion.terminal_acceleration_sign = motion.terminal_acceleration_sign.opposite(),
                    watch => self.with_instant(state, *time, observer, |transmission, at| transmission.reached(at, watch)),
                }
                // Any guard of a flywheel may be zero where its mode changes.
                for (other, fresh) in state.fresh.iter_mut().enumerate() {
                    *fresh |= (other == 0) == (index == 0) && other % 2 == index % 2;
                }
            }
            End::Stopped(wheel) => self.stopped(state, wheel),
        }
        end != End::Reached
    }

    /// Answer of the device to an event; a change of its coupling is reported.
    fn with_instant(
        &self,
        state: &mut HybridState<S>,
        time: S,
        observer: &mut dyn Observer<S>,
        answer: impl FnOnce(&AnyTransmission<S>, &mut EventContext<'_, S>),
    ) {
        let before = state.device.wheels.map(|wheel| wheel.coupling);
        let motion = &state.motion;
        let mut at = EventContext {
            body: &self.body,
            parameters: &self.transmission.parameters,
            side: motion.side,
            direction: motion.direction,
            rotation: motion.rotation,
            velocity: motion.velocity,
            ground: state.ground,
            device: &mut state.device,
        };
        answer(&self.transmission, &mut at);
        let velocity = at.velocity;
        if velocity != state.motion.velocity {
            self.jolted(state, velocity, time, observer);
        }
        let after = state.device.wheels.map(|wheel| wheel.coupling);
        if before.map(Coupling::is_engaged) != after.map(Coupling::is_engaged) {
            observer.event(Event::Switch, time, &state.motion);
        } else if before != after {
            observer.event(Event::Coupling, time, &state.motion);
        }
    }

    /// After a jump of velocity or ground: modes that it ended are left.
    #[inline(never)]
    fn settle(&self, state: &mut HybridState<S>, time: S, observer: &mut dyn Observer<S>) {
        self.with_instant(state, time, observer, |transmission, at| transmission.settle(at));
    }

    /// Coefficients of the mode of `state`.
    fn law(&self, state: &HybridState<S>) -> ModeCoefficients<S> {
        self.transmission.law(state.motion.direction, state.motion.terminal_acceleration_sign, &state.device)
    }

    /// `state` as the start of a step.
    fn place(&self, state: &HybridState<S>) -> Place<S, UNKNOWNS> {
        let BlockState { rotation, velocity, .. } = state.motion;
        Place { time: S::ZERO, ground: state.ground, rotation, velocity, unknowns: state.device.unknowns() }
    }

    /// The evaluation point of an instant.
    fn point<'a>(&'a self, law: &'a ModeCoefficients<S>, side: Sign, at: &Place<S, UNKNOWNS>) -> AnyPoint<'a, S, UNKNOWNS> {
        let Place { time, ground, rotation, velocity, unknowns } = *at;
        let configuration = self.body.configuration(side.unit(), rotation);
        let parameters = &self.transmission.parameters;
        EvaluationPoint { body: &self.body, parameters, law, configuration, velocity, unknowns, ground, clock: time }
    }

    /// Snapshot of block and device at an instant, for observers.
    fn snapshot(
        &self,
        law: &ModeCoefficients<S>,
        state: &HybridState<S>,
        at: &Place<S, UNKNOWNS>,
        acceleration: S,
    ) -> Snapshot<S> {
        let side = state.motion.side;
        let point = self.point(law, side, at);
        let mut device = self.transmission.account(&point, acceleration, &state.device);
        if state.motion.phase == Phase::Rocking && at.velocity == S::ZERO {
            self.hold_rack(state, law, at.ground, &mut device);
        }
        let parameters = &self.transmission.parameters;
        // What load friction adds to the coupling is friction.
        let coupling = if parameters.load_friction == S::ZERO {
            law.coupling
        } else {
            parameters.rack_coupling + S::count(state.device.locked()) * parameters.inertance
        };
        device.spent.kinematics = self.body.paper_power(side.unit(), &point.configuration, at.velocity, coupling);
        if state.device.terminals.is_some() && at.velocity != S::ZERO {
            // −κ k ℓ' θ̇² v: flywheels turn with the rack on its support.
            let flywheels = S::count(state.device.locked()) * parameters.inertance;
            let share = self.body.paper_power(side.unit(), &point.configuration, at.velocity, flywheels);
            let rack = self.body.to_terminal(&point.configuration, at.velocity);
            device.spent.kinematics = device.spent.kinematics - share * (at.unknowns[0] / rack);
        }
        Snapshot {
            motion: Motion { rotation: at.rotation, velocity: at.velocity, acceleration },
            ground: at.ground,
            terminal_velocity: self.body.to_terminal(&point.configuration, at.velocity),
            device,
        }
    }
}

#[cfg(test)]
mod tests;
