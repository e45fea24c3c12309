//! Friction of rack and pinion that grows with the force in the mesh: μ|F| against the motion of the rack, F the force of a locked flywheel.
//!
//! While the rack drives the flywheel, F along ẋ, it spends (1 + μ)F and a share 1/(1 + μ) of its power arrives; while the flywheel
//! drives the rack, a share 1 − μ does. A locked flywheel so counts 1 ± μ times. F falls strictly as the rack yields for every μ up to 1, so
//! that one sign of F is consistent; beyond, both may be, and no flywheel could drive the rack. Friction is 0 where F changes its sign.
//!
//! It is Coulomb's, and so acts on the impulse of a jolt as well.

use super::clutch_state::{Coupling, DeviceState, Guard, ModeCoefficients};
use super::ideal::{IdealPair, Single};
use super::rigid::RigidPair;
use super::scaled_parameters::ScaledParameters;
use super::transmission::{Account, AnyPoint, EventContext, PointOf, Transmission, account, command, locked_force};
use crate::equation::body::Body;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::math::value::Value;

/// A transmission that only locks, with friction that grows with load.
pub struct Loaded<T>(pub T);

impl<S: Real> ScaledParameters<S> {
    /// Friction over the force of what is locked, with the sign that makes it resist.
    pub fn load_share(&self, device: &DeviceState<S>) -> S {
        if device.drives { -self.load_friction } else { self.load_friction }
    }

    /// What load friction adds to the coefficients of a mode, and its guard.
    fn load(&self, law: &mut ModeCoefficients<S>, device: &DeviceState<S>) {
        let locked = device.locked();
        if locked > 0 {
            let share = self.load_share(device);
            let more = share * S::count(locked) * self.inertance;
            law.coupling = law.coupling + more;
            law.viscous = law.viscous + more * self.bearing_rate;
            law.dry = law.dry + law.direction * more * self.bearing_dry;
            law.watch[1] = Guard::Held(if device.drives { -law.direction } else { law.direction });
        }
    }
}

impl<S: Real> EventContext<'_, S> {
    /// Who drives whom. A block that sets out drives its flywheels: what accelerates and what holds them is along its way.
    fn settle_load<D: Transmission<S, X, G>, const X: usize, const G: usize>(&mut self, transmission: &D) {
        self.device.drives = false;
        if self.velocity != S::ZERO && self.device.locked() > 0 {
            let law = transmission.law(self.parameters, self.direction, self.direction, self.device);
            let point = self.point(&law, self.device);
            let (acceleration, _) = transmission.flow(&point);
            let force = locked_force(&point, acceleration);
            self.device.drives = self.direction.times(force) < S::ZERO;
        }
    }

    /// [`EventContext::jolt`] with friction on its impulse: a flywheel slower than the rack is driven, what is locked already then drives, and the
    /// other way round. One that turns against the rack may stop it first, and then drives it.
    fn jolt_under_load(&mut self, wheel: usize) {
        let ScaledParameters { rack_coupling, inertance, load_friction, .. } = *self.parameters;
        let configuration = self.body.configuration(self.side.unit(), self.rotation);
        let arm = self.body.arm(&configuration);
        let others = S::count(self.device.locked()) * inertance;
        let after = |velocity: S, spin: S, share: S| {
            let before = S::ONE + (rack_coupling + others * (S::ONE - share)) * arm * arm;
            let joins = inertance * (S::ONE + share);
            (before, (before * velocity + joins * arm * spin) / (before + joins * arm * arm))
        };
        let (velocity, mut spin) = (self.velocity, self.device.wheels[wheel].spin);
        let way = Sign::of(velocity, Sign::of(spin, Sign::Positive));
        let faster = way.times(spin) > way.times(arm * velocity);
        let (inertia, mut end) = after(velocity, spin, if faster { -load_friction } else { load_friction });
        if way.times(end) < S::ZERO {
            // The impulse that stops the rack is spent.
            spin = spin + inertia * velocity / ((S::ONE + load_friction) * arm * inertance);
            end = after(S::ZERO, spin, -load_friction).1;
        }
        self.velocity = end;
        self.device.wheels[wheel].coupling = Coupling::Locked;
    }
}

/// [`Transmission`] of [`Loaded`] for a type with so many unknowns and guards, and what a jolt does.
macro_rules! loaded {
    ($inner:ty, $unknowns:literal, $guards:literal, $engage:expr) => {
        impl<S: Real> Transmission<S, $unknowns, 2> for Loaded<$inner> {
            const COMMANDED: bool = <$inner as Transmission<S, $unknowns, $guards>>::COMMANDED;
            const HOLDS: bool = true;
            const THROUGH_IMPACTS: bool = <$inner as Transmission<S, $unknowns, $guards>>::THROUGH_IMPACTS;
            const PERMANENT: bool = <$inner as Transmission<S, $unknowns, $guards>>::PERMANENT;

            fn extend(&self, law: &mut ModeCoefficients<S>, parameters: &ScaledParameters<S>, device: &DeviceState<S>) {
                parameters.load(law, device);
            }

            #[inline(always)]
            fn guard<V: Value<S>, B: Body<S>>(
                &self,
                at: &PointOf<'_, S, B, V, $unknowns>,
                acceleration: V,
                watch: Guard<S>,
            ) -> V {
                match watch {
                    Guard::Command(sign) => command(at, true, sign),
                    Guard::Held(sign) => locked_force(at, acceleration).scale(sign),
                    _ => acceleration,
                }
            }

            fn engage(&self, at: &mut EventContext<'_, S>, wheel: usize) {
                let engage: fn(&$inner, &mut EventContext<'_, S>, usize) = $engage;
                engage(&self.0, at, wheel);
            }

            fn reached(&self, at: &mut EventContext<'_, S>, watch: Guard<S>) {
                if let Guard::Held(_) = watch {
                    at.device.drives = !at.device.drives;
                }
            }

            fn settle(&self, at: &mut EventContext<'_, S>) {
                at.settle_load(self);
            }

            fn account(&self, at: &AnyPoint<'_, S, $unknowns>, acceleration: S, device: &DeviceState<S>) -> Account<S> {
                loaded_account(at, acceleration, device)
            }
        }
    };
}

loaded!(Single<true>, 0, 0, |own, at, wheel| own.engage(at, wheel));
loaded!(IdealPair<true>, 0, 1, |own, at, wheel| own.engage(at, wheel));
loaded!(RigidPair, 2, 1, |_, at, wheel| at.jolt_under_load(wheel));

/// [`account`], with the friction of the mesh: the rack passes it on to the pinion, whose bearings are those of the flywheel.
fn loaded_account<S: Real, const X: usize>(at: &AnyPoint<'_, S, X>, acceleration: S, device: &DeviceState<S>) -> Account<S> {
    let mut account = account(at, acceleration, device);
    let share = at.parameters.load_share(device);
    let [first, second] = account.force.map(|force| share * force);
    account.force = account.force.map(|force| force + share * force);
    account.spent.rack = account.spent.rack + (first + second) * at.body.to_terminal(&at.configuration, at.velocity);
    account
}
