//! A rigid clutch with flywheels that keep spinning: it obeys Eq. 10, and closing at speed costs the block momentum.

use super::device::{Coupling, Device, Law, Watch};
use super::drive::{Account, Drive, Instant, MomentOf, acceleration, account, command, jolt, open};
use super::gears::Gears;
use crate::body::Body;
use crate::scalar::{Real, Sign};
use crate::value::Value;

/// Two flywheels, a rigid clutch on each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidPair<S>(pub Gears<S>);

/// ẇ = −c w − d sgn w of idle flywheels, in the present mode's numbers.
#[inline(always)]
pub fn coasting<S: Real, V: Value<S>, B: Body<S>>(at: &MomentOf<'_, S, B, V, 2>) -> [V; 2] {
    [0, 1].map(|i| at.extra[i].scale(-at.law.decay[i]).offset(-at.law.drag[i]))
}

/// Unknowns of devices whose flywheels have a speed of their own.
macro_rules! two_spins {
    () => {
        #[inline(always)]
        fn load(&self, device: &Device<S>) -> [S; 2] {
            [device.wheels[0].spin, device.wheels[1].spin]
        }

        #[inline(always)]
        fn store(&self, device: &mut Device<S>, extra: &[S; 2], rack: S) {
            for (wheel, &spin) in device.wheels.iter_mut().zip(extra) {
                wheel.spin = if wheel.coupling == Coupling::Locked { rack } else { spin };
            }
        }

        #[inline(always)]
        fn scales(&self, speed: S) -> [S; 2] {
            [speed; 2]
        }

        #[inline(always)]
        fn gears(&self) -> Option<&Gears<S>> {
            Some(&self.0)
        }
    };
}
pub(super) use two_spins;

impl<S: Real> Drive<S, 2, 1> for RigidPair<S> {
    const COMMANDED: bool = true;
    const HOLDS: bool = true;

    two_spins!();

    #[inline(always)]
    fn law(&self, direction: Sign, drive: Sign, device: &Device<S>) -> Law<S> {
        let mut law = self.0.law(direction, device);
        law.watch[0] = Watch::Command(drive.unit());
        law
    }

    #[inline(always)]
    fn flow<V: Value<S>, B: Body<S>>(&self, at: &MomentOf<'_, S, B, V, 2>) -> (V, [V; 2]) {
        (acceleration::<S, V, B, 2, true>(at, self.0.rack_push, None), coasting(at))
    }

    #[inline(always)]
    fn guard<V: Value<S>, B: Body<S>>(&self, at: &MomentOf<'_, S, B, V, 2>, acceleration: V, watch: Watch<S>) -> V {
        match watch {
            Watch::Command(sign) => command::<S, V, B, 2, true>(at, self.0.rack_push, sign),
            _ => acceleration,
        }
    }

    fn engage<B: Body<S>>(&self, at: &mut Instant<'_, S, B>, wheel: usize) {
        jolt(&self.0, at, wheel);
    }

    fn release<B: Body<S>>(&self, at: &mut Instant<'_, S, B>, wheel: usize) {
        open(&self.0, at, wheel);
    }

    #[inline(always)]
    fn reached<B: Body<S>>(&self, _at: &mut Instant<'_, S, B>, _watch: Watch<S>) {}

    #[inline(always)]
    fn settle<B: Body<S>>(&self, _at: &mut Instant<'_, S, B>) {}

    #[inline(always)]
    fn impact<B: Body<S>>(&self, _at: &mut Instant<'_, S, B>, _before: S) {}

    #[inline(always)]
    fn engaged_at_impact(&self, device: &Device<S>) -> usize {
        device.wheels.iter().filter(|wheel| wheel.coupling == Coupling::Locked).count()
    }

    #[inline(always)]
    fn swing_coupling(&self, inward: bool) -> S {
        if inward { self.0.inertance + self.0.rack_coupling } else { self.0.rack_coupling }
    }

    #[inline(always)]
    fn account<B: Body<S>>(&self, at: &MomentOf<'_, S, B, S, 2>, acceleration: S, device: &Device<S>) -> Account<S> {
        account(at, &self.0, acceleration, device, at.extra)
    }
}
