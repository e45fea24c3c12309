//! Dry friction of rack and bearings may hold a tilted block where it turns.

use super::impact::Threshold;
use super::path::Shaking;
use super::{Machine, MachineState};
use crate::arc::{Arc, Motion};
use crate::body::Body;
use crate::drivetrain::device::Coupling;
use crate::drivetrain::drive::Drive;
use crate::ground::Piece;
use crate::observer::Stretch;
use crate::scalar::{Real, Sign};
use crate::snapshot::{DeviceArc, DeviceObserver, Snapshot};

impl<S: Real, B: Body<S>, D: Drive<S, X, G>, const X: usize, const G: usize> Machine<S, B, D, X, G> {
    /// What moves a block that stands tilted towards `sign`, against the friction of what moves with the rack. Forces of
    /// slipping or stretched clutches are taken as they are now.
    fn breakaway(&self, state: &MachineState<S>, sign: Sign) -> Threshold<S> {
        let motion = &state.motion;
        let posture = self.body.posture(motion.side.unit(), motion.rotation);
        let (horizontal, vertical) = self.body.factors(&posture);
        let arm = self.body.arm(&posture);
        let (mut push, mut dry, mut force) = (S::ZERO, S::ZERO, S::ZERO);
        if let Some(gears) = self.drive.gears() {
            (push, dry) = (gears.rack_push, gears.rack_dry);
            let law = self.drive.law(motion.direction, motion.drive, &state.device);
            let still = Motion { rotation: motion.rotation, velocity: S::ZERO, acceleration: S::ZERO };
            let moment = self.moment(&law, motion.side, &still, self.drive.load(&state.device), state.ground, S::ZERO);
            let account = self.drive.account(&moment, S::ZERO, &state.device);
            for (wheel, &carried) in state.device.wheels.iter().zip(&account.force) {
                match wheel.coupling {
                    Coupling::Locked => dry = dry + gears.inertance * gears.bearing_dry,
                    Coupling::Open => {}
                    _ => force = force + carried,
                }
            }
        }
        Threshold {
            horizontal: sign.times(horizontal - arm * push),
            vertical: sign.times(vertical),
            constant: -(arm * dry) - sign.times(arm * force),
        }
    }

    /// At θ̇ = 0: the way on, if friction lets the block go.
    pub(super) fn turned(&self, state: &mut MachineState<S>) {
        let on = self.breakaway(state, state.motion.direction).at(state.ground);
        if on > S::ZERO {
            return;
        }
        let back = self.breakaway(state, state.motion.direction.opposite()).at(state.ground);
        if back > S::ZERO {
            state.motion.direction = state.motion.direction.opposite();
        } else if D::HOLDS {
            state.held = true;
        }
    }

    /// Follows a held block until the push is strong enough or `stop`. Returns the time.
    pub(super) fn hold<P: Piece<S>, Q: Piece<S>>(
        &self,
        state: &mut MachineState<S>,
        shaking: Shaking<'_, P, Q>,
        time: S,
        stop: S,
        observer: &mut dyn DeviceObserver<S>,
    ) -> S {
        let ways = [Sign::Positive, Sign::Negative].map(|sign| {
            let free = self.breakaway(state, sign).exceeded::<B, P, Q>(shaking, time, stop);
            (free, sign)
        });
        let (free, sign) = match ways {
            [(Some(a), _), (Some(b), negative)] if b.0 < a.0 => (Some(b), negative),
            [(Some(a), positive), _] => (Some(a), positive),
            [_, (b, negative)] => (b, negative),
        };
        let until = free.map_or(stop, |(at, _)| at);
        // A flywheel that comes to a stop on the way kinks the powers that watchers integrate.
        let whole = until - time;
        let wheels =
            self.drive.gears().into_iter().flat_map(|gears| state.device.wheels.iter().map(|w| gears.stops_within(w, whole)));
        let shortest = wheels.flatten().fold(whole, Real::smaller);
        let (until, free) = if shortest < whole { (time + shortest, None) } else { (until, free) };
        if until > time {
            let still = Motion { rotation: state.motion.rotation, velocity: S::ZERO, acceleration: S::ZERO };
            let stretch = Stretch {
                start: time,
                from: S::ZERO,
                to: until - time,
                first: still,
                last: still,
                engaged: state.device.wheels.iter().any(|wheel| wheel.coupling != Coupling::Open),
                side: state.motion.side,
                direction: state.motion.direction,
            };
            observer.device_stretch(&Still { machine: self, state: &*state, shaking, time, length: until - time }, &stretch);
            self.idle(state, until - time);
        }
        state.ground = shaking.at::<S, B>(until);
        if let Some((_, crossing)) = free {
            (state.held, state.free) = (false, crossing);
            state.motion.direction = sign;
            state.motion.drive = if D::COMMANDED { self.drive_sign(state) } else { state.motion.drive };
            self.settle(state, until, observer);
        }
        until
    }
}

/// A block that does not move.
struct Still<'a, S, B, D, P, Q, const X: usize, const G: usize> {
    machine: &'a Machine<S, B, D, X, G>,
    state: &'a MachineState<S>,
    shaking: Shaking<'a, P, Q>,
    time: S,
    length: S,
}

impl<S: Real, B, D, P, Q, const X: usize, const G: usize> Arc<S> for Still<'_, S, B, D, P, Q, X, G> {
    fn length(&self) -> S {
        self.length
    }

    fn at(&self, _time: S) -> Motion<S> {
        Motion { rotation: self.state.motion.rotation, velocity: S::ZERO, acceleration: S::ZERO }
    }

    fn switching(&self, _time: S) -> S {
        S::ZERO
    }
}

impl<S, B, D, P, Q, const X: usize, const G: usize> DeviceArc<S> for Still<'_, S, B, D, P, Q, X, G>
where
    S: Real,
    B: Body<S>,
    D: Drive<S, X, G>,
    P: Piece<S>,
    Q: Piece<S>,
{
    fn snapshot(&self, time: S) -> Snapshot<S> {
        let ground = self.shaking.at::<S, B>(self.time + time);
        let mut state = *self.state;
        self.machine.idle(&mut state, time);
        let law = self.machine.drive.law(state.motion.direction, state.motion.drive, &state.device);
        self.machine.snapshot(&law, &state, self.at(time), self.machine.drive.load(&state.device), ground, S::ZERO)
    }
}
