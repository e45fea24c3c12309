//! One-way (sprag) clutches: nobody commands them. Each holds while its flywheel resists the block and lets go as soon as the
//! flywheel would drive it; it holds again when the block has caught up, so that there is never a jolt.

use super::clutch_state::{Coupling, Device, Law, Watch};
use super::drive::{Drive, Instant, MomentOf, acceleration, force_if_locked, jolt, locked_force, open};
use super::gears::Gears;
use super::rigid::coasting;
use crate::equation::body::Body;
use crate::equation::clutch_rule::wheel_for;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::math::value::Value;

/// Two flywheels, an overrunning clutch on each, for one direction of motion each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OverrunningPair<S>(pub Gears<S>);

impl<S: Real> Drive<S, 2, 1> for OverrunningPair<S> {
    const COMMANDED: bool = false;
    const HOLDS: bool = true;

    #[inline(always)]
    fn gears(&self) -> Option<&Gears<S>> {
        Some(&self.0)
    }

    #[inline(always)]
    fn law(&self, direction: Sign, _drive: Sign, device: &Device<S>) -> Law<S> {
        let mut law = self.0.law(direction, device);
        let wheel = wheel_for(direction);
        law.watch[0] = match device.wheels[wheel].coupling {
            Coupling::Locked => Watch::Held(law.direction),
            _ => Watch::Ahead(law.direction, wheel),
        };
        law
    }

    #[inline(always)]
    fn flow<V: Value<S>, B: Body<S>>(&self, at: &MomentOf<'_, S, B, V, 2>) -> (V, [V; 2]) {
        (acceleration::<S, V, B, 2, true>(at, self.0.rack_push, None), coasting(at))
    }

    #[inline(always)]
    fn guard<V: Value<S>, B: Body<S>>(&self, at: &MomentOf<'_, S, B, V, 2>, acceleration: V, watch: Watch<S>) -> V {
        match watch {
            Watch::Held(sign) => locked_force(at, &self.0, acceleration).scale(sign),
            Watch::Ahead(sign, wheel) => (at.extra[wheel & 1] - at.body.along(&at.posture, at.velocity)).scale(sign),
            _ => acceleration,
        }
    }

    #[inline(always)]
    fn release(&self, _at: &mut Instant<'_, S>, _wheel: usize) {}

    fn reached(&self, at: &mut Instant<'_, S>, watch: Watch<S>) {
        let wheel = wheel_for(at.direction);
        match watch {
            Watch::Ahead(..) => at.device.wheels[wheel].coupling = Coupling::Locked,
            _ => open(&self.0, at, wheel),
        }
    }

    fn settle(&self, at: &mut Instant<'_, S>) {
        let (wheel, rack) = (wheel_for(at.direction), at.rack_speed());
        let other = 1 - wheel;
        if at.device.wheels[other].coupling == Coupling::Locked {
            open(&self.0, at, other);
        }
        let resists = |at: &Instant<'_, S>| at.direction.times(force_if_locked(self, &self.0, at, wheel)) > S::ZERO;
        // What stands still is held by the clutch until the push overcomes the bearings.
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

    fn impact(&self, at: &mut Instant<'_, S>, before: S) {
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
