//! From settings to the controller that they describe.
//!
//! Every range has been checked word by word, so only what takes two words is left to check here, and no error has a text.

use super::{Item, SettingError, Settings};
use crate::control::controller::Controller;
use crate::control::estimation::Estimator;
use crate::control::estimation::complementary::Complementary;
use crate::control::estimation::estimate::Deviation;
use crate::control::estimation::kalman::Kalman;
use crate::control::estimation::model_aided::ModelAided;
use crate::control::estimation::rest_detection::Standing;
use crate::control::law::any_law::ClutchLaw;
use crate::control::law::look_ahead::LookAhead;
use crate::control::law::minimum_dwell::Gate;
use crate::control::law::{GatedTable, SignTable};
use crate::control::model::{Model, ModelParameters, PlantBody};
use crate::control::monitor::fault::Wheel;
use crate::control::monitor::{EncoderLimits, FEWEST_WINDOW_TICKS, MonitorParameters, SensorLimits};
use crate::control::sensing::calibration::Plausible;
use crate::control::sensing::instruments::Instruments;
use crate::control::sensing::required::Required;
use crate::control::supervisor::{Parameters, SafeState, Supervisor};
use crate::control::ticks::ticks;
use crate::equation::FullBlock;
use crate::equation::any_body::AnyBody;
use crate::equation::body::{FullBody, SlenderBody};
use crate::equation::kinematics::BodyKinematics;
use crate::equation::lever::TyingPoint;

/// Choices of `body`.
const SLENDER: u32 = 0;
const PAPER: u32 = 1;
const CONSISTENT: u32 = 2;

/// A controller for whichever body its settings name.
pub type AnyController = Controller<AnyBody<f32>, ClutchLaw>;

impl<B: Into<AnyBody<f32>> + PlantBody> Controller<B, ClutchLaw> {
    /// The same to the last bit, its body told at run time.
    pub fn told(self) -> AnyController {
        let Controller { model, instruments, estimator, law, horizon, bands, engaged_at_rest, gate, supervisor } = self;
        let model = Model::of(model.body.into(), model.parameters);
        Controller { model, instruments, estimator, law, horizon, bands, engaged_at_rest, gate, supervisor }
    }
}

impl AnyController {
    /// The controller that `settings` describe.
    ///
    /// # Errors
    /// [`SettingError::Contradiction`] names the first two parameters that do not go together.
    pub fn of(settings: &Settings) -> Result<AnyController, SettingError> {
        controller(settings)
    }
}

/// A body that settings can name.
pub trait SettingsBody: PlantBody + PartialEq {
    /// Its number among the choices of `body`.
    fn choice(&self) -> u32;

    /// The body of `settings`, whatever body they name.
    fn of_settings(settings: &Settings) -> Self;

    /// What of its levers is put down in `draft`.
    fn put(&self, draft: &mut super::record::Draft);
}

impl SettingsBody for SlenderBody<f32> {
    fn choice(&self) -> u32 {
        SLENDER
    }

    fn of_settings(settings: &Settings) -> SlenderBody<f32> {
        SlenderBody {
            frequency_squared: settings.real(Item::FrequencySquared),
            slenderness: settings.real(Item::Slenderness),
            lever: settings.real(Item::Lever),
            vertical: true,
        }
    }

    fn put(&self, draft: &mut super::record::Draft) {
        draft.real(Item::Lever, self.lever);
    }
}

impl<K: BodyKinematics + PartialEq> SettingsBody for FullBody<f32, K> {
    fn choice(&self) -> u32 {
        if self.kinematics.consistent() { CONSISTENT } else { PAPER }
    }

    fn of_settings(settings: &Settings) -> FullBody<f32, K> {
        FullBody {
            block: FullBlock {
                frequency_squared: settings.real(Item::FrequencySquared),
                slenderness: settings.real(Item::Slenderness),
            },
            lever: TyingPoint { along: settings.real(Item::LeverAlong), across: settings.real(Item::LeverAcross) },
            kinematics: K::chosen(settings.whole(Item::Body) == CONSISTENT),
            vertical: true,
        }
    }

    fn put(&self, draft: &mut super::record::Draft) {
        draft.real(Item::LeverAlong, self.lever.along);
        draft.real(Item::LeverAcross, self.lever.across);
    }
}

impl SettingsBody for AnyBody<f32> {
    fn choice(&self) -> u32 {
        match self {
            AnyBody::Slender(body) => body.choice(),
            AnyBody::Full(body) => body.choice(),
        }
    }

    fn of_settings(settings: &Settings) -> AnyBody<f32> {
        match settings.whole(Item::Body) {
            SLENDER => AnyBody::Slender(SlenderBody::<f32>::of_settings(settings)),
            _ => AnyBody::Full(FullBody::of_settings(settings)),
        }
    }

    fn put(&self, draft: &mut super::record::Draft) {
        match self {
            AnyBody::Slender(body) => body.put(draft),
            AnyBody::Full(body) => body.put(draft),
        }
    }
}

/// By which p² may differ from the square of p, relative to it: some roundings of single precision.
const ROUNDING: f32 = 1e-6;

/// The controller for a body `B`, whatever body the settings name.
pub(super) fn controller<B: SettingsBody>(settings: &Settings) -> Result<Controller<B, ClutchLaw>, SettingError> {
    let model: Model<B> = model(settings);
    let square = model.parameters.frequency * model.parameters.frequency;
    if (square - model.parameters.frequency_squared).abs() > ROUNDING * square {
        return Err(SettingError::contradiction(Item::FrequencySquared, Item::Frequency));
    }
    // Where the rack does not move with the block the encoder says nothing.
    if model.body.arm(&model.body.configuration(1.0, 0.0)) <= 0.0 {
        return Err(SettingError::contradiction(Item::LeverAcross, Item::LeverAlong));
    }
    Ok(Controller {
        model,
        instruments: Instruments::of_gains(
            settings.real(Item::Period),
            settings.real(Item::TravelPerCount),
            [Item::GyroscopeDelay, Item::EncoderDelay, Item::GroundDelay].map(|item| settings.real(item)),
            [Item::TrackingValue, Item::TrackingGrowth].map(|item| settings.real(item)),
        ),
        estimator: estimator(settings),
        law: law(settings),
        horizon: settings.real(Item::Horizon),
        bands: settings.real(Item::Bands),
        engaged_at_rest: settings.switch(Item::EngagedAtRest),
        gate: Gate { dwell: settings.whole(Item::Dwell) as u16 },
        supervisor: supervisor(settings)?,
    })
}

fn model<B: SettingsBody>(settings: &Settings) -> Model<B> {
    let parameters = ModelParameters {
        frequency: settings.real(Item::Frequency),
        frequency_squared: settings.real(Item::FrequencySquared),
        slenderness: settings.real(Item::Slenderness),
        size: settings.real(Item::Size),
        restitution: settings.real(Item::Restitution),
        uplift: settings.real(Item::Uplift),
        coupling: settings.real(Item::Coupling),
        wheels_spin: settings.switch(Item::WheelsSpin),
        decay: settings.real(Item::Decay),
        drag: settings.real(Item::Drag),
        stops_at_once: settings.switch(Item::StopsAtOnce),
    };
    Model::of(B::of_settings(settings), parameters)
}

/// The rows of gains, of which an estimator takes as many numbers as it has.
pub(super) const GAINS: [[Item; 3]; 4] = [
    [Item::RotationByEncoder, Item::RotationByGyroscope, Item::RotationByAccelerometers],
    [Item::VelocityByEncoder, Item::VelocityByGyroscope, Item::VelocityByAccelerometers],
    [Item::AccelerationByEncoder, Item::AccelerationByGyroscope, Item::AccelerationByAccelerometers],
    [Item::BiasByEncoder, Item::BiasByGyroscope, Item::BiasByAccelerometers],
];

fn estimator(settings: &Settings) -> Estimator {
    let gains = GAINS.map(|row| row.map(|item| settings.real(item)));
    let blank = settings.whole(Item::Blank) as u16;
    let jump = settings.real(Item::Jump);
    let standing = Standing {
        rotation: settings.real(Item::StandingRotation),
        velocity: settings.real(Item::StandingVelocity),
        ticks: settings.whole(Item::StandingTicks) as u16,
    };
    let deviation = Deviation {
        rotation: settings.real(Item::DeviationRotation),
        velocity: settings.real(Item::DeviationVelocity),
        push: settings.real(Item::DeviationPush),
        ground: settings.real(Item::DeviationGround),
    };
    let [[rotation, by_rate, _], [velocity, velocity_by_rate, _], ..] = gains;
    match settings.whole(Item::Estimator) {
        0 => Estimator::ModelAided(ModelAided {
            gains: [[rotation, by_rate], [velocity, velocity_by_rate]],
            blank,
            jump,
            standing,
            deviation,
        }),
        1 => Estimator::Kalman(Kalman { gains, blank, jump, standing, deviation }),
        _ => Estimator::Complementary(Complementary {
            gains: [rotation, velocity],
            smoothing: settings.real(Item::Smoothing),
            blank,
            standing,
            deviation,
        }),
    }
}

fn law(settings: &Settings) -> ClutchLaw {
    let table = settings.whole(Item::LawTable) as u8;
    let gated = GatedTable { table, row: settings.whole(Item::LawRow) as u8, threshold: settings.real(Item::LawThreshold) };
    match settings.whole(Item::Law) {
        0 => ClutchLaw::Passive,
        1 => ClutchLaw::AlwaysEngaged,
        2 => ClutchLaw::Resisting,
        3 => ClutchLaw::ResistingPredicted,
        4 => ClutchLaw::SignTable(SignTable(table)),
        5 => ClutchLaw::GatedTable(gated),
        _ => ClutchLaw::LookAhead(LookAhead {
            step: settings.real(Item::LawStep),
            chosen: settings.whole(Item::LawChosen) as u8,
            fading: settings.real(Item::LawFading),
            fading_half: settings.real(Item::LawFadingHalf),
            margin: settings.real(Item::LawMargin),
            base: gated,
        }),
    }
}

fn supervisor(settings: &Settings) -> Result<Supervisor, SettingError> {
    let parameters = supervision(settings);
    if parameters.calibration_patience <= parameters.calibration_time {
        return Err(SettingError::contradiction(Item::CalibrationPatience, Item::CalibrationTime));
    }
    let monitor = &parameters.monitor;
    if ticks(monitor.contradiction_time, parameters.period) < FEWEST_WINDOW_TICKS {
        return Err(SettingError::contradiction(Item::ContradictionTime, Item::Period));
    }
    if monitor.slow_contradiction_time < monitor.contradiction_time {
        return Err(SettingError::contradiction(Item::SlowContradictionTime, Item::ContradictionTime));
    }
    Ok(Supervisor::of_checked(&parameters))
}

/// What the supervisor is told.
pub(super) fn supervision(settings: &Settings) -> Parameters {
    Parameters {
        period: settings.real(Item::Period),
        monitor: monitor(settings),
        required: Required {
            gyroscope: settings.switch(Item::RequiredGyroscope),
            block_accelerometer: settings.switch(Item::RequiredBlockAccelerometer),
            ground_accelerometer: settings.switch(Item::RequiredGroundAccelerometer),
            encoder: settings.switch(Item::RequiredEncoder),
        },
        safe_state: match settings.whole(Item::SafeState) {
            0 => SafeState::Released,
            1 => SafeState::Engaged(Wheel::First),
            _ => SafeState::Engaged(Wheel::Second),
        },
        both_allowed: settings.switch(Item::BothAllowed),
        self_test_clutches: settings.switch(Item::SelfTestClutches),
        boot_time: settings.real(Item::BootTime),
        actuator_time: settings.real(Item::ActuatorTime),
        feedback_time: settings.real(Item::FeedbackTime),
        stillness_time: settings.real(Item::StillnessTime),
        calibration_time: settings.real(Item::CalibrationTime),
        calibration_patience: settings.real(Item::CalibrationPatience),
        quiet_time: settings.real(Item::QuietTime),
        recover_after: settings.real(Item::RecoverAfter),
        plausible: Plausible {
            gyroscope: settings.real(Item::PlausibleGyroscope),
            accelerometer: settings.real(Item::PlausibleAccelerometer),
        },
        shaking: settings.real(Item::Shaking),
        moving_counts: settings.whole(Item::MovingCounts) as i32,
        overrun_ticks: settings.whole(Item::OverrunTicks),
        overrun_limit: settings.real(Item::OverrunLimit),
    }
}

/// The limits of a gyroscope or accelerometer, in the order of their fields.
pub(super) const GYROSCOPE: [Item; 5] = [
    Item::GyroscopeStaleTime,
    Item::GyroscopeStuckTime,
    Item::GyroscopeStuckTimeMoving,
    Item::GyroscopeFullScale,
    Item::GyroscopeSaturationTime,
];
/// As [`GYROSCOPE`].
pub(super) const BLOCK_ACCELEROMETER: [Item; 5] =
    [Item::BlockStaleTime, Item::BlockStuckTime, Item::BlockStuckTimeMoving, Item::BlockFullScale, Item::BlockSaturationTime];
/// As [`GYROSCOPE`].
pub(super) const GROUND_ACCELEROMETER: [Item; 5] = [
    Item::GroundStaleTime,
    Item::GroundStuckTime,
    Item::GroundStuckTimeMoving,
    Item::GroundFullScale,
    Item::GroundSaturationTime,
];

fn monitor(settings: &Settings) -> MonitorParameters {
    let limits = |items: [Item; 5]| {
        let [stale_time, stuck_time, stuck_time_moving, full_scale, saturation_time] = items.map(|item| settings.real(item));
        SensorLimits { stale_time, stuck_time, stuck_time_moving, full_scale, saturation_time }
    };
    MonitorParameters {
        gyroscope: limits(GYROSCOPE),
        block_accelerometer: limits(BLOCK_ACCELEROMETER),
        ground_accelerometer: limits(GROUND_ACCELEROMETER),
        encoder: EncoderLimits {
            stale_time: settings.real(Item::EncoderStaleTime),
            counts_per_radian: settings.real(Item::CountsPerRadian),
            travel: settings.whole(Item::EncoderTravel) as i32,
        },
        contradiction_time: settings.real(Item::ContradictionTime),
        slow_contradiction_time: settings.real(Item::SlowContradictionTime),
        rest_contradiction_time: settings.real(Item::RestContradictionTime),
        rest_tolerance: settings.real(Item::RestTolerance),
        count_tolerance: settings.real(Item::CountTolerance),
        rate_tolerance: settings.real(Item::RateTolerance),
        lever_tolerance: settings.real(Item::LeverTolerance),
        sensor_delay: settings.real(Item::SensorDelay),
        moving_rate: settings.real(Item::MovingRate),
        gravity: settings.real(Item::Gravity),
    }
}
