//! One step of a block that rocks or slides: its rates, and what ends its mode.

use super::balance::Balance;
use super::{Contact, SlidingState, SlidingSystem};
use crate::math::scalar::Real;
use crate::method::dense_output::DenseOutput;
use crate::motion::device_snapshot::{DeviceOutput, Snapshot};
use crate::motion::state::{BlockState, Phase};
use crate::motion::stepped::{self, Mode, Place};

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
pub(super) type Stretch<'a, S> = stepped::Stretch<'a, S, SlidingState<S>>;

impl<S: Real> Mode<S> for SlidingState<S> {
    type System = SlidingSystem<S>;

    fn block(&self) -> &BlockState<S> {
        &self.motion
    }

    fn place(&self) -> Place<S> {
        let BlockState { rotation, velocity, .. } = self.motion;
        [rotation, velocity, self.displacement, self.slip, self.spent]
    }

    fn at(&self, place: &Place<S>) -> SlidingState<S> {
        let [rotation, velocity, displacement, slip, spent] = *place;
        SlidingState { motion: BlockState { rotation, velocity, ..self.motion }, displacement, slip, spent, ..*self }
    }

    /// θ̇, θ̈, ẋ/R, ẍ/R, power of friction.
    fn rates(&self, system: &SlidingSystem<S>, ground: [S; 2]) -> Place<S> {
        let balance = system.balance(self, ground);
        let turns = self.motion.phase == Phase::Rocking;
        let slides = self.contact != Contact::Sticks;
        let turning = if turns { self.motion.velocity } else { S::ZERO };
        let (sliding, loss) = if slides { (self.slip, -balance.along * self.slip) } else { (S::ZERO, S::ZERO) };
        [turning, balance.acceleration, sliding, balance.slide, loss]
    }
}

impl<S: Real> Stretch<'_, S> {
    /// A guard `time` (s) after the start; one that the mode does not have is 1.
    pub(super) fn guard(&self, guard: Guard, time: S, overturned: S) -> S {
        let state = self.state(time);
        let SlidingState { motion: BlockState { phase, side, direction, rotation, velocity, .. }, slip, .. } = state;
        let rocks = phase == Phase::Rocking;
        let slides = match state.contact {
            Contact::Sticks => None,
            Contact::Slides(direction) => Some(direction),
        };
        let balance = || self.system.balance(&state, self.ground(time));
        match (guard, slides) {
            (Guard::Impact, _) if rocks => side.times(rotation),
            (Guard::Overturned, _) if rocks => overturned - side.times(rotation),
            (Guard::Turn, _) if rocks => direction.times(velocity),
            (Guard::Lift, Some(_)) if rocks => balance().normal,
            (Guard::Stop, Some(direction)) => direction.times(slip),
            (Guard::Grip, None) if rocks => {
                let Balance { along, normal, .. } = balance();
                self.system.friction * normal - along.abs()
            }
            _ => S::ONE,
        }
    }
}

impl<S: Real> DeviceOutput<S> for Stretch<'_, S> {
    fn motion(&self) -> &dyn DenseOutput<S> {
        self
    }

    fn snapshot(&self, time: S) -> Snapshot<S> {
        let [push, weight] = self.ground(time);
        let ground = [push, weight - S::ONE, S::ZERO];
        Snapshot { motion: self.at(time), ground, terminal_velocity: S::ZERO, device: Default::default() }
    }

    fn displacement(&self, time: S) -> S {
        self.system.size * self.state(time).displacement
    }
}
