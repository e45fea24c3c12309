//! Rigid clutch with flywheels that spin on: it obeys Eq. 10, and closing at unequal speeds is a plastic impact.

use super::clutch_state::{Coupling, DeviceState, Guard, ModeCoefficients};
use super::scaled_parameters::ScaledParameters;
use super::transmission::{EventContext, PointOf, Transmission, acceleration, jolt};
use crate::equation::body::Body;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::math::value::Value;

/// Two flywheels, a rigid clutch on each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidPair<S>(pub ScaledParameters<S>);

/// ẇ = −c w − d sgn w of idle flywheels, in the present mode's numbers.
#[inline(always)]
pub fn coasting<S: Real, V: Value<S>, B: Body<S>>(at: &PointOf<'_, S, B, V, 2>) -> [V; 2] {
    [0, 1].map(|i| at.unknowns[i].scale(-at.law.decay[i]).offset(-at.law.drag[i]))
}

impl<S: Real> Transmission<S, 2, 1> for RigidPair<S> {
    const COMMANDED: bool = true;
    const HOLDS: bool = true;

    #[inline(always)]
    fn parameters(&self) -> Option<&ScaledParameters<S>> {
        Some(&self.0)
    }

    #[inline(always)]
    fn law(&self, direction: Sign, terminal_acceleration_sign: Sign, device: &DeviceState<S>) -> ModeCoefficients<S> {
        let mut law = self.0.law(direction, device);
        law.watch[0] = Guard::Command(terminal_acceleration_sign.unit());
        law
    }

    #[inline(always)]
    fn flow<V: Value<S>, B: Body<S>>(&self, at: &PointOf<'_, S, B, V, 2>) -> (V, [V; 2]) {
        (acceleration(at, self.0.rack_push, true, None), coasting(at))
    }

    fn engage(&self, at: &mut EventContext<'_, S>, wheel: usize) {
        jolt(&self.0, at, wheel);
    }

    #[inline(always)]
    fn engaged_at_impact(&self, device: &DeviceState<S>) -> usize {
        device.wheels.iter().filter(|wheel| wheel.coupling == Coupling::Locked).count()
    }
}
