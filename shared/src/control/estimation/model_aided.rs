//! The model-aided estimator: the equation of motion itself, corrected by gyroscope and encoder.
//!
//! Between readings θ and θ̇ move by the equation of motion with what is engaged. The sign that Eq. 10 asks for is that of the
//! bracket of Eq. 15, which needs only θ and the ground's acceleration, so nothing is differentiated. θ = 0 is an impact: the velocity
//! takes η and the other toe takes over, and the gyroscope is not believed until its own filter has seen the jump.

use super::estimate::{Deviation, Estimate};
use super::reference::ABOVE_STANDING;
use super::rest_detection::Standing;
use super::state::EstimatorState;
use crate::control::model::Model;
use crate::control::sensing::instruments::{Instruments, Measured};

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

impl ModelAided {
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
        let ahead = state.modelled_acceleration(model, seen, engaged);
        state.advance(ahead, instruments.period);
        let velocity = state.velocity;
        if let Some(travel) = seen.travel {
            let error = state.encoder_error(model, instruments, travel);
            state.rotation += self.gains[0][0] * error;
            state.velocity += self.gains[1][0] * error;
        }
        state.blank = state.blank.saturating_sub(1);
        let error = seen.rate.map(|rate| rate - state.bias - (velocity - ahead * instruments.gyroscope_delay));
        if let (Some(error), 0) = (error, state.blank) {
            let (error, jumps) = state.believed(error, self.jump);
            let share = if jumps { 1.0 } else { self.gains[1][1] };
            state.rotation += self.gains[0][1] * error;
            state.velocity += share * error;
        }
        state.bound();
        if self.standing.settles(state, model, seen) {
            return Standing::estimate(seen, state.side);
        }
        if state.lost {
            state.look_for_impact(model, instruments, seen, ABOVE_STANDING * self.standing.velocity);
        } else if state.hits() {
            // With a gyroscope that is believed again at once the jump is already in its reading.
            state.impact(if self.blank > 0 { model.parameters.restitution } else { 1.0 }, self.blank);
        }
        self.estimate(state, model, seen)
    }

    #[inline]
    pub(super) fn estimate(&self, state: &EstimatorState, model: &Model, seen: &Measured) -> Estimate {
        state.estimate(seen, model.push(state.side, state.rotation, state.velocity, seen.ground), self.deviation)
    }
}
