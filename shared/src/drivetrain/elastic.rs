//! Elastic clutch: a torsional spring, a damper and gear play, in series with plates that slip at their capacity.
//!
//! With x the twist as travel of the rack over R and o the edge of the play on the side in contact,
//! F = K (x − o) + C ẋ and ẋ = ℓθ̇ − w; within the play F = 0. Saturated plates hold F at the capacity; the twist then relaxes as
//! C ẋ = F − K (x − o), and the plates slip at ℓθ̇ − w − ẋ. The contact ends where the spring is without force, so that a
//! damper may pull for an instant (the classical dead zone).

use super::clutch_state::{Coupling, DeviceState, FlywheelState, GUARDS, Guard, ModeCoefficients};
use super::scaled_parameters::ScaledParameters;
use super::transmission::{Account, AnyPoint, EventContext, PointOf, Transmission, acceleration, account, command};
use crate::equation::body::Body;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::math::value::Value;

/// Two flywheels, an elastic clutch on each, that obey Eq. 10.
pub struct ElasticPair;

impl<S: Real> ScaledParameters<S> {
    /// Largest force that leaves the mode as it is, and its growth: the plates' capacity, or the bearing friction of a flywheel that
    /// stands; 1/s² and 1/s³.
    fn bound(&self, wheel: &FlywheelState<S>) -> (S, S) {
        if wheel.turning.is_some() { self.capacity_of(wheel) } else { self.standing_friction(wheel) }
    }

    /// Rate of the twist at which plates of rising capacity wind up a spring without a damper, 1/s.
    fn creep(&self, law: &ModeCoefficients<S>, wheel: usize) -> S {
        if self.damping > S::ZERO { S::ZERO } else { law.slip_growth[wheel] / self.stiffness }
    }
}

impl<S: Real> EventContext<'_, S> {
    /// Force of a clutch in contact.
    fn force(&self, wheel: usize) -> S {
        let rack = self.rack_speed();
        let wheel = &self.device.wheels[wheel];
        let Some(side) = wheel.coupling.contact_side() else { return S::ZERO };
        let edge = side.times(self.parameters.half_play);
        self.parameters.stiffness * (wheel.twist - edge) + self.parameters.damping * (rack - wheel.spin)
    }

    /// A wheel in contact: plates that the force overcomes slip, a flywheel that it overcomes starts.
    fn settle_contact(&mut self, wheel: usize) {
        let force = self.force(wheel);
        let clutch = &mut self.device.wheels[wheel];
        if force.abs() > self.parameters.capacity_of(clutch).0 {
            self.saturate(wheel, force);
        } else {
            self.parameters.settle(clutch, force);
        }
    }

    /// Teeth part: what remains of the twist is play.
    fn part(&mut self, wheel: usize) {
        let wheel = &mut self.device.wheels[wheel];
        if let Coupling::Elastic(side) = wheel.coupling {
            wheel.twist = side.times(self.parameters.half_play);
            wheel.coupling = Coupling::InPlay;
            self.parameters.settle(wheel, S::ZERO);
        }
    }

    /// The force has reached its bound: a standing flywheel starts, or the plates slip.
    fn overcome(&mut self, i: usize) {
        let force = self.force(i);
        let wheel = &mut self.device.wheels[i];
        if wheel.turning.is_none() && self.parameters.bound(wheel).0 < self.parameters.capacity_of(wheel).0 {
            wheel.turning = Some(Sign::of(force, Sign::Positive));
            return;
        }
        self.saturate(i, force);
    }

    /// The plates slip. A damper that pulls teeth apart with such a force has parted them instead.
    fn saturate(&mut self, i: usize, force: S) {
        let sign = Sign::of(force, Sign::Positive);
        let (parameters, wheel) = (self.parameters, &mut self.device.wheels[i]);
        if parameters.half_play > S::ZERO && wheel.coupling == Coupling::Elastic(sign.opposite()) {
            self.part(i);
            return;
        }
        wheel.coupling = Coupling::Saturated(sign);
        let held = sign.times(parameters.capacity_of(wheel).0);
        if parameters.damping == S::ZERO {
            wheel.twist = sign.times(parameters.half_play) + held / parameters.stiffness;
        }
        parameters.settle(wheel, held);
    }
}

impl<S: Real> Transmission<S, 4, GUARDS> for ElasticPair {
    const COMMANDED: bool = true;
    const HOLDS: bool = true;
    const SPRINGS: bool = true;

    fn scales(&self, parameters: &ScaledParameters<S>, speed: S) -> [S; 4] {
        // A twist matters by its force: that of a spring that would give the flywheel this speed.
        let twist = speed * (parameters.inertance / parameters.stiffness).square_root();
        [speed, speed, twist, twist]
    }

    fn extend(&self, law: &mut ModeCoefficients<S>, parameters: &ScaledParameters<S>, device: &DeviceState<S>) {
        let plays = parameters.half_play > S::ZERO;
        for (i, wheel) in device.wheels.iter().enumerate() {
            law.follows[i] = S::ONE;
            match wheel.coupling {
                Coupling::InPlay => law.watch[i + 1] = Guard::Play(parameters.half_play, i),
                Coupling::Elastic(side) => {
                    law.stiffness[i] = parameters.stiffness;
                    law.damping[i] = parameters.damping;
                    law.rest_twist[i] = side.times(parameters.half_play);
                    if plays {
                        law.watch[i + 1] = Guard::Contact(side.unit(), i);
                    }
                    let (bound, growth) = parameters.bound(wheel);
                    if bound.is_finite() {
                        law.watch[i + 3] = Guard::Below(bound, growth, i);
                    }
                }
                Coupling::Saturated(side) => {
                    law.rest_twist[i] = side.times(parameters.half_play);
                    law.follows[i] = S::ZERO;
                    law.relaxation[i] = if parameters.damping > S::ZERO { S::ONE / parameters.damping } else { S::ZERO };
                    law.watch[i + 1] = Guard::Slip(side.unit(), i);
                }
                _ => law.follows[i] = S::ZERO,
            }
        }
    }

    #[inline(always)]
    fn flow<V: Value<S>, B: Body<S>>(&self, at: &PointOf<'_, S, B, V, 4>) -> (V, [V; 4]) {
        let (law, parameters) = (at.law, at.parameters);
        let rack = at.body.to_terminal(&at.configuration, at.velocity);
        let relative = [0, 1].map(|i| rack - at.unknowns[i]);
        let plates = [0, 1].map(|i| at.clock.scale(law.slip_growth[i]).offset(law.slip[i]));
        let twist = [0, 1].map(|i| at.unknowns[i + 2].offset(-law.rest_twist[i]));
        let force = [0, 1].map(|i| twist[i].scale(law.stiffness[i]) + relative[i].scale(law.damping[i]) + plates[i]);
        let spin = [0, 1].map(|i| {
            force[i].scale(law.moves[i] * parameters.mobility).offset(-law.drag[i]) - at.unknowns[i].scale(law.decay[i])
        });
        let slides = [0, 1].map(|i| {
            let relaxes = (plates[i] - twist[i].scale(parameters.stiffness)).scale(law.relaxation[i]);
            relative[i].scale(law.follows[i]) + relaxes.offset(parameters.creep(law, i))
        });
        let acceleration = acceleration(at, true, Some(force[0] + force[1]));
        (acceleration, [spin[0], spin[1], slides[0], slides[1]])
    }

    #[inline(always)]
    fn guard<V: Value<S>, B: Body<S>>(&self, at: &PointOf<'_, S, B, V, 4>, acceleration: V, watch: Guard<S>) -> V {
        let (law, parameters) = (at.law, at.parameters);
        let relative = |i: usize| at.body.to_terminal(&at.configuration, at.velocity) - at.unknowns[i & 1];
        let twist = |i: usize| at.unknowns[(i & 1) + 2].offset(-law.rest_twist[i & 1]);
        match watch {
            Guard::Command(sign) => command(at, true, sign),
            Guard::Play(half, i) => (-at.unknowns[(i & 1) + 2].square()).offset(half * half),
            Guard::Contact(sign, i) => twist(i).scale(sign),
            Guard::Below(bound, growth, i) => {
                let force = twist(i).scale(parameters.stiffness) + relative(i).scale(parameters.damping);
                at.clock.scale(growth).offset(bound).square() - force.square()
            }
            Guard::Slip(sign, i) => {
                let j = i & 1;
                let plates = at.clock.scale(law.slip_growth[j]).offset(law.slip[j]);
                let relaxes = (plates - twist(i).scale(parameters.stiffness)).scale(law.relaxation[j]);
                (relative(i) - relaxes.offset(parameters.creep(law, j))).scale(sign)
            }
            Guard::Stuck(friction) => (-acceleration.square()).offset(friction * friction),
            Guard::HeldDown(friction, sign) => acceleration.scale(-sign).offset(friction),
            _ => acceleration,
        }
    }

    fn engage(&self, at: &mut EventContext<'_, S>, wheel: usize) {
        let plays = at.parameters.half_play > S::ZERO;
        let clutch = &mut at.device.wheels[wheel];
        (clutch.engaged_for, clutch.twist) = (S::ZERO, S::ZERO);
        clutch.coupling = if plays { Coupling::InPlay } else { Coupling::Elastic(Sign::Positive) };
        if plays {
            at.parameters.settle(clutch, S::ZERO);
        } else {
            at.settle_contact(wheel);
        }
    }

    fn reached(&self, at: &mut EventContext<'_, S>, watch: Guard<S>) {
        match watch {
            Guard::Play(half, i) => {
                let wheel = &mut at.device.wheels[i & 1];
                let side = Sign::of(wheel.twist, Sign::Positive);
                wheel.twist = side.times(half);
                wheel.coupling = Coupling::Elastic(side);
                at.settle_contact(i & 1);
            }
            Guard::Contact(_, i) => at.part(i & 1),
            Guard::Below(.., i) => at.overcome(i & 1),
            Guard::Slip(_, i) => {
                let wheel = &mut at.device.wheels[i & 1];
                if let Coupling::Saturated(side) = wheel.coupling {
                    wheel.coupling = Coupling::Elastic(side);
                }
            }
            _ => {}
        }
    }

    fn settle(&self, at: &mut EventContext<'_, S>) {
        for wheel in 0..2 {
            match at.device.wheels[wheel].coupling {
                Coupling::Elastic(_) => at.settle_contact(wheel),
                Coupling::Saturated(side) => {
                    // The jump may have ended the slip.
                    let law = self.law(at.parameters, at.direction, at.direction, at.device);
                    let point = at.point(&law, at.device);
                    if self.guard(&point, S::ZERO, Guard::Slip(side.unit(), wheel)) < S::ZERO {
                        at.device.wheels[wheel].coupling = Coupling::Elastic(side);
                        at.settle_contact(wheel);
                    }
                }
                _ => {}
            }
        }
    }

    fn account(&self, at: &AnyPoint<'_, S, 4>, acceleration: S, device: &DeviceState<S>) -> Account<S> {
        let mut account = account(at, acceleration, device);
        let rack = at.body.to_terminal(&at.configuration, at.velocity);
        for (i, wheel) in device.wheels.iter().enumerate() {
            if wheel.coupling.contact_side().is_none() {
                continue;
            }
            let twist = at.unknowns[i + 2] - at.law.rest_twist[i];
            let plates = at.law.slip[i] + at.law.slip_growth[i] * at.clock;
            let relative = rack - at.unknowns[i];
            let force = at.law.stiffness[i] * twist + at.law.damping[i] * relative + plates;
            let spring = at.parameters.stiffness * twist;
            let rate = at.law.follows[i] * relative + at.law.relaxation[i] * (plates - spring) + at.parameters.creep(at.law, i);
            account.force[i] = force;
            let sprung = S::HALF * spring * twist;
            (account.stored, account.sprung) = (account.stored + sprung, account.sprung + sprung);
            account.spent.clutch = account.spent.clutch + force * relative - spring * rate;
        }
        account
    }
}
