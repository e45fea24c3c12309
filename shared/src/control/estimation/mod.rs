//! State estimators: rotation, velocity and acceleration of the block from the sensors' readings, by one of three methods.
//!
//! [`model_aided`], [`kalman`], [`complementary`]: the estimators, to an [`estimate`]; [`rest_detection`]: whether the block stands;
//! [`prediction`]: the motion when the clutch will have moved.
//!
//! The room imports `math`, `equation`, `control::sensing` and `control::model`.

pub mod complementary;
pub mod estimate;
pub mod kalman;
pub mod model_aided;
pub mod prediction;
pub mod rest_detection;

use crate::control::model::Model;
use crate::control::sensing::instruments::{Instruments, Measured};
use crate::control::sensing::required::Required;
use complementary::{Complementary, ComplementaryState};
use estimate::Estimate;
use kalman::{Kalman, KalmanState};
use model_aided::{ModelAided, ModelAidedState};

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

/// State of the one that was chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EstimatorState {
    /// Of [`Estimator::ModelAided`].
    ModelAided(ModelAidedState),
    /// Of [`Estimator::Kalman`].
    Kalman(KalmanState),
    /// Of [`Estimator::Complementary`].
    Complementary(ComplementaryState),
}

impl Estimator {
    /// State of a standing block.
    pub fn start(&self) -> EstimatorState {
        match self {
            Estimator::ModelAided(_) => EstimatorState::ModelAided(ModelAidedState::default()),
            Estimator::Kalman(_) => EstimatorState::Kalman(KalmanState::default()),
            Estimator::Complementary(_) => EstimatorState::Complementary(ComplementaryState::default()),
        }
    }

    /// State of a block that is met in motion at θ (rad) and θ̇ (rad/s), as after a reset in mid-earthquake.
    pub fn met(&self, rotation: f32, velocity: f32) -> EstimatorState {
        match self {
            Estimator::ModelAided(_) => EstimatorState::ModelAided(ModelAidedState::met(rotation, velocity)),
            Estimator::Kalman(_) => EstimatorState::Kalman(KalmanState::met(rotation, velocity)),
            Estimator::Complementary(_) => EstimatorState::Complementary(ComplementaryState::met(rotation, velocity)),
        }
    }

    /// Sensors that it cannot do without.
    pub fn required(&self) -> Required {
        match self {
            Estimator::ModelAided(_) => {
                Required { gyroscope: true, block_accelerometer: false, ground_accelerometer: true, encoder: true }
            }
            Estimator::Kalman(_) => {
                Required { gyroscope: true, block_accelerometer: true, ground_accelerometer: true, encoder: true }
            }
            Estimator::Complementary(_) => {
                Required { gyroscope: false, block_accelerometer: true, ground_accelerometer: true, encoder: true }
            }
        }
    }

    /// One tick, with `engaged` flywheels on the rack. A state of another estimator is started anew.
    #[inline]
    pub fn step(
        &self,
        state: &mut EstimatorState,
        model: &Model,
        instruments: &Instruments,
        seen: &Measured,
        engaged: u8,
    ) -> Estimate {
        match (self, state) {
            (Estimator::ModelAided(estimator), EstimatorState::ModelAided(state)) => {
                estimator.step(state, model, instruments, seen, engaged)
            }
            (Estimator::Kalman(estimator), EstimatorState::Kalman(state)) => {
                estimator.step(state, model, instruments, seen, engaged)
            }
            (Estimator::Complementary(estimator), EstimatorState::Complementary(state)) => {
                estimator.step(state, model, instruments, seen, engaged)
            }
            (_, state) => {
                *state = self.start();
                Estimate { standing: true, ..Estimate::default() }
            }
        }
    }
}
