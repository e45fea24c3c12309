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
use crate::control::law::minimum_dwell::Gate;
use crate::control::law::{GatedTable, SignTable};
use crate::control::model::{Model, ModelParameters};
use crate::control::monitor::fault::Wheel;
use crate::control::monitor::{EncoderLimits, MonitorParameters, SensorLimits};
use crate::control::sensing::calibration::Plausible;
use crate::control::sensing::instruments::Instruments;
use crate::control::sensing::required::Required;
use crate::control::supervisor::{Parameters, SafeState};

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
        supervision: &Parameters,
    ) -> Result<Settings, SettingError> {
        let mut draft = Draft { words: DEFAULTS };
        // Whatever is put down is taken apart whole, here and below: a field that is forgotten does not compile.
        let Controller { model, instruments, estimator, law, horizon, bands, engaged_at_rest, gate, supervisor: _ } = controller;
        let Gate { dwell } = *gate;
        put_model(&mut draft, model);
        put_instruments(&mut draft, instruments);
        put_estimator(&mut draft, estimator);
        put_law(&mut draft, law);
        draft.real(Item::Horizon, *horizon);
        draft.real(Item::Bands, *bands);
        draft.switch(Item::EngagedAtRest, *engaged_at_rest);
        draft.word(Item::Dwell, dwell.into());
        put_supervision(&mut draft, supervision);
        let settings = Settings::from_words(&draft.words)?;
        if self::controller::<B>(&settings)? == *controller && self::supervision(&settings) == *supervision {
            Ok(settings)
        } else {
            Err(SettingError::NotRepresentable)
        }
    }
}

fn put_model<B: SettingsBody>(draft: &mut Draft, model: &Model<B>) {
    let ModelParameters {
        frequency,
        frequency_squared,
        slenderness,
        size,
        restitution,
        uplift,
        coupling,
        wheels_spin,
        decay,
        drag,
        stops_at_once,
    } = model.parameters;
    draft.word(Item::Body, model.body.choice());
    model.body.put(draft);
    draft.reals(&[
        (Item::Frequency, frequency),
        (Item::FrequencySquared, frequency_squared),
        (Item::Slenderness, slenderness),
        (Item::Size, size),
        (Item::Restitution, restitution),
        (Item::Uplift, uplift),
        (Item::Coupling, coupling),
        (Item::Decay, decay),
        (Item::Drag, drag),
    ]);
    draft.switch(Item::WheelsSpin, wheels_spin);
    draft.switch(Item::StopsAtOnce, stops_at_once);
}

fn put_instruments(draft: &mut Draft, instruments: &Instruments) {
    let Instruments {
        period,
        travel_per_count,
        gyroscope_delay,
        encoder_delay,
        ground_delay,
        gains: [value, growth],
        period_inverse: _,
    } = *instruments;
    draft.reals(&[
        (Item::Period, period),
        (Item::TravelPerCount, travel_per_count),
        (Item::GyroscopeDelay, gyroscope_delay),
        (Item::EncoderDelay, encoder_delay),
        (Item::GroundDelay, ground_delay),
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

fn put_supervision(draft: &mut Draft, parameters: &Parameters) {
    let Parameters {
        // Of the instruments too.
        period: _,
        monitor,
        required,
        safe_state,
        both_allowed,
        self_test_clutches,
        boot_time,
        actuator_time,
        feedback_time,
        stillness_time,
        calibration_time,
        calibration_patience,
        quiet_time,
        recover_after,
        plausible,
        shaking,
        moving_counts,
        overrun_ticks,
        overrun_limit,
    } = *parameters;
    let Required { gyroscope, block_accelerometer, ground_accelerometer, encoder } = required;
    let Plausible { gyroscope: plausible_gyroscope, accelerometer: plausible_accelerometer } = plausible;
    let safe_state = match safe_state {
        SafeState::Released => 0,
        SafeState::Engaged(Wheel::First) => 1,
        SafeState::Engaged(Wheel::Second) => 2,
    };
    draft.word(Item::SafeState, safe_state);
    draft.switch(Item::RequiredGyroscope, gyroscope);
    draft.switch(Item::RequiredBlockAccelerometer, block_accelerometer);
    draft.switch(Item::RequiredGroundAccelerometer, ground_accelerometer);
    draft.switch(Item::RequiredEncoder, encoder);
    draft.switch(Item::BothAllowed, both_allowed);
    draft.switch(Item::SelfTestClutches, self_test_clutches);
    // A negative number becomes one that is refused.
    draft.word(Item::MovingCounts, moving_counts as u32);
    draft.word(Item::OverrunTicks, overrun_ticks);
    draft.reals(&[
        (Item::BootTime, boot_time),
        (Item::ActuatorTime, actuator_time),
        (Item::FeedbackTime, feedback_time),
        (Item::StillnessTime, stillness_time),
        (Item::CalibrationTime, calibration_time),
        (Item::CalibrationPatience, calibration_patience),
        (Item::QuietTime, quiet_time),
        (Item::RecoverAfter, recover_after),
        (Item::PlausibleGyroscope, plausible_gyroscope),
        (Item::PlausibleAccelerometer, plausible_accelerometer),
        (Item::Shaking, shaking),
        (Item::OverrunLimit, overrun_limit),
    ]);
    put_monitor(draft, &monitor);
}

fn put_monitor(draft: &mut Draft, monitor: &MonitorParameters) {
    let MonitorParameters {
        gyroscope,
        block_accelerometer,
        ground_accelerometer,
        encoder,
        contradiction_time,
        slow_contradiction_time,
        rest_contradiction_time,
        rest_tolerance,
        count_tolerance,
        rate_tolerance,
        lever_tolerance,
        sensor_delay,
        moving_rate,
        gravity,
    } = *monitor;
    for (items, limits) in
        [(GYROSCOPE, gyroscope), (BLOCK_ACCELEROMETER, block_accelerometer), (GROUND_ACCELEROMETER, ground_accelerometer)]
    {
        let SensorLimits { stale_time, stuck_time, stuck_time_moving, full_scale, saturation_time } = limits;
        for (item, value) in items.into_iter().zip([stale_time, stuck_time, stuck_time_moving, full_scale, saturation_time]) {
            draft.real(item, value);
        }
    }
    let EncoderLimits { stale_time, counts_per_radian, travel } = encoder;
    draft.word(Item::EncoderTravel, travel as u32);
    draft.reals(&[
        (Item::EncoderStaleTime, stale_time),
        (Item::CountsPerRadian, counts_per_radian),
        (Item::ContradictionTime, contradiction_time),
        (Item::SlowContradictionTime, slow_contradiction_time),
        (Item::RestContradictionTime, rest_contradiction_time),
        (Item::RestTolerance, rest_tolerance),
        (Item::CountTolerance, count_tolerance),
        (Item::RateTolerance, rate_tolerance),
        (Item::LeverTolerance, lever_tolerance),
        (Item::SensorDelay, sensor_delay),
        (Item::MovingRate, moving_rate),
        (Item::Gravity, gravity),
    ]);
}
