//! The look-ahead law: the equation of motion is run ahead for either choice, and the safer one is taken.
//!
//! Each choice stands for the first steps and is followed by the gated table of signs ([`super::GatedTable`]). The ground is taken to go
//! on along its tangent and to fade, u(t) = (u + u̇ t) e^(−t/τ). What a choice leads to is measured at the end of the horizon by the capture
//! point of the block as an inverted pendulum: moving outward, |θ| + |θ̇|/p is where a slender block would come to stand without ground motion
//! (θ and θ̇/p measured from the toe's balance: α is the point of no return); moving inward, half of |θ̇|/p, and twice what |θ| has beyond α.
//! Steps, forecast and costs were chosen among some 130 variants on one-cycle pulses.

use super::signs::Signs;
use super::turn_taking::AHEAD;
use super::{GatedTable, Law, Situation, Wish, sign_row};
use crate::equation::body::Body;
use crate::equation::clutch_rule::wheel_for;
use crate::math::sign::Sign;

/// Parameters. Times in 1/p.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LookAhead {
    /// Length of a step, 1/p.
    pub step: f32,
    /// Steps for which a choice stands.
    pub chosen: u8,
    /// Gain of the forecast over a step: e^(−step/τ).
    pub fading: f32,
    /// e^(−step/2τ).
    pub fading_half: f32,
    /// How much safer, in α, the other choice must be to be taken.
    pub margin: f32,
    /// What follows the choice.
    pub base: GatedTable,
}

/// Steps of the horizon.
const STEPS: u8 = 12;

impl Default for LookAhead {
    /// Twelve steps of 0.1/p, a choice for three, a ground that fades within 0.3/p.
    fn default() -> Self {
        LookAhead {
            step: 0.1,
            chosen: 3,
            fading: 0.716_531_3,
            fading_half: 0.846_481_7,
            margin: 0.014,
            base: GatedTable::DEFAULT,
        }
    }
}

impl LookAhead {
    /// What comes of a choice: smaller is safer, rad.
    #[inline]
    fn cost(&self, at: &Situation<'_>, engage: bool) -> f32 {
        let model = at.model;
        let step = self.step / model.parameters.frequency;
        let (mut rotation, mut velocity, mut side) = (at.estimate.rotation, at.estimate.velocity, at.estimate.side);
        let (mut spins, mut locked) = (at.spins, at.engaged);
        let mut fading = self.fading_half;
        for k in 0..STEPS {
            let middle = (f32::from(k) + 0.5) * step;
            let ground = [(at.estimate.ground[0] + at.estimate.ground_rate * middle) * fading, at.estimate.ground[1]];
            fading *= self.fading;
            let direction = Sign::of(velocity, at.signs.velocity);
            let configuration = model.body.configuration(side.unit(), rotation);
            let driving_moment = model.body.driving_moment(&configuration, ground);
            let arm = model.body.arm(&configuration);
            let resists = if k < self.chosen {
                engage
            } else {
                let push = Sign::of(model.body.switching(&configuration, velocity, driving_moment), direction);
                let signs = Signs {
                    rotation: side,
                    velocity: direction,
                    push,
                    ground: Sign::of(ground[0], direction),
                    quiet: ground[0] == 0.0,
                };
                self.base.engages(sign_row(&signs), at.ground_drift, model.parameters.uplift)
            };
            let wheel = wheel_for(direction);
            for (index, (spin, locked)) in spins.iter_mut().zip(&mut locked).enumerate() {
                let rack = arm * velocity;
                if *locked {
                    *spin = rack;
                }
                let ahead = direction.times(*spin) > direction.times(rack) + AHEAD * model.parameters.slenderness;
                let wanted = resists && index == wheel && (*locked || !ahead);
                if wanted && !*locked && model.parameters.wheels_spin {
                    let after = 1.0 + model.parameters.coupling * arm * arm;
                    velocity = (velocity + model.parameters.coupling * arm * *spin) / after;
                }
                *locked = wanted;
                if !wanted {
                    *spin = model.coasted(*spin, step);
                }
            }
            let engaged = u8::from(locked[0]) + u8::from(locked[1]);
            velocity += step
                * model.body.solve_acceleration(
                    &configuration,
                    driving_moment,
                    f32::from(engaged) * model.parameters.coupling,
                    velocity,
                );
            rotation += step * velocity;
            if side.times(rotation) < 0.0 {
                velocity *= model.parameters.restitution;
                side = Sign::of(velocity, side);
            }
        }
        let (size, speed) = (rotation.abs(), velocity.abs() / model.parameters.frequency);
        if side.times(velocity) > 0.0 {
            size + speed
        } else {
            let beyond = if size > model.parameters.slenderness { size - model.parameters.slenderness } else { 0.0 };
            2.0 * beyond + 0.5 * speed
        }
    }
}

impl Law for LookAhead {
    #[inline]
    fn wish(&self, at: &Situation<'_>) -> Wish {
        if at.estimate.standing {
            return self.base.wish(at);
        }
        let gain = self.cost(at, false) - self.cost(at, true);
        if gain > self.margin * at.model.parameters.slenderness { Wish::Resist } else { Wish::Release }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::estimation::estimate::Estimate;
    use crate::control::model::Model;
    use crate::control::tests::{example_model, spinning_model};

    fn at(model: &Model, mirror: f32) -> Wish {
        let side = Sign::of(mirror, Sign::Positive);
        let estimate = Estimate {
            rotation: 0.09 * mirror,
            velocity: 0.31 * mirror,
            side,
            ground: [-0.3 * mirror, 0.0],
            ground_rate: 0.7 * mirror,
            ..Estimate::default()
        };
        let signs = Signs { rotation: side, velocity: side, push: side, ground: side.opposite(), quiet: false };
        LookAhead::default().wish(&Situation { model, estimate, signs, engaged: [false; 2], spins: [0.0; 2], ground_drift: 0.0 })
    }

    #[test]
    fn mirrored_situations_have_mirrored_answers() {
        for model in [example_model(), spinning_model()] {
            assert_eq!(at(&model, 1.0), at(&model, -1.0));
        }
    }

    /// A block that is thrown outward is resisted; one that falls back slowly well inside of its balance is not held up.
    #[test]
    fn it_resists_what_throws_the_block() {
        let model = example_model();
        assert_eq!(at(&model, 1.0), Wish::Resist);
    }

    /// Costs are those of the same steps taken in double precision.
    #[test]
    fn the_cost_of_a_free_rise_is_its_capture_point() {
        let model = example_model();
        let estimate = Estimate { rotation: 0.02, velocity: 0.2, ..Estimate::default() };
        let signs = Signs::default();
        let law = LookAhead { base: GatedTable { table: 0, ..GatedTable::DEFAULT }, ..LookAhead::default() };
        let situation = Situation { model: &model, estimate, signs, engaged: [false; 2], spins: [0.0; 2], ground_drift: 0.0 };
        let (mut theta, mut omega) = (0.02_f64, 0.2_f64);
        let p2 = 3.0 * 9.80665 / 8.0;
        let h = 0.1 / crate::math::square_root(p2);
        for _ in 0..12 {
            omega -= h * p2 * crate::math::sin(10_f64.to_radians() - theta);
            theta += h * omega;
        }
        let exact =
            if omega > 0.0 { theta + omega / crate::math::square_root(p2) } else { -0.5 * omega / crate::math::square_root(p2) };
        assert!((f64::from(law.cost(&situation, false)) - exact).abs() < 1e-4, "{exact}");
    }
}
