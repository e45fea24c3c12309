//! Snapshots of an ideal device along the dense output of [`crate::motion::ideal`], for observers of forces and energies.
//!
//! The clutch of an ideal device has no memory: a working flywheel moves with the rack, an idle one stands still. So
//! with κ = 1 while it works, force and energy follow from the block's motion alone,
//!
//! F/(λmR) = κ k (terminals' acceleration)/R,  E/(λmR²) = ½ κ k (ℓθ̇)²,  k = σ/λ.

use crate::drivetrain::transmission::Account;
use crate::equation::Equation;
use crate::equation::any_equation::AnyEquation;
use crate::equation::clutch_rule::ClutchRule;
use crate::equation::motion::Motion;
use crate::ground::GroundSegment;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::method::dense_output::DenseOutput;
use crate::motion::device_snapshot::{DeviceOutput, Snapshot};
use crate::motion::observer::{Event, MonotoneInterval, Observer};
use crate::motion::rest::impact_accumulation::Accumulation;
use crate::motion::state::BlockState;

/// Shows an observer the motion of an ideal device as that of one with a memory, by [`Observer::device_interval`].
#[derive(Debug)]
pub struct Watched<'o, S, P, O> {
    /// The equation of motion with the inerter engaged.
    pub engaged: AnyEquation<S>,
    /// k = σ/λ; 0 without an inerter.
    pub coupling: S,
    /// The ground motion in force, in the local time of the intervals that follow; the caller keeps it up to date.
    pub segment: P,
    /// The observer.
    pub observer: &'o mut O,
    /// When it engages.
    pub clutch: ClutchRule,
}

impl<S: Real, P: GroundSegment<S>, O: Observer<S>> Observer<S> for Watched<'_, S, P, O> {
    #[inline]
    fn interval(&mut self, output: &dyn DenseOutput<S>, interval: &MonotoneInterval<S>) {
        let output = WatchedArc {
            output,
            equation: &self.engaged,
            coupling: self.coupling,
            segment: &self.segment,
            start: interval.start,
            side: interval.side.unit(),
            wheel: self.clutch.flywheel(interval.engaged && self.clutch.has_inerter(), interval.direction),
        };
        self.observer.device_interval(&output, interval);
    }

    #[inline]
    fn event(&mut self, event: Event, time: S, state: &BlockState<S>) {
        self.observer.event(event, time, state);
    }

    fn accumulation(&mut self, tail: &Accumulation<S>) {
        self.observer.accumulation(tail);
    }

    fn bounce(&mut self, (side, direction): (Sign, Sign), acceleration: S, time: S) {
        let wheel = self.clutch.flywheel(self.clutch.engages(direction, side.opposite()), direction);
        let motion = Motion { rotation: S::ZERO, velocity: S::ZERO, acceleration };
        let ground = self.segment.acceleration(time);
        let snapshot = || seen((&self.engaged, self.coupling, wheel), side.unit(), motion, ground);
        self.observer.device_bounce(side, time, &snapshot);
    }
}

/// Dense output with the ideal device engaged over it.
struct WatchedArc<'a, S, P> {
    output: &'a dyn DenseOutput<S>,
    equation: &'a AnyEquation<S>,
    coupling: S,
    segment: &'a P,
    start: S,
    side: S,
    wheel: Option<usize>,
}

impl<S: Real, P: GroundSegment<S>> DeviceOutput<S> for WatchedArc<'_, S, P> {
    #[inline]
    fn motion(&self) -> &dyn DenseOutput<S> {
        self.output
    }

    #[inline]
    fn snapshot(&self, time: S) -> Snapshot<S> {
        let ground = self.segment.acceleration(self.start + time);
        seen((self.equation, self.coupling, self.wheel), self.side, self.output.at(time), ground)
    }
}

/// Snapshot of a block that moves on a side s = `side` with the flywheel `wheel` working, if any; `ground` is ü_g/g.
#[inline]
fn seen<S: Real>(
    (equation, coupling, wheel): (&AnyEquation<S>, S, Option<usize>),
    side: S,
    motion: Motion<S>,
    ground: S,
) -> Snapshot<S> {
    let Motion { rotation, velocity, acceleration } = motion;
    // Without a θ̇² term the terminals' acceleration is ℓ times what it is given.
    let terminal_velocity = equation.terminal_acceleration(side, rotation, S::ZERO, velocity);
    let mut device = Account::NOTHING;
    if let Some(wheel) = wheel {
        let terminal = equation.terminal_acceleration(side, rotation, velocity, acceleration);
        device.force[wheel] = coupling * terminal;
        device.engaged[wheel] = true;
        device.spin[wheel] = terminal_velocity;
        device.stored = S::HALF * coupling * terminal_velocity * terminal_velocity;
        device.spent.kinematics = equation.paper_power(side, rotation, velocity);
    }
    Snapshot { motion, ground: [ground, S::ZERO, S::ZERO], terminal_velocity, device }
}

#[cfg(test)]
pub(crate) mod tests;
