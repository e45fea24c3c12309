//! The model-aided estimator: the equation of motion itself, corrected by gyroscope and encoder.
//!
//! Between readings θ and θ̇ move by the equation of motion with what is engaged. The sign that Eq. 10 asks for is that of the
//! bracket of Eq. 15, which needs only θ and the ground's acceleration, so nothing is differentiated. θ = 0 is an impact: the velocity
//! takes η and the other toe takes over, and the gyroscope is not believed until its own filter has seen the jump.

use super::estimate::{Deviation, Estimate, bounded};
use super::rest_detection::{Standing, StandingState};
use crate::control::model::Model;
use crate::control::sensing::instruments::{Instruments, Measured};
use crate::math::sign::Sign;

/// Parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelAided {
    /// Corrections of θ (rows) and θ̇ by an encoder and a gyroscope (columns) that disagree, per tick; steady-state Kalman gains.
    pub gains: [[f32; 2]; 2],
    /// Ticks after an impact for which the gyroscope is not believed.
    pub blank: u16,
    /// θ̇ off by more than this, rad/s, is a jump that the model did not foresee, and is taken over at once.
    pub jump: f32,
    /// When the block stands.
    pub standing: Standing,
    /// Standard deviations of a settled estimate.
    pub deviation: Deviation,
}

/// State.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ModelAidedState {
    rotation: f32,
    velocity: f32,
    side: Sign,
    blank: u16,
    standing: StandingState,
}

impl ModelAidedState {
    /// Of a block that is met in motion at θ and θ̇.
    pub(super) fn met(rotation: f32, velocity: f32) -> ModelAidedState {
        let side = Sign::of(rotation, Sign::of(velocity, Sign::Positive));
        ModelAidedState { rotation, velocity, side, standing: StandingState::ROCKING, ..ModelAidedState::default() }
    }
}

impl ModelAided {
    /// One tick, with `engaged` flywheels on the rack.
    #[inline]
    pub fn step(
        &self,
        state: &mut ModelAidedState,
        model: &Model,
        instruments: &Instruments,
        seen: &Measured,
        engaged: u8,
    ) -> Estimate {
        let period = instruments.period;
        let ahead = if state.standing.stands {
            0.0
        } else {
            model.acceleration(state.side, state.rotation, state.velocity, seen.ground, engaged)
        };
        let velocity = state.velocity + ahead * period;
        let rotation = state.rotation + 0.5 * (state.velocity + velocity) * period;
        let (rotation, velocity, _) = bounded(rotation, velocity, 0.0);
        (state.rotation, state.velocity) = (rotation, velocity);
        // Readings are compared with the motion of when they were taken.
        if let Some(travel) = seen.travel {
            let then = rotation - velocity * instruments.encoder_delay;
            let side = Sign::of(travel, state.side);
            let error = model.rotation_of_travel(travel, then, side) - then;
            state.rotation += self.gains[0][0] * error;
            state.velocity += self.gains[1][0] * error;
        }
        state.blank = state.blank.saturating_sub(1);
        if let (Some(rate), 0) = (seen.rate, state.blank) {
            let error = rate - (velocity - ahead * instruments.gyroscope_delay);
            let share = if error.abs() > self.jump { 1.0 } else { self.gains[1][1] };
            state.rotation += self.gains[0][1] * error;
            state.velocity += share * error;
        }
        let (rotation, velocity, _) = bounded(state.rotation, state.velocity, 0.0);
        (state.rotation, state.velocity) = (rotation, velocity);
        let stood = state.standing.stands;
        if self.standing.step(&mut state.standing, model, seen, (rotation, velocity), &mut state.side) {
            (state.rotation, state.velocity) = (0.0, 0.0);
            return Standing::estimate(seen, state.side);
        }
        if !stood && state.side.times(state.rotation) < 0.0 && state.side.times(state.velocity) < 0.0 {
            state.side = state.side.opposite();
            if self.blank > 0 {
                // With a gyroscope that is believed again at once the jump is already in its reading.
                state.velocity *= model.parameters.restitution;
            }
            state.blank = self.blank;
        }
        Estimate {
            rotation: state.rotation,
            velocity: state.velocity,
            side: state.side,
            push: model.push(state.side, state.rotation, state.velocity, seen.ground),
            ground: seen.ground,
            ground_rate: seen.ground_rate,
            standing: false,
            deviation: self.deviation,
        }
    }
}
