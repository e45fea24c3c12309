//! One step of a block on its feet: the classical Runge-Kutta method, taken again for every instant inside the step.

use super::balance::{Balance, Place};
use super::{CompliantState, CompliantSystem, Foot};
use crate::drivetrain::transmission::Account;
use crate::equation::motion::Motion;
use crate::math::scalar::Real;
use crate::method::dense_output::DenseOutput;
use crate::motion::device_snapshot::{DeviceOutput, Snapshot};
use crate::motion::ground_pair::GroundPair;

/// A function that is positive for as long as nothing happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Guard {
    /// It has not overturned.
    Overturned,
    /// sθ: the block leans to its side.
    Upright,
    /// What keeps the foot with this number in its mode.
    Foot(usize),
    /// θ̇ keeps its sign.
    Turn,
    /// The terminals' acceleration keeps its sign, where a clutch looks at it.
    Push,
}

impl Guard {
    /// Each; of two at one instant the earlier one here is handled first.
    pub const ALL: [Guard; 6] = [Guard::Overturned, Guard::Upright, Guard::Foot(0), Guard::Foot(1), Guard::Turn, Guard::Push];
}

/// Dense output of a step.
pub(super) struct Stretch<'a, S> {
    system: &'a CompliantSystem<S>,
    ground: GroundPair<'a, S>,
    /// The mode, which lasts through the step.
    mode: CompliantState<S>,
    time: S,
    length: S,
    end: Place<S>,
}

impl<'a, S: Real> Stretch<'a, S> {
    /// From `state` at `time` over `length` (s).
    pub fn new(
        system: &'a CompliantSystem<S>,
        ground: GroundPair<'a, S>,
        state: &CompliantState<S>,
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
        (state.height, state.rise) = (place.height, place.rise);
        self.system.balance(&state, ground)
    }

    fn rates(&self, place: &Place<S>, ground: [S; 2]) -> Place<S> {
        let Balance { acceleration, lift, loss, .. } = self.balance(place, ground);
        Place { rotation: place.velocity, velocity: acceleration, height: place.rise, rise: lift, spent: loss }
    }

    fn step(&self, h: S) -> Place<S> {
        let start = self.mode.place();
        let [middle, end] = [S::HALF * h, h].map(|t| self.ground.at(self.time + t));
        let first = self.rates(&start, self.ground.at(self.time));
        let second = self.rates(&start.after(&first, S::HALF * h), middle);
        let third = self.rates(&start.after(&second, S::HALF * h), middle);
        let fourth = self.rates(&start.after(&third, h), end);
        let both = second.after(&third, S::ONE);
        start.after(&first.after(&both, S::of(2.0)).after(&fourth, S::ONE), h * S::of(1.0 / 6.0))
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
        let motion = &self.mode.motion;
        match guard {
            Guard::Overturned => overturned - motion.side.times(place.rotation),
            Guard::Upright => motion.side.times(place.rotation),
            Guard::Turn => motion.direction.times(place.velocity),
            Guard::Foot(foot) => {
                let (compression, force) = self.system.foot(&place, motion.side, foot);
                let weight = self.system.gravity();
                match self.mode.feet[foot] {
                    Foot::Presses => force / weight,
                    Foot::Relaxes => (-force / weight).smaller(self.system.stiffness / weight * compression),
                    Foot::Lifted => -compression,
                }
            }
            Guard::Push if self.system.clutch.follows_signs() => {
                let push = self.balance(&place, self.ground.at(self.time + time)).push;
                motion.terminal_acceleration_sign.times(push)
            }
            Guard::Push => S::ONE,
        }
    }
}

impl<S: Real> Place<S> {
    /// The place with `rates` for `h`.
    fn after(&self, rates: &Place<S>, h: S) -> Place<S> {
        Place {
            rotation: self.rotation + h * rates.rotation,
            velocity: self.velocity + h * rates.velocity,
            height: self.height + h * rates.height,
            rise: self.rise + h * rates.rise,
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

    /// Force, speed and energy of an ideal device as in [`crate::motion::ideal::device_view`].
    fn snapshot(&self, time: S) -> Snapshot<S> {
        let (system, motion) = (self.system, self.motion(time));
        let [push, weight] = self.ground.at(self.time + time);
        let side = self.mode.motion.side;
        let (sine, cosine) = system.delta(side, motion.rotation);
        let terminal_velocity = cosine * motion.velocity;
        let mut device = Account::default();
        if let Some(wheel) = system.clutch.flywheel(self.mode.engaged, self.mode.motion.direction) {
            let coupling = system.mass_ratio / system.inertia;
            let swing = if system.consistent { side.times(sine * motion.velocity * motion.velocity) } else { S::ZERO };
            device.force[wheel] = coupling * (cosine * motion.acceleration + swing);
            device.engaged[wheel] = true;
            device.spin[wheel] = terminal_velocity;
            device.stored = S::HALF * coupling * terminal_velocity * terminal_velocity;
        }
        Snapshot { motion, ground: [push, weight - S::ONE, S::ZERO], terminal_velocity, device }
    }
}
