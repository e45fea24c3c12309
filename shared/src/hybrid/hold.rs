//! Dry friction of rack and bearings may hold a block: tilted, where it turns, or on its base, where clutches engage as it starts.

use super::path::Shaking;
use super::seen::Still;
use super::threshold::{Threshold, earlier};
use super::{Machine, MachineState};
use crate::arc::Motion;
use crate::body::Body;
use crate::drivetrain::device::Coupling;
use crate::drivetrain::drive::Drive;
use crate::ground::Piece;
use crate::observer::{Event, Stretch};
use crate::scalar::{Real, Sign};
use crate::snapshot::DeviceObserver;

impl<S: Real, B: Body<S>, D: Drive<S, X, G>, const X: usize, const G: usize> Machine<S, B, D, X, G> {
    /// At θ̇ = 0: the way on, if friction lets the block go.
    pub(super) fn turned(&self, state: &mut MachineState<S>) {
        let (side, direction) = (state.motion.side, state.motion.direction);
        // A block on its base goes nowhere but up.
        let on = if state.motion.rotation == S::ZERO { side } else { direction };
        let on_base = D::HOLDS && state.motion.rotation == S::ZERO;
        let goes = |sign: Sign| {
            let threshold = self.breakaway(state, side, sign);
            if D::HOLDS { threshold.is_exceeded(state.ground) } else { threshold.at(state.ground) > S::ZERO }
        };
        let (goes_on, goes_back) = (goes(on), !on_base && goes(direction.opposite()));
        state.held = D::HOLDS && !goes_on && !goes_back;
        if on_base {
            state.motion.direction = side;
        } else if !goes_on && goes_back {
            state.motion.direction = direction.opposite();
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
        let end = self.let_go(state, shaking, time, stop);
        let until = end.map_or(stop, |(at, _)| at);
        // A flywheel that comes to a stop on the way kinks the powers that watchers integrate.
        let whole = until - time;
        let wheels =
            self.drive.gears().into_iter().flat_map(|gears| state.device.wheels.iter().map(|w| gears.stops_within(w, whole)));
        let length = wheels.flatten().fold(whole, Real::smaller);
        let (until, end) = if length < whole { (time + length, None) } else { (until, end) };
        // On its base it stands, as watchers see it.
        let on_base = state.motion.rotation == S::ZERO;
        if until > time && !on_base {
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
        }
        // What the clock cannot tell from now still stops a flywheel.
        self.idle(state, length);
        state.ground = shaking.at::<S, B>(until);
        match end {
            Some((_, LetGo::Moves { sign, crossing })) => {
                (state.held, state.free) = (false, crossing);
                state.motion.direction = sign;
                if on_base {
                    // What lifts the block accelerates the terminals, and that may have been zero until now.
                    (state.motion.drive, state.jolted, state.fresh[0]) = (sign, false, D::COMMANDED);
                    observer.device_event(Event::Uplift, until, &state.motion);
                    observer.device_event(Event::Switch, until, &state.motion);
                } else {
                    self.look_at_drive(state);
                }
                self.settle(state, until, observer);
            }
            Some((_, LetGo::Rests)) => *state = self.standing(state),
            None => {}
        }
        until
    }

    /// When a held block is let go before `stop`, and how. On its base it can only go up, and its weight alone may hold it again.
    fn let_go<P: Piece<S>, Q: Piece<S>>(
        &self,
        state: &MachineState<S>,
        shaking: Shaking<'_, P, Q>,
        time: S,
        stop: S,
    ) -> Option<(S, LetGo)> {
        let side = state.motion.side;
        let first = |threshold: Threshold<S>| threshold.exceeded::<B, P, Q>(shaking, time, stop);
        let moves = |sign| first(self.breakaway(state, side, sign)).map(|(at, crossing)| (at, LetGo::Moves { sign, crossing }));
        let ends = if state.motion.rotation == S::ZERO {
            let weight = self.breakaway(&self.standing(state), side, side).opposite();
            [moves(side), first(weight).map(|(at, _)| (at, LetGo::Rests))]
        } else {
            [moves(Sign::Positive), moves(Sign::Negative)]
        };
        earlier(ends)
    }
}

/// What lets a held block go.
#[derive(Clone, Copy, Debug)]
enum LetGo {
    /// The push overcomes friction.
    Moves {
        /// Towards.
        sign: Sign,
        /// By crossing the threshold, not by a jump.
        crossing: bool,
    },
    /// On its base, the weight alone holds it.
    Rests,
}
