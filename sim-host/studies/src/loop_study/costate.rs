//! A candidate: Eq. 10 with the costate of optimal control in the place of the velocity.
//!
//! Engaging divides the moment by 1 + kℓ². By Pontryagin's principle the best switch engages while λ·D > 0, where D is the driving moment
//! and λ, the costate of θ̇, has the sign of the direction in which more speed brings the block nearer to its tip. Eq. 10 takes θ̇ for λ.
//! Here λ is a linear function of what the controller knows; so the law may engage against the motion of a block that creeps back from near
//! its tip, or let one go that is about to be caught by the ground.

use sprag_shared::control::law::{Law, Situation, Wish};
use sprag_shared::equation::clutch_rule::wheel_for;

/// λ = θ̇/(pα) + `rotation` θ/α + `curvature` θ|θ|/α² + `ground` ü_g/(g tan α) + `drift` Δv_g p/(g tan α), with the velocity Δv_g that the
/// ground has lately gained ([`Situation::ground_drift`]); engaged while λ (a + `jolt` w) > `threshold`, where a is Eq. 10's
/// acceleration of the terminals over p²α and w how much slower than the rack, over pα, a flywheel is that would be taken on.
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
    /// What a flywheel must be worth to be on the rack.
    pub threshold: f32,
}

impl Costate {
    /// Found by the cross-entropy method on pulses of all families, at random ω/p and amplitudes, and on recorded motions, with rigid clutches of
    /// 10 to 50 ms, wheels braked and coasting (R = 2 m, α = 20°, σ = 0.5).
    pub const TRAINED: Costate =
        Costate { rotation: 0.13, curvature: 0.69, ground: -0.4, drift: 1.03, jolt: 0.66, threshold: 0.085 };
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
        let engaged = at.engaged[0] || at.engaged[1];
        let slip = if engaged || !model.wheels_spin {
            0.0
        } else {
            let rack = at.model.rack_speed(estimate.side, estimate.rotation, estimate.velocity);
            (rack - at.spins[wheel_for(at.signs.velocity)]) / speed
        };
        let push = estimate.push / (model.frequency_squared * model.slenderness);
        if costate * (push + self.jolt * slip) > self.threshold { Wish::Resist } else { Wish::Release }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loop_study::bench::{Conditions, Variant, run_loop, with_loop};
    use crate::loop_study::law_settings::IDEAL;
    use crate::loop_study::motion::Motion;
    use sprag_sim::interrupt::Interrupt;

    /// With θ̇ alone for the costate it is Eq. 10: the same peak as the law of that name.
    #[test]
    fn a_costate_that_is_the_velocity_is_eq_10() {
        let equation_10 = Costate { rotation: 0.0, curvature: 0.0, ground: 0.0, drift: 0.0, jolt: 0.0, threshold: 0.0 };
        let (interrupt, motion) = (Interrupt::default(), Motion::Pulse { shape: "cosine", frequency: 4.0, amplitude: 3.0 });
        let conditions = Conditions::new(None, &interrupt);
        let variant = Variant::new("ideal", &IDEAL);
        let peak = |law: Costate| {
            let looped = with_loop(&motion, &variant, &conditions, |task| Ok(task.answered_by::<(), Costate>(|| law)?.2));
            looped.unwrap().extremes.peaks.rotation / 10_f64.to_radians()
        };
        let named = run_loop(&motion, &variant.with("controller.law=\"resisting-predicted\""), &conditions).unwrap().peak;
        assert!((peak(equation_10) / named - 1.0).abs() < 0.01, "{} {named}", peak(equation_10));
        assert!((peak(Costate::TRAINED) / named - 1.0).abs() > 0.02, "the trained law is another one");
    }
}
