//! Viscous slip between rack and flywheel, a dashpot in series with the inertance (Maxwell's model): F = c (ẋ − w), ẇ = F/σ less bearings.
//!
//! On a rack that swings with ω the force is b ẍ/√(1 + (ω/ω_c)²), ω_c = c/b, and lags ẍ by arctan(ω/ω_c): an inertance that falls with
//! frequency. The dashpot passes no impulse on, so that there is neither a jolt nor a flywheel that goes through an impact.
//!
//! Rigid clutches with drag while they are open have the same equations, and jolts.

use super::clutch_state::{Coupling, DeviceState, Guard, ModeCoefficients};
use super::dashpot;
use super::scaled_parameters::ScaledParameters;
use super::transmission::{Account, AnyPoint, EventContext, PointOf, Transmission, account};
use crate::equation::body::Body;
use crate::math::scalar::Real;
use crate::math::value::Value;

/// Two flywheels behind dashpots that obey Eq. 10. `SLIPS`: viscously while they are engaged; else clutches are rigid and the dashpots are the drag
/// of open ones. `PERMANENT`: one flywheel that is always engaged.
pub struct DashpotPair<const SLIPS: bool, const PERMANENT: bool>;

impl<S: Real, const SLIPS: bool, const PERMANENT: bool> Transmission<S, 2, 3> for DashpotPair<SLIPS, PERMANENT> {
    const COMMANDED: bool = !PERMANENT;
    const HOLDS: bool = true;
    const THROUGH_IMPACTS: bool = !SLIPS;
    const PERMANENT: bool = PERMANENT;

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
        if !SLIPS {
            return at.jolt(wheel);
        }
        let clutch = &mut at.device.wheels[wheel];
        (clutch.engaged_for, clutch.coupling) = (S::ZERO, Coupling::Viscous);
        at.settle_dashpots();
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
