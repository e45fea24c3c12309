//! Overrunning (sprag) clutches, without commands. Each locks while its flywheel resists the block, opens when the flywheel would
//! accelerate it, and locks again at equal speeds, so that there is never a jolt.

use super::clutch_state::{Coupling, DeviceState, Guard, ModeCoefficients};
use super::scaled_parameters::ScaledParameters;
use super::transmission::{EventContext, PointOf, Transmission, force_if_locked, jolt, locked_force, open};
use crate::equation::body::Body;
use crate::equation::clutch_rule::wheel_for;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::math::value::Value;

/// Two flywheels, an overrunning clutch on each, for one direction of motion each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OverrunningPair<S>(pub ScaledParameters<S>);

impl<S: Real> Transmission<S, 2, 1> for OverrunningPair<S> {
    const COMMANDED: bool = false;
    const HOLDS: bool = true;

    #[inline(always)]
    fn parameters(&self) -> Option<&ScaledParameters<S>> {
        Some(&self.0)
    }

    #[inline(always)]
    fn law(&self, direction: Sign, _terminal_acceleration_sign: Sign, device: &DeviceState<S>) -> ModeCoefficients<S> {
        let mut law = self.0.law(direction, device);
        let wheel = wheel_for(direction);
        law.watch[0] = match device.wheels[wheel].coupling {
            Coupling::Locked => Guard::Held(law.direction),
            _ => Guard::Ahead(law.direction, wheel),
        };
        law
    }

    #[inline(always)]
    fn guard<V: Value<S>, B: Body<S>>(&self, at: &PointOf<'_, S, B, V, 2>, acceleration: V, watch: Guard<S>) -> V {
        match watch {
            Guard::Held(sign) => locked_force(at, &self.0, acceleration).scale(sign),
            Guard::Ahead(sign, wheel) => {
                (at.unknowns[wheel & 1] - at.body.to_terminal(&at.configuration, at.velocity)).scale(sign)
            }
            _ => acceleration,
        }
    }

    #[inline(always)]
    fn release(&self, _at: &mut EventContext<'_, S>, _wheel: usize) {}

    fn reached(&self, at: &mut EventContext<'_, S>, watch: Guard<S>) {
        let wheel = wheel_for(at.direction);
        match watch {
            Guard::Ahead(..) => at.device.wheels[wheel].coupling = Coupling::Locked,
            _ => open(&self.0, at, wheel),
        }
    }

    fn settle(&self, at: &mut EventContext<'_, S>) {
        let (wheel, rack) = (wheel_for(at.direction), at.rack_speed());
        let other = 1 - wheel;
        if at.device.wheels[other].coupling == Coupling::Locked {
            open(&self.0, at, other);
        }
        let resists = |at: &EventContext<'_, S>| at.direction.times(force_if_locked(self, &self.0, at, wheel)) > S::ZERO;
        // What stands still is held by the clutch until the force overcomes the bearings.
        let stands = rack == S::ZERO;
        let spin = at.device.wheels[wheel].spin;
        if at.device.wheels[wheel].coupling != Coupling::Locked {
            let ahead = at.direction.times(spin - rack);
            if ahead > S::ZERO {
                return;
            } else if ahead < S::ZERO {
                jolt(&self.0, at, wheel);
            } else {
                at.device.wheels[wheel].coupling = Coupling::Locked;
            }
        }
        if !resists(at) && !stands {
            open(&self.0, at, wheel);
        }
    }

    fn impact(&self, at: &mut EventContext<'_, S>, before: S) {
        // The block slows down at once and its flywheel runs on.
        for wheel in &mut at.device.wheels {
            if wheel.coupling == Coupling::Locked {
                wheel.spin = before;
                wheel.coupling = Coupling::Open;
                self.0.settle(wheel, S::ZERO);
            }
        }
    }
}
