//! What every estimator must do: find the motion, survive impacts and shocks, know when the block stands, never leave the finite numbers.

use std::vec::Vec;

use super::example_model;
use crate::control::estimation::complementary::Complementary;
use crate::control::estimation::estimate::{Deviation, Estimate};
use crate::control::estimation::kalman::Kalman;
use crate::control::estimation::model_aided::ModelAided;
use crate::control::estimation::rest_detection::Standing;
use crate::control::estimation::{Estimator, EstimatorState};
use crate::control::sensing::calibration::Calibration;
use crate::control::sensing::instruments::{Instruments, InstrumentsState};
use crate::control::sensing::sample::{Count, Reading, Sample};
use crate::math;
use crate::structure::block::GRAVITY;

const PERIOD: f64 = 5e-4;
/// Travel over R in a count.
const COUNT: f64 = 5e-7;

const DEVIATION: Deviation = Deviation { rotation: 1e-6, velocity: 5e-4, push: 5e-3, ground: 1e-3 };
const STANDING: Standing = Standing { rotation: 5e-6, velocity: 3e-3, ticks: 40 };

/// Gains of the steady state for an ICM-42688-P at 2 kHz, rounded (`sim-host/src/closed_loop/design.rs`).
fn estimators() -> [(&'static str, Estimator); 3] {
    let standing = STANDING;
    let deviation = DEVIATION;
    let model_aided = ModelAided { gains: [[0.288, 2.17e-5], [99.6, 0.017]], blank: 5, jump: 0.0335, standing, deviation };
    let kalman = Kalman {
        gains: [[0.168, 6.75e-6, 3.44e-8], [31.0, 2.63e-3, 2.5e-4], [15.6, 2.46e-2, 0.991], [-3.04e-3, 8.54e-6, -2.04e-9]],
        blank: 5,
        jump: 0.0335,
        standing,
        deviation,
    };
    let complementary = Complementary { gains: [0.548, 423.0], smoothing: 0.283, blank: 5, standing, deviation };
    [
        ("model-aided", Estimator::ModelAided(model_aided)),
        ("kalman", Estimator::Kalman(kalman)),
        ("complementary", Estimator::Complementary(complementary)),
    ]
}

/// The true motion at one tick.
#[derive(Clone, Copy)]
struct Truth {
    rotation: f64,
    velocity: f64,
    acceleration: f64,
    ground: f64,
    since_impact: f64,
    jump: f64,
}

/// A block of 10° and R = 2 m under one cycle of a sine of the ground (in g), in double precision, in steps far below the period.
fn motion(amplitude: f64, frequency: f64, duration: f64) -> Vec<Truth> {
    let (alpha, p2, eta) = (10_f64.to_radians(), 3.0 * GRAVITY / 8.0, 0.85);
    let (mut theta, mut omega, mut side, mut since, mut jump) = (0.0_f64, 0.0_f64, 1.0_f64, f64::INFINITY, 0.0);
    let fine = 50;
    let h = PERIOD / f64::from(fine);
    let shake = |time: f64| {
        let phase = frequency * (time - 1.0);
        if (0.0..core::f64::consts::TAU).contains(&phase) { amplitude * math::sin(phase) } else { 0.0 }
    };
    let mut all = Vec::new();
    for tick in 0..(duration / PERIOD) as u32 {
        let mut acceleration = 0.0;
        for part in 0..fine {
            let time = f64::from(tick) * PERIOD + f64::from(part) * h;
            let ground = shake(time);
            let moving = theta != 0.0 || omega != 0.0;
            if !moving && ground.abs() <= math::tan(alpha) {
                continue;
            }
            if !moving {
                side = -ground.signum();
            }
            let delta = alpha * side - theta;
            acceleration = -p2 * (math::sin(delta) + ground * math::cos(delta));
            omega += h * acceleration;
            theta += h * omega;
            since += h;
            if theta * side < 0.0 {
                jump = (eta - 1.0) * omega;
                omega *= eta;
                side = omega.signum();
                since = 0.0;
                if omega.abs() < 1e-4 {
                    (theta, omega, acceleration) = (0.0, 0.0, 0.0);
                }
            }
        }
        let time = f64::from(tick + 1) * PERIOD;
        let ground = shake(time);
        if theta != 0.0 {
            let delta = alpha * side - theta;
            acceleration = -p2 * (math::sin(delta) + ground * math::cos(delta));
        }
        all.push(Truth { rotation: theta, velocity: omega, acceleration, ground, since_impact: since, jump });
    }
    all
}

/// What sensors make of it: noise of `noise` times an ICM-42688-P's, and a shock of 1 ms after every impact.
fn sample(truth: &Truth, number: u32, noise: f64, dice: &mut u32) -> Sample {
    let mut roll = |size: f64| {
        *dice = dice.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        noise * size * (f64::from(*dice >> 8) / f64::from(1 << 23) - 1.0) * 1.732
    };
    let (alpha, size) = (10_f64.to_radians(), 2.0);
    let side = if truth.rotation < 0.0 { -1.0 } else { 1.0 };
    let delta = alpha * side - truth.rotation;
    let (s, c) = (math::sin(delta), math::cos(delta));
    let shock = if truth.since_impact < 0.001 { truth.jump / 0.001 } else { 0.0 };
    let acceleration = truth.acceleration + shock;
    let horizontal = truth.ground * GRAVITY + size * (c * acceleration + s * truth.velocity * truth.velocity);
    let vertical = GRAVITY + size * (s * acceleration - c * truth.velocity * truth.velocity);
    let (st, ct) = (math::sin(truth.rotation), math::cos(truth.rotation));
    let travel = side * math::sin(alpha) - s;
    let reading = |value: f64| Reading { value: value as f32, number };
    Sample {
        gyroscope: reading(truth.velocity + roll(1.2e-3)),
        block_accelerometer: [
            reading(horizontal * ct - vertical * st + roll(0.017)),
            reading(horizontal * st + vertical * ct + roll(0.017)),
        ],
        ground_accelerometer: [reading(truth.ground * GRAVITY + roll(0.017)), reading(GRAVITY + roll(0.017))],
        encoder: Count { counts: (travel / COUNT) as i32, number },
        engaged: [false; 2],
    }
}

fn run(estimator: &Estimator, truths: &[Truth], noise: f64, look: impl FnMut(&Truth, &Estimate)) {
    run_mounted(estimator, truths, noise, [[0.0; 2]; 2], look);
}

/// With the block's accelerometer at one place, (x, y) from the centre of mass, and believed to be at another.
fn run_mounted(
    estimator: &Estimator,
    truths: &[Truth],
    noise: f64,
    [place, believed]: [[f32; 2]; 2],
    mut look: impl FnMut(&Truth, &Estimate),
) {
    let model = example_model();
    let centred = Instruments::new(PERIOD, COUNT, [0.0; 3], 0.0015).unwrap();
    let instruments = Instruments { block_position: believed, ..centred };
    let (mut state, mut reading, mut dice) = (EstimatorState::default(), InstrumentsState::default(), 1);
    for (number, truth) in truths.iter().enumerate() {
        let mut sample = sample(truth, number as u32 + 1, noise, &mut dice);
        let shock = if truth.since_impact < 0.001 { truth.jump / 0.001 } else { 0.0 };
        let (turning, squared) = ((truth.acceleration + shock) as f32, (truth.velocity * truth.velocity) as f32);
        sample.block_accelerometer[0].value += place[1] * turning - place[0] * squared;
        sample.block_accelerometer[1].value -= place[0] * turning + place[1] * squared;
        let seen = instruments.read(&mut reading, &sample, &Calibration::default());
        look(truth, &estimator.step(&mut state, &model, &instruments, &seen, 0));
    }
}

#[test]
fn the_motion_is_found_through_noise_and_impacts() {
    let truths = motion(0.25, 7.0, 8.0);
    let impacts = truths.iter().filter(|truth| truth.since_impact < PERIOD).count();
    assert!(impacts >= 6, "{impacts}");
    for (name, estimator) in estimators() {
        for noise in [0.0, 1.0] {
            let (mut rotation, mut velocity, mut wrong, mut weight) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
            run(&estimator, &truths, noise, |truth, estimate| {
                rotation = rotation.max((f64::from(estimate.rotation) - truth.rotation).abs());
                if truth.since_impact > 0.01 {
                    velocity = velocity.max((f64::from(estimate.velocity) - truth.velocity).abs());
                }
                // The sign that Eq. 10 asks for, where it matters.
                let push = truth.acceleration;
                weight += truth.velocity.abs();
                if !estimate.standing && (f64::from(estimate.push) > 0.0) != (push > 0.0) {
                    wrong += truth.velocity.abs();
                }
            });
            assert!(rotation < 2e-4, "{name}, noise {noise}: θ within {rotation}");
            assert!(velocity < 0.02, "{name}, noise {noise}: θ̇ within {velocity}");
            assert!(wrong < 0.02 * weight, "{name}, noise {noise}: wrong sign on {} of the way", wrong / weight);
        }
    }
}

/// A metre above the centre of mass and half a metre beside it, where a metre is half of R.
#[test]
fn an_accelerometer_may_be_anywhere_that_is_known() {
    let truths = motion(0.25, 7.0, 8.0);
    let place = [0.5, 1.0];
    for (name, estimator) in estimators().into_iter().filter(|(name, _)| *name != "model-aided") {
        let wrong = |believed: [f32; 2]| {
            let (mut wrong, mut weight) = (0.0, 0.0);
            run_mounted(&estimator, &truths, 1.0, [place, believed], |truth, estimate| {
                let off = (f64::from(estimate.push) - truth.acceleration).abs();
                if !estimate.standing && truth.since_impact > 0.02 && truth.since_impact.is_finite() {
                    wrong += off;
                    weight += truth.acceleration.abs();
                }
            });
            wrong / weight
        };
        assert!(wrong(place) < 0.05, "{name}: {}", wrong(place));
        assert!(wrong([0.0; 2]) > 0.2, "{name}: {}", wrong([0.0; 2]));
    }
}

/// A word of the gyroscope that was spoilt on the way, once in 20 ms: it sets no velocity, and moves no block that stands.
#[test]
fn a_single_bad_word_is_no_velocity() {
    let (model, truths) = (example_model(), motion(0.25, 7.0, 8.0));
    let instruments = Instruments::new(PERIOD, COUNT, [0.0; 3], 0.0015).unwrap();
    for (name, estimator) in estimators() {
        let (mut state, mut reading, mut dice) = (EstimatorState::default(), InstrumentsState::default(), 1);
        for (number, truth) in truths.iter().enumerate() {
            let mut sample = sample(truth, number as u32 + 1, 1.0, &mut dice);
            if number % 40 == 7 {
                sample.gyroscope.value = if number % 80 == 7 { 8.0 } else { -8.0 };
            }
            let seen = instruments.read(&mut reading, &sample, &Calibration::default());
            let estimate = estimator.step(&mut state, &model, &instruments, &seen, 0);
            if truth.since_impact > 0.01 {
                let off = (f64::from(estimate.velocity) - truth.velocity).abs();
                assert!(off < 0.02, "{name}: θ̇ off by {off} at {number}");
            }
            if truth.rotation == 0.0 && truth.since_impact == f64::INFINITY && truth.ground == 0.0 {
                assert!(estimate.standing, "{name} moves at rest at {number}");
            }
        }
    }
}

#[test]
fn a_standing_block_stands_and_a_moving_one_does_not() {
    let truths = motion(0.25, 7.0, 4.0);
    for (name, estimator) in estimators() {
        let mut late = 0;
        run(&estimator, &truths, 1.0, |truth, estimate| {
            if truth.rotation == 0.0 && truth.since_impact == f64::INFINITY {
                assert!(estimate.standing || estimate.rotation.abs() < 1e-5, "{name} moves at rest");
            }
            late += u32::from(truth.rotation.abs() > 1e-3 && estimate.standing);
        });
        assert_eq!(late, 0, "{name} stands while the block rocks");
    }
}

#[test]
fn days_of_constant_readings_change_nothing() {
    let still = Truth { rotation: 0.0, velocity: 0.0, acceleration: 0.0, ground: 0.0, since_impact: f64::INFINITY, jump: 0.0 };
    let truths = std::vec![still; 400_000];
    for (name, estimator) in estimators() {
        run(&estimator, &truths, 0.0, |_, estimate| {
            assert!(estimate.standing && estimate.rotation == 0.0 && estimate.velocity == 0.0, "{name}: {estimate:?}");
        });
    }
}

/// Garbage of every kind: the estimate stays a number, and within what a block can do.
#[test]
fn no_readings_make_an_estimate_run_away() {
    let model = example_model();
    for period in [5e-4, 0.01] {
        let instruments = Instruments::new(period, COUNT, [1e-3; 3], 0.0015).unwrap();
        for (name, estimator) in estimators() {
            let (mut state, mut reading, mut dice) = (EstimatorState::default(), InstrumentsState::default(), 7_u32);
            let mut word = || {
                dice = dice.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                dice ^ dice >> 16
            };
            for _ in 0..200_000 {
                let mut value = || f32::from_bits(word());
                let mut reading_of = || Reading { value: value(), number: 0 };
                let mut sample = Sample {
                    gyroscope: reading_of(),
                    block_accelerometer: [reading_of(), reading_of()],
                    ground_accelerometer: [reading_of(), reading_of()],
                    ..Sample::default()
                };
                sample.gyroscope.number = word();
                sample.block_accelerometer[0].number = word();
                sample.ground_accelerometer[0].number = word();
                sample.encoder = Count { counts: word() as i32, number: word() };
                let seen = instruments.read(&mut reading, &sample, &Calibration::default());
                let estimate = estimator.step(&mut state, &model, &instruments, &seen, (word() % 3) as u8);
                let finite = estimate.rotation.is_finite() && estimate.velocity.is_finite() && estimate.push.is_finite();
                assert!(finite && estimate.rotation.abs() <= 2.0, "{name}: {estimate:?}");
            }
        }
    }
}
