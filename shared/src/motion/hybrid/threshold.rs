//! Breakaway threshold of a block that does not move.

use super::mode_output::{Place, Shaking};
use super::{HybridState, HybridSystem};
use crate::drivetrain::any_transmission::TransmissionKind;
use crate::drivetrain::clutch_state::{Coupling, FlywheelState};
use crate::equation::Accelerations;
use crate::equation::body::Body;
use crate::equation::clutch_rule::wheel_for;
use crate::math::polynomial::first_zero_of;
use crate::math::scalar::Real;
use crate::math::sign::Sign;

/// Roundings within which a threshold counts as zero.
const ROUNDINGS: f64 = 64.0;

/// a ü_g/g + b (1 + v̈_g/g) + c + d t + e (ü_s − ü_g)/g + f exp(−r t): the moment that moves the block to one side, over its inertia about
/// the toe; 1/s².
#[derive(Clone, Copy, Debug)]
pub(super) struct Threshold<S> {
    horizontal: S,
    vertical: S,
    constant: S,
    /// What dry friction takes from the constant.
    pub(super) dry: S,
    /// d, the growth by the capacity of engaged plates, 1/s³.
    growth: S,
    /// e, of a support of its own motion.
    support: S,
    /// f, the push of flywheels through dashpots, 1/s², and its rate r, 1/s.
    decay: (S, S),
}

/// The earlier of two instants, with what is known of it.
pub(super) fn earlier<S: Real, T>(instants: [Option<(S, T)>; 2]) -> Option<(S, T)> {
    instants.into_iter().flatten().reduce(|a, b| if b.0 < a.0 { b } else { a })
}

impl<S: Real> Threshold<S> {
    /// Its value under the accelerations `ground`.
    pub(super) fn at(&self, ground: Accelerations<S>) -> S {
        let value = self.horizontal * ground[0] + self.vertical * (S::ONE + ground[1]) + (self.constant + self.decay.0);
        if self.support == S::ZERO { value } else { value + self.support * ground[2] }
    }

    /// Bound of its rounding error.
    fn rounding(&self, ground: Accelerations<S>) -> S {
        let terms = (self.horizontal * ground[0]).abs() + self.vertical.abs() * (S::ONE + ground[1]).abs() + self.constant.abs();
        (terms + (self.support * ground[2]).abs() + self.decay.0.abs()) * S::EPSILON * S::of(ROUNDINGS)
    }

    /// Whether it is above zero, by more than rounding.
    pub(super) fn is_exceeded(&self, ground: Accelerations<S>) -> bool {
        self.at(ground) > self.rounding(ground)
    }

    /// Whether the links of the device push that way, by more than rounding.
    pub(super) fn is_pushed(&self, ground: Accelerations<S>) -> bool {
        self.constant + self.dry + self.decay.0 > self.rounding(ground)
    }

    /// |ü_g|/g below which it stays under zero, on a support that moves with the ground, while 1 + v̈_g/g is at least `lightest` (above 0).
    pub(super) fn least_horizontal(&self, lightest: S) -> S {
        (-(self.vertical * lightest + (self.constant + self.decay.0.larger(S::ZERO))) / self.horizontal.abs()).larger(S::ZERO)
    }

    /// The moment that holds where this one moves.
    pub(super) fn opposite(&self) -> Threshold<S> {
        let Threshold { horizontal, vertical, constant, dry, growth, support, decay: (push, rate) } = *self;
        Threshold {
            horizontal: -horizontal,
            vertical: -vertical,
            constant: -constant,
            dry: -dry,
            growth: -growth,
            support: -support,
            decay: (-push, rate),
        }
    }

    /// First instant in [`from`, `to`) at which it is above zero by more than rounding, or rises through zero, and whether it gets there by
    /// crossing zero or by a jump. It grows from `from` on.
    pub(super) fn exceeded(&self, shaking: Shaking<'_, S>, from: S, to: S) -> Option<(S, bool)> {
        let (push, rate) = self.decay;
        let value = |t: S| {
            let mut slope = self.horizontal * shaking.horizontal.slope(t) + self.growth;
            if let Some(vertical) = shaking.vertical {
                slope = slope + self.vertical * vertical.slope(t);
            }
            if let Some(support) = shaking.support {
                slope = slope + self.support * support.slope(t);
            }
            let now = self.at(shaking.at(t)) + self.growth * (t - from);
            if push == S::ZERO {
                return (now, slope);
            }
            let left = (-(rate * (t - from))).exp();
            (now - push * (S::ONE - left), slope - push * rate * left)
        };
        let ground = shaking.at(from);
        let (now, slope) = value(from);
        let above = now > S::ZERO;
        if self.is_exceeded(ground) {
            return Some((from, false));
        }
        let mut curvature = self.horizontal.abs() * shaking.horizontal.curvature_bound();
        if let Some(vertical) = shaking.vertical {
            curvature = curvature + self.vertical.abs() * vertical.curvature_bound();
        }
        if let Some(support) = shaking.support {
            curvature = curvature + self.support.abs() * support.curvature_bound();
        }
        curvature = curvature + push.abs() * rate * rate;
        let rounding = |t: S| self.rounding(shaking.at(t));
        // A rise that may turn within rounding moves nothing before it is more than that.
        let grazes = |t: S, slope: S| slope * slope <= S::of(2.0) * curvature * rounding(t);
        if above && slope > S::ZERO && !grazes(from, slope) {
            return Some((from, true));
        }
        let first = |start: S, least: S| {
            let above_least = |t: S| {
                let (value, slope) = value(t);
                (value - least, slope)
            };
            let stretch = (start, to, value(to).0 - least);
            first_zero_of(above_least, curvature, stretch, Sign::Negative, above && least == S::ZERO)
        };
        let zero = if above && slope >= S::ZERO {
            first(from, rounding(from))
        } else {
            first(from, S::ZERO).and_then(|t| if grazes(t, value(t).1) { first(t, rounding(t)) } else { Some(t) })
        };
        // A breakaway within rounding of the segment's end belongs to the next segment.
        zero.filter(|&t| to - t > to * S::EPSILON * S::of(4.0)).map(|t| (t, true))
    }
}

/// A flywheel that a standing rack would take along.
fn sticks<S: Real>(wheel: &FlywheelState<S>) -> bool {
    match wheel.coupling {
        Coupling::Locked => true,
        Coupling::Slipping(_) => wheel.spin == S::ZERO,
        Coupling::Open | Coupling::Viscous | Coupling::InPlay | Coupling::Elastic(_) | Coupling::Saturated(_) => false,
    }
}

impl<S: Real> HybridSystem<S> {
    /// Flywheels that are coupled to a rack that begins to move towards `sign`, with their numbers.
    pub(super) fn carried_along<'a>(
        &self,
        state: &'a HybridState<S>,
        sign: Sign,
    ) -> impl Iterator<Item = (usize, &'a FlywheelState<S>)> {
        // An overrunning clutch holds one way, and lets go the other way.
        let one_way = self.transmission.kind == TransmissionKind::Overrunning;
        let holds = move |index: usize| !one_way || index == wheel_for(sign);
        let wheels = state.device.wheels.iter().enumerate();
        wheels.filter(move |(index, wheel)| sticks(wheel) && holds(*index))
    }

    /// Breakaway threshold of a block at θ̇ = 0, tilted to `side`, towards `sign`: weight and ground, against the friction of the rack and of
    /// the flywheels that are coupled to it. Forces of elastic clutches are taken as they are now.
    #[inline(never)]
    pub(super) fn breakaway(&self, state: &HybridState<S>, side: Sign, sign: Sign) -> Threshold<S> {
        let configuration = self.body.configuration(side.unit(), state.motion.rotation);
        let (horizontal, vertical) = self.body.factors(&configuration);
        let arm = self.body.arm(&configuration);
        let parameters = &self.transmission.parameters;
        let (mut decaying, mut rate) = (S::ZERO, S::ZERO);
        let (mut dry, mut force) = ((parameters.rack_dry, S::ZERO), (S::ZERO, S::ZERO));
        let (mut push, mut support) = (parameters.rack_push, S::ZERO);
        let add = |(a, b): (S, S), (c, d): (S, S)| (a + c, b + d);
        let wheels = &state.device.wheels;
        for (_, wheel) in self.carried_along(state, sign) {
            let (friction, growth) = parameters.standing_friction(wheel);
            dry = add(dry, (friction * (S::ONE + parameters.load_friction), growth));
            push = push - parameters.support_push;
            support = support + parameters.relative_push;
        }
        let dragged = |wheel: &FlywheelState<S>| parameters.dashpot(wheel) > S::ZERO;
        let pulls = |wheel: &FlywheelState<S>| (wheel.coupling.is_engaged() || dragged(wheel)) && !sticks(wheel);
        if wheels.iter().any(pulls) {
            let law = self.law(state);
            let point = self.point(&law, side, &Place { velocity: S::ZERO, ..self.place(state) });
            let account = self.transmission.account(&point, S::ZERO, &state.device);
            for (i, _) in wheels.iter().enumerate().filter(|(_, wheel)| pulls(wheel)) {
                force = add(force, (account.force[i], law.slip_growth[i]));
            }
            // A flywheel behind a dashpot slows down as (w + d/r) e^(−r t) − d/r while the rack stands.
            for wheel in wheels.iter().filter(|wheel| dragged(wheel)) {
                rate = parameters.slowing_rate(wheel);
                let steady = Sign::of(wheel.spin, Sign::Positive).times(parameters.dry_of(wheel) / rate);
                if wheel.spin != S::ZERO {
                    decaying = decaying + parameters.dashpot(wheel) * (wheel.spin + steady);
                }
            }
        }
        Threshold {
            horizontal: sign.times(horizontal - arm * push),
            vertical: sign.times(vertical),
            dry: arm * dry.0,
            constant: -(arm * dry.0) - sign.times(arm * (force.0 + decaying)),
            growth: -(arm * dry.1) - sign.times(arm * force.1),
            support: sign.times(arm * support),
            decay: (sign.times(arm * decaying), rate),
        }
    }
}
