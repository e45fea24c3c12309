//! From settings to the controller that they describe, and back.
//!
//! Every range has been checked word by word, so only what takes two words is left to check here, and no error has a text.

use super::parts::{Draft, Part, Place};
use super::{Item, SettingError, Settings, stability};
use crate::control::controller::Controller;
use crate::control::estimation::Estimator;
use crate::control::model::Model;
use crate::control::monitor::FEWEST_WINDOW_TICKS;
use crate::control::sensing::instruments::Instruments;
use crate::control::supervisor::{Parameters, Supervisor};
use crate::control::ticks::ticks;
use crate::equation::body::Body;

/// By which p² may differ from the square of p, relative to it: some roundings of single precision.
const ROUNDING: f32 = 1e-6;

impl Controller {
    /// The controller that `settings` describe.
    ///
    /// # Errors
    /// [`SettingError::Contradiction`] names the first two parameters that do not go together.
    pub fn of(settings: &Settings) -> Result<Controller, SettingError> {
        let model = Model::read(settings);
        let square = model.parameters.frequency * model.parameters.frequency;
        if (square - model.parameters.frequency_squared).abs() > ROUNDING * square {
            return Err(SettingError::contradiction(Item::FrequencySquared, Item::Frequency));
        }
        // Where the rack does not move with the block the encoder says nothing.
        if model.body.arm(&model.body.configuration(1.0, 0.0)) <= 0.0 {
            return Err(SettingError::contradiction(Item::LeverAcross, Item::LeverAlong));
        }
        let (instruments, estimator) = (Part::read(settings), Part::read(settings));
        check_estimator(&estimator, &instruments, square, settings)?;
        Ok(Controller {
            model,
            instruments,
            estimator,
            law: Part::read(settings),
            horizons: Part::read(settings),
            bands: Item::Bands.read(settings),
            engaged_at_rest: Item::EngagedAtRest.read(settings),
            gate: Part::read(settings),
            lag: Part::read(settings),
            supervisor: supervisor(settings)?,
        })
    }
}

/// What it needs must be required, and its gains must make it forget its errors.
fn check_estimator(
    estimator: &Estimator,
    instruments: &Instruments,
    square: f32,
    settings: &Settings,
) -> Result<(), SettingError> {
    let required =
        [Item::RequiredGyroscope, Item::RequiredBlockAccelerometer, Item::RequiredGroundAccelerometer, Item::RequiredEncoder];
    for (item, needed) in required.into_iter().zip(estimator.required().flags()) {
        if needed && !settings.switch(item) {
            return Err(SettingError::contradiction(item, Item::Estimator));
        }
    }
    if let Estimator::Complementary(estimator) = estimator
        && estimator.smoothing == 0.0
    {
        // No reading of the accelerometers would ever count.
        return Err(SettingError::contradiction(Item::Smoothing, Item::Estimator));
    }
    if !stability::forgets(estimator, instruments, square) {
        return Err(SettingError::contradiction(Item::RotationByEncoder, Item::Estimator));
    }
    Ok(())
}

fn supervisor(settings: &Settings) -> Result<Supervisor, SettingError> {
    let parameters = Parameters::read(settings);
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

impl Settings {
    /// The settings of `controller`, whose supervisor was made from `supervision`. What it does not read, and what only the board reads,
    /// is as in [`Settings::default`].
    ///
    /// # Errors
    /// [`SettingError`] for a number that no setting can be, or a controller whose parts contradict each other.
    pub fn of(controller: &Controller, supervision: &Parameters) -> Result<Settings, SettingError> {
        let settings = Settings::written(controller, supervision)?;
        if Controller::of(&settings)? == *controller && Parameters::read(&settings) == *supervision {
            Ok(settings)
        } else {
            Err(SettingError::NotRepresentable)
        }
    }

    /// The settings of `controller` as by [`Settings::of`], whether or not they contradict each other.
    ///
    /// # Errors
    /// [`SettingError`] for a number that no setting can be.
    pub fn written(controller: &Controller, supervision: &Parameters) -> Result<Settings, SettingError> {
        let mut draft = Draft::new();
        // Taken apart whole: a field that is forgotten does not compile.
        let Controller { model, instruments, estimator, law, horizons, bands, engaged_at_rest, gate, lag, supervisor: _ } =
            controller;
        // The period is that of the instruments, which come later.
        supervision.put(&mut draft);
        model.put(&mut draft);
        instruments.put(&mut draft);
        estimator.put(&mut draft);
        law.put(&mut draft);
        gate.put(&mut draft);
        horizons.put(&mut draft);
        Item::Bands.put(bands, &mut draft);
        lag.put(&mut draft);
        Item::EngagedAtRest.put(engaged_at_rest, &mut draft);
        Settings::from_words(&draft.words)
    }
}
