//! One step of a block on its feet: its rates, and what ends its mode.

use super::balance::Balance;
use super::{CompliantState, CompliantSystem, Foot};
use crate::drivetrain::transmission::Account;
use crate::math::scalar::Real;
use crate::method::dense_output::DenseOutput;
use crate::motion::device_snapshot::{DeviceOutput, Snapshot};
use crate::motion::state::BlockState;
use crate::motion::stepped::{self, Mode, Place};

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
pub(super) type Stretch<'a, S> = stepped::Stretch<'a, S, CompliantState<S>>;

impl<S: Real> Mode<S> for CompliantState<S> {
    type System = CompliantSystem<S>;

    fn block(&self) -> &BlockState<S> {
        &self.motion
    }

    fn place(&self) -> Place<S> {
        let BlockState { rotation, velocity, .. } = self.motion;
        [rotation, velocity, self.height, self.rise, self.spent]
    }

    fn at(&self, place: &Place<S>) -> CompliantState<S> {
        let [rotation, velocity, height, rise, spent] = *place;
        CompliantState { motion: BlockState { rotation, velocity, ..self.motion }, height, rise, spent, ..*self }
    }

    /// θ̇, θ̈, ẏ/R, ÿ/R, power of the dashpots.
    fn rates(&self, system: &CompliantSystem<S>, ground: [S; 2]) -> Place<S> {
        let Balance { acceleration, lift, loss, .. } = system.balance(self, ground);
        [self.motion.velocity, acceleration, self.rise, lift, loss]
    }
}

impl<S: Real> Stretch<'_, S> {
    /// A guard `time` (s) after the start; one that the mode does not have is 1.
    pub(super) fn guard(&self, guard: Guard, time: S, overturned: S) -> S {
        let (system, state) = (self.system, self.state(time));
        let motion = &state.motion;
        match guard {
            Guard::Overturned => overturned - motion.side.times(motion.rotation),
            Guard::Upright => motion.side.times(motion.rotation),
            Guard::Turn => motion.direction.times(motion.velocity),
            Guard::Foot(foot) => {
                let (compression, force) = system.foot(&state, foot);
                let weight = system.gravity();
                match state.feet[foot] {
                    Foot::Presses => force / weight,
                    Foot::Relaxes => (-force / weight).smaller(system.stiffness / weight * compression),
                    Foot::Lifted => -compression,
                }
            }
            Guard::Push if system.clutch.follows_signs() => {
                motion.terminal_acceleration_sign.times(system.balance(&state, self.ground(time)).push)
            }
            Guard::Push => S::ONE,
        }
    }
}

impl<S: Real> DeviceOutput<S> for Stretch<'_, S> {
    fn motion(&self) -> &dyn DenseOutput<S> {
        self
    }

    /// Force, speed and energy of an ideal device as in [`crate::motion::ideal::device_view`].
    fn snapshot(&self, time: S) -> Snapshot<S> {
        let (system, motion) = (self.system, self.at(time));
        let [push, weight] = self.ground(time);
        let side = self.mode.motion.side;
        let (sine, cosine) = system.delta(side, motion.rotation);
        let terminal_velocity = cosine * motion.velocity;
        let mut device = Account::NOTHING;
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
