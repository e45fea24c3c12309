//! Rigid clutch with flywheels that spin on: it obeys Eq. 10, and closing at unequal speeds is a plastic impact.

use super::transmission::{EventContext, Transmission};
use crate::math::scalar::Real;

/// Two flywheels, a rigid clutch on each.
pub struct RigidPair;

impl<S: Real> Transmission<S, 2, 1> for RigidPair {
    const COMMANDED: bool = true;
    const HOLDS: bool = true;
    const THROUGH_IMPACTS: bool = true;

    fn engage(&self, at: &mut EventContext<'_, S>, wheel: usize) {
        at.jolt(wheel);
    }
}
