//! Overrunning (sprag) clutches, without commands. Each locks while its flywheel resists the block, opens when the flywheel would
//! accelerate it, and locks again at equal speeds, so that there is never a jolt.

use super::clutch_state::{Coupling, DeviceState, Guard, ModeCoefficients};
use super::scaled_parameters::ScaledParameters;
use super::transmission::{EventContext, PointOf, Transmission, force_if_locked, locked_force};
use crate::equation::body::Body;
use crate::equation::clutch_rule::wheel_for;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::math::value::Value;

/// Two flywheels, an overrunning clutch on each, for one direction of motion each.
pub struct OverrunningPair;

impl<S: Real> Transmission<S, 2, 1> for OverrunningPair {
    const COMMANDED: bool = false;
    const HOLDS: bool = true;

    fn extend(&self, law: &mut ModeCoefficients<S>, _parameters: &ScaledParameters<S>, device: &DeviceState<S>) {
        let wheel = wheel_for(Sign::of(law.direction, Sign::Positive));
        law.watch[0] = match device.wheels[wheel].coupling {
            Coupling::Locked => Guard::Held(law.direction),
            _ => Guard::Ahead(law.direction, wheel),
        };
    }

    #[inline(always)]
    fn guard<V: Value<S>, B: Body<S>>(&self, at: &PointOf<'_, S, B, V, 2>, acceleration: V, watch: Guard<S>) -> V {
        match watch {
            Guard::Held(sign) => locked_force(at, acceleration).scale(sign),
            Guard::Ahead(sign, wheel) => {
                (at.unknowns[wheel & 1] - at.body.to_terminal(&at.configuration, at.velocity)).scale(sign)
            }
            _ => acceleration,
        }
    }

    fn reached(&self, at: &mut EventContext<'_, S>, watch: Guard<S>) {
        let wheel = wheel_for(at.direction);
        match watch {
            Guard::Ahead(..) => at.device.wheels[wheel].coupling = Coupling::Locked,
            _ => at.open(wheel),
        }
    }

    fn settle(&self, at: &mut EventContext<'_, S>) {
        let (wheel, rack) = (wheel_for(at.direction), at.rack_speed());
        let other = 1 - wheel;
        if at.device.wheels[other].coupling == Coupling::Locked {
            at.open(other);
        }
        let resists = |at: &EventContext<'_, S>| at.direction.times(force_if_locked(self, at, wheel)) > S::ZERO;
        // What stands still is held by the clutch until the force overcomes the bearings.
        let stands = rack == S::ZERO;
        let spin = at.device.wheels[wheel].spin;
        if at.device.wheels[wheel].coupling != Coupling::Locked {
            let ahead = at.direction.times(spin - rack);
            if ahead > S::ZERO {
                return;
            } else if ahead < S::ZERO {
                at.jolt(wheel);
            } else {
                at.device.wheels[wheel].coupling = Coupling::Locked;
            }
        }
        if !resists(at) && !stands {
            at.open(wheel);
        }
    }

    fn impact(&self, at: &mut EventContext<'_, S>, before: S) {
        // The block slows down at once and its flywheel runs on.
        for wheel in &mut at.device.wheels {
            if wheel.coupling == Coupling::Locked {
                wheel.spin = before;
                wheel.coupling = Coupling::Open;
                at.parameters.settle(wheel, S::ZERO);
            }
        }
    }
}
