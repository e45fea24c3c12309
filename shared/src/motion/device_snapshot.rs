//! Snapshot of block and device at one instant, for observers of forces and energies.
//!
//! Everything is divided by I_O = λmR²: forces at the rack come as F/(λmR) in 1/s², energies as E/(λmR²) in 1/s², powers in
//! 1/s³.

use crate::drivetrain::transmission::Account;
use crate::equation::Accelerations;
use crate::equation::motion::Motion;
use crate::math::scalar::Real;
use crate::method::dense_output::DenseOutput;

/// Snapshot of block and device at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Snapshot<S> {
    /// θ, θ̇, θ̈.
    pub motion: Motion<S>,
    /// Accelerations of ground and support.
    pub ground: Accelerations<S>,
    /// ℓθ̇, the velocity of the rack over R; 1/s.
    pub terminal_velocity: S,
    /// Forces, speeds, energies and losses of the device.
    pub device: Account<S>,
}

impl<S: Real> Snapshot<S> {
    /// F₁ + F₂, what both flywheels together press on their support; F/(λmR), 1/s². Friction of the rack's guides is not in it,
    /// that of its mesh is.
    pub fn support_force(&self) -> S {
        self.device.force[0] + self.device.force[1]
    }
}

/// Dense output with snapshots of the device.
pub trait DeviceOutput<S: Real> {
    /// The motion of the block alone.
    fn motion(&self) -> &dyn DenseOutput<S>;

    /// Block and device at `time` after the start of the step.
    fn snapshot(&self, time: S) -> Snapshot<S>;

    /// Into how many equal pieces an observer is to cut the step, so that between three looks at a piece no force does more than bend; 1 for the
    /// steps of a method, which are short enough.
    fn pieces(&self) -> u32 {
        1
    }

    /// Displacement of the base over the ground at `time` after the start of the step, m; 0 where it cannot slide.
    fn displacement(&self, _time: S) -> S {
        S::ZERO
    }
}
