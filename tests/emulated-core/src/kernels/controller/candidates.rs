//! The controllers that are measured: every estimator with Eq. 10 predicted, and the model-aided one with every other law.

use super::rig::{CLUTCH_TICKS, PERIOD, TRAVEL_PER_COUNT};
use core::fmt;
use sprag_shared::control::clutch_position::ClutchLag;
use sprag_shared::control::controller::{Controller, Horizons};
use sprag_shared::control::estimation::Estimator;
use sprag_shared::control::estimation::complementary::Complementary;
use sprag_shared::control::estimation::estimate::Deviation;
use sprag_shared::control::estimation::kalman::Kalman;
use sprag_shared::control::estimation::model_aided::ModelAided;
use sprag_shared::control::estimation::rest_detection::Standing;
use sprag_shared::control::law::any_law::ClutchLaw;
use sprag_shared::control::law::costate::Costate;
use sprag_shared::control::law::look_ahead::LookAhead;
use sprag_shared::control::law::minimum_dwell::Gate;
use sprag_shared::control::law::{GatedTable, SignTable};
use sprag_shared::control::model::Model;
use sprag_shared::control::monitor::{EncoderLimits, MonitorParameters, SensorLimits};
use sprag_shared::control::sensing::calibration::Plausible;
use sprag_shared::control::sensing::instruments::Instruments;
use sprag_shared::control::supervisor::{Parameters, Supervisor};
use sprag_shared::structure::added_mass::AddedMass;
use sprag_shared::structure::block::{Block, GRAVITY, Geometry, RECTANGLE_INERTIA_RATIO};
use sprag_shared::structure::device::{Device, DeviceKind, KinematicsKind};
use sprag_shared::structure::drivetrain::{Drivetrain, Engagement, FlywheelLosses};
use sprag_shared::structure::error::ParameterError;
use sprag_shared::structure::{Base, RestitutionScatter};
use sprag_shared::structure::{REST_SPEED, Restitution, Structure};

/// One of them.
pub struct Candidate {
    /// What it is called.
    pub name: &'static str,
    estimator: Estimator,
    law: ClutchLaw,
}

// What the host's `LoopTask::controller` solves for R = 2 m, α = 10°, σ = 0.5 on an ideal pair with a latency of 5 ms, at 2 kHz with the
// sensors of the suite icm-42688-p.
const MODEL_AIDED: Estimator = Estimator::ModelAided(ModelAided {
    gains: [[0.287_661_64, 2.167_216e-5], [99.620_54, 0.017_028_436]],
    blank: 5,
    jump: 0.033_469_82,
    standing: standing(1.265_482_9e-4, 0.002_215_856),
    deviation: deviation([3.870_707_4e-7, 0.000_201_911_05, 0.004_891_986]),
});
const KALMAN: Estimator = Estimator::Kalman(Kalman {
    gains: [
        [0.167_793_07, 6.747_878e-6, 3.440_351_3e-8],
        [31.021_053, 0.002_632_430_8, 0.000_250_115_85],
        [15.579_426, 0.024_639_942, 0.991_422],
        [-0.003_043_99, 8.541_889e-6, -2.039_042e-9],
    ],
    blank: 5,
    jump: 0.033_469_82,
    standing: standing(1.261_825e-4, 0.000_476_336_6),
    deviation: deviation([2.956_217_3e-7, 7.938_927e-5, 0.015_291_602]),
});
const COMPLEMENTARY: Estimator = Estimator::Complementary(Complementary {
    gains: [0.547_534_8, 423.077_24],
    smoothing: 0.283_468_7,
    blank: 5,
    standing: standing(1.271_361e-4, 0.003_935_762_6),
    deviation: deviation([5.340_172e-7, 0.000_655_960_3, 0.006_240_946]),
});

const fn standing(rotation: f32, velocity: f32) -> Standing {
    Standing { rotation, velocity, ticks: 40 }
}

const fn deviation([rotation, velocity, push]: [f32; 3]) -> Deviation {
    Deviation { rotation, velocity, push, ground: 0.001_329_863 }
}

/// Of gyroscope, encoder and ground accelerometer, s.
const DELAYS: [f64; 3] = [DELAY, 0.0, DELAY];
const DELAY: f64 = 5.324_236_549_240_234e-4;
/// Of the ground's acceleration, s.
const TRACKING: f64 = 0.0015;

/// What the host allows these sensors; all that waits for stillness is shorter.
fn supervision() -> Parameters {
    let monitor = MonitorParameters::default();
    let limits = |full_scale, saturation_time| SensorLimits {
        stale_time: 0.003,
        stuck_time: 0.0045,
        stuck_time_moving: 0.0045,
        full_scale,
        saturation_time,
    };
    let accelerometer = limits(76.884_13, 0.004);
    Parameters {
        period: PERIOD,
        monitor: MonitorParameters {
            gyroscope: limits(8.552_114, 0.0025),
            block_accelerometer: accelerometer,
            ground_accelerometer: accelerometer,
            encoder: EncoderLimits { counts_per_radian: 398_477.88, ..monitor.encoder },
            sensor_delay: 0.002_064_847_3,
            gravity: GRAVITY as f32,
            ..monitor
        },
        plausible: Plausible { gyroscope: 0.2, accelerometer: 1.470_997_5 },
        stillness_time: 0.05,
        calibration_time: 0.1,
        ..Parameters::default()
    }
}

const fn candidate(name: &'static str, estimator: Estimator, law: ClutchLaw) -> Candidate {
    Candidate { name, estimator, law }
}

/// On an ideal pair.
pub fn ideal() -> [Candidate; 8] {
    [
        candidate("model-aided", MODEL_AIDED, ClutchLaw::ResistingPredicted),
        candidate("kalman", KALMAN, ClutchLaw::ResistingPredicted),
        candidate("complementary", COMPLEMENTARY, ClutchLaw::ResistingPredicted),
        candidate("passive", MODEL_AIDED, ClutchLaw::Passive),
        candidate("sign-table", MODEL_AIDED, ClutchLaw::SignTable(SignTable::EITHER)),
        candidate("gated-table", MODEL_AIDED, ClutchLaw::GatedTable(GatedTable::DEFAULT)),
        candidate("look-ahead", MODEL_AIDED, ClutchLaw::LookAhead(LookAhead::default())),
        candidate("costate", MODEL_AIDED, ClutchLaw::Costate(Costate::TRAINED)),
    ]
}

/// On a pair whose flywheels keep spinning, in the consistent kinematics.
pub fn spinning() -> [Candidate; 3] {
    [
        candidate("spinning", MODEL_AIDED, ClutchLaw::ResistingPredicted),
        candidate("spinning-look-ahead", MODEL_AIDED, ClutchLaw::LookAhead(LookAhead::default())),
        candidate("spinning-costate", MODEL_AIDED, ClutchLaw::Costate(Costate::TRAINED)),
    ]
}

impl Candidate {
    /// The whole controller, for an ideal pair.
    ///
    /// # Errors
    /// The errors of [`Candidate::controller`].
    pub fn paper(&self) -> Result<Controller, fmt::Error> {
        self.controller(KinematicsKind::Paper, &Drivetrain::default()).map_err(|_| fmt::Error)
    }

    /// The whole controller, for flywheels that spin.
    ///
    /// # Errors
    /// The errors of [`Candidate::controller`].
    pub fn consistent(&self) -> Result<Controller, fmt::Error> {
        let flywheel = FlywheelLosses { viscous_rate: 0.05, dry_deceleration: 0.3, brake_deceleration: 5.0, drag_rate: 0.0 };
        let rigid = Drivetrain { engagement: Engagement::Rigid, flywheel, ..Drivetrain::default() };
        self.controller(KinematicsKind::Consistent, &rigid).map_err(|_| fmt::Error)
    }

    fn controller(&self, kinematics: KinematicsKind, drivetrain: &Drivetrain) -> Result<Controller, ParameterError> {
        let structure = Structure {
            block: Block::new(2.0, 10.0 * core::f64::consts::PI / 180.0, RECTANGLE_INERTIA_RATIO)?,
            geometry: Geometry::Full,
            device: Device { kind: DeviceKind::ClutchedPair, mass_ratio: 0.5, kinematics, ..Device::NONE },
            added_mass: AddedMass::NONE,
            restitution: Restitution::Constant(0.85),
            restitution_scatter: RestitutionScatter::NONE,
            base: Base::Rigid,
            rest_speed: REST_SPEED,
        };
        let period = f64::from(PERIOD);
        Ok(Controller {
            model: Model::new(&structure, drivetrain)?,
            instruments: Instruments::new(period, f64::from(TRAVEL_PER_COUNT), DELAYS, TRACKING)?,
            estimator: self.estimator,
            law: self.law,
            horizons: Horizons::of(((f64::from(CLUTCH_TICKS) + 0.5) * period) as f32),
            bands: 1.0,
            engaged_at_rest: true,
            gate: Gate { dwell: 0 },
            lag: ClutchLag::default(),
            supervisor: Supervisor::new(&Parameters { required: self.estimator.required(), ..supervision() })?,
        })
    }
}
