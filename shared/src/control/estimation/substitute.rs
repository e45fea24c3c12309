//! The ground's acceleration without a ground accelerometer: from the block's, less what the block itself does.
//!
//! The centre of mass moves by ẍ = g u + R (cos δ θ̈ + sin δ θ̇²) with the ground's acceleration u (in g), and θ̈ = A₀ + A₁ u by the
//! equation of motion, so u = (ẍ − R (cos δ A₀ + sin δ θ̇²))/(g + R cos δ A₁). Nothing is differentiated; noise of the block's
//! accelerometer is four times as large in u for a slender bare block, where 1 + R A₁/g = ¼, and less with an inerter.

use super::state::EstimatorState;
use crate::control::model::Model;
use crate::math::sine32;
use crate::structure::block::GRAVITY;

/// g, m/s².
const STANDARD_GRAVITY: f32 = GRAVITY as f32;

/// Largest |u| that is concluded, g: more is the shock of an impact.
const MOST: f32 = 2.0;

impl EstimatorState {
    /// u, g, from the specific force (m/s², horizontal and vertical at rest) on a block with `engaged` flywheels on its rack; `None` where an
    /// impact shakes the block.
    #[inline(never)]
    pub fn ground_by_block(&self, model: &Model, [along, up]: [f32; 2], engaged: u8) -> Option<f32> {
        let (sine, cosine) = sine32::sin_cos(self.rotation);
        let horizontal = along * cosine + up * sine;
        let ground = if self.rocks {
            let at = |ground| model.acceleration(self.side, self.rotation, self.velocity, [ground, 0.0], engaged);
            let (still, pushed) = (at(0.0), at(1.0));
            let (cosine, sine) = model.direction_cosines(self.side, self.rotation);
            let size = model.parameters.size;
            (horizontal - size * (cosine * still + sine * self.velocity * self.velocity))
                / (STANDARD_GRAVITY + size * cosine * (pushed - still))
        } else {
            horizontal / STANDARD_GRAVITY
        };
        (self.blank == 0 && ground.abs() < MOST).then_some(ground)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::sign::Sign;
    use crate::settings::Settings;

    /// What the sensors' equations make of a ground's acceleration is turned back into it.
    #[test]
    fn the_ground_is_found_from_the_block() {
        let model = crate::control::controller::Controller::of(&Settings::default()).unwrap().model;
        for (rotation, velocity) in [(0.02_f32, 0.3_f32), (0.1, -0.2), (-0.05, -0.4), (-0.16, 0.1)] {
            for engaged in 0..=2 {
                for ground in [-0.6_f32, 0.0, 0.05, 0.9] {
                    let state = EstimatorState::met(rotation, velocity);
                    let side = Sign::of(rotation, Sign::Positive);
                    let acceleration = model.acceleration(side, rotation, velocity, [ground, 0.0], engaged);
                    let (cosine, sine) = model.direction_cosines(side, rotation);
                    let size = model.parameters.size;
                    let x = STANDARD_GRAVITY * ground + size * (cosine * acceleration + sine * velocity * velocity);
                    let (s, c) = sine32::sin_cos(rotation);
                    let force = [x * c - 9.0 * s, x * s + 9.0 * c];
                    let found = state.ground_by_block(&model, force, engaged).unwrap();
                    assert!((found - ground).abs() < 1e-5, "{rotation} {engaged} {ground}: {found}");
                    assert_eq!(state.ground_by_block(&model, [300.0, 0.0], engaged), None, "an impact");
                }
            }
        }
        assert_eq!(EstimatorState::default().ground_by_block(&model, [0.5 * STANDARD_GRAVITY, 9.8], 0), Some(0.5));
    }
}
