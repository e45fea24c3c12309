//! The complementary filter of encoder and accelerometers: no gyroscope, no equation of motion.
//!
//! The velocity is the integral of the measured acceleration above a corner frequency and the derivative of the encoder's rotation
//! below it: with e the difference between encoder and estimate,
//!
//! θ' = θ̇ + 2 ω_c e,  θ̇' = θ̈ + ω_c² e,
//!
//! critically damped (Higgins 1975). The acceleration is the measured one through a low-pass of its own.

use super::estimate::{Deviation, Estimate, bounded};
use super::kalman::{kinematic_estimate, measured_acceleration};
use super::rest_detection::{Standing, StandingState};
use crate::control::model::Model;
use crate::control::sensing::instruments::{Instruments, Measured};
use crate::equation::motion::Motion;
use crate::math::sign::Sign;

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

/// State.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ComplementaryState {
    rotation: f32,
    velocity: f32,
    acceleration: f32,
    side: Sign,
    blank: u16,
    standing: StandingState,
}

impl ComplementaryState {
    /// Of a block that is met in motion at θ and θ̇.
    pub(super) fn met(rotation: f32, velocity: f32) -> ComplementaryState {
        let side = Sign::of(rotation, Sign::of(velocity, Sign::Positive));
        ComplementaryState { rotation, velocity, side, standing: StandingState::ROCKING, ..ComplementaryState::default() }
    }
}

impl Complementary {
    /// One tick, with `engaged` flywheels on the rack.
    #[inline]
    pub fn step(
        &self,
        state: &mut ComplementaryState,
        model: &Model,
        instruments: &Instruments,
        seen: &Measured,
        engaged: u8,
    ) -> Estimate {
        let period = instruments.period;
        state.blank = state.blank.saturating_sub(1);
        if let (Some(block), 0, false) = (seen.block, state.blank, state.standing.stands) {
            let at = (state.side, state.rotation, state.velocity);
            let measured = measured_acceleration(model, at, block, seen.ground_force[0]);
            state.acceleration += self.smoothing * (measured - state.acceleration);
        }
        let ahead = if state.standing.stands { 0.0 } else { state.acceleration };
        let velocity = state.velocity + ahead * period;
        let rotation = state.rotation + 0.5 * (state.velocity + velocity) * period;
        let (rotation, velocity, _) = bounded(rotation, velocity, 0.0);
        (state.rotation, state.velocity) = (rotation, velocity);
        if let Some(travel) = seen.travel {
            let then = rotation - velocity * instruments.encoder_delay;
            let error = model.rotation_of_travel(travel, then, Sign::of(travel, state.side)) - then;
            state.rotation += self.gains[0] * error;
            state.velocity += self.gains[1] * error;
        }
        (state.rotation, state.velocity, state.acceleration) = bounded(state.rotation, state.velocity, state.acceleration);
        let stood = state.standing.stands;
        if self.standing.step(&mut state.standing, model, seen, (state.rotation, state.velocity), &mut state.side) {
            (state.rotation, state.velocity, state.acceleration) = (0.0, 0.0, 0.0);
            return Standing::estimate(seen, state.side);
        }
        let impact = state.side.times(state.rotation) < 0.0 && state.side.times(state.velocity) < 0.0;
        if stood || impact {
            if impact && !stood {
                state.side = state.side.opposite();
                state.velocity *= model.parameters.restitution;
                state.blank = self.blank;
            }
            state.acceleration = model.acceleration(state.side, state.rotation, state.velocity, seen.ground, engaged);
        }
        let motion = Motion { rotation: state.rotation, velocity: state.velocity, acceleration: state.acceleration };
        kinematic_estimate(model, seen, state.side, &motion, self.deviation)
    }
}
