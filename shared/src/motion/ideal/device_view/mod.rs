//! Snapshots of an ideal device along the dense output of [`crate::motion::ideal`], for observers of forces and energies.
//!
//! The clutch of an ideal device has no memory: a working flywheel moves with the rack, an idle one stands still. So
//! with κ = 1 while it works, force and energy follow from the block's motion alone,
//!
//! F/(λmR) = κ k (terminals' acceleration)/R,  E/(λmR²) = ½ κ k (ℓθ̇)²,  k = σ/λ.

use crate::drivetrain::power_loss::Spent;
use crate::equation::Equation;
use crate::equation::any_equation::AnyEquation;
use crate::equation::clutch_rule::{ClutchRule, Flywheel};
use crate::equation::motion::Motion;
use crate::ground::GroundSegment;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::method::dense_output::DenseOutput;
use crate::motion::device_snapshot::{DeviceObserver, DeviceOutput, Snapshot};
use crate::motion::observer::{Event, MonotoneInterval, Observer};
use crate::motion::state::BlockState;

/// Shows the motion of an ideal device to a [`DeviceObserver`].
#[derive(Clone, Copy, Debug)]
pub struct Watched<S, P, O> {
    /// The equation of motion with the inerter engaged.
    pub engaged: AnyEquation<S>,
    /// k = σ/λ; 0 without an inerter.
    pub coupling: S,
    /// The ground motion in force, in the local time of the intervals that follow; the caller keeps it up to date.
    pub piece: P,
    /// The observer.
    pub observer: O,
    /// When it engages.
    pub clutch: ClutchRule,
}

impl<S: Real, P: GroundSegment<S>, O: DeviceObserver<S>> Observer<S> for Watched<S, P, O> {
    #[inline]
    fn interval(&mut self, output: &dyn DenseOutput<S>, interval: &MonotoneInterval<S>) {
        let output = WatchedArc {
            output,
            equation: &self.engaged,
            coupling: self.coupling,
            piece: &self.piece,
            start: interval.start,
            side: interval.side.unit(),
            wheel: self.clutch.flywheel(interval.engaged && self.clutch.has_inerter(), interval.direction),
        };
        self.observer.device_interval(&output, interval);
    }

    #[inline]
    fn event(&mut self, event: Event, time: S, state: &BlockState<S>) {
        self.observer.device_event(event, time, state);
    }
}

/// Dense output with the ideal device engaged over it.
struct WatchedArc<'a, S, P> {
    output: &'a dyn DenseOutput<S>,
    equation: &'a AnyEquation<S>,
    coupling: S,
    piece: &'a P,
    start: S,
    side: S,
    wheel: Flywheel,
}

impl<S: Real, P: GroundSegment<S>> DenseOutput<S> for WatchedArc<'_, S, P> {
    #[inline]
    fn length(&self) -> S {
        self.output.length()
    }

    #[inline]
    fn at(&self, time: S) -> Motion<S> {
        self.output.at(time)
    }

    #[inline]
    fn switching(&self, time: S) -> S {
        self.output.switching(time)
    }

    #[inline]
    fn acceleration_zero(&self, from: S, to: S, sign: Sign, from_zero: bool) -> Option<S> {
        self.output.acceleration_zero(from, to, sign, from_zero)
    }

    #[inline]
    fn switching_zero(&self, from: S, to: S, sign: Sign, from_zero: bool) -> Option<S> {
        self.output.switching_zero(from, to, sign, from_zero)
    }

    #[inline]
    fn largest_acceleration(&self, from: (S, S), to: (S, S), floor: S) -> S {
        self.output.largest_acceleration(from, to, floor)
    }
}

impl<S: Real, P: GroundSegment<S>> DeviceOutput<S> for WatchedArc<'_, S, P> {
    #[inline]
    fn snapshot(&self, time: S) -> Snapshot<S> {
        let motion = self.output.at(time);
        let Motion { rotation, velocity, acceleration } = motion;
        // Without a θ̇² term the terminals' acceleration is ℓ times what it is given.
        let terminal_velocity = self.equation.terminal_acceleration(self.side, rotation, S::ZERO, velocity);
        let mut snapshot = Snapshot {
            motion,
            ground: [self.piece.acceleration(self.start + time), S::ZERO],
            terminal_velocity,
            force: [S::ZERO; 2],
            rack_force: S::ZERO,
            engaged: [false; 2],
            spin: [S::ZERO; 2],
            stored: S::ZERO,
            sprung: S::ZERO,
            spent: Spent::default(),
        };
        let wheel = match self.wheel {
            Flywheel::Idle => return snapshot,
            Flywheel::First => 0,
            Flywheel::Second => 1,
        };
        let terminal = self.equation.terminal_acceleration(self.side, rotation, velocity, acceleration);
        snapshot.force[wheel] = self.coupling * terminal;
        snapshot.engaged[wheel] = true;
        snapshot.spin[wheel] = terminal_velocity;
        snapshot.stored = S::HALF * self.coupling * terminal_velocity * terminal_velocity;
        snapshot.spent.kinematics = self.equation.paper_power(self.side, rotation, velocity);
        snapshot
    }
}

#[cfg(test)]
pub(crate) mod tests;
