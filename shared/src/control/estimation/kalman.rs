//! The kinematic Kalman filter: rotation, velocity, acceleration and the gyroscope's bias, without an equation of motion.
//!
//! The motion is a random walk of the acceleration, x = (θ, θ̇, θ̈, b); measured are the encoder's θ, the gyroscope's θ̇ + b, and the
//! θ̈ that follows from the difference of the two accelerometers,
//!
//! R (cos δ θ̈ + sin δ θ̇²) = f₁ cos θ + f₂ sin θ − f_g,
//!
//! with f in the block's axes at the centre of mass, or corrected for where it is measured. Gains are those of the steady
//! state, solved on the host. The filter knows of impacts only that θ = 0 is one: the velocity takes η there, the acceleration that of
//! the other toe.

use super::estimate::{Deviation, Estimate, bounded};
use super::reference::ABOVE_NOISE;
use super::rest_detection::Standing;
use super::state::EstimatorState;
use crate::control::model::Model;
use crate::control::sensing::instruments::{Instruments, Measured};
use crate::math::sine32;

/// Parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kalman {
    /// Corrections of θ, θ̇, θ̈ and b (rows) by encoder, gyroscope and accelerometers (columns), per tick.
    pub gains: [[f32; 3]; 4],
    /// Ticks after an impact for which gyroscope and accelerometers are not believed.
    pub blank: u16,
    /// θ̇ off by more than this, rad/s, is a jump, and is taken over at once.
    pub jump: f32,
    /// When the block stands.
    pub standing: Standing,
    /// Standard deviations of a settled estimate.
    pub deviation: Deviation,
}

/// θ̈ from the specific forces of block and ground, rad/s². An accelerometer at (x, y) from the centre of mass, in the block's axes, feels
/// (y θ̈ − x θ̇², −x θ̈ − y θ̇²) more than there, so that
///
/// (R cos δ + y cos θ − x sin θ) θ̈ = f₁ cos θ + f₂ sin θ − f_g − (R sin δ − x cos θ − y sin θ) θ̇².
#[inline]
pub(super) fn measured_acceleration(
    model: &Model,
    instruments: &Instruments,
    state: &EstimatorState,
    block: [f32; 2],
    ground: f32,
) -> f32 {
    let (sine, cosine) = sine32::sin_cos(state.rotation);
    let ([x, y], size) = (instruments.block_position, model.parameters.size);
    let (across, along) = model.direction_cosines(state.side, state.rotation);
    let turning = along - (x * cosine + y * sine) / size;
    let relative = (block[0] * cosine + block[1] * sine - ground) / size;
    (relative - turning * state.velocity * state.velocity) / (across + (y * cosine - x * sine) / size)
}

impl Kalman {
    /// One tick of a block that rocked at the last one, with `engaged` flywheels on the rack.
    #[inline]
    pub(super) fn step(
        &self,
        state: &mut EstimatorState,
        model: &Model,
        instruments: &Instruments,
        seen: &Measured,
        engaged: u8,
    ) -> Estimate {
        let (period, ahead) = (instruments.period, state.acceleration);
        let velocity = state.velocity + ahead * period;
        let rotation = state.rotation + (state.velocity + 0.5 * ahead * period) * period;
        let (rotation, velocity, ahead) = bounded(rotation, velocity, ahead);
        (state.rotation, state.velocity) = (rotation, velocity);
        state.blank = state.blank.saturating_sub(1);
        let believed = state.blank == 0;
        let travel = seen.travel.map_or(0.0, |travel| state.encoder_error(model, instruments, travel));
        let error = seen.rate.map(|rate| rate - state.bias - (velocity - ahead * instruments.gyroscope_delay));
        let (rate, jumps) = error.filter(|_| believed).map_or((0.0, false), |error| state.believed(error, self.jump));
        let acceleration = seen
            .block
            .filter(|_| believed)
            .map_or(0.0, |block| measured_acceleration(model, instruments, state, block, seen.ground_force[0]) - ahead);
        let [of_rotation, of_velocity, of_acceleration, of_bias] = self.gains;
        let corrected = |gains: [f32; 3]| gains[0] * travel + gains[1] * rate + gains[2] * acceleration;
        state.rotation = rotation + corrected(of_rotation);
        state.velocity = velocity + if jumps { rate } else { corrected(of_velocity) };
        state.acceleration = ahead + corrected(of_acceleration);
        state.bias += corrected(of_bias);
        state.bound();
        if self.standing.settles(state, model, seen) {
            return Standing::estimate(seen, state.side);
        }
        let lost = state.lost;
        let impact = if lost {
            state.look_for_impact(model, instruments, seen, ABOVE_NOISE * self.deviation.velocity)
        } else {
            state.hits()
        };
        if impact {
            if !lost {
                state.impact(if self.blank > 0 { model.parameters.restitution } else { 1.0 }, self.blank);
            }
            state.acceleration = state.modelled_acceleration(model, seen, engaged);
        }
        state.kinematic_estimate(model, seen, self.deviation)
    }
}
