//! Entries of the energy ledger.

use crate::math::scalar::Real;

/// Energies over λmR², 1/s²: what came in, what is there, and what is gone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Entries<S> {
    /// Energy at the start.
    pub initial: S,
    /// Work of the ground on block and rack, and of a support of its own motion on flywheels, in the frame that moves with the ground.
    pub input: S,
    /// Kinetic energy of the block.
    pub kinetic: S,
    /// Potential energy of the block.
    pub potential: S,
    /// Energy of flywheels, rack and springs.
    pub stored: S,
    /// Gone in impacts, in the block and in what moves rigidly with it.
    pub impact: S,
    /// Gone in clutches: slip, damping, jolts.
    pub clutch: S,
    /// Gone in brakes of released flywheels.
    pub brake: S,
    /// Gone in bearings of flywheels.
    pub bearing: S,
    /// Gone in the rack's friction.
    pub rack: S,
    /// Taken without a cause by the paper's kinematics; negative where they give.
    pub kinematics: S,
    /// Created by ideal clutches, which engage a standing flywheel at speed without a jolt.
    pub created: S,
}

impl<S: Real> Entries<S> {
    /// Kinetic, potential and stored energy.
    pub fn mechanical(&self) -> S {
        self.kinetic + self.potential + self.stored
    }

    /// Everything gone, with what the kinematics took.
    pub fn dissipated(&self) -> S {
        self.impact + self.clutch + self.brake + self.bearing + self.rack + self.kinematics
    }

    /// initial + input + created − mechanical − dissipated: zero but for the errors of the motion and of the entries.
    pub fn residual(&self) -> S {
        self.initial + self.input + self.created - self.mechanical() - self.dissipated()
    }

    /// Every entry times `factor`: λmR² for joules, the reciprocal of the barrier for shares of it.
    pub fn scaled(&self, factor: S) -> Entries<S> {
        self.each(|entry| entry * factor)
    }

    /// `change` of every entry.
    pub fn each<T>(&self, change: impl Fn(S) -> T) -> Entries<T> {
        Entries {
            initial: change(self.initial),
            input: change(self.input),
            kinetic: change(self.kinetic),
            potential: change(self.potential),
            stored: change(self.stored),
            impact: change(self.impact),
            clutch: change(self.clutch),
            brake: change(self.brake),
            bearing: change(self.bearing),
            rack: change(self.rack),
            kinematics: change(self.kinematics),
            created: change(self.created),
        }
    }
}
