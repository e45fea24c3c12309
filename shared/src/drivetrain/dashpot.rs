//! Dashpots between rack and flywheels, F = c (ẋ − w): viscous slip of engaged clutches, and the drag of open ones.
//!
//! An open clutch is not without torque: oil or air between its parts passes some on, which data sheets give as drag or idle torque at a
//! difference of speeds. With c = b·rate a released flywheel nears the speed of the rack as e^(−rate t), and the block meets the reaction.
//! Beside a dashpot plates may slip, so that all these kinds have one flow and one set of guards, and share their steps.

use super::clutch_state::{DeviceState, Guard, ModeCoefficients};
use super::friction::{below_capacity, slip};
use super::scaled_parameters::ScaledParameters;
use super::transmission::{Account, AnyPoint, EventContext, PointOf, acceleration, command, locked_force};
use crate::equation::body::Body;
use crate::math::scalar::{Real, Scalar};
use crate::math::sign::Sign;
use crate::math::value::Value;

/// Force of each dashpot on the rack, 1/s².
#[inline(always)]
fn forces<S: Scalar, V: Value<S>, B: Body<S>>(at: &PointOf<'_, S, B, V, 2>) -> [V; 2] {
    let rack = at.body.to_terminal(&at.configuration, at.velocity);
    [0, 1].map(|i| (rack - at.unknowns[i]).scale(at.law.damping[i]))
}

/// θ̈ and the rates of the flywheels' speeds under dashpots and slipping plates.
#[inline(always)]
pub fn flow<S: Real, V: Value<S>, B: Body<S>>(at: &PointOf<'_, S, B, V, 2>) -> (V, [V; 2]) {
    let law = at.law;
    let dashpots = forces(at);
    let force = [0, 1].map(|i| dashpots[i] + at.clock.scale(law.slip_growth[i]).offset(law.slip[i]));
    let rates = [0, 1]
        .map(|i| force[i].scale(law.moves[i] * at.parameters.mobility).offset(-law.drag[i]) - at.unknowns[i].scale(law.decay[i]));
    (acceleration(at, true, Some(force[0] + force[1])), rates)
}

/// Value of a guard of dashpots and plates.
#[inline(always)]
pub fn guard<S: Real, V: Value<S>, B: Body<S>>(at: &PointOf<'_, S, B, V, 2>, acceleration: V, watch: Guard<S>) -> V {
    match watch {
        Guard::Command(sign) => command(at, true, sign),
        Guard::Capacity(capacity, growth) => below_capacity(at, locked_force(at, acceleration), (capacity, growth)),
        Guard::Slip(sign, wheel) => slip(at, sign, wheel),
        Guard::Below(bound, _, wheel) => (-forces(at)[wheel & 1].square()).offset(bound * bound),
        _ => acceleration,
    }
}

impl<S: Real> ScaledParameters<S> {
    /// What dashpots add to the coefficients of a mode, and the guards of flywheels that friction holds against them.
    pub(super) fn add_dashpots(&self, law: &mut ModeCoefficients<S>, device: &DeviceState<S>) {
        for (i, wheel) in device.wheels.iter().enumerate() {
            law.damping[i] = self.dashpot(wheel);
            if law.damping[i] > S::ZERO && wheel.turning.is_none() {
                law.watch[i + 1] = Guard::Below(self.inertance * self.dry_of(wheel), S::ZERO, i);
            }
        }
    }
}

impl<S: Real> EventContext<'_, S> {
    /// Which way flywheels behind a dashpot turn.
    pub(super) fn settle_dashpots(&mut self) {
        let rack = self.rack_speed();
        for wheel in &mut self.device.wheels {
            let dashpot = self.parameters.dashpot(wheel);
            if dashpot > S::ZERO {
                self.parameters.settle(wheel, dashpot * (rack - wheel.spin));
            }
        }
    }

    /// The force of a dashpot has overcome the friction that held a flywheel, if that is what `watch` looks at.
    pub(super) fn overcome_friction(&mut self, watch: Guard<S>) {
        if let Guard::Below(.., i) = watch {
            let rack = self.rack_speed();
            let wheel = &mut self.device.wheels[i & 1];
            wheel.turning = Some(Sign::of(rack - wheel.spin, Sign::Positive));
        }
    }
}

/// `account` with the forces of dashpots and the power that they lose.
pub fn with_dashpots<S: Real>(mut account: Account<S>, at: &AnyPoint<'_, S, 2>, device: &DeviceState<S>) -> Account<S> {
    let rack = at.body.to_terminal(&at.configuration, at.velocity);
    for (i, force) in forces(at).into_iter().enumerate().filter(|(i, _)| at.parameters.dashpot(&device.wheels[*i]) > S::ZERO) {
        account.force[i] = force;
        account.spent.clutch = account.spent.clutch + force * (rack - at.unknowns[i]);
    }
    account
}
