//! The kinematic Kalman filter: rotation, velocity, acceleration and the gyroscope's bias, without an equation of motion.
//!
//! The motion is a random walk of the acceleration, x = (θ, θ̇, θ̈, b); measured are the encoder's θ, the gyroscope's θ̇ + b, and the
//! θ̈ that follows from the difference of the two accelerometers,
//!
//! R (cos δ θ̈ + sin δ θ̇²) = f₁ cos θ + f₂ sin θ − f_g,
//!
//! with f in the block's axes (horizontal acceleration of the centre of mass relative to the ground). Gains are those of the steady
//! state, solved on the host. The filter knows of impacts only that θ = 0 is one: the velocity takes η there, the acceleration that of
//! the other toe.

use super::estimate::{Deviation, Estimate, bounded};
use super::rest_detection::{Standing, StandingState};
use crate::control::model::Model;
use crate::control::sensing::instruments::{Instruments, Measured};
use crate::equation::body::Body;
use crate::equation::motion::Motion;
use crate::math::sign::Sign;
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

/// State.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct KalmanState {
    rotation: f32,
    velocity: f32,
    acceleration: f32,
    bias: f32,
    side: Sign,
    blank: u16,
    standing: StandingState,
}

/// θ̈ from the specific forces of block and ground, rad/s².
#[inline]
pub fn measured_acceleration(model: &Model, (side, rotation, velocity): (Sign, f32, f32), block: [f32; 2], ground: f32) -> f32 {
    let (sine, cosine) = sine32::sin_cos(rotation);
    let relative = (block[0] * cosine + block[1] * sine - ground) / model.parameters.size;
    let (across, along) = model.direction_cosines(side, rotation);
    (relative - along * velocity * velocity) / across
}

/// The estimate of a filter that has measured θ̈: the sign of the terminals' acceleration is that of the measured one.
#[inline]
pub(super) fn kinematic_estimate(
    model: &Model,
    seen: &Measured,
    side: Sign,
    motion: &Motion<f32>,
    deviation: Deviation,
) -> Estimate {
    let Motion { rotation, velocity, acceleration } = *motion;
    let configuration = model.configuration(side, rotation);
    let terminal = model.body.terminal_acceleration(&configuration, velocity, acceleration);
    Estimate {
        rotation,
        velocity,
        side,
        push: model.body.arm(&configuration) * terminal,
        ground: seen.ground,
        ground_rate: seen.ground_rate,
        standing: false,
        deviation,
    }
}

impl KalmanState {
    /// Of a block that is met in motion at θ and θ̇.
    pub(super) fn met(rotation: f32, velocity: f32) -> KalmanState {
        let side = Sign::of(rotation, Sign::of(velocity, Sign::Positive));
        KalmanState { rotation, velocity, side, standing: StandingState::ROCKING, ..KalmanState::default() }
    }
}

impl Kalman {
    /// One tick, with `engaged` flywheels on the rack.
    #[inline]
    pub fn step(
        &self,
        state: &mut KalmanState,
        model: &Model,
        instruments: &Instruments,
        seen: &Measured,
        engaged: u8,
    ) -> Estimate {
        let period = instruments.period;
        let ahead = if state.standing.stands { 0.0 } else { state.acceleration };
        let velocity = state.velocity + ahead * period;
        let rotation = state.rotation + (state.velocity + 0.5 * ahead * period) * period;
        let (rotation, velocity, ahead) = bounded(rotation, velocity, ahead);
        state.blank = state.blank.saturating_sub(1);
        let believed = state.blank == 0;
        let travel = seen.travel.map_or(0.0, |travel| {
            let then = rotation - velocity * instruments.encoder_delay;
            model.rotation_of_travel(travel, then, Sign::of(travel, state.side)) - then
        });
        let rate = seen
            .rate
            .filter(|_| believed)
            .map_or(0.0, |rate| rate - state.bias - (velocity - ahead * instruments.gyroscope_delay));
        let acceleration = seen.block.filter(|_| believed).map_or(0.0, |block| {
            measured_acceleration(model, (state.side, rotation, velocity), block, seen.ground_force[0]) - ahead
        });
        let [of_rotation, of_velocity, of_acceleration, of_bias] = self.gains;
        let corrected = |gains: [f32; 3]| gains[0] * travel + gains[1] * rate + gains[2] * acceleration;
        state.rotation = rotation + corrected(of_rotation);
        state.velocity = velocity + if rate.abs() > self.jump { rate } else { corrected(of_velocity) };
        state.acceleration = ahead + corrected(of_acceleration);
        state.bias += corrected(of_bias);
        (state.rotation, state.velocity, state.acceleration) = bounded(state.rotation, state.velocity, state.acceleration);
        let stood = state.standing.stands;
        if self.standing.step(&mut state.standing, model, seen, (state.rotation, state.velocity), &mut state.side) {
            (state.rotation, state.velocity, state.acceleration) = (0.0, 0.0, 0.0);
            return Standing::estimate(seen, state.side);
        }
        if stood {
            state.acceleration = model.acceleration(state.side, 0.0, state.velocity, seen.ground, engaged);
        } else if state.side.times(state.rotation) < 0.0 && state.side.times(state.velocity) < 0.0 {
            state.side = state.side.opposite();
            if self.blank > 0 {
                state.velocity *= model.parameters.restitution;
            }
            state.acceleration = model.acceleration(state.side, state.rotation, state.velocity, seen.ground, engaged);
            state.blank = self.blank;
        }
        let motion = Motion { rotation: state.rotation, velocity: state.velocity, acceleration: state.acceleration };
        kinematic_estimate(model, seen, state.side, &motion, self.deviation)
    }
}
