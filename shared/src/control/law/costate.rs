//! Eq. 10 with the costate of optimal control in the place of the velocity.
//!
//! Engaging divides the moment by 1 + kℓ². By Pontryagin's principle the best switch engages while λ·D > 0, where D is the driving moment
//! and λ, the costate of θ̇, has the sign of the direction in which more speed brings the block nearer to its tip. Eq. 10 takes θ̇ for λ.
//! Here λ is a linear function of what the controller knows; so the law may engage against the motion of a block that creeps back from near
//! its tip, or let one go that is about to be caught by the ground.

use super::{Law, Situation, Wish};
use crate::equation::clutch_rule::wheel_for;

/// λ = θ̇/(pα) + `rotation` θ/α + `curvature` θ|θ|/α² + `ground` ü_g/(g tan α) + `drift` Δv_g p/(g tan α), with the velocity Δv_g that the
/// ground has lately gained ([`Situation::ground_drift`]). With Eq. 10's acceleration of the terminals over p²α, a, a flywheel is kept on the
/// rack while λ a > `keep`, and one that is slower than the rack by w (over pα) is taken on where λ (a + `jolt` w) > `take`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Costate {
    /// Weight of θ.
    pub rotation: f32,
    /// Weight of θ|θ|.
    pub curvature: f32,
    /// Weight of ü_g.
    pub ground: f32,
    /// Weight of Δv_g.
    pub drift: f32,
    /// Weight of w.
    pub jolt: f32,
    /// What a flywheel must be worth to be taken on, …
    pub take: f32,
    /// … and to be kept.
    pub keep: f32,
}

impl Costate {
    /// Found by `sprag loop-study train`: the cross-entropy method on random pulses of all families and on recorded motions, with rigid
    /// clutches of 10 and 30 ms whose wheels are braked or coast (R = 2 m, α = 20°, σ = 0.5).
    pub const TRAINED: Costate =
        Costate { rotation: 0.18, curvature: 0.45, ground: -0.41, drift: 0.73, jolt: 0.6, take: -0.01, keep: -0.01 };
}

impl Law for Costate {
    fn wish(&self, at: &Situation<'_>) -> Wish {
        let estimate = &at.estimate;
        if estimate.standing {
            return Wish::Resist;
        }
        let model = &at.model.parameters;
        let speed = model.frequency * model.slenderness;
        let (x, v) = (estimate.rotation / model.slenderness, estimate.velocity / speed);
        let (ground, drift) = (estimate.ground[0] / model.uplift, at.ground_drift / model.uplift);
        let costate = v + (self.rotation + self.curvature * x.abs()) * x + self.ground * ground + self.drift * drift;
        let push = estimate.push / (model.frequency_squared * model.slenderness);
        let resists = if at.engaged[0] || at.engaged[1] {
            costate * push > self.keep
        } else {
            let slip = if model.wheels_spin {
                let rack = at.model.rack_speed(estimate.side, estimate.rotation, estimate.velocity);
                (rack - at.spins[wheel_for(at.signs.velocity)]) / speed
            } else {
                0.0
            };
            costate * (push + self.jolt * slip) > self.take
        };
        if resists { Wish::Resist } else { Wish::Release }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::law::Resisting;
    use crate::control::tests::{situation, spinning_model};
    use crate::math::sign::Sign;

    /// Situations with every sign of θ, θ̇, acceleration, ground and drift, with a flywheel on the rack and without, and the size of each.
    fn each(mut check: impl FnMut(&Situation<'_>)) {
        let model = spinning_model();
        for bits in 0..64_u8 {
            let mut at = situation(&model, bits & 15);
            let sign = |bit: u8| if bits >> bit & 1 == 1 { 1.0_f32 } else { -1.0 };
            at.estimate.side = at.signs.rotation;
            at.estimate.rotation = 0.03 * sign(0);
            at.estimate.velocity = 0.2 * sign(1);
            at.estimate.push = 0.4 * sign(2);
            at.estimate.ground[0] = 0.3 * sign(3);
            at.ground_drift = 0.1 * sign(4);
            at.engaged = [bits >> 5 & 1 == 1, false];
            at.spins = [0.05, -0.03];
            check(&at);
        }
    }

    #[test]
    fn a_costate_that_is_the_velocity_is_equation_10() {
        let equation_10 = Costate { rotation: 0.0, curvature: 0.0, ground: 0.0, drift: 0.0, jolt: 0.0, take: 0.0, keep: 0.0 };
        each(|at| assert_eq!(equation_10.wish(at), Resisting.wish(at), "{at:?}"));
    }

    /// Otherwise a flywheel goes on and off as fast as its clutch can.
    #[test]
    fn a_flywheel_as_fast_as_the_rack_is_taken_on_only_where_it_is_kept() {
        let mut taken = 0;
        for share in -40..=40 {
            each(|at| {
                let mut at = *at;
                at.ground_drift += 0.01 * share as f32;
                at.engaged = [false, false];
                at.spins = [at.model.rack_speed(at.estimate.side, at.estimate.rotation, at.estimate.velocity); 2];
                if Costate::TRAINED.wish(&at) == Wish::Resist {
                    taken += 1;
                    at.engaged = [true, false];
                    assert_eq!(Costate::TRAINED.wish(&at), Wish::Resist, "{at:?}");
                }
            });
        }
        assert!(taken > 100, "{taken}");
    }

    /// What is right to one side is right to the other.
    #[test]
    fn it_is_mirror_symmetric() {
        each(|at| {
            let mut mirrored = *at;
            let estimate = &mut mirrored.estimate;
            estimate.side = at.estimate.side.opposite();
            for quantity in [
                &mut estimate.rotation,
                &mut estimate.velocity,
                &mut estimate.push,
                &mut estimate.ground[0],
                &mut mirrored.ground_drift,
            ] {
                *quantity = -*quantity;
            }
            mirrored.spins = [-at.spins[1], -at.spins[0]];
            mirrored.engaged = [at.engaged[1], at.engaged[0]];
            mirrored.signs.velocity = at.signs.velocity.opposite();
            assert_eq!(Costate::TRAINED.wish(at), Costate::TRAINED.wish(&mirrored), "{at:?}");
        });
    }

    /// By hand: λ of a block at rest in mid-swing is what rotation, ground and drift make it.
    #[test]
    fn each_weight_is_that_of_its_quantity() {
        let model = spinning_model();
        let mut at = situation(&model, 15);
        at.engaged = [true, false];
        let p = &model.parameters;
        at.estimate.side = Sign::Positive;
        at.estimate.rotation = 0.5 * p.slenderness;
        at.estimate.ground[0] = -2.0 * p.uplift;
        at.ground_drift = 3.0 * p.uplift;
        at.estimate.push = p.frequency_squared * p.slenderness;
        // 0.2·0.5 + 0.4·0.25 + 0.1·(−2) + 0.3·3 = 0.9.
        let law = Costate { rotation: 0.2, curvature: 0.4, ground: 0.1, drift: 0.3, jolt: 5.0, take: 9.0, keep: 0.0 };
        assert_eq!(Costate { keep: 0.899, ..law }.wish(&at), Wish::Resist);
        assert_eq!(Costate { keep: 0.901, ..law }.wish(&at), Wish::Release);
        // A flywheel that turns back as fast as pα is slower than the standing rack by 1.
        at.engaged = [false, false];
        at.spins = [-p.frequency * p.slenderness; 2];
        let taken = 0.9 * (1.0 + 5.0);
        assert_eq!(Costate { take: 0.999 * taken, ..law }.wish(&at), Wish::Resist);
        assert_eq!(Costate { take: 1.001 * taken, ..law }.wish(&at), Wish::Release);
    }
}
