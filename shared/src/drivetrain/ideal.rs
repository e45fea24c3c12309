//! Ideal devices in the hybrid loop: none, one inerter, and the ideal clutched pair, for scenes that need this loop for another
//! reason. With `FRICTION` the rack and the bearings lose energy, and a guided rack has a mass.

use super::clutch_state::{Coupling, DeviceState};
use super::scaled_parameters::ScaledParameters;
use super::transmission::{EventContext, PointOf, Transmission};
use crate::equation::body::Body;
use crate::math::scalar::Real;
use crate::math::value::Value;

/// Block without a device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alone;

/// One inerter, always engaged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Single<S, const FRICTION: bool>(pub ScaledParameters<S>);

/// The clutched pair that engages a stopped flywheel at speed without a loss of momentum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IdealPair<S, const FRICTION: bool>(pub ScaledParameters<S>);

impl<S: Real> Transmission<S, 0, 0> for Alone {
    const COMMANDED: bool = false;
    const HOLDS: bool = false;

    #[inline(always)]
    fn flow<V: Value<S>, B: Body<S>>(&self, at: &PointOf<'_, S, B, V, 0>) -> (V, [V; 0]) {
        (at.body.driving_moment(&at.configuration, at.ground), [])
    }

    #[inline(always)]
    fn parameters(&self) -> Option<&ScaledParameters<S>> {
        None
    }
}

impl<S: Real, const FRICTION: bool> Transmission<S, 0, 0> for Single<S, FRICTION> {
    const COMMANDED: bool = false;
    const HOLDS: bool = FRICTION;

    #[inline(always)]
    fn engage(&self, at: &mut EventContext<'_, S>, wheel: usize) {
        at.device.wheels[wheel].coupling = Coupling::Locked;
    }

    #[inline(always)]
    fn release(&self, _at: &mut EventContext<'_, S>, _wheel: usize) {}

    #[inline(always)]
    fn engaged_at_impact(&self, _device: &DeviceState<S>) -> usize {
        1
    }

    #[inline(always)]
    fn swing_coupling(&self, _inward: bool) -> S {
        self.0.inertance + self.0.rack_coupling
    }

    #[inline(always)]
    fn parameters(&self) -> Option<&ScaledParameters<S>> {
        Some(&self.0)
    }
}

impl<S: Real, const FRICTION: bool> Transmission<S, 0, 1> for IdealPair<S, FRICTION> {
    const COMMANDED: bool = true;
    const HOLDS: bool = FRICTION;

    #[inline(always)]
    fn engage(&self, at: &mut EventContext<'_, S>, wheel: usize) {
        at.device.wheels[wheel].coupling = Coupling::Locked;
    }

    #[inline(always)]
    fn parameters(&self) -> Option<&ScaledParameters<S>> {
        Some(&self.0)
    }
}
