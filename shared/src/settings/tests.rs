//! Settings are controllers: there and back without losing a bit, and no word without a meaning.

use super::kind::{Description, Kind, Use};
use super::parts::Part;
use super::*;
use crate::control::clutch_position::ClutchLag;
use crate::control::controller::{Circumstances, Controller, Horizons};
use crate::control::estimation::Estimator;
use crate::control::estimation::complementary::Complementary;
use crate::control::estimation::estimate::Deviation;
use crate::control::estimation::kalman::Kalman;
use crate::control::estimation::model_aided::ModelAided;
use crate::control::estimation::rest_detection::Standing;
use crate::control::law::any_law::ClutchLaw;
use crate::control::law::costate::Costate;
use crate::control::law::look_ahead::LookAhead;
use crate::control::law::minimum_dwell::Gate;
use crate::control::model::Model;
use crate::control::monitor::fault::Wheel;
use crate::control::monitor::{EncoderLimits, MonitorParameters, SensorLimits};
use crate::control::sensing::calibration::Plausible;
use crate::control::sensing::instruments::Instruments;
use crate::control::sensing::required::Required;
use crate::control::sensing::sample::{Count, Reading, Sample};
use crate::control::supervisor::{Parameters, Phase, SafeState, Supervisor};
use crate::structure::block::{Block, Geometry};
use crate::structure::device::{Device, DeviceKind, KinematicsKind};
use crate::structure::drivetrain::{Drivetrain, Engagement, FlywheelLosses};
use crate::structure::mount::Mount;
use crate::structure::{Restitution, Structure};
use std::collections::BTreeSet;
use std::string::ToString;
use std::vec::Vec;

/// Every body that settings can name.
const BODIES: [(Geometry, KinematicsKind); 3] = [
    (Geometry::Slender, KinematicsKind::Consistent),
    (Geometry::Full, KinematicsKind::Paper),
    (Geometry::Full, KinematicsKind::Consistent),
];

fn structure((geometry, kinematics): (Geometry, KinematicsKind), mount: Mount) -> Structure {
    Structure {
        geometry,
        device: Device { kind: DeviceKind::ClutchedPair, mass_ratio: 0.5, mount, kinematics },
        ..Structure::new(Block::new(2.0, 10_f64.to_radians(), 4.0 / 3.0).unwrap(), Restitution::Constant(0.85))
    }
}

const DEVIATION: Deviation =
    Deviation { rotation: 3.870_707_4e-7, velocity: 0.000_201_911_05, push: 0.004_891_986, ground: 0.001_329_863 };
const STANDING: Standing = Standing { rotation: 1.265_482_9e-4, velocity: 0.002_215_856, ticks: 40 };
/// What the host solves for 2 kHz with an ICM-42688-P.
const MODEL_AIDED: ModelAided = ModelAided {
    gains: [[0.287_661_64, 2.167_216e-5], [99.620_54, 0.017_028_436]],
    blank: 5,
    jump: 0.033_469_82,
    standing: STANDING,
    deviation: DEVIATION,
};

fn estimators() -> [Estimator; 3] {
    let (standing, deviation) = (Standing { ticks: 41, ..STANDING }, DEVIATION.scaled(1.1));
    let gains = [[0.168, 6.75e-6, 3.44e-8], [31.0, 2.63e-3, 2.5e-4], [15.6, 2.46e-2, 0.991], [-3.04e-3, 8.54e-6, -2.04e-9]];
    [
        Estimator::ModelAided(MODEL_AIDED),
        Estimator::Kalman(Kalman { gains, blank: 6, jump: 0.03, standing, deviation }),
        Estimator::Complementary(Complementary { gains: [0.548, 423.0], smoothing: 0.283, blank: 7, standing, deviation }),
    ]
}

/// How many choices `item` has.
fn choices(item: Item) -> u32 {
    Description::at(item.index()).unwrap().most + 1
}

/// Each that has a name, its parameters different from the defaults.
fn laws() -> Vec<ClutchLaw> {
    let mut settings = Settings::default();
    let reals = [
        (Item::LawThreshold, 0.7),
        (Item::LawStep, 0.11),
        (Item::LawFading, 0.7),
        (Item::LawFadingHalf, 0.8),
        (Item::LawMargin, 0.02_f32),
        (Item::LawRotation, 0.2),
        (Item::LawCurvature, 0.6),
        (Item::LawGround, -0.3),
        (Item::LawDrift, 0.9),
        (Item::LawJolt, 0.5),
        (Item::LawTake, -0.1),
        (Item::LawKeep, 0.1),
    ];
    let wholes = [(Item::LawTable, 0b1001_0110), (Item::LawRow, 3), (Item::LawChosen, 4)];
    for (item, word) in reals.map(|(item, value)| (item, value.to_bits())).into_iter().chain(wholes) {
        settings.set(item.index(), word).unwrap();
    }
    let law = |word| {
        settings.set(Item::Law.index(), word).unwrap();
        Controller::of(&settings).unwrap().law
    };
    (0..choices(Item::Law)).map(law).collect()
}

/// As good as the defaults, and different from them in everything.
fn supervisions() -> [Parameters; 2] {
    let defaults = Parameters::default();
    let limits = |more: f32| SensorLimits {
        stale_time: 0.004 + more,
        stuck_time: 0.006 + more,
        stuck_time_moving: 0.007 + more,
        full_scale: 10.0 + more,
        saturation_time: 0.008 + more,
    };
    // Every field is named, so that a new one is thought of here too.
    let monitor = MonitorParameters {
        gyroscope: limits(0.0),
        block_accelerometer: limits(0.01),
        ground_accelerometer: limits(0.02),
        encoder: EncoderLimits { stale_time: 0.004, counts_per_radian: -398_477.88, travel: 70_000 },
        contradiction_time: 0.01,
        slow_contradiction_time: 0.08,
        rest_contradiction_time: 0.2,
        rest_tolerance: 0.6,
        count_tolerance: 5.0,
        rate_tolerance: 0.03,
        lever_tolerance: 0.3,
        sensor_delay: 0.003,
        moving_rate: 0.03,
        gravity: 9.806_65,
    };
    let other = Parameters {
        period: 0.001,
        monitor,
        required: Required::NONE,
        safe_state: SafeState::Engaged(Wheel::Second),
        both_allowed: true,
        self_test_clutches: false,
        boot_time: 2.0,
        actuator_time: 0.05,
        feedback_time: 0.005,
        stillness_time: 0.2,
        calibration_time: 2.0,
        calibration_patience: 5.0,
        quiet_time: 3.0,
        recover_after: 4.0,
        plausible: Plausible { gyroscope: 0.3, accelerometer: 2.0 },
        shaking: 0.4,
        moving_counts: 3,
        overrun_ticks: 4,
        overrun_limit: 0.003,
        proof_test_interval: 86_400.0,
    };
    [defaults, other]
}

fn controller(structure: &Structure, estimator: Estimator, law: ClutchLaw, p: &Parameters) -> Controller {
    let flywheel = FlywheelLosses { viscous_rate: 0.05, dry_deceleration: 0.3, brake_deceleration: 5.0, drag_rate: 0.0 };
    let drivetrain = Drivetrain { engagement: Engagement::Rigid, flywheel, ..Drivetrain::default() };
    let delay = 5.324_236_549_240_234e-4;
    Controller {
        model: Model::new(structure, &drivetrain).unwrap(),
        instruments: Instruments::new(p.period.into(), 5e-6 / 2.0, [delay, 0.0, delay], 0.0015).unwrap(),
        estimator,
        law,
        horizons: Horizons::of((10.5 / (1.0 / f64::from(p.period)).round()) as f32),
        bands: 1.0,
        engaged_at_rest: true,
        gate: Gate { dwell: 10 },
        lag: ClutchLag::default(),
        supervisor: Supervisor::new(p).unwrap(),
    }
}

/// The full block with the consistent kinematics.
fn example() -> Structure {
    structure(BODIES[2], Mount::CentreOfMass)
}

/// The defaults, with the sensors that the estimator needs, the encoder's counts at half of the block's α, and how long an accelerometer with
/// noise may repeat itself.
fn example_supervision() -> Parameters {
    let structure = example();
    let block = &structure.block;
    let lever = structure.device.mount.lever_at(block, structure.geometry, 0.5 * block.slenderness()).unwrap();
    let monitor = MonitorParameters::default();
    let encoder = EncoderLimits { counts_per_radian: (lever * block.size() / 5e-6) as f32, ..monitor.encoder };
    let noisy = |limits| SensorLimits { stuck_time: 0.0045, stuck_time_moving: 0.0045, ..limits };
    let [block_accelerometer, ground_accelerometer] = [monitor.block_accelerometer, monitor.ground_accelerometer].map(noisy);
    Parameters {
        required: Estimator::ModelAided(MODEL_AIDED).required(),
        monitor: MonitorParameters { encoder, block_accelerometer, ground_accelerometer, ..monitor },
        ..Parameters::default()
    }
}

#[test]
fn the_default_is_the_controller_of_an_example() {
    let estimator = Estimator::ModelAided(MODEL_AIDED);
    let supervision = example_supervision();
    let example = controller(&example(), estimator, ClutchLaw::ResistingPredicted, &supervision);
    let settings = Settings::of(&example, &supervision).unwrap();
    for (item, (&derived, default)) in Item::ALL.into_iter().zip(settings.words().iter().zip(Settings::default().words)) {
        let description = Description::at(item.index()).unwrap();
        assert_eq!(derived, default, "{item:?} is {:?}", description.show(derived).to_string());
    }
    assert_eq!(Controller::of(&Settings::default()), Ok(example));
    let own = |law, first: Item, count: usize| {
        let derived = Settings::of(&Controller { law, ..example }, &supervision).unwrap();
        assert_eq!(derived.words()[first as usize..][..count], settings.words()[first as usize..][..count], "{law:?}");
    };
    own(ClutchLaw::LookAhead(LookAhead::default()), Item::LawStep, 5);
    own(ClutchLaw::Costate(Costate::TRAINED), Item::LawRotation, 7);
}

/// Every body by every estimator, law and supervision, and what `check` makes of its settings.
fn each(mut check: impl FnMut(&Settings, Controller)) {
    let mount = Mount::TyingPoint { height: 1.5, pulley_ratio: 2.0 };
    for supervision in supervisions() {
        for estimator in estimators() {
            let (own, needed) = (supervision.required, estimator.required());
            let required = Required {
                gyroscope: own.gyroscope || needed.gyroscope,
                block_accelerometer: own.block_accelerometer || needed.block_accelerometer,
                ground_accelerometer: own.ground_accelerometer || needed.ground_accelerometer,
                encoder: own.encoder || needed.encoder,
            };
            let supervision = Parameters { required, ..supervision };
            for law in laws() {
                for (index, body) in BODIES.into_iter().enumerate() {
                    let mut made = controller(&structure(body, mount), estimator, law, &supervision);
                    if index == 2 {
                        (made.bands, made.engaged_at_rest, made.gate) = (2.0, false, Gate { dwell: 9 });
                        made.horizons = Horizons { engagement: 0.01, release: 0.004 };
                        made.lag = ClutchLag { closing: 7, opening: 3, closing_time: 0.02 };
                    }
                    check(&Settings::of(&made, &supervision).unwrap(), made);
                }
            }
        }
    }
}

#[test]
fn there_and_back_without_losing_a_bit() {
    let mut count = 0;
    each(|settings, controller| {
        assert_eq!(Controller::of(settings), Ok(controller));
        assert_eq!(Settings::from_words(settings.words()), Ok(*settings));
        count += 1;
    });
    assert_eq!(count, 2 * [Item::Body, Item::Estimator, Item::Law].map(choices).iter().product::<u32>());
}

/// Settings whose parts, each within its range, would leave the block to an estimator that never gets right.
#[test]
fn an_estimator_without_its_sensors_or_that_does_not_forget_is_refused() {
    let with = |settings: &Settings, changes: &[(Item, u32)]| {
        let mut settings = *settings;
        changes.iter().for_each(|&(item, word)| settings.set(item.index(), word).unwrap());
        Controller::of(&settings).map(|_| ())
    };
    let real = |number: f32| number.to_bits();
    let refused = |item| Err(SettingError::contradiction(item, Item::Estimator));
    let default = Settings::default();
    assert_eq!(with(&default, &[]), Ok(()));
    // The Kalman filter as `--set estimator=kalman` makes it: without its sensor, and with it but without the sensor's gains.
    assert_eq!(with(&default, &[(Item::Estimator, 1)]), refused(Item::RequiredBlockAccelerometer));
    let kalman = [(Item::Estimator, 1), (Item::RequiredBlockAccelerometer, 1)];
    assert_eq!(with(&default, &kalman), refused(Item::RotationByEncoder));
    assert_eq!(with(&default, &[(Item::RequiredGyroscope, 0)]), refused(Item::RequiredGyroscope));
    assert_eq!(with(&default, &[(Item::RequiredGroundAccelerometer, 0)]), refused(Item::RequiredGroundAccelerometer));
    assert_eq!(with(&default, &[(Item::RequiredEncoder, 0)]), refused(Item::RequiredEncoder));
    for gain in [-1e12, -0.5, 4.0, 1e12] {
        assert_eq!(with(&default, &[(Item::RotationByEncoder, real(gain))]), refused(Item::RotationByEncoder), "{gain}");
    }
    // Without the encoder's share θ falls away from the truth as the block would.
    let encoder = [(Item::RotationByEncoder, 0), (Item::VelocityByEncoder, 0)];
    assert_eq!(with(&default, &encoder), refused(Item::RotationByEncoder));
    assert_eq!(with(&default, &[(Item::RotationByGyroscope, 0), (Item::VelocityByGyroscope, 0)]), Ok(()));
    each(|settings, _| {
        for (estimator, gain, number) in [
            (0, Item::VelocityByGyroscope, 2.5),
            (1, Item::AccelerationByAccelerometers, 2.5),
            (1, Item::VelocityByGyroscope, 2.5),
            (2, Item::VelocityByEncoder, -1.0),
        ] {
            if settings.whole(Item::Estimator) == estimator {
                assert_eq!(with(settings, &[(gain, real(number))]), refused(Item::RotationByEncoder), "{gain:?}");
            }
        }
        if settings.whole(Item::Estimator) == 2 {
            assert_eq!(with(settings, &[(Item::Smoothing, 0)]), refused(Item::Smoothing));
        }
    });
    let horizon = real(1.1);
    assert_eq!(
        Settings::default().set(Item::Horizon.index(), horizon),
        Err(SettingError::OutOfRange { index: Item::Horizon.index(), word: horizon })
    );
}

/// What is made of a choice that has a name, and is written down, has that name again.
#[test]
fn every_choice_is_itself_again() {
    for (index, description) in (0..).zip(Description::all()) {
        if matches!(description.kind, Kind::Choice(_)) && description.used != Use::Board {
            for word in description.least..=description.most {
                let mut settings = Settings::default();
                if index == Item::Estimator.index() {
                    let estimator = estimators()[word as usize];
                    let supervision = Parameters { required: estimator.required(), ..example_supervision() };
                    let made = controller(&example(), estimator, ClutchLaw::ResistingPredicted, &supervision);
                    settings = Settings::of(&made, &supervision).unwrap();
                }
                settings.set(index, word).unwrap();
                let controller = Controller::of(&settings).unwrap();
                let again = Settings::of(&controller, &Parameters::read(&settings));
                let name = description.show(word);
                assert_eq!(again.map(|again| again.get(index)), Ok(Some(word)), "{}: {name}", description.name);
            }
        }
    }
}

/// Words that a parameter might have instead, all within its range.
fn others(description: &Description, word: u32) -> Vec<u32> {
    let mut candidates = std::vec![word.wrapping_add(1), word.wrapping_sub(1), description.least, description.most];
    if description.kind == Kind::Real {
        let value = f32::from_bits(word);
        candidates.extend([2.0 * value, 0.5 * value, 1.2 * value, value + 1.0, value + 0.01, value - 0.01].map(f32::to_bits));
    }
    candidates.retain(|&candidate| candidate != word);
    candidates
}

#[test]
fn every_word_has_its_effect_or_is_said_to_have_none() {
    each(|settings, controller| {
        for (index, description) in (0..).zip(Description::all()) {
            let word = settings.get(index).unwrap();
            let mut changes = 0;
            for other in others(description, word) {
                let mut changed = *settings;
                if changed.set(index, other).is_ok() {
                    // One that the rest does not allow has an effect, too.
                    changes += usize::from(Controller::of(&changed) != Ok(controller));
                }
            }
            assert_eq!(changes > 0, description.applies(settings), "{} of {controller:?}", description.name);
        }
    });
}

#[test]
fn a_word_outside_its_range_is_refused_and_named() {
    let before = Settings::default();
    for (index, description) in (0..).zip(Description::all()) {
        let mut settings = before;
        for word in [description.least, description.most, description.default] {
            assert_eq!(settings.set(index, word), Ok(()), "{}", description.name);
        }
        assert_eq!(settings, before, "the default");
        let beyond = match description.kind {
            Kind::Real => std::vec![
                f32::NAN.to_bits(),
                f32::INFINITY.to_bits(),
                f32::NEG_INFINITY.to_bits(),
                f32::from_bits(description.most).next_up().to_bits(),
                f32::from_bits(description.least).next_down().to_bits(),
            ],
            _ => [description.most.checked_add(1), description.least.checked_sub(1)].into_iter().flatten().collect(),
        };
        for word in beyond {
            let error = SettingError::OutOfRange { index, word };
            assert_eq!(settings.set(index, word), Err(error));
            assert_eq!(settings, before);
            let mut words = *before.words();
            words[usize::from(index)] = word;
            assert_eq!(Settings::from_words(&words), Err(error));
            let line = error.describe(&settings).to_string();
            assert!(line.starts_with(description.name) && line.contains("must be"), "{line}");
        }
    }
    let index = COUNT as u16;
    assert_eq!((before.get(index), before.clone().set(index, 0)), (None, Err(SettingError::NoSuch { index })));
}

#[test]
fn names_are_unlike_each_other_and_words_print_as_they_read() {
    let names: BTreeSet<&str> = Description::all().iter().map(|description| description.name).collect();
    assert_eq!(names.len(), COUNT);
    for (index, description) in (0..).zip(Description::all()) {
        assert_eq!(Description::find(description.name), Some((index, description)));
        assert!(description.name.bytes().all(|letter| matches!(letter, b'a'..=b'z' | b'_' | b'.')));
        for word in [description.least, description.most, description.default] {
            assert_eq!(description.parse(&description.show(word).to_string()), Some(word), "{}", description.name);
        }
    }
    assert_eq!(Description::find("model.colour"), None);
}

#[test]
fn contradictions_are_found_and_named() {
    let cases: [(Item, f32, Item, &str); 5] = [
        (Item::CalibrationPatience, 1.0, Item::CalibrationTime, "supervisor.calibration_patience is 1, but must be above"),
        (Item::ContradictionTime, 0.003, Item::Period, "monitor.contradiction_time is 0.003, but must be at least eight"),
        (Item::SlowContradictionTime, 0.0039, Item::ContradictionTime, "monitor.slow_contradiction_time is 0.0039, but must"),
        (Item::FrequencySquared, 3.6, Item::Frequency, "model.frequency_squared is 3.6, but must be the square of"),
        (Item::LeverAcross, -6.0, Item::LeverAlong, "body.lever_across is -6, but must be"),
    ];
    for (item, value, other, beginning) in cases {
        let mut settings = Settings::default();
        settings.set(item.index(), value.to_bits()).unwrap();
        let error = Controller::of(&settings).unwrap_err();
        assert_eq!(error, SettingError::contradiction(item, other));
        let line = error.describe(&settings).to_string();
        assert!(line.starts_with(beginning), "{line}");
    }
}

#[test]
fn a_controller_that_contradicts_itself_cannot_be_recorded() {
    let p = Parameters::default();
    let good = controller(&structure(BODIES[1], Mount::CentreOfMass), Estimator::ModelAided(MODEL_AIDED), ClutchLaw::Passive, &p);
    assert!(Settings::of(&good, &p).is_ok());
    assert_eq!(Settings::of(&good, &Parameters { shaking: 0.5, ..p }), Err(SettingError::NotRepresentable));
    let other_tick = Parameters { period: 0.000_4, ..p };
    assert_eq!(Settings::of(&good, &other_tick), Err(SettingError::NotRepresentable));
    let unsound = Controller { bands: f32::NAN, ..good };
    assert!(matches!(Settings::of(&unsound, &p), Err(SettingError::OutOfRange { index, .. }) if index == Item::Bands.index()));
    let negative = Parameters { moving_counts: -1, ..p };
    assert!(matches!(Settings::of(&good, &negative), Err(SettingError::OutOfRange { .. })));
}

/// Ranges are never wider than what the core accepts, so that a controller of settings is one that it could have made.
#[test]
fn what_settings_allow_the_supervisor_accepts() {
    for (index, description) in (0..).zip(Description::all()) {
        for word in [description.least, description.most] {
            let mut settings = Settings::default();
            settings.set(index, word).unwrap();
            let accepted = Supervisor::new(&Parameters::read(&settings));
            if Controller::of(&settings).is_ok() {
                assert!(accepted.is_ok(), "{}: {accepted:?}", description.name);
            }
        }
    }
}

/// The same controller decides the same, whoever made it.
#[test]
fn a_controller_of_settings_ticks_as_the_one_that_was_recorded() {
    let mut p = example_supervision();
    // Its readings repeat themselves.
    let monitor = &mut p.monitor;
    for limits in [&mut monitor.gyroscope, &mut monitor.block_accelerometer, &mut monitor.ground_accelerometer] {
        (limits.stuck_time, limits.stuck_time_moving) = (0.0, 0.0);
    }
    let made = controller(&example(), estimators()[0], ClutchLaw::LookAhead(LookAhead::default()), &p);
    let read = Controller::of(&Settings::of(&made, &p).unwrap()).unwrap();
    let (mut first, mut second) = (made.start(), read.start());
    let (mut rocked, mut engaged) = (false, [false; 2]);
    for number in 1..12_000_u32 {
        let rate = if number > 8000 { 0.3 } else { 0.0 };
        let reading = |value| Reading { value, number };
        let sample = Sample {
            gyroscope: reading(rate),
            block_accelerometer: [reading(0.0), reading(9.806_65)],
            ground_accelerometer: [reading(0.1 * rate), reading(9.806_65)],
            encoder: Count { counts: (number.saturating_sub(8000) as f32 * 59.77) as i32, number },
            engaged,
        };
        let (one, other) =
            (made.tick(&mut first, &sample, Circumstances::default()), read.tick(&mut second, &sample, Circumstances::default()));
        assert_eq!(one, other, "{number}");
        engaged = one.command;
        rocked |= one.phase == Phase::Rocking;
    }
    assert!(rocked && first.supervisor() == second.supervisor());
    assert_eq!(read.instruments.period, 0.0005);
}

#[test]
fn only_the_board_reads_its_own() {
    for description in Description::all() {
        assert_eq!(description.name.starts_with("board."), description.used == Use::Board, "{}", description.name);
    }
}
