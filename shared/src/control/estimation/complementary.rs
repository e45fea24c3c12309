//! The complementary filter of encoder and accelerometers: no gyroscope, no equation of motion.
//!
//! The velocity is the integral of the measured acceleration above a corner frequency and the derivative of the encoder's rotation
//! below it: with e the difference between encoder and estimate,
//!
//! θ' = θ̇ + 2 ω_c e,  θ̇' = θ̈ + ω_c² e,
//!
//! critically damped (Higgins 1975). The acceleration is the measured one through a low-pass of its own.

use super::estimate::{Deviation, Estimate};
use super::kalman::measured_acceleration;
use super::reference::ABOVE_NOISE;
use super::rest_detection::Standing;
use super::state::EstimatorState;
use crate::control::model::Model;
use crate::control::sensing::instruments::{Instruments, Measured};

/// Parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Complementary {
    /// Corrections of θ and θ̇ (1/s) by an encoder that disagrees, per tick: 2 ω_c T and ω_c² T, or as a fading memory has them.
    pub gains: [f32; 2],
    /// Share of a new reading in the acceleration, per tick; 0 to 1.
    pub smoothing: f32,
    /// Ticks after an impact for which the accelerometers are not believed.
    pub blank: u16,
    /// When the block stands.
    pub standing: Standing,
    /// Standard deviations of a settled estimate.
    pub deviation: Deviation,
}

impl Complementary {
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
        state.blank = state.blank.saturating_sub(1);
        if let (Some(block), 0) = (seen.block, state.blank) {
            let measured = measured_acceleration(model, instruments, state, block, seen.ground_force[0]);
            state.acceleration += self.smoothing * (measured - state.acceleration);
        }
        state.advance(state.acceleration, instruments.period);
        if let Some(travel) = seen.travel {
            let error = state.encoder_error(model, instruments, travel);
            state.rotation += self.gains[0] * error;
            state.velocity += self.gains[1] * error;
        }
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
                state.impact(model.parameters.restitution, self.blank);
            }
            state.acceleration = state.modelled_acceleration(model, seen, engaged);
        }
        state.kinematic_estimate(model, seen, self.deviation)
    }
}
