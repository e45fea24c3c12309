//! Viscous slip between rack and flywheel, a dashpot in series with the inertance (Maxwell's model): F = c (ẋ − w), ẇ = F/σ less bearings.
//!
//! On a rack that swings with ω the force is b ẍ/√(1 + (ω/ω_c)²), ω_c = c/b, and lags ẍ by arctan(ω/ω_c): an inertance that falls with
//! frequency. The dashpot passes no impulse on, so that there is neither a jolt nor a flywheel that goes through an impact.

use super::clutch_state::{Coupling, DeviceState, FlywheelState, Guard, ModeCoefficients};
use super::scaled_parameters::ScaledParameters;
use super::transmission::{Account, AnyPoint, EventContext, PointOf, Transmission, acceleration, account, command};
use crate::equation::body::Body;
use crate::math::scalar::{Real, Scalar};
use crate::math::sign::Sign;
use crate::math::value::Value;

/// Two flywheels with viscous slip that obey Eq. 10; `PERMANENT`: one that is always engaged.
pub struct ViscousPair<const PERMANENT: bool>;

/// Force of each engaged flywheel on the rack, 1/s².
#[inline(always)]
fn forces<S: Scalar, V: Value<S>, B: Body<S>>(at: &PointOf<'_, S, B, V, 2>) -> [V; 2] {
    let rack = at.body.to_terminal(&at.configuration, at.velocity);
    [0, 1].map(|i| (rack - at.unknowns[i]).scale(at.law.damping[i]))
}

impl<S: Real> EventContext<'_, S> {
    /// Which way the flywheel of an engaged clutch turns.
    fn settle_slip(&mut self, wheel: usize) {
        let rack = self.rack_speed();
        let wheel: &mut FlywheelState<S> = &mut self.device.wheels[wheel];
        let force = self.parameters.damping * (rack - wheel.spin);
        self.parameters.settle(wheel, force);
    }
}

impl<S: Real, const PERMANENT: bool> Transmission<S, 2, 3> for ViscousPair<PERMANENT> {
    const COMMANDED: bool = !PERMANENT;
    const HOLDS: bool = true;
    const PERMANENT: bool = PERMANENT;

    fn extend(&self, law: &mut ModeCoefficients<S>, parameters: &ScaledParameters<S>, device: &DeviceState<S>) {
        for (i, wheel) in device.wheels.iter().enumerate() {
            if wheel.coupling == Coupling::Viscous {
                law.damping[i] = parameters.damping;
                if wheel.turning.is_none() {
                    law.watch[i + 1] = Guard::Below(parameters.standing_friction(wheel).0, S::ZERO, i);
                }
            }
        }
    }

    #[inline(always)]
    fn flow<V: Value<S>, B: Body<S>>(&self, at: &PointOf<'_, S, B, V, 2>) -> (V, [V; 2]) {
        let (law, force) = (at.law, forces(at));
        let rates = [0, 1].map(|i| {
            force[i].scale(law.moves[i] * at.parameters.mobility).offset(-law.drag[i]) - at.unknowns[i].scale(law.decay[i])
        });
        (acceleration(at, true, Some(force[0] + force[1])), rates)
    }

    #[inline(always)]
    fn guard<V: Value<S>, B: Body<S>>(&self, at: &PointOf<'_, S, B, V, 2>, acceleration: V, watch: Guard<S>) -> V {
        match watch {
            Guard::Command(sign) => command(at, true, sign),
            Guard::Below(bound, _, wheel) => (-forces(at)[wheel & 1].square()).offset(bound * bound),
            _ => acceleration,
        }
    }

    fn engage(&self, at: &mut EventContext<'_, S>, wheel: usize) {
        let clutch = &mut at.device.wheels[wheel];
        (clutch.engaged_for, clutch.coupling) = (S::ZERO, Coupling::Viscous);
        at.settle_slip(wheel);
    }

    fn reached(&self, at: &mut EventContext<'_, S>, watch: Guard<S>) {
        if let Guard::Below(.., i) = watch {
            let rack = at.rack_speed();
            let wheel = &mut at.device.wheels[i & 1];
            wheel.turning = Some(Sign::of(rack - wheel.spin, Sign::Positive));
        }
    }

    fn settle(&self, at: &mut EventContext<'_, S>) {
        for wheel in 0..2 {
            if at.device.wheels[wheel].coupling == Coupling::Viscous {
                at.settle_slip(wheel);
            }
        }
    }

    fn account(&self, at: &AnyPoint<'_, S, 2>, acceleration: S, device: &DeviceState<S>) -> Account<S> {
        let mut account = account(at, acceleration, device);
        let rack = at.body.to_terminal(&at.configuration, at.velocity);
        for (i, force) in forces(at).into_iter().enumerate().filter(|(i, _)| device.wheels[*i].coupling == Coupling::Viscous) {
            account.force[i] = force;
            account.spent.clutch = account.spent.clutch + force * (rack - at.unknowns[i]);
        }
        account
    }
}
