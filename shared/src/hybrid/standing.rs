//! A block that stands on its base: what uplifts it, and what may still hold it there.

use super::path::Shaking;
use super::threshold::{Threshold, earlier};
use super::{Machine, MachineState};
use crate::body::Body;
use crate::drivetrain::device::{Coupling, WATCHES};
use crate::drivetrain::drive::{Drive, open};
use crate::drivetrain::under_way::UnderWay;
use crate::ground::Piece;
use crate::observer::Event;
use crate::rocking::{Phase, State};
use crate::scalar::{Real, Sign};
use crate::snapshot::DeviceObserver;

impl<S: Real, B: Body<S>, D: Drive<S, X, G>, const X: usize, const G: usize> Machine<S, B, D, X, G> {
    /// Block and device of `state` once the block stands.
    pub(super) fn standing(&self, state: &MachineState<S>) -> MachineState<S> {
        let State { side, direction, impacts, .. } = state.motion;
        let mut standing = *state;
        standing.motion = State { impacts, side, direction, ..State::default() };
        standing.held = false;
        self.part_at_rest(&mut standing);
        // A flywheel that a resting block has left with less than rounding stands, or its sign would decide what the next clutch does.
        for wheel in &mut standing.device.wheels {
            if wheel.spin.abs() <= self.rest_speed * S::EPSILON {
                wheel.spin = S::ZERO;
            }
        }
        standing
    }

    /// The clutches of a standing block are open, but for those that a controller holds; a device without clutches stays engaged.
    pub(super) fn part_at_rest(&self, state: &mut MachineState<S>) {
        let Some(gears) = self.drive.gears() else { return };
        if !D::COMMANDED && X == 0 {
            state.device.wheels[0].coupling = Coupling::Locked;
            return;
        }
        if self.actuator.controlled {
            return;
        }
        self.with_instant(state, S::ZERO, &mut (), |_, at| {
            for wheel in 0..2 {
                if at.device.wheels[wheel].coupling != Coupling::Open {
                    open(gears, at, wheel);
                }
                let wheel = &mut at.device.wheels[wheel];
                (wheel.commanded, wheel.pending, wheel.under_way) = (false, -S::ONE, UnderWay::default());
            }
        });
    }

    /// The side to which the ground would lift a block on its base, and the threshold there.
    fn lifted(&self, state: &MachineState<S>, ground: [S; 2]) -> (Sign, Threshold<S>) {
        let [positive, negative] = [Sign::Positive, Sign::Negative].map(|side| self.breakaway(state, side, side));
        if positive.at(ground) >= negative.at(ground) { (Sign::Positive, positive) } else { (Sign::Negative, negative) }
    }

    /// The moment that lifts a block on its base, over its inertia about the toe; 1/s².
    pub(super) fn uplifting(&self, state: &MachineState<S>, ground: [S; 2]) -> S {
        self.lifted(state, ground).1.at(ground)
    }

    /// How long the clutches of a standing block stay as they are, from `time` to `duration` at most.
    pub(super) fn stands_until(&self, state: &mut MachineState<S>, time: S, duration: S) -> S {
        let Some(gears) = self.drive.gears().filter(|_| self.actuator.controlled) else { return duration };
        let mut stop = self.until_due(state, time, duration);
        for wheel in state.device.wheels.iter_mut().filter(|wheel| matches!(wheel.coupling, Coupling::Slipping(_))) {
            match gears.stops_within(wheel, stop - time) {
                Some(stops) if time + stops > time => stop = time + stops,
                Some(stops) => gears.coast(wheel, stops),
                None => {}
            }
        }
        stop
    }

    /// First instant in [`from`, `to`) at which the ground pushes a standing block harder than its weight holds it, and whether
    /// it gets there by crossing that threshold.
    pub(super) fn uplift_time<P: Piece<S>, Q: Piece<S>>(
        &self,
        state: &MachineState<S>,
        shaking: Shaking<'_, P, Q>,
        from: S,
        to: S,
    ) -> Option<(S, bool)> {
        let first = |side| self.breakaway(state, side, side).exceeded::<B, P, Q>(shaking, from, to);
        earlier([Sign::Positive, Sign::Negative].map(first))
    }

    /// Sets the block in motion, to the side to which the ground pushes it. Clutches that engage as it starts may hold it.
    pub(super) fn uplift(
        &self,
        state: &mut MachineState<S>,
        ground: [S; 2],
        time: S,
        crossing: bool,
        observer: &mut dyn DeviceObserver<S>,
    ) {
        let (side, _) = self.lifted(state, ground);
        let impacts = state.motion.impacts;
        state.motion =
            State { phase: Phase::Rocking, side, direction: side, drive: side, push: side, impacts, ..State::default() };
        state.ground = ground;
        (state.fresh, state.free, state.jolted) = ([false; WATCHES], crossing, false);
        state.fresh[0] = D::COMMANDED;
        let mut started = *state;
        self.start_clutches(&mut started, time, &mut ());
        if started.held {
            *state = started;
        } else {
            observer.device_event(Event::Uplift, time, &state.motion);
            self.start_clutches(state, time, observer);
        }
    }

    /// The clutches answer an uplift, and may hold the block on its base.
    fn start_clutches(&self, state: &mut MachineState<S>, time: S, observer: &mut dyn DeviceObserver<S>) {
        let before = state.device.wheels.map(|wheel| wheel.coupling);
        self.settle(state, time, observer);
        self.command(state, time, observer);
        if D::HOLDS && state.motion.velocity == S::ZERO && state.device.wheels.map(|wheel| wheel.coupling) != before {
            self.turned(state);
        }
    }

    /// A block that falls back on its base under a push to which it would rise, stays there while its clutches hold it.
    pub(super) fn stay_on_base(&self, state: &mut MachineState<S>, time: S, observer: &mut dyn DeviceObserver<S>) {
        let mut held = *state;
        (held.motion.rotation, held.motion.velocity) = (S::ZERO, S::ZERO);
        let (side, threshold) = self.lifted(&held, state.ground);
        if D::HOLDS && !threshold.is_exceeded(state.ground) {
            (held.motion.side, held.motion.direction, held.held) = (side, side, true);
            *state = held;
            observer.device_event(Event::Rest, time, &state.motion);
        }
    }
}
