//! Whether a base sticks or slides, and when a block that stands begins to move.

use super::{Contact, GroundPair, SlidingState, SlidingSystem};
use crate::math::polynomial::first_zero_of;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::motion::observer::{Event, Observer};
use crate::motion::state::Phase;

impl<S: Real> SlidingSystem<S> {
    /// |ü_g| over the weight g + v̈_g above which a block that stands moves: it slides at μ or uplifts at tan α.
    fn least_push(&self) -> S {
        self.friction.smaller(self.uplift)
    }

    /// A block that stands stays so. Above the threshold by so little that the rounded equation still presses it on its base, it does.
    pub(super) fn stands(&self, ground: [S; 2]) -> bool {
        let [push, weight] = ground;
        let side = Sign::of(push, Sign::Positive).opposite();
        let exceeded = push.abs() > self.least_push() * weight;
        let tips = || side.times(self.stuck(side, S::ZERO, S::ZERO, ground).acceleration) > S::ZERO;
        !(exceeded && (self.friction <= self.uplift || tips()))
    }

    /// First instant in [`from`, `to`) at which a block that stands begins to move.
    pub(super) fn leaves(&self, ground: GroundPair<'_, S>, from: S, to: S) -> Option<S> {
        if !self.stands(ground.at(from)) {
            return Some(from);
        }
        let least = self.least_push();
        let vertical = ground.vertical;
        let curvature = ground.horizontal.curvature_bound() + least * vertical.map_or(S::ZERO, |up| up.curvature_bound());
        let crossing = |sign: Sign| {
            let value = |t: S| {
                let [push, weight] = ground.at(t);
                let growth = least * vertical.map_or(S::ZERO, |up| up.slope(t));
                (sign.times(push) - least * weight, sign.times(ground.horizontal.slope(t)) - growth)
            };
            // On the threshold already, it leaves it if it grows.
            let (now, slope) = value(from);
            if now >= S::ZERO && slope > S::ZERO {
                return Some(from);
            }
            first_zero_of(value, curvature, (from, to, value(to).0), Sign::Negative, now >= S::ZERO)
        };
        let first = [Sign::Positive, Sign::Negative].into_iter().filter_map(crossing).reduce(Real::smaller);
        // One within rounding of the segment's end belongs to the next segment.
        first.filter(|&t| to - t > to * S::EPSILON * S::of(4.0))
    }

    /// Sets a block that stands in motion at `time` (s): it slides, or uplifts to the side opposite to the ground acceleration.
    pub(super) fn leave(&self, state: &mut SlidingState<S>, ground: [S; 2], time: S, observer: &mut dyn Observer<S>) {
        let side = Sign::of(ground[0], Sign::Positive).opposite();
        if self.friction <= self.uplift {
            state.contact = Contact::Slides(side);
            observer.event(Event::Slip, time, &state.motion);
            return;
        }
        state.contact = Contact::Sticks;
        self.tip(state, side, time, observer);
        self.settle_seen(state, ground, time, observer);
    }

    /// Uplift to `side`.
    pub(super) fn tip(&self, state: &mut SlidingState<S>, side: Sign, time: S, observer: &mut dyn Observer<S>) {
        state.motion = state.motion.uplifted(side);
        observer.event(Event::Uplift, time, &state.motion);
    }

    /// What the toe of a block that rocks does from here on: by its speed, and at ẋ = 0 by what would hold it. Gives whether
    /// it leaves the ground: it neither sticks nor is pressed down while it slides.
    pub(super) fn settle(&self, state: &mut SlidingState<S>, ground: [S; 2]) -> bool {
        let (side, rotation, velocity) = (state.motion.side, state.motion.rotation, state.motion.velocity);
        state.contact = if state.slip != S::ZERO {
            Contact::Slides(Sign::of(state.slip, Sign::Positive))
        } else {
            let stuck = self.stuck(side, rotation, velocity, ground);
            if stuck.along.abs() <= self.friction * stuck.normal {
                Contact::Sticks
            } else {
                Contact::Slides(self.slips_to(state, ground))
            }
        };
        match state.contact {
            Contact::Sticks => false,
            Contact::Slides(direction) => self.sliding(side, direction, rotation, velocity, ground).normal < S::ZERO,
        }
    }

    /// Where a toe at ẋ = 0 that cannot stick slides to: the direction in which sliding accelerates it.
    pub(super) fn slips_to(&self, state: &SlidingState<S>, ground: [S; 2]) -> Sign {
        let (side, rotation, velocity) = (state.motion.side, state.motion.rotation, state.motion.velocity);
        let along = self.stuck(side, rotation, velocity, ground).along;
        let likely = Sign::of(along, Sign::Positive).opposite();
        // At the limit of sticking the acceleration of the one is zero to rounding, and the other way friction opposes it.
        let gain = |way: Sign| way.times(self.sliding(side, way, rotation, velocity, ground).slide);
        if gain(likely) >= gain(likely.opposite()) { likely } else { likely.opposite() }
    }

    /// [`SlidingSystem::settle`], shown to `observer`.
    pub(super) fn settle_seen(&self, state: &mut SlidingState<S>, ground: [S; 2], time: S, observer: &mut dyn Observer<S>) {
        let before = state.contact;
        if self.settle(state, ground) {
            self.lift_off(state, time, observer);
        } else if state.contact != before {
            observer.event(Event::Slip, time, &state.motion);
        }
    }

    /// ẋ has come to 0 at `time` (s): the base sticks, or slides back at once.
    pub(super) fn stop(&self, state: &mut SlidingState<S>, ground: [S; 2], time: S, observer: &mut dyn Observer<S>) {
        if state.motion.phase == Phase::Rocking {
            return self.settle_seen(state, ground, time, observer);
        }
        let [push, weight] = ground;
        if push.abs() > self.friction * weight {
            state.contact = Contact::Slides(Sign::of(push, Sign::Positive).opposite());
            observer.event(Event::Slip, time, &state.motion);
        } else {
            state.contact = Contact::Sticks;
            observer.event(Event::Slip, time, &state.motion);
            observer.event(Event::Rest, time, &state.motion);
        }
    }

    /// |θ| is beyond α + arctan μ, where no reaction within the cone of friction turns the block back.
    pub(super) fn is_falling(&self, state: &SlidingState<S>) -> bool {
        let (sin, cos) = (state.motion.side.times(state.motion.rotation) - self.slenderness).sin_cos();
        cos <= S::ZERO || sin > self.friction * cos
    }
}
