//! Rigid clutch with flywheels that spin on: it obeys Eq. 10, and closing at unequal speeds is a plastic impact.

use super::clutch_state::{Coupling, DeviceState};
use super::scaled_parameters::ScaledParameters;
use super::transmission::{EventContext, Transmission, jolt};
use crate::math::scalar::Real;

/// Two flywheels, a rigid clutch on each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidPair<S>(pub ScaledParameters<S>);

impl<S: Real> Transmission<S, 2, 1> for RigidPair<S> {
    const COMMANDED: bool = true;
    const HOLDS: bool = true;

    #[inline(always)]
    fn parameters(&self) -> Option<&ScaledParameters<S>> {
        Some(&self.0)
    }

    fn engage(&self, at: &mut EventContext<'_, S>, wheel: usize) {
        jolt(&self.0, at, wheel);
    }

    #[inline(always)]
    fn engaged_at_impact(&self, device: &DeviceState<S>) -> usize {
        device.wheels.iter().filter(|wheel| wheel.coupling == Coupling::Locked).count()
    }
}
