//! Friction clutch: plates transmit force up to their capacity and slip above it. Stick and slip begin at located events: slip
//! when the force of a locked flywheel reaches the capacity, stick when the plates run at one speed and can hold it.

use super::clutch_state::{Coupling, DeviceState, Guard, ModeCoefficients};
use super::scaled_parameters::ScaledParameters;
use super::transmission::{
    Account, AnyPoint, EventContext, PointOf, Transmission, acceleration, account, command, force_if_locked, locked_force,
};
use crate::equation::body::Body;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::math::value::Value;

/// Two flywheels, a friction clutch on each, that obey Eq. 10.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionPair<S>(pub ScaledParameters<S>);

impl<S: Real> FrictionPair<S> {
    /// Stick or slip where the plates run at one speed.
    fn stick_or_slip(&self, at: &mut EventContext<'_, S>, wheel: usize) {
        let force = force_if_locked(self, &self.0, at, wheel);
        let rack = at.rack_speed();
        let wheel = &mut at.device.wheels[wheel];
        wheel.spin = rack;
        if force.abs() <= self.0.capacity_of(wheel).0 {
            wheel.coupling = Coupling::Locked;
        } else {
            self.slip(wheel, Sign::of(force, Sign::Positive));
        }
    }

    fn slip(&self, wheel: &mut crate::drivetrain::clutch_state::FlywheelState<S>, sign: Sign) {
        wheel.coupling = Coupling::Slipping(sign);
        let force = sign.times(self.0.capacity_of(wheel).0);
        self.0.settle(wheel, force);
    }
}

impl<S: Real> Transmission<S, 2, 3> for FrictionPair<S> {
    const COMMANDED: bool = true;
    const HOLDS: bool = true;

    #[inline(always)]
    fn parameters(&self) -> Option<&ScaledParameters<S>> {
        Some(&self.0)
    }

    #[inline(always)]
    fn law(&self, direction: Sign, terminal_acceleration_sign: Sign, device: &DeviceState<S>) -> ModeCoefficients<S> {
        let mut law = self.0.law(direction, device);
        law.watch[0] = Guard::Command(terminal_acceleration_sign.unit());
        for (i, wheel) in device.wheels.iter().enumerate() {
            law.watch[i + 1] = match wheel.coupling {
                Coupling::Locked => {
                    let (capacity, growth) = self.0.capacity_of(wheel);
                    Guard::Capacity(capacity, growth)
                }
                Coupling::Slipping(sign) => Guard::Slip(sign.unit(), i),
                _ => Guard::Nothing,
            };
        }
        law
    }

    #[inline(always)]
    fn flow<V: Value<S>, B: Body<S>>(&self, at: &PointOf<'_, S, B, V, 2>) -> (V, [V; 2]) {
        let law = at.law;
        let plates = at.clock.scale(law.slip_growth[0] + law.slip_growth[1]).offset(law.slip[0] + law.slip[1]);
        let rates = [0, 1].map(|i| {
            let gain = law.moves[i] * self.0.mobility;
            at.clock.scale(law.slip_growth[i] * gain).offset(law.slip[i] * gain - law.drag[i])
                - at.unknowns[i].scale(law.decay[i])
        });
        (acceleration(at, self.0.rack_push, true, Some(plates)), rates)
    }

    #[inline(always)]
    fn guard<V: Value<S>, B: Body<S>>(&self, at: &PointOf<'_, S, B, V, 2>, acceleration: V, watch: Guard<S>) -> V {
        match watch {
            Guard::Command(sign) => command(at, self.0.rack_push, true, sign),
            Guard::Capacity(capacity, growth) => {
                let force = locked_force(at, &self.0, acceleration);
                at.clock.scale(growth).offset(capacity).square() - force.square()
            }
            Guard::Slip(sign, wheel) => {
                (at.body.to_terminal(&at.configuration, at.velocity) - at.unknowns[wheel & 1]).scale(sign)
            }
            _ => acceleration,
        }
    }

    fn engage(&self, at: &mut EventContext<'_, S>, wheel: usize) {
        let slip = at.rack_speed() - at.device.wheels[wheel].spin;
        at.device.wheels[wheel].engaged_for = S::ZERO;
        if slip == S::ZERO {
            self.stick_or_slip(at, wheel);
        } else {
            self.slip(&mut at.device.wheels[wheel], Sign::of(slip, Sign::Positive));
        }
    }

    fn reached(&self, at: &mut EventContext<'_, S>, watch: Guard<S>) {
        match watch {
            Guard::Slip(_, wheel) => {
                let (wheel, other) = (wheel & 1, 1 - (wheel & 1));
                let both = at.device.wheels[other].coupling == Coupling::Locked;
                self.stick_or_slip(at, wheel);
                if both {
                    // What joins changes the force on what sticks already, and that the force on what joins.
                    self.stick_or_slip(at, other);
                    self.stick_or_slip(at, wheel);
                }
            }
            Guard::Capacity(..) => {
                for wheel in 0..2 {
                    if at.device.wheels[wheel].coupling == Coupling::Locked {
                        let force = force_if_locked(self, &self.0, at, wheel);
                        if force.abs() >= self.0.capacity_of(&at.device.wheels[wheel]).0 * S::of(0.999) {
                            self.slip(&mut at.device.wheels[wheel], Sign::of(force, Sign::Positive));
                        }
                    }
                }
            }
            _ => {}
        }
    }

    fn settle(&self, at: &mut EventContext<'_, S>) {
        let rack = at.rack_speed();
        for wheel in 0..2 {
            match at.device.wheels[wheel].coupling {
                Coupling::Locked => {
                    let force = force_if_locked(self, &self.0, at, wheel);
                    if force.abs() > self.0.capacity_of(&at.device.wheels[wheel]).0 {
                        at.device.wheels[wheel].spin = rack;
                        self.slip(&mut at.device.wheels[wheel], Sign::of(force, Sign::Positive));
                    }
                }
                Coupling::Slipping(_) => {
                    let slip = rack - at.device.wheels[wheel].spin;
                    if slip == S::ZERO {
                        self.stick_or_slip(at, wheel);
                    } else {
                        self.slip(&mut at.device.wheels[wheel], Sign::of(slip, Sign::Positive));
                    }
                }
                _ => {}
            }
        }
    }

    fn impact(&self, at: &mut EventContext<'_, S>, before: S) {
        // No plate holds against an impulse: the flywheel keeps its speed and the plates slip.
        let rack = at.rack_speed();
        for wheel in &mut at.device.wheels {
            if wheel.coupling == Coupling::Locked && rack != before {
                wheel.spin = before;
                self.slip(wheel, Sign::of(rack - before, Sign::Positive));
            }
        }
    }

    fn account(&self, at: &AnyPoint<'_, S, 2>, acceleration: S, device: &DeviceState<S>) -> Account<S> {
        let mut account = account(at, &self.0, acceleration, device);
        let rack = at.body.to_terminal(&at.configuration, at.velocity);
        for (i, wheel) in device.wheels.iter().enumerate() {
            if let Coupling::Slipping(_) = wheel.coupling {
                account.force[i] = at.law.slip[i] + at.law.slip_growth[i] * at.clock;
                account.spent.clutch = account.spent.clutch + account.force[i] * (rack - at.unknowns[i]);
            }
        }
        account
    }
}
