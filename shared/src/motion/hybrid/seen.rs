//! What watchers see: a block on its path, and one that does not move.

use super::path::{Path, Shaking};
use super::{Machine, MachineState};
use crate::drivetrain::clutch_state::Law;
use crate::equation::motion::Motion;
use crate::math::scalar::Real;
use crate::method::dense_output::Arc;
use crate::motion::device_snapshot::{DeviceArc, Snapshot};
use crate::motion::state::State;

/// A path as watchers see it.
pub(super) struct Seen<'a, S, A> {
    pub(super) machine: &'a Machine<S>,
    pub(super) path: &'a A,
    pub(super) law: &'a Law<S>,
    pub(super) state: &'a MachineState<S>,
    pub(super) shaking: Shaking<'a, S>,
    pub(super) time: S,
}

impl<S: Real, A: Arc<S>> Arc<S> for Seen<'_, S, A> {
    #[inline(always)]
    fn length(&self) -> S {
        self.path.length()
    }

    #[inline(always)]
    fn at(&self, time: S) -> Motion<S> {
        self.path.at(time)
    }

    #[inline(always)]
    fn switching(&self, time: S) -> S {
        self.path.switching(time)
    }

    #[inline(always)]
    fn largest_acceleration(&self, from: (S, S), to: (S, S), floor: S) -> S {
        self.path.largest_acceleration(from, to, floor)
    }
}

impl<S: Real, A: Path<S>> DeviceArc<S> for Seen<'_, S, A> {
    fn snapshot(&self, time: S) -> Snapshot<S> {
        let ground = self.shaking.at(self.time + time);
        self.machine.snapshot(self.law, self.state, self.path.at(time), self.path.extra(time), ground, time)
    }
}

/// A block that does not move, or at one instant. The ground is behind a pointer: one copy of this serves every kind of it.
pub(super) struct Still<'a, S> {
    pub(super) machine: &'a Machine<S>,
    pub(super) state: &'a MachineState<S>,
    /// Acceleration in g, horizontal and vertical, a time (s) after the start.
    pub(super) ground: &'a dyn Fn(S) -> [S; 2],
    pub(super) length: S,
}

impl<S: Real> Arc<S> for Still<'_, S> {
    fn length(&self) -> S {
        self.length
    }

    fn at(&self, _time: S) -> Motion<S> {
        let State { rotation, velocity, .. } = self.state.motion;
        Motion { rotation, velocity, acceleration: S::ZERO }
    }

    fn switching(&self, _time: S) -> S {
        S::ZERO
    }
}

impl<S: Real> DeviceArc<S> for Still<'_, S> {
    fn snapshot(&self, time: S) -> Snapshot<S> {
        let mut state = *self.state;
        self.machine.idle(&mut state, time);
        let law = self.machine.drive.law(state.motion.direction, state.motion.drive, &state.device);
        let extra = self.machine.drive.load(&state.device);
        self.machine.snapshot(&law, &state, self.at(time), extra, (self.ground)(time), S::ZERO)
    }
}
