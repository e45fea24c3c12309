//! Rigid clutch with flywheels that spin on: it obeys Eq. 10, and closing at unequal speeds is a plastic impact.

use super::clutch_state::{DeviceState, Guard, ModeCoefficients};
use super::dashpot;
use super::scaled_parameters::ScaledParameters;
use super::transmission::{Account, AnyPoint, EventContext, PointOf, Transmission, account};
use crate::equation::body::Body;
use crate::math::scalar::Real;
use crate::math::value::Value;

/// Two flywheels, a rigid clutch on each, with `DRAG` while it is open.
pub struct RigidPair<const DRAG: bool>;

impl<S: Real> Transmission<S, 2, 1> for RigidPair<false> {
    const COMMANDED: bool = true;
    const HOLDS: bool = true;
    const THROUGH_IMPACTS: bool = true;

    fn engage(&self, at: &mut EventContext<'_, S>, wheel: usize) {
        at.jolt(wheel);
    }
}

impl<S: Real> Transmission<S, 2, 3> for RigidPair<true> {
    const COMMANDED: bool = true;
    const HOLDS: bool = true;
    const THROUGH_IMPACTS: bool = true;

    fn extend(&self, law: &mut ModeCoefficients<S>, parameters: &ScaledParameters<S>, device: &DeviceState<S>) {
        parameters.add_dashpots(law, device);
    }

    #[inline(always)]
    fn flow<V: Value<S>, B: Body<S>>(&self, at: &PointOf<'_, S, B, V, 2>) -> (V, [V; 2]) {
        dashpot::flow(at)
    }

    #[inline(always)]
    fn guard<V: Value<S>, B: Body<S>>(&self, at: &PointOf<'_, S, B, V, 2>, acceleration: V, watch: Guard<S>) -> V {
        dashpot::guard(at, acceleration, watch)
    }

    fn engage(&self, at: &mut EventContext<'_, S>, wheel: usize) {
        at.jolt(wheel);
    }

    fn reached(&self, at: &mut EventContext<'_, S>, watch: Guard<S>) {
        at.overcome_friction(watch);
    }

    fn settle(&self, at: &mut EventContext<'_, S>) {
        at.settle_dashpots();
    }

    fn account(&self, at: &AnyPoint<'_, S, 2>, acceleration: S, device: &DeviceState<S>) -> Account<S> {
        dashpot::with_dashpots(account(at, acceleration, device), at, device)
    }
}
