//! Impact, and the decision between rocking and rest after it.

use super::IdealSystem;
use crate::equation::Equation;
use crate::ground::GroundSegment;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::motion::observer::{Event, Observer};
use crate::motion::rest::free_decay::HalfCycles;
use crate::motion::rest::impact_accumulation::{Accumulation, ways};
use crate::motion::state::{BlockState, Phase};

impl<S: Real> IdealSystem<S> {
    /// Impact at θ = 0: the velocity is multiplied by η and the other toe takes over, or the block comes to rest. Returns the
    /// time, which rest moves on to the end of the impacts that it stands for.
    pub(super) fn impact(
        &self,
        state: &mut BlockState<S>,
        segment: &dyn GroundSegment<S>,
        time: S,
        duration: S,
        observer: &mut dyn Observer<S>,
    ) -> S {
        let incoming = state.velocity.abs();
        if incoming >= self.counted_speed {
            state.impacts += 1;
        }
        // A turn and a hit in one ulp leave the direction of before the turn.
        state.direction = Sign::of(state.velocity, state.direction);
        state.velocity = self.restitution * state.velocity;
        state.side = state.direction;
        let ground = segment.acceleration(time);
        self.read_signs(state, ground);
        observer.event(Event::Impact, time, state);
        // A ground acceleration above the threshold ends impacts too weak for the clock to distinguish: the block uplifts to the other side.
        if self.lifts(ground) {
            let rate = self.released.acceleration(state.side.unit(), S::ZERO, S::ZERO, ground);
            let unresolved = state.side.times(rate) < S::ZERO && time + state.velocity.abs() / rate.abs() == time;
            if state.velocity == S::ZERO || unresolved {
                self.uplift(state, ground, false);
            }
            return time;
        }
        if state.velocity.abs() <= self.rest_speed {
            let tail = self.accumulation(state.side, state.velocity.abs(), ground);
            let negligible = state.velocity.abs() <= self.rest_speed * S::EPSILON;
            if let Some(ends) = tail.rest(time, duration, negligible, |at| segment.acceleration(at).abs() < self.uplift) {
                observer.accumulation(&tail);
                if tail.acceleration > S::ZERO {
                    for way in ways(state.side) {
                        observer.bounce(way, self.bounce(way, ground), time);
                    }
                }
                *state = state.rested(state.impacts + tail.impacts);
                observer.event(Event::Rest, ends, state);
                return ends;
            }
        }
        time
    }

    /// Free decay after an impact on quiet ground, in closed form, or as many whole swings as `duration` has room for.
    pub(super) fn sum_up(
        &self,
        state: &mut BlockState<S>,
        swings: &mut Option<HalfCycles<S>>,
        time: S,
        duration: S,
        observer: &mut dyn Observer<S>,
    ) -> S {
        if state.phase != Phase::Rocking {
            return time;
        }
        let swings = swings.get_or_insert_with(|| HalfCycles::of(&self.released, &self.engaged, !self.clutch.follows_signs()));
        let Some(decay) = swings.decay(state.velocity.abs(), self.restitution, self.counted_speed, duration - time) else {
            return time;
        };
        observer.decay(&decay);
        let impacts = state.impacts.saturating_add(decay.impacts);
        let ends = (time + decay.duration).smaller(duration);
        if decay.speed != S::ZERO {
            // Still rocking at the end of its time: the last, incomplete swing is integrated by the method.
            let velocity = state.direction.times(decay.speed);
            let turned = |sign: Sign| if decay.speed < S::ZERO { sign.opposite() } else { sign };
            let (side, direction) = (turned(state.side), turned(state.direction));
            *state = BlockState {
                impacts,
                velocity,
                side,
                direction,
                acceleration_sign: turned(state.acceleration_sign),
                terminal_acceleration_sign: turned(state.terminal_acceleration_sign),
                ..*state
            };
        } else {
            *state = state.rested(impacts);
            observer.event(Event::Rest, ends, state);
        }
        ends
    }

    /// Impact accumulation: the infinitely many impacts that follow a weak one ([`crate::motion::rest::impact_accumulation`]).
    fn accumulation(&self, side: Sign, speed: S, ground: S) -> Accumulation<S> {
        let [out, back, farther, home] = ways(side).map(|way| self.bounce(way, ground).abs().larger(S::EPSILON * S::EPSILON));
        let tail = Accumulation::of((out, back), (farther, home), self.restitution, speed, self.counted_speed);
        if self.clutch.follows_signs() { tail } else { tail.without_closings() }
    }

    /// θ̈ (rad/s²) of a way of its bounces, inward on either.
    fn bounce(&self, (side, direction): (Sign, Sign), ground: S) -> S {
        self.equation(direction, side.opposite()).acceleration(side.unit(), S::ZERO, S::ZERO, ground)
    }
}
