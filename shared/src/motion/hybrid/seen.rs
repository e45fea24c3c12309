//! Snapshots for observers: along the mode output, and of a block that does not move.

use super::mode_output::{ModeOutput, Place, Shaking};
use super::{HybridState, HybridSystem};
use crate::drivetrain::clutch_state::ModeCoefficients;
use crate::equation::Accelerations;
use crate::equation::motion::Motion;
use crate::math::scalar::Real;
use crate::method::dense_output::DenseOutput;
use crate::motion::device_snapshot::{DeviceOutput, Snapshot};
use crate::motion::state::BlockState;

/// Mode output with snapshots.
pub(super) struct Seen<'a, S, A> {
    pub(super) machine: &'a HybridSystem<S>,
    pub(super) output: &'a A,
    pub(super) law: &'a ModeCoefficients<S>,
    pub(super) state: &'a HybridState<S>,
    pub(super) shaking: Shaking<'a, S>,
    pub(super) time: S,
}

impl<S: Real, A: ModeOutput<S>> DeviceOutput<S> for Seen<'_, S, A> {
    fn motion(&self) -> &dyn DenseOutput<S> {
        self.output
    }

    fn snapshot(&self, time: S) -> Snapshot<S> {
        let ground = self.shaking.at(self.time + time);
        let Motion { rotation, velocity, acceleration } = self.output.at(time);
        let place = Place { time, ground, rotation, velocity, unknowns: self.output.unknowns(time) };
        self.machine.snapshot(self.law, self.state, &place, acceleration)
    }
}

/// Dense output of a block that does not move, or of one instant. The ground is behind a pointer: one copy of this serves every kind of it.
pub(super) struct Still<'a, S> {
    pub(super) machine: &'a HybridSystem<S>,
    pub(super) state: &'a HybridState<S>,
    /// The accelerations a time (s) after the start, and what the support's speed has gained until then.
    pub(super) ground: &'a dyn Fn(S) -> (Accelerations<S>, S),
    pub(super) length: S,
    /// [`DeviceOutput::pieces`].
    pub(super) pieces: u32,
}

impl<S: Real> DenseOutput<S> for Still<'_, S> {
    fn length(&self) -> S {
        self.length
    }

    fn at(&self, _time: S) -> Motion<S> {
        let BlockState { rotation, velocity, .. } = self.state.motion;
        Motion { rotation, velocity, acceleration: S::ZERO }
    }
}

impl<S: Real> DeviceOutput<S> for Still<'_, S> {
    fn motion(&self) -> &dyn DenseOutput<S> {
        self
    }

    fn snapshot(&self, time: S) -> Snapshot<S> {
        let mut state = *self.state;
        self.machine.idle(&mut state, time);
        let (ground, gain) = (self.ground)(time);
        if let Some(terminals) = &mut state.device.terminals {
            terminals.support = terminals.support + gain;
        }
        let place = Place { ground, ..self.machine.place(&state) };
        self.machine.snapshot(&self.machine.law(&state), &state, &place, S::ZERO)
    }

    fn pieces(&self) -> u32 {
        self.pieces
    }
}
