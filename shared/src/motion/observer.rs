//! Contract of an observer: it receives every monotone interval and every event. An unused observer costs nothing.

use super::device_snapshot::{DeviceOutput, Snapshot};
use super::state::BlockState;
use crate::equation::motion::Motion;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::method::dense_output::DenseOutput;
use crate::motion::rest::free_decay::Decay;
use crate::motion::rest::impact_accumulation::Accumulation;

/// Event of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// Uplift: the block leaves its rest.
    Uplift,
    /// Impact, θ = 0; the state is the one after the impact.
    Impact,
    /// Turn: θ̇ = 0 at a largest rotation.
    Turn,
    /// The clutch engaged or released; the state is the one after it.
    Switch,
    /// A clutch of a device with a memory stuck, slipped, or took up its play; the state is the one after it.
    Coupling,
    /// The base of the block began to slide over the ground, or sticks again; the state is the one after it.
    Slip,
    /// Rest: the impacts have accumulated, or the slide of a block on its base has ended.
    Rest,
    /// Overturning: the block cannot return.
    Overturned,
}

/// Monotone interval: a part of a step over which θ and θ̇ are monotone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MonotoneInterval<S> {
    /// Local time in the ground segment at which the step starts, s.
    pub start: S,
    /// Start, s from the start of the step.
    pub from: S,
    /// End, s from the start of the step.
    pub to: S,
    /// The motion at `from`.
    pub first: Motion<S>,
    /// The motion at `to`.
    pub last: Motion<S>,
    /// The inerter is engaged.
    pub engaged: bool,
    /// s = sgn θ.
    pub side: Sign,
    /// Sign of θ̇.
    pub direction: Sign,
}

impl<S: Real> MonotoneInterval<S> {
    /// max |θ̇|, rad/s.
    pub fn fastest(&self) -> S {
        self.first.velocity.abs().larger(self.last.velocity.abs())
    }
}

/// Observer of monotone intervals and events, in order. Times are local to the ground segment.
pub trait Observer<S: Real> {
    /// Wants every swing of a free motion; otherwise its end is summed in closed form ([`Decay`]).
    fn every_swing(&self) -> bool {
        true
    }

    /// Motion over a monotone interval.
    fn interval(&mut self, _output: &dyn DenseOutput<S>, _interval: &MonotoneInterval<S>) {}

    /// Motion over a monotone interval, with the device: where the loop shows one, it calls this in the place of [`Observer::interval`].
    fn device_interval(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        self.interval(output.motion(), interval);
    }

    /// The block stands on its base while its flywheels may coast, or of no length: what one event left for another at the same instant.
    fn device_at_rest(&mut self, _output: &dyn DeviceOutput<S>, _interval: &MonotoneInterval<S>) {}

    /// An event, with the state after it.
    fn event(&mut self, _event: Event, _time: S, _state: &BlockState<S>) {}

    /// Free decay: the remaining swings, summed in closed form.
    fn decay(&mut self, _decay: &Decay<S>) {}

    /// Impacts that accumulate to rest, summed in closed form; the rest is an event of its own.
    fn accumulation(&mut self, _tail: &Accumulation<S>) {}

    /// The bounces that a rest at local `time` (s) stands for, as θ → 0: θ̈ (rad/s²) of a way, out or back on one side, by the signs of θ and θ̇.
    fn bounce(&mut self, _way: (Sign, Sign), _acceleration: S, _time: S) {}

    /// The same with the device on a way on `side`, where the loop shows one.
    fn device_bounce(&mut self, _side: Sign, _time: S, _snapshot: &dyn Fn() -> Snapshot<S>) {}
}

/// Observer that ignores everything.
impl<S: Real> Observer<S> for () {
    fn every_swing(&self) -> bool {
        false
    }
}

/// What an observer hands on to each `$observer` of `$pattern`.
macro_rules! hand_on {
    ($self:ident: $pattern:pat = $observers:expr; $($observer:ident),+) => {
        #[inline]
        fn interval(&mut $self, output: &dyn DenseOutput<S>, interval: &MonotoneInterval<S>) {
            if let $pattern = $observers { $($observer.interval(output, interval);)+ }
        }
        #[inline]
        fn device_interval(&mut $self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
            if let $pattern = $observers { $($observer.device_interval(output, interval);)+ }
        }
        #[inline]
        fn device_at_rest(&mut $self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
            if let $pattern = $observers { $($observer.device_at_rest(output, interval);)+ }
        }
        #[inline]
        fn event(&mut $self, event: Event, time: S, state: &BlockState<S>) {
            if let $pattern = $observers { $($observer.event(event, time, state);)+ }
        }
        #[inline]
        fn decay(&mut $self, decay: &Decay<S>) {
            if let $pattern = $observers { $($observer.decay(decay);)+ }
        }
        #[inline]
        fn accumulation(&mut $self, tail: &Accumulation<S>) {
            if let $pattern = $observers { $($observer.accumulation(tail);)+ }
        }
        #[inline]
        fn bounce(&mut $self, way: (Sign, Sign), acceleration: S, time: S) {
            if let $pattern = $observers { $($observer.bounce(way, acceleration, time);)+ }
        }
        #[inline]
        fn device_bounce(&mut $self, side: Sign, time: S, snapshot: &dyn Fn() -> Snapshot<S>) {
            if let $pattern = $observers { $($observer.device_bounce(side, time, snapshot);)+ }
        }
    };
}

/// Two observers, in order.
#[allow(irrefutable_let_patterns)]
impl<S: Real, A: Observer<S>, B: Observer<S>> Observer<S> for (A, B) {
    fn every_swing(&self) -> bool {
        self.0.every_swing() || self.1.every_swing()
    }

    hand_on!(self: (first, second) = self; first, second);
}

/// An observer, or nobody.
impl<S: Real, O: Observer<S>> Observer<S> for Option<O> {
    fn every_swing(&self) -> bool {
        self.as_ref().is_some_and(O::every_swing)
    }

    hand_on!(self: Some(observer) = self; observer);
}

/// An observer elsewhere.
#[allow(irrefutable_let_patterns)]
impl<S: Real, O: Observer<S> + ?Sized> Observer<S> for &mut O {
    fn every_swing(&self) -> bool {
        (**self).every_swing()
    }

    hand_on!(self: observer = &mut **self; observer);
}
