//! State estimators: rotation, velocity and acceleration of the block from the sensors' readings, by one of three methods.
//!
//! [`model_aided`], [`kalman`], [`complementary`]: the estimators, to an [`estimate`]; [`rest_detection`]: whether the block stands;
//! `reference`: where θ = 0 is, after counts were lost; [`prediction`]: the motion when the clutch will have moved; `substitute`: the
//! ground's acceleration without its accelerometer.
//!
//! The room imports `math`, `equation`, `control::sensing` and `control::model`.

pub mod complementary;
pub mod estimate;
pub mod kalman;
pub mod model_aided;
pub mod prediction;
mod reference;
pub mod rest_detection;
mod state;
mod substitute;

pub use state::EstimatorState;

use crate::control::model::Model;
use crate::control::sensing::instruments::{Instruments, Measured};
use crate::control::sensing::required::Required;
use complementary::Complementary;
use estimate::Estimate;
use kalman::Kalman;
use model_aided::ModelAided;
use rest_detection::Standing;

/// One of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Estimator {
    /// Equation of motion, gyroscope, encoder.
    ModelAided(ModelAided),
    /// Kinematic Kalman filter of gyroscope, accelerometers and encoder.
    Kalman(Kalman),
    /// Encoder and accelerometers.
    Complementary(Complementary),
}

impl Estimator {
    /// Sensors that it cannot do without.
    pub fn required(&self) -> Required {
        let (gyroscope, block_accelerometer) = match self {
            Estimator::ModelAided(_) => (true, false),
            Estimator::Kalman(_) => (true, true),
            Estimator::Complementary(_) => (false, true),
        };
        Required { gyroscope, block_accelerometer, ground_accelerometer: true, encoder: true }
    }

    /// One tick, with `engaged` flywheels on the rack.
    #[inline]
    pub fn step(
        &self,
        state: &mut EstimatorState,
        model: &Model,
        instruments: &Instruments,
        seen: &Measured,
        engaged: u8,
    ) -> Estimate {
        if !state.rocks {
            return self.stand(state, model, instruments, seen, engaged);
        }
        match self {
            Estimator::ModelAided(estimator) => estimator.step(state, model, instruments, seen, engaged),
            Estimator::Kalman(estimator) => estimator.step(state, model, instruments, seen, engaged),
            Estimator::Complementary(estimator) => estimator.step(state, model, instruments, seen, engaged),
        }
    }

    /// One tick of a block that stood at the last one.
    #[inline(always)]
    fn stand(
        &self,
        state: &mut EstimatorState,
        model: &Model,
        instruments: &Instruments,
        seen: &Measured,
        engaged: u8,
    ) -> Estimate {
        let (standing, rate, jump) = match self {
            Estimator::ModelAided(estimator) => (&estimator.standing, seen.rate, estimator.jump),
            Estimator::Kalman(estimator) => (&estimator.standing, seen.rate, estimator.jump),
            Estimator::Complementary(estimator) => (&estimator.standing, None, 0.0),
        };
        if standing.holds(state, model, instruments, seen, rate, jump) {
            return Standing::estimate(seen, state.side);
        }
        match self {
            Estimator::ModelAided(estimator) => estimator.estimate(state, model, seen),
            Estimator::Kalman(Kalman { deviation, .. }) | Estimator::Complementary(Complementary { deviation, .. }) => {
                state.acceleration = state.modelled_acceleration(model, seen, engaged);
                state.kinematic_estimate(model, seen, *deviation)
            }
        }
    }
}
