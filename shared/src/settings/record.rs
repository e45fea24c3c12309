//! From a controller to the settings that describe it.

use super::assemble::{BLOCK_ACCELEROMETER, GAINS, GROUND_ACCELEROMETER, GYROSCOPE, SettingsBody, controller, supervision};
use super::limits::DEFAULTS;
use super::{COUNT, Item, SettingError, Settings};
use crate::control::controller::Controller;
use crate::control::estimation::Estimator;
use crate::control::estimation::complementary::Complementary;
use crate::control::estimation::estimate::Deviation;
use crate::control::estimation::kalman::Kalman;
use crate::control::estimation::model_aided::ModelAided;
use crate::control::estimation::rest_detection::Standing;
use crate::control::law::any_law::ClutchLaw;
use crate::control::law::look_ahead::LookAhead;
use crate::control::law::{GatedTable, SignTable};
use crate::control::model::Model;
use crate::control::monitor::fault::Wheel;
use crate::control::monitor::{EncoderLimits, MonitorParameters, SensorLimits};
use crate::control::sensing::instruments::Instruments;
use crate::control::supervisor::{self, SafeState};

/// Words that nobody has checked yet; the defaults where nothing is put.
pub struct Draft {
    words: [u32; COUNT],
}

impl Draft {
    pub(super) fn word(&mut self, item: Item, word: u32) {
        if let Some(place) = self.words.get_mut(usize::from(item.index())) {
            *place = word;
        }
    }

    pub(super) fn real(&mut self, item: Item, value: f32) {
        self.word(item, value.to_bits());
    }

    fn reals(&mut self, pairs: &[(Item, f32)]) {
        for &(item, value) in pairs {
            self.real(item, value);
        }
    }

    fn switch(&mut self, item: Item, value: bool) {
        self.word(item, value.into());
    }
}

impl Settings {
    /// The settings of `controller`, whose supervisor was made from `supervision`. What it does not read, and what only the board reads,
    /// is as in [`Settings::default`].
    ///
    /// # Errors
    /// [`SettingError`] for a number that no setting can be, or a controller whose parts contradict each other.
    pub fn of<B: SettingsBody>(
        controller: &Controller<B, ClutchLaw>,
        supervision: &supervisor::Parameters,
    ) -> Result<Settings, SettingError> {
        let mut draft = Draft { words: DEFAULTS };
        draft.word(Item::Body, controller.model.body.choice());
        put_model(&mut draft, &controller.model);
        put_instruments(&mut draft, &controller.instruments);
        put_estimator(&mut draft, &controller.estimator);
        put_law(&mut draft, &controller.law);
        draft.real(Item::Horizon, controller.horizon);
        draft.real(Item::Bands, controller.bands);
        draft.switch(Item::EngagedAtRest, controller.engaged_at_rest);
        draft.word(Item::Dwell, controller.gate.dwell.into());
        put_supervision(&mut draft, supervision);
        put_monitor(&mut draft, &supervision.monitor);
        let settings = Settings::from_words(&draft.words)?;
        if self::controller::<B>(&settings)? == *controller && self::supervision(&settings) == *supervision {
            Ok(settings)
        } else {
            Err(SettingError::NotRepresentable)
        }
    }
}

fn put_model<B: SettingsBody>(draft: &mut Draft, model: &Model<B>) {
    model.body.put(draft);
    draft.reals(&[
        (Item::Frequency, model.parameters.frequency),
        (Item::FrequencySquared, model.parameters.frequency_squared),
        (Item::Slenderness, model.parameters.slenderness),
        (Item::Size, model.parameters.size),
        (Item::Restitution, model.parameters.restitution),
        (Item::Uplift, model.parameters.uplift),
        (Item::Coupling, model.parameters.coupling),
        (Item::Decay, model.parameters.decay),
        (Item::Drag, model.parameters.drag),
    ]);
    draft.switch(Item::WheelsSpin, model.parameters.wheels_spin);
    draft.switch(Item::StopsAtOnce, model.parameters.stops_at_once);
}

fn put_instruments(draft: &mut Draft, instruments: &Instruments) {
    let [value, growth] = instruments.gains();
    draft.reals(&[
        (Item::Period, instruments.period),
        (Item::TravelPerCount, instruments.travel_per_count),
        (Item::GyroscopeDelay, instruments.gyroscope_delay),
        (Item::EncoderDelay, instruments.encoder_delay),
        (Item::GroundDelay, instruments.ground_delay),
        (Item::TrackingValue, value),
        (Item::TrackingGrowth, growth),
    ]);
}

fn put_estimator(draft: &mut Draft, estimator: &Estimator) {
    let (choice, gains, blank, standing, deviation) = match *estimator {
        Estimator::ModelAided(ModelAided { gains: [[a, b], [c, d]], blank, jump, standing, deviation }) => {
            draft.real(Item::Jump, jump);
            draft.real(Item::RotationByGyroscope, b);
            draft.real(Item::VelocityByGyroscope, d);
            (0, [a, c], blank, standing, deviation)
        }
        Estimator::Kalman(Kalman { gains, blank, jump, standing, deviation }) => {
            draft.real(Item::Jump, jump);
            for (item, gain) in GAINS.as_flattened().iter().zip(gains.as_flattened()) {
                draft.real(*item, *gain);
            }
            let [[rotation, ..], [velocity, ..], ..] = gains;
            (1, [rotation, velocity], blank, standing, deviation)
        }
        Estimator::Complementary(Complementary { gains, smoothing, blank, standing, deviation }) => {
            draft.real(Item::Smoothing, smoothing);
            (2, gains, blank, standing, deviation)
        }
    };
    let Standing { rotation, velocity, ticks } = standing;
    let Deviation { rotation: of_rotation, velocity: of_velocity, push, ground } = deviation;
    let [rotation_by_encoder, velocity_by_encoder] = gains;
    draft.word(Item::Estimator, choice);
    draft.word(Item::Blank, blank.into());
    draft.word(Item::StandingTicks, ticks.into());
    draft.reals(&[
        (Item::RotationByEncoder, rotation_by_encoder),
        (Item::VelocityByEncoder, velocity_by_encoder),
        (Item::StandingRotation, rotation),
        (Item::StandingVelocity, velocity),
        (Item::DeviationRotation, of_rotation),
        (Item::DeviationVelocity, of_velocity),
        (Item::DeviationPush, push),
        (Item::DeviationGround, ground),
    ]);
}

fn put_law(draft: &mut Draft, law: &ClutchLaw) {
    let mut gated = |GatedTable { table, row, threshold }: GatedTable| {
        draft.word(Item::LawTable, table.into());
        draft.word(Item::LawRow, row.into());
        draft.real(Item::LawThreshold, threshold);
    };
    let choice = match *law {
        ClutchLaw::Passive => 0,
        ClutchLaw::AlwaysEngaged => 1,
        ClutchLaw::Resisting => 2,
        ClutchLaw::ResistingPredicted => 3,
        ClutchLaw::SignTable(SignTable(table)) => {
            draft.word(Item::LawTable, table.into());
            4
        }
        ClutchLaw::GatedTable(table) => {
            gated(table);
            5
        }
        ClutchLaw::LookAhead(LookAhead { step, chosen, fading, fading_half, margin, base }) => {
            gated(base);
            draft.word(Item::LawChosen, chosen.into());
            draft.reals(&[
                (Item::LawStep, step),
                (Item::LawFading, fading),
                (Item::LawFadingHalf, fading_half),
                (Item::LawMargin, margin),
            ]);
            6
        }
    };
    draft.word(Item::Law, choice);
}

fn put_supervision(draft: &mut Draft, parameters: &supervisor::Parameters) {
    let safe_state = match parameters.safe_state {
        SafeState::Released => 0,
        SafeState::Engaged(Wheel::First) => 1,
        SafeState::Engaged(Wheel::Second) => 2,
    };
    draft.word(Item::SafeState, safe_state);
    draft.switch(Item::RequiredGyroscope, parameters.required.gyroscope);
    draft.switch(Item::RequiredBlockAccelerometer, parameters.required.block_accelerometer);
    draft.switch(Item::RequiredGroundAccelerometer, parameters.required.ground_accelerometer);
    draft.switch(Item::RequiredEncoder, parameters.required.encoder);
    draft.switch(Item::BothAllowed, parameters.both_allowed);
    draft.switch(Item::SelfTestClutches, parameters.self_test_clutches);
    // A negative number becomes one that is refused.
    draft.word(Item::MovingCounts, parameters.moving_counts as u32);
    draft.word(Item::OverrunTicks, parameters.overrun_ticks);
    draft.reals(&[
        (Item::BootTime, parameters.boot_time),
        (Item::ActuatorTime, parameters.actuator_time),
        (Item::FeedbackTime, parameters.feedback_time),
        (Item::StillnessTime, parameters.stillness_time),
        (Item::CalibrationTime, parameters.calibration_time),
        (Item::CalibrationPatience, parameters.calibration_patience),
        (Item::QuietTime, parameters.quiet_time),
        (Item::RecoverAfter, parameters.recover_after),
        (Item::PlausibleGyroscope, parameters.plausible.gyroscope),
        (Item::PlausibleAccelerometer, parameters.plausible.accelerometer),
        (Item::Shaking, parameters.shaking),
        (Item::OverrunLimit, parameters.overrun_limit),
    ]);
}

fn put_monitor(draft: &mut Draft, monitor: &MonitorParameters) {
    for (items, limits) in [
        (GYROSCOPE, &monitor.gyroscope),
        (BLOCK_ACCELEROMETER, &monitor.block_accelerometer),
        (GROUND_ACCELEROMETER, &monitor.ground_accelerometer),
    ] {
        let SensorLimits { stale_time, stuck_time, stuck_time_moving, full_scale, saturation_time } = *limits;
        for (item, value) in items.into_iter().zip([stale_time, stuck_time, stuck_time_moving, full_scale, saturation_time]) {
            draft.real(item, value);
        }
    }
    let EncoderLimits { stale_time, counts_per_radian, travel } = monitor.encoder;
    draft.word(Item::EncoderTravel, travel as u32);
    draft.reals(&[
        (Item::EncoderStaleTime, stale_time),
        (Item::CountsPerRadian, counts_per_radian),
        (Item::ContradictionTime, monitor.contradiction_time),
        (Item::SlowContradictionTime, monitor.slow_contradiction_time),
        (Item::RestContradictionTime, monitor.rest_contradiction_time),
        (Item::RestTolerance, monitor.rest_tolerance),
        (Item::CountTolerance, monitor.count_tolerance),
        (Item::RateTolerance, monitor.rate_tolerance),
        (Item::LeverTolerance, monitor.lever_tolerance),
        (Item::SensorDelay, monitor.sensor_delay),
        (Item::MovingRate, monitor.moving_rate),
        (Item::Gravity, monitor.gravity),
    ]);
}
