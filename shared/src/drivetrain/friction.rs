//! Friction clutch: plates transmit force up to their capacity and slip above it. Stick and slip begin at located events: slip
//! when the force of a locked flywheel reaches the capacity, stick when the plates run at one speed and can hold it.

use super::clutch_state::{Coupling, DeviceState, Guard, ModeCoefficients};
use super::dashpot;
use super::scaled_parameters::ScaledParameters;
use super::transmission::{
    Account, AnyPoint, EventContext, PointOf, Transmission, acceleration, account, command, force_if_locked, locked_force,
};
use crate::equation::body::Body;
use crate::math::scalar::{Real, Scalar};
use crate::math::sign::Sign;
use crate::math::value::Value;

/// Two flywheels, a friction clutch on each, that obey Eq. 10; with `DRAG` while it is open, which flow and guards leave out without: at
/// events a drag of zero changes nothing.
pub struct FrictionPair<const DRAG: bool>;

/// Force of the plates that slip, on the rack; 1/s².
#[inline(always)]
pub fn plate_force<S: Scalar, V: Value<S>, B: Body<S>>(at: &PointOf<'_, S, B, V, 2>) -> V {
    let law = at.law;
    at.clock.scale(law.slip_growth[0] + law.slip_growth[1]).offset(law.slip[0] + law.slip[1])
}

/// Rates of the flywheels' speeds, 1/s²: those that are not locked coast, and slipping plates drive them.
#[inline(always)]
pub fn spin_rates<S: Scalar, V: Value<S>, B: Body<S>>(at: &PointOf<'_, S, B, V, 2>) -> [V; 2] {
    let law = at.law;
    [0, 1].map(|i| {
        let gain = law.moves[i] * at.parameters.mobility;
        at.clock.scale(law.slip_growth[i] * gain).offset(law.slip[i] * gain - law.drag[i]) - at.unknowns[i].scale(law.decay[i])
    })
}

/// [`Guard::Capacity`] of plates whose capacity and its growth are given (1/s², 1/s³), under the `force` of a locked flywheel.
#[inline(always)]
pub fn below_capacity<S: Scalar, V: Value<S>, B: Body<S>>(
    at: &PointOf<'_, S, B, V, 2>,
    force: V,
    (capacity, growth): (S, S),
) -> V {
    at.clock.scale(growth).offset(capacity).square() - force.square()
}

/// [`Guard::Slip`] of the plates of `wheel`.
#[inline(always)]
pub fn slip<S: Scalar, V: Value<S>, B: Body<S>>(at: &PointOf<'_, S, B, V, 2>, sign: S, wheel: usize) -> V {
    (at.body.to_terminal(&at.configuration, at.velocity) - at.unknowns[wheel & 1]).scale(sign)
}

impl<S: Real> EventContext<'_, S> {
    /// Stick or slip where the plates run at one speed.
    fn stick_or_slip(&mut self, wheel: usize) {
        let force = force_if_locked(&FrictionPair::<true>, self, wheel);
        let rack = self.rack_speed();
        let clutch = &mut self.device.wheels[wheel];
        clutch.spin = rack;
        if force.abs() <= self.parameters.capacity_of(clutch).0 {
            clutch.coupling = Coupling::Locked;
        } else {
            self.slip(wheel, Sign::of(force, Sign::Positive));
        }
    }

    /// Plates that touch at any speed of the flywheel.
    fn meet(&mut self, wheel: usize) {
        let slip = self.rack_speed() - self.device.wheels[wheel].spin;
        if slip == S::ZERO {
            self.stick_or_slip(wheel);
        } else {
            self.slip(wheel, Sign::of(slip, Sign::Positive));
        }
    }

    fn slip(&mut self, wheel: usize, sign: Sign) {
        let wheel = &mut self.device.wheels[wheel];
        wheel.coupling = Coupling::Slipping(sign);
        self.parameters.settle(wheel, sign.times(self.parameters.capacity_of(wheel).0));
    }
}

impl<S: Real, const DRAG: bool> Transmission<S, 2, 3> for FrictionPair<DRAG> {
    const COMMANDED: bool = true;
    const HOLDS: bool = true;

    fn extend(&self, law: &mut ModeCoefficients<S>, parameters: &ScaledParameters<S>, device: &DeviceState<S>) {
        parameters.add_dashpots(law, device);
        for (i, wheel) in device.wheels.iter().enumerate() {
            match wheel.coupling {
                Coupling::Locked => {
                    let (capacity, growth) = parameters.capacity_of(wheel);
                    law.watch[i + 1] = Guard::Capacity(capacity, growth);
                }
                Coupling::Slipping(sign) => law.watch[i + 1] = Guard::Slip(sign.unit(), i),
                _ => {}
            }
        }
    }

    #[inline(always)]
    fn flow<V: Value<S>, B: Body<S>>(&self, at: &PointOf<'_, S, B, V, 2>) -> (V, [V; 2]) {
        if DRAG {
            return dashpot::flow(at);
        }
        (acceleration(at, true, Some(plate_force(at))), spin_rates(at))
    }

    #[inline(always)]
    fn guard<V: Value<S>, B: Body<S>>(&self, at: &PointOf<'_, S, B, V, 2>, acceleration: V, watch: Guard<S>) -> V {
        if DRAG {
            return dashpot::guard(at, acceleration, watch);
        }
        match watch {
            Guard::Command(sign) => command(at, true, sign),
            Guard::Capacity(capacity, growth) => below_capacity(at, locked_force(at, acceleration), (capacity, growth)),
            Guard::Slip(sign, wheel) => slip(at, sign, wheel),
            _ => acceleration,
        }
    }

    fn engage(&self, at: &mut EventContext<'_, S>, wheel: usize) {
        at.device.wheels[wheel].engaged_for = S::ZERO;
        at.meet(wheel);
    }

    fn reached(&self, at: &mut EventContext<'_, S>, watch: Guard<S>) {
        match watch {
            Guard::Slip(_, wheel) => {
                let (wheel, other) = (wheel & 1, 1 - (wheel & 1));
                let both = at.device.wheels[other].coupling == Coupling::Locked;
                at.stick_or_slip(wheel);
                if both {
                    // What joins changes the force on what sticks already, and that the force on what joins.
                    at.stick_or_slip(other);
                    at.stick_or_slip(wheel);
                }
            }
            Guard::Capacity(..) => {
                for wheel in 0..2 {
                    if at.device.wheels[wheel].coupling == Coupling::Locked {
                        let force = force_if_locked(self, at, wheel);
                        if force.abs() >= at.parameters.capacity_of(&at.device.wheels[wheel]).0 * S::of(0.999) {
                            at.slip(wheel, Sign::of(force, Sign::Positive));
                        }
                    }
                }
            }
            _ => at.overcome_friction(watch),
        }
    }

    fn settle(&self, at: &mut EventContext<'_, S>) {
        at.settle_dashpots();
        for wheel in 0..2 {
            match at.device.wheels[wheel].coupling {
                Coupling::Locked => {
                    let force = force_if_locked(self, at, wheel);
                    if force.abs() > at.parameters.capacity_of(&at.device.wheels[wheel]).0 {
                        at.device.wheels[wheel].spin = at.rack_speed();
                        at.slip(wheel, Sign::of(force, Sign::Positive));
                    }
                }
                Coupling::Slipping(_) => at.meet(wheel),
                _ => {}
            }
        }
    }

    fn impact(&self, at: &mut EventContext<'_, S>, before: S) {
        // No plate holds against an impulse: the flywheel keeps its speed and the plates slip.
        let rack = at.rack_speed();
        for wheel in 0..2 {
            if at.device.wheels[wheel].coupling == Coupling::Locked && rack != before {
                at.device.wheels[wheel].spin = before;
                at.slip(wheel, Sign::of(rack - before, Sign::Positive));
            }
        }
    }

    fn account(&self, at: &AnyPoint<'_, S, 2>, acceleration: S, device: &DeviceState<S>) -> Account<S> {
        let mut account = account(at, acceleration, device);
        let rack = at.body.to_terminal(&at.configuration, at.velocity);
        for (i, wheel) in device.wheels.iter().enumerate() {
            if let Coupling::Slipping(_) = wheel.coupling {
                account.force[i] = at.law.slip[i] + at.law.slip_growth[i] * at.clock;
                account.spent.clutch = account.spent.clutch + account.force[i] * (rack - at.unknowns[i]);
            }
        }
        dashpot::with_dashpots(account, at, device)
    }
}
