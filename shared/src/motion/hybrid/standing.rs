//! Uplift of a standing block with a device.

use super::mode_output::Shaking;
use super::seen::Still;
use super::threshold::{Threshold, earlier};
use super::{HybridState, HybridSystem};
use crate::drivetrain::clutch_state::{Coupling, FlywheelState, GUARDS};
use crate::drivetrain::under_way::UnderWay;
use crate::equation::Accelerations;
use crate::equation::motion::Motion;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::motion::observer::{Event, MonotoneInterval, Observer};
use crate::motion::state::{BlockState, Phase};

impl<S: Real> HybridSystem<S> {
    /// Block and device of `state` once the block stands.
    #[inline(never)]
    pub(super) fn standing(&self, state: &HybridState<S>, time: S, observer: &mut dyn Observer<S>) -> HybridState<S> {
        let mut standing = HybridState { motion: state.motion.rested(state.motion.impacts), held: false, weak: false, ..*state };
        self.part_at_rest(&mut standing, time, observer);
        for wheel in &mut standing.device.wheels {
            // Plates that slip as slowly as impacts that accumulate stick with them. Any other flywheel that a resting block has left with
            // less than rounding stands, or its sign would decide what the next clutch does.
            let slips = matches!(wheel.coupling, Coupling::Slipping(_));
            if wheel.spin.abs() <= if slips { self.rest_speed } else { self.rest_speed * S::EPSILON } {
                wheel.spin = S::ZERO;
                wheel.coupling = if slips { Coupling::Locked } else { wheel.coupling };
            }
        }
        standing
    }

    /// The clutches of a standing block are open, but for those that a controller holds or that follow a support of its own motion; a device
    /// without clutches stays engaged.
    pub(super) fn part_at_rest(&self, state: &mut HybridState<S>, time: S, observer: &mut dyn Observer<S>) {
        if self.transmission.traits().permanent {
            state.device.wheels[0].coupling = self.transmission.permanent_link();
            return;
        }
        if self.actuator.controlled || state.device.terminals.is_some() {
            return;
        }
        self.open_clutches(state, time, observer);
    }

    /// Opens the clutches, and withdraws their commands.
    pub(super) fn open_clutches(&self, state: &mut HybridState<S>, time: S, observer: &mut dyn Observer<S>) {
        self.with_instant(state, time, observer, |_, at| {
            for wheel in 0..2 {
                if at.device.wheels[wheel].coupling.is_engaged() {
                    at.open(wheel);
                }
                let wheel = &mut at.device.wheels[wheel];
                (wheel.commanded, wheel.pending, wheel.under_way) = (false, -S::ONE, UnderWay::default());
            }
        });
    }

    /// The side to which the ground would lift a block on its base, and the threshold there.
    #[inline(never)]
    pub(super) fn lifted(&self, state: &HybridState<S>, ground: Accelerations<S>) -> (Sign, Threshold<S>) {
        let [positive, negative] = [Sign::Positive, Sign::Negative].map(|side| self.breakaway(state, side, side));
        if positive.at(ground) >= negative.at(ground) { (Sign::Positive, positive) } else { (Sign::Negative, negative) }
    }

    /// The moment that lifts a block on its base, over its inertia about the toe; 1/s².
    pub(super) fn uplifting(&self, state: &HybridState<S>, ground: Accelerations<S>) -> S {
        self.lifted(state, ground).1.at(ground)
    }

    /// Observation of block and device between two changes at one instant.
    pub(super) fn show_instant(&self, state: &HybridState<S>, time: S, observer: &mut dyn Observer<S>) {
        self.show_still(state, &|_| (state.ground, S::ZERO), time, (S::ZERO, 1), observer);
    }

    /// Observation of a block that does not move, from `time` on for `length` (s) in so many `pieces`, and of its device.
    #[inline(never)]
    pub(super) fn show_still(
        &self,
        state: &HybridState<S>,
        ground: &dyn Fn(S) -> (Accelerations<S>, S),
        time: S,
        (length, pieces): (S, u32),
        observer: &mut dyn Observer<S>,
    ) {
        let BlockState { rotation, velocity, side, direction, .. } = state.motion;
        let still = Motion { rotation, velocity, acceleration: S::ZERO };
        let engaged = state.device.wheels.iter().any(|wheel| wheel.coupling.is_engaged());
        let interval =
            MonotoneInterval { start: time, from: S::ZERO, to: length, first: still, last: still, engaged, side, direction };
        let output = Still { machine: self, state, ground, length, pieces };
        if rotation == S::ZERO || length == S::ZERO {
            observer.device_at_rest(&output, &interval);
        } else {
            observer.device_interval(&output, &interval);
        }
    }

    /// `time` (s), or when before that a flywheel comes to a stop, if the block does not move: it kinks the powers that observers integrate.
    /// What viscous forces slow down, faster than all else may move, is shown in pieces.
    pub(super) fn until_stop(&self, state: &HybridState<S>, time: S) -> S {
        let parameters = &self.transmission.parameters;
        let stops = state.device.wheels.iter().filter_map(|wheel| parameters.stops_within(wheel, time));
        let end = stops.fold(time, Real::smaller);
        let spins = |wheel: &&FlywheelState<S>| {
            parameters.slowing_rate(wheel) > S::ZERO && wheel.spin.abs() > self.rest_speed * S::EPSILON
        };
        let slow = state.device.wheels.iter().filter(spins).map(|wheel| S::of(2.0) / parameters.slowing_rate(wheel));
        slow.fold(end, Real::smaller)
    }

    /// The block stands from `time` to `end`, flywheels coast, or follow a support of its own motion.
    #[inline(never)]
    pub(super) fn stand(
        &self,
        state: &mut HybridState<S>,
        shaking: Shaking<'_, S>,
        time: S,
        end: S,
        observer: &mut dyn Observer<S>,
    ) {
        let carried = state.device.terminals.is_some();
        let turns = |state: &HybridState<S>| carried || state.device.wheels.iter().any(|wheel| wheel.spin != S::ZERO);
        // Up to half a wave of the support, in pieces that are close to polynomials.
        let longest = if carried { (end - time) * S::of(0.25) } else { end - time };
        if turns(state) {
            let (mut now, mut shown) = (time, *state);
            while now < end && turns(&shown) {
                let piece = self.until_stop(&shown, longest.smaller(end - now));
                // A piece that the clock does not resolve would have no end.
                let length = if now + piece > now { piece } else { end - now };
                let ground = |t: S| (shaking.at(now + t), self.support_gain(&shown, shaking, now, now + t));
                self.show_still(&shown, &ground, now, (length, 1), observer);
                self.idle(&mut shown, length);
                self.carry(&mut shown, shaking, now, now + length);
                now = now + length;
            }
        }
        self.idle(state, end - time);
        self.carry(state, shaking, time, end);
    }

    /// How long the clutches of a standing block stay as they are, from `time` to `duration` at most.
    pub(super) fn stands_until(&self, state: &mut HybridState<S>, time: S, duration: S) -> S {
        let parameters = &self.transmission.parameters;
        let pushed = self.transmission.slips_viscously() || parameters.drag > S::ZERO;
        if !self.actuator.controlled && !pushed && state.device.terminals.is_none() {
            return duration;
        }
        let mut stop = self.until_due(state, time, duration);
        let pushes = |wheel: &&mut FlywheelState<S>| {
            matches!(wheel.coupling, Coupling::Slipping(_)) || parameters.dashpot(wheel) > S::ZERO
        };
        for wheel in state.device.wheels.iter_mut().filter(pushes) {
            match parameters.stops_within(wheel, stop - time) {
                Some(stops) if time + stops > time => stop = time + stops,
                Some(stops) => parameters.coast(wheel, stops),
                None => {}
            }
        }
        stop
    }

    /// First instant in [`from`, `to`) at which the ground acceleration exceeds a standing block's uplift threshold, and whether
    /// it gets there by crossing that threshold.
    pub(super) fn uplift_time(&self, state: &HybridState<S>, shaking: Shaking<'_, S>, from: S, to: S) -> Option<(S, bool)> {
        let first = |side| self.breakaway(state, side, side).exceeded(shaking, from, to);
        earlier([Sign::Positive, Sign::Negative].map(first))
    }

    /// Sets the block in motion, to the side to which the ground turns it. Clutches that engage as it starts may hold it.
    pub(super) fn uplift(
        &self,
        state: &mut HybridState<S>,
        ground: Accelerations<S>,
        time: S,
        crossing: bool,
        observer: &mut dyn Observer<S>,
    ) {
        let (side, _) = self.lifted(state, ground);
        state.motion = state.motion.uplifted(side);
        state.ground = ground;
        (state.fresh, state.free) = ([false; GUARDS], crossing);
        if self.transmission.traits().holds {
            let mut started = *state;
            self.leave_base(&mut started, time, &mut ());
            self.start_clutches(&mut started, time, &mut ());
            if started.held {
                *state = started;
                return;
            }
        }
        self.leave_base(state, time, observer);
        self.start_clutches(state, time, observer);
    }

    /// Uplift: θ̈ and the terminals' acceleration take the sign of the motion, and may have been zero until now; that of terminals whose
    /// flywheels lift the block may be the other.
    pub(super) fn leave_base(&self, state: &mut HybridState<S>, time: S, observer: &mut dyn Observer<S>) {
        (state.motion.terminal_acceleration_sign, state.jolted, state.fresh[0]) =
            (state.motion.side, false, self.transmission.traits().commanded);
        let follows = state.device.terminals.is_some();
        if follows || self.breakaway(state, state.motion.side, state.motion.side).is_pushed(state.ground) {
            // What lifts the block is not what it would meet with a flywheel engaged.
            self.look_at_drive(state);
            state.fresh[0] = false;
        }
        if follows {
            self.look_at_terminals(state);
        }
        observer.event(Event::Uplift, time, &state.motion);
    }

    /// The clutches answer an uplift, and may hold the block on its base.
    fn start_clutches(&self, state: &mut HybridState<S>, time: S, observer: &mut dyn Observer<S>) {
        let before = state.device.wheels.map(|wheel| wheel.coupling);
        self.settle(state, time, observer);
        self.command(state, time, observer);
        if self.transmission.traits().holds
            && state.motion.velocity == S::ZERO
            && state.device.wheels.map(|wheel| wheel.coupling) != before
        {
            self.turned(state);
        }
    }

    /// A block that falls back on its base under a ground acceleration that would uplift it, stays there while its clutches hold it. So does one
    /// whose flywheels swing on springs, which push it.
    pub(super) fn stay_on_base(&self, state: &mut HybridState<S>, time: S, observer: &mut dyn Observer<S>) {
        let mut held = *state;
        (held.motion.rotation, held.motion.velocity) = (S::ZERO, S::ZERO);
        let (side, threshold) = self.lifted(&held, state.ground);
        if self.transmission.traits().holds && !threshold.is_exceeded(state.ground) {
            (held.motion.side, held.motion.direction, held.held, held.weak) = (side, side, true, false);
            held.motion.phase = Phase::Rocking;
            let stood = state.motion.phase == Phase::Rest;
            *state = held;
            if !stood {
                observer.event(Event::Rest, time, &state.motion);
            }
        }
    }
}
