//! One step of a block that rocks or slides: the classical Runge-Kutta method, taken again for every instant inside the step.

use super::balance::{Balance, Place};
use super::{Contact, GroundPair, SlidingState, SlidingSystem};
use crate::equation::motion::Motion;
use crate::math::scalar::Real;
use crate::method::dense_output::DenseOutput;
use crate::motion::device_snapshot::{DeviceOutput, Snapshot};
use crate::motion::state::Phase;

/// A function that is positive for as long as nothing happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Guard {
    /// sθ: the block is above its base.
    Impact,
    /// It has not overturned.
    Overturned,
    /// V of a toe that slides.
    Lift,
    /// θ̇ keeps its sign.
    Turn,
    /// ẋ keeps its sign.
    Stop,
    /// μV − |H| of a toe that sticks.
    Grip,
}

impl Guard {
    /// Each; of two at one instant the earlier one here is handled first.
    pub const ALL: [Guard; 6] = [Guard::Impact, Guard::Overturned, Guard::Lift, Guard::Turn, Guard::Stop, Guard::Grip];
}

/// Dense output of a step.
pub(super) struct Stretch<'a, S> {
    system: &'a SlidingSystem<S>,
    ground: GroundPair<'a, S>,
    /// The mode, which lasts through the step.
    mode: SlidingState<S>,
    time: S,
    length: S,
    end: Place<S>,
}

impl<'a, S: Real> Stretch<'a, S> {
    /// From `state` at `time` over `length` (s).
    pub fn new(
        system: &'a SlidingSystem<S>,
        ground: GroundPair<'a, S>,
        state: &SlidingState<S>,
        time: S,
        length: S,
    ) -> Stretch<'a, S> {
        let mut stretch = Stretch { system, ground, mode: *state, time, length, end: state.place() };
        stretch.end = stretch.step(length);
        stretch
    }

    fn balance(&self, place: &Place<S>, ground: [S; 2]) -> Balance<S> {
        let mut state = self.mode;
        (state.motion.rotation, state.motion.velocity) = (place.rotation, place.velocity);
        self.system.balance(&state, ground)
    }

    /// Rates of a place: θ̇, θ̈, ẋ/R, ẍ/R, power of friction.
    fn rates(&self, place: &Place<S>, ground: [S; 2]) -> Place<S> {
        let balance = self.balance(place, ground);
        let turns = self.mode.motion.phase == Phase::Rocking;
        let slides = self.mode.contact != Contact::Sticks;
        Place {
            rotation: if turns { place.velocity } else { S::ZERO },
            velocity: balance.acceleration,
            displacement: if slides { place.slip } else { S::ZERO },
            slip: balance.slide,
            spent: if slides { -balance.along * place.slip } else { S::ZERO },
        }
    }

    fn step(&self, h: S) -> Place<S> {
        let start = self.mode.place();
        let [middle, end] = [S::HALF * h, h].map(|t| self.ground.at(self.time + t));
        let first = self.rates(&start, self.ground.at(self.time));
        let second = self.rates(&start.after(&first, S::HALF * h), middle);
        let third = self.rates(&start.after(&second, S::HALF * h), middle);
        let fourth = self.rates(&start.after(&third, h), end);
        let sixth = h * S::of(1.0 / 6.0);
        let both = second.after(&third, S::ONE);
        start.after(&first.after(&both, S::of(2.0)).after(&fourth, S::ONE), sixth)
    }

    /// The place `time` (s) after the start.
    pub fn place(&self, time: S) -> Place<S> {
        if time == S::ZERO {
            self.mode.place()
        } else if time == self.length {
            self.end
        } else {
            self.step(time)
        }
    }

    /// θ, θ̇ and θ̈ `time` (s) after the start.
    pub fn motion(&self, time: S) -> Motion<S> {
        let place = self.place(time);
        let acceleration = self.balance(&place, self.ground.at(self.time + time)).acceleration;
        Motion { rotation: place.rotation, velocity: place.velocity, acceleration }
    }

    /// A guard `time` (s) after the start; one that the mode does not have is 1.
    pub fn guard(&self, guard: Guard, time: S, overturned: S) -> S {
        let place = self.place(time);
        let rocks = self.mode.motion.phase == Phase::Rocking;
        let side = self.mode.motion.side;
        let direction = match self.mode.contact {
            Contact::Sticks => None,
            Contact::Slides(direction) => Some(direction),
        };
        let balance = || self.balance(&place, self.ground.at(self.time + time));
        match (guard, direction) {
            (Guard::Impact, _) if rocks => side.times(place.rotation),
            (Guard::Overturned, _) if rocks => overturned - side.times(place.rotation),
            (Guard::Turn, _) if rocks => self.mode.motion.direction.times(place.velocity),
            (Guard::Lift, Some(_)) if rocks => balance().normal,
            (Guard::Stop, Some(direction)) => direction.times(place.slip),
            (Guard::Grip, None) if rocks => {
                let Balance { along, normal, .. } = balance();
                self.system.friction * normal - along.abs()
            }
            _ => S::ONE,
        }
    }
}

impl<S: Real> Place<S> {
    /// The place with `rates` for `h`.
    fn after(&self, rates: &Place<S>, h: S) -> Place<S> {
        Place {
            rotation: self.rotation + h * rates.rotation,
            velocity: self.velocity + h * rates.velocity,
            displacement: self.displacement + h * rates.displacement,
            slip: self.slip + h * rates.slip,
            spent: self.spent + h * rates.spent,
        }
    }
}

impl<S: Real> DenseOutput<S> for Stretch<'_, S> {
    fn length(&self) -> S {
        self.length
    }

    fn at(&self, time: S) -> Motion<S> {
        self.motion(time)
    }
}

impl<S: Real> DeviceOutput<S> for Stretch<'_, S> {
    fn motion(&self) -> &dyn DenseOutput<S> {
        self
    }

    fn snapshot(&self, time: S) -> Snapshot<S> {
        let [push, weight] = self.ground.at(self.time + time);
        let ground = [push, weight - S::ONE, S::ZERO];
        Snapshot { motion: self.motion(time), ground, terminal_velocity: S::ZERO, device: Default::default() }
    }

    fn displacement(&self, time: S) -> S {
        self.system.size * self.place(time).displacement
    }
}
