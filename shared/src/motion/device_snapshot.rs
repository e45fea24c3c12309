//! Snapshot of block and device at one instant, for observers of forces and energies.
//!
//! Everything is divided by I_O = λmR²: forces at the rack come as F/(λmR) in 1/s², energies as E/(λmR²) in 1/s², powers in
//! 1/s³.

use super::observer::{Event, MonotoneInterval};
use super::state::BlockState;
use crate::drivetrain::transmission::Account;
use crate::equation::motion::Motion;
use crate::math::scalar::Real;
use crate::method::dense_output::DenseOutput;

/// Snapshot of block and device at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Snapshot<S> {
    /// θ, θ̇, θ̈.
    pub motion: Motion<S>,
    /// Ground acceleration, horizontal and vertical, in g.
    pub ground: [S; 2],
    /// ℓθ̇, the velocity of the rack over R; 1/s.
    pub terminal_velocity: S,
    /// Forces, speeds, energies and losses of the device.
    pub device: Account<S>,
}

impl<S: Real> Snapshot<S> {
    /// F₁ + F₂, what both flywheels together press on their support; F/(λmR), 1/s². Friction of the rack's guides is not in it.
    #[inline]
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
}

/// Observer of monotone intervals with the device, and of events, in order. Times are local to the ground segment.
pub trait DeviceObserver<S: Real> {
    /// Motion over a monotone interval.
    #[inline(always)]
    fn device_interval(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        let _ = (output, interval);
    }

    /// The block stands on its base while its flywheels may coast, or of no length: what one event left for another at the same instant.
    #[inline(always)]
    fn device_at_rest(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        let _ = (output, interval);
    }

    /// An event, with the state after it.
    #[inline(always)]
    fn device_event(&mut self, event: Event, time: S, state: &BlockState<S>) {
        let _ = (event, time, state);
    }
}

/// Observer that ignores everything.
impl<S: Real> DeviceObserver<S> for () {}

/// Pair of observers, called in order.
impl<S: Real, A: DeviceObserver<S>, B: DeviceObserver<S>> DeviceObserver<S> for (A, B) {
    #[inline(always)]
    fn device_interval(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        self.0.device_interval(output, interval);
        self.1.device_interval(output, interval);
    }

    #[inline(always)]
    fn device_at_rest(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        self.0.device_at_rest(output, interval);
        self.1.device_at_rest(output, interval);
    }

    #[inline(always)]
    fn device_event(&mut self, event: Event, time: S, state: &BlockState<S>) {
        self.0.device_event(event, time, state);
        self.1.device_event(event, time, state);
    }
}

impl<S: Real, A: DeviceObserver<S> + ?Sized> DeviceObserver<S> for &mut A {
    #[inline(always)]
    fn device_interval(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        (**self).device_interval(output, interval);
    }

    #[inline(always)]
    fn device_at_rest(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        (**self).device_at_rest(output, interval);
    }

    #[inline(always)]
    fn device_event(&mut self, event: Event, time: S, state: &BlockState<S>) {
        (**self).device_event(event, time, state);
    }
}

/// Observer that may be absent.
impl<S: Real, A: DeviceObserver<S>> DeviceObserver<S> for Option<A> {
    #[inline(always)]
    fn device_interval(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        if let Some(watcher) = self {
            watcher.device_interval(output, interval);
        }
    }

    #[inline(always)]
    fn device_at_rest(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        if let Some(watcher) = self {
            watcher.device_at_rest(output, interval);
        }
    }

    #[inline(always)]
    fn device_event(&mut self, event: Event, time: S, state: &BlockState<S>) {
        if let Some(watcher) = self {
            watcher.device_event(event, time, state);
        }
    }
}
