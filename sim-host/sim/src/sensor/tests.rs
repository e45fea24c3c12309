//! Whole sensors, from the truth to the sample.

use std::f64::consts::{PI, SQRT_2};

use sprag_shared::control::sensing::sample::Reading;
use sprag_shared::math;

use super::preset::{DEGREE, SUITES, find, names};
use super::*;

const FIRST: Truth = Truth { rate: 0.1, block: [1.0, 9.5], ground: [-0.5, 9.8], travel: 0.01 };

fn suite(name: &str) -> Suite {
    find(SUITES, name).unwrap()
}

fn with(gyroscope: Inertial) -> Suite {
    Suite { gyroscope, ..Suite::IDEAL }
}

fn rate(value: f64) -> Truth {
    Truth { rate: value, ..FIRST }
}

/// Every reading of the gyroscope while the truth stands still.
fn at_rest(inertial: Inertial, seed: u64, step: f64, count: u32) -> Vec<f64> {
    let mut sensors = Sensors::new(&with(inertial), seed, &rate(0.0));
    let mut last = 0;
    let mut values = Vec::new();
    for index in 1..=count {
        sensors.advance(step * f64::from(index), &rate(0.0));
        let reading = sensors.sample().gyroscope;
        if reading.number != last {
            values.push(f64::from(reading.value));
            last = reading.number;
        }
    }
    values
}

fn moments(values: &[f64]) -> (f64, f64) {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let square = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / values.len() as f64;
    (mean, square.sqrt())
}

fn motion(time: f64) -> Truth {
    let swing = math::sin(7.0 * time);
    Truth { rate: 0.3 * swing, block: [2.0 * swing, 9.0], ground: [swing, 9.8 + swing], travel: 0.02 * swing }
}

/// Samples of a moving truth, as bytes.
fn run(suite: &Suite, seed: u64) -> Vec<Sample> {
    let mut sensors = Sensors::new(suite, seed, &motion(0.0));
    (1..2000)
        .map(|index| {
            let time = 3e-4 * f64::from(index);
            sensors.advance(time, &motion(time));
            sensors.sample()
        })
        .collect()
}

#[test]
fn ideal_sensors_read_the_truth_at_once() {
    let mut sensors = Sensors::new(&Suite::IDEAL, 3, &FIRST);
    let first = sensors.sample();
    assert_eq!((first.gyroscope.value, first.gyroscope.number, first.encoder.number), (0.1, 1, 1));
    assert_eq!(first.ground_accelerometer[1].value, 9.8);
    for index in 1..1000_u32 {
        let truth = motion(1e-3 * f64::from(index));
        sensors.advance(1e-3 * f64::from(index), &truth);
        let sample = sensors.sample();
        assert_eq!(sample.gyroscope, Reading { value: truth.rate as f32, number: index + 1 });
        assert_eq!(sample.block_accelerometer.map(|reading| reading.value), truth.block.map(|value| value as f32));
        assert_eq!(sample.ground_accelerometer.map(|reading| reading.value), truth.ground.map(|value| value as f32));
        assert!((f64::from(sample.encoder.counts) * 1e-8 - (truth.travel - FIRST.travel)).abs() <= 1e-8);
        assert_eq!(sample.engaged, [false; 2]);
    }
}

#[test]
fn the_same_seed_gives_the_same_bytes_and_another_one_others() {
    for name in names(SUITES).skip(1) {
        assert_eq!(run(&suite(name), 5), run(&suite(name), 5), "{name}");
        let (one, other) = (run(&suite(name), 5), run(&suite(name), 6));
        let same = one.iter().zip(&other).filter(|(one, other)| one.gyroscope.value == other.gyroscope.value).count();
        assert!(same < one.len() / 2, "{name}: {same}");
    }
}

#[test]
fn changing_one_sensor_leaves_the_noise_of_the_others() {
    let full = suite("icm-42688-p");
    let quiet = Suite { gyroscope: Inertial::IDEAL, encoder: Encoder::IDEAL, ..full };
    for (one, other) in run(&full, 1).iter().zip(run(&quiet, 1)) {
        assert_eq!(one.block_accelerometer, other.block_accelerometer);
        assert_eq!(one.ground_accelerometer, other.ground_accelerometer);
    }
    // The same part on block and ground is still two specimens, and so is each axis.
    let twins = Suite { block_accelerometer: full.ground_accelerometer, ..full };
    let mut sensors = Sensors::new(&twins, 1, &Truth { block: [1.0; 2], ground: [1.0; 2], ..FIRST });
    sensors.advance(0.01, &Truth { block: [1.0; 2], ground: [1.0; 2], ..FIRST });
    let sample = sensors.sample();
    let values = [sample.block_accelerometer, sample.ground_accelerometer].concat();
    for (index, reading) in values.iter().enumerate() {
        assert!(values[..index].iter().all(|other| other.value != reading.value));
    }
}

#[test]
fn switching_one_imperfection_leaves_the_others() {
    let full = Inertial { resolution: 0.0, ..suite("mpu-6050").gyroscope };
    let bias = |inertial: Inertial| moments(&at_rest(inertial, 9, 1e-3, 20_000)).0;
    let quiet = Inertial { noise_density: 0.0, scale_error: 0.0, ..full };
    assert!((bias(full) - bias(quiet)).abs() < 0.01 * DEGREE);
    assert_eq!(bias(Inertial { bias: 0.0, drift: Drift::NONE, ..quiet }), 0.0);
}

#[test]
fn readings_do_not_depend_on_how_often_the_truth_is_given() {
    // Several readings between two looks, of which the last can be read at once, soon or after many others.
    for latency in [0.0, 5e-5, 3.9e-3] {
        let sampling = Sampling { rate: 8000.0, jitter: 1e-5, latency, synchronous: false };
        let drift = Drift { deviation: 1e-3, correlation_time: 0.5, random_walk: 1e-3 };
        let suite = with(Inertial { noise_density: 1e-3, drift, bandwidth: 200.0, sampling, ..Inertial::IDEAL });
        let read = |pieces: u32| {
            let mut sensors = Sensors::new(&suite, 4, &rate(0.0));
            let mut values = Vec::new();
            for index in 1..=1000 * pieces {
                let time = 5e-4 * f64::from(index) / f64::from(pieces);
                sensors.advance(time, &rate(3.0 * time));
                if index % pieces == 0 {
                    values.push(sensors.sample().gyroscope);
                }
            }
            values
        };
        for (coarse, fine) in read(1).iter().zip(read(7)) {
            assert!(coarse.number == fine.number && (coarse.value - fine.value).abs() < 1e-6, "{latency}: {coarse:?} {fine:?}");
        }
    }
}

#[test]
fn noise_has_the_deviation_of_its_density_and_band() {
    let sampling = Sampling { rate: 2000.0, ..Sampling::CONTINUOUS };
    let filtered = Inertial { noise_density: 1e-4, bandwidth: 150.0, sampling, ..Inertial::IDEAL };
    let (mean, deviation) = moments(&at_rest(filtered, 1, 5e-4, 200_000));
    assert!((deviation / (1e-4 * (1.110_72_f64 * 150.0).sqrt()) - 1.0).abs() < 0.02, "{deviation}");
    assert!(mean.abs() < 1e-4 * 5.0 / (2.0_f64 * 100.0).sqrt());
    let (_, deviation) = moments(&at_rest(Inertial { bandwidth: 0.0, ..filtered }, 1, 5e-4, 200_000));
    assert!((deviation / (1e-4 * 1000.0_f64.sqrt()) - 1.0).abs() < 0.01, "{deviation}");
    let continuous = Inertial { sampling: Sampling::CONTINUOUS, ..filtered };
    let (_, deviation) = moments(&at_rest(continuous, 1, 3e-4, 200_000));
    assert!((deviation / (1e-4 * (1.110_72_f64 * 150.0).sqrt()) - 1.0).abs() < 0.02, "{deviation}");
}

/// Amplitude ratio and delay (s) of a sine of `frequency` as it is read, against the instants of sampling.
fn response(inertial: Inertial, frequency: f64) -> (f64, f64) {
    let mut sensors = Sensors::new(&with(inertial), 1, &rate(0.0));
    let angle = |time: f64| 2.0 * PI * frequency * time;
    let (mut along, mut across, mut readings, mut last) = (0.0, 0.0, 0.0, 1);
    for index in 1..400_000_u32 {
        let time = 2e-6 * f64::from(index);
        sensors.advance(time, &rate(math::sin(angle(time))));
        let reading = sensors.sample().gyroscope;
        // Whole periods, once the beginning has died away.
        if reading.number != last && (601..1401).contains(&reading.number) {
            let instant = f64::from(reading.number - 1) / inertial.sampling.rate;
            along += f64::from(reading.value) * math::sin(angle(instant));
            across += f64::from(reading.value) * math::cos(angle(instant));
            readings += 0.5;
        }
        last = reading.number;
    }
    (math::hypot(along, across) / readings, -math::atan2(across, along) / (2.0 * PI * frequency))
}

#[test]
fn the_bandwidth_is_right_at_the_sampling_rate() {
    // A corner at more than a quarter of the rate, where a filter that runs at the rate would be off by a fifth.
    let sampling = Sampling { rate: 2000.0, ..Sampling::CONTINUOUS };
    let inertial = Inertial { bandwidth: 530.0, sampling, ..Inertial::IDEAL };
    let (ratio, delay) = response(inertial, 530.0);
    assert!((ratio * SQRT_2 - 1.0).abs() < 1e-3, "{ratio}");
    assert!((delay * 4.0 * 530.0 - 1.0).abs() < 1e-2, "{delay}");
    let (ratio, delay) = response(inertial, 10.0);
    assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
    assert!((delay / (SQRT_2 / (2.0 * PI * 530.0)) - 1.0).abs() < 1e-2, "{delay}");
}

#[test]
fn latency_is_kept_to_within_the_sampling() {
    for latency in [0.0, 0.4e-3, 1.7e-3, 6e-3] {
        for synchronous in [false, true] {
            let sampling = Sampling { rate: 2000.0, synchronous, jitter: 0.0, latency };
            let mut sensors = Sensors::new(&with(Inertial { sampling, ..Inertial::IDEAL }), 2, &rate(0.0));
            for index in 1..20_000 {
                let time = 1e-4 * f64::from(index);
                sensors.advance(time, &rate(time));
                // The truth is the time, so that the reading shows when it was taken.
                let age = time - f64::from(sensors.sample().gyroscope.value);
                assert!(time < 0.01 || (age > latency - 1e-6 && age < latency + 0.6e-3 + 1e-6), "{latency}: {age}");
            }
        }
    }
}

#[test]
fn jitter_moves_the_instants_and_not_their_mean() {
    let sampling = Sampling { rate: 1000.0, synchronous: true, jitter: 50e-6, latency: 0.0 };
    let mut sensors = Sensors::new(&with(Inertial { sampling, ..Inertial::IDEAL }), 2, &rate(0.0));
    let mut shifts = Vec::new();
    for index in 1..60_000_u32 {
        // The middle of each period, when exactly one more sample has been taken.
        let time = 1e-3 * (f64::from(index) + 0.5);
        // A saw tooth keeps f32 fine enough: each sample lies on the straight piece around it.
        sensors.advance(1e-3 * (f64::from(index) - 0.5), &rate(-0.5));
        sensors.advance(time, &rate(0.5));
        shifts.push(f64::from(sensors.sample().gyroscope.value) * 1e-3);
    }
    let (mean, deviation) = moments(&shifts);
    assert!(mean.abs() < 50e-6 * 5.0 / 60_000.0_f64.sqrt(), "{mean}");
    assert!((deviation / 50e-6 - 1.0).abs() < 0.02, "{deviation}");
}

#[test]
fn outputs_are_steps_within_the_full_scale() {
    let inertial = Inertial { resolution: 0.25, full_scale: 2.0, ..Inertial::IDEAL };
    let mut sensors = Sensors::new(&with(inertial), 1, &rate(0.0));
    for (truth, expected) in [(0.12, 0.0), (0.13, 0.25), (-0.13, -0.25), (1.9, 2.0), (50.0, 2.0), (-50.0, -2.0), (0.6, 0.5)] {
        sensors.advance(0.0, &rate(truth));
        assert_eq!(sensors.sample().gyroscope.value, expected);
    }
}

#[test]
fn turn_on_errors_scatter_as_stated_over_seeds() {
    let inertial = Inertial { bias: 0.2, scale_error: 0.03, misalignment: 0.02, ..Inertial::IDEAL };
    let suite = Suite { gyroscope: inertial, block_accelerometer: inertial, ..Suite::IDEAL };
    let of = |block: [f64; 2], rate: f64| -> Vec<[f64; 3]> {
        (0..4000)
            .map(|seed| {
                let sample = Sensors::new(&suite, seed, &Truth { rate, block, ..FIRST }).sample();
                let [first, second] = sample.block_accelerometer;
                [sample.gyroscope.value, first.value, second.value].map(f64::from)
            })
            .collect()
    };
    let (none, along, up) = (of([0.0; 2], 0.0), of([10.0, 0.0], 10.0), of([0.0, 10.0], 0.0));
    let column = |values: &[[f64; 3]], axis: usize| -> Vec<f64> {
        values.iter().zip(&none).map(|(value, none)| (value[axis] - none[axis]) / 10.0).collect()
    };
    for axis in 0..3 {
        let (mean, deviation) = moments(&none.iter().map(|value| value[axis]).collect::<Vec<_>>());
        assert!(mean.abs() < 0.015 && (deviation / 0.2 - 1.0).abs() < 0.05, "{axis}: {mean} {deviation}");
    }
    for (values, axis) in [(&along, 0), (&along, 1), (&up, 2)] {
        let (mean, deviation) = moments(&column(values, axis));
        assert!((mean - 1.0).abs() < 0.003 && (deviation / 0.03 - 1.0).abs() < 0.05, "{axis}: {mean} {deviation}");
    }
    for (values, axis) in [(&up, 1), (&along, 2)] {
        let (mean, deviation) = moments(&column(values, axis));
        assert!(mean.abs() < 0.002 && (deviation / 0.02 - 1.0).abs() < 0.05, "{axis}: {mean} {deviation}");
    }
    // Nothing but the cosine of a gyroscope's misalignment: never more than the truth.
    let tilted = with(Inertial { misalignment: 0.1, ..Inertial::IDEAL });
    let readings: Vec<f64> =
        (0..4000).map(|seed| f64::from(Sensors::new(&tilted, seed, &rate(1.0)).sample().gyroscope.value)).collect();
    assert!(readings.iter().all(|reading| *reading <= 1.0));
    assert!((moments(&readings).0 - (1.0 - 0.005)).abs() < 0.0005);
}

#[test]
fn readings_exist_from_the_start_and_have_settled() {
    for name in names(SUITES) {
        let quiet = |inertial: Inertial| Inertial { noise_density: 0.0, drift: Drift::NONE, ..inertial };
        let full = suite(name);
        let settled = Suite { gyroscope: quiet(full.gyroscope), ..full };
        let mut sensors = Sensors::new(&settled, 1, &FIRST);
        let first = sensors.sample();
        assert_eq!((first.gyroscope.number, first.block_accelerometer[1].number, first.encoder.number), (1, 1, 1));
        for index in 1..1000 {
            sensors.advance(1e-4 * f64::from(index), &FIRST);
            assert_eq!(sensors.sample().gyroscope.value, first.gyroscope.value, "{name}");
            assert_eq!(sensors.sample().encoder.counts, 0, "{name}");
        }
        let expected = if full.gyroscope.sampling.rate > 0.0 { 0.0999 * full.gyroscope.sampling.rate } else { 999.0 };
        assert!((f64::from(sensors.sample().gyroscope.number) - 1.0 - expected).abs() < 2.0, "{name}");
    }
}

#[test]
fn a_jump_and_a_step_back_in_time_are_taken_as_they_come() {
    let mut sensors = Sensors::new(&Suite::IDEAL, 1, &rate(0.0));
    sensors.advance(0.1, &rate(1.0));
    sensors.advance(0.1, &rate(-1.0));
    assert_eq!(sensors.sample().gyroscope.value, -1.0);
    let mut filtered = Sensors::new(&suite("icm-42688-p"), 1, &rate(0.0));
    for time in [0.1, 0.1, 0.05, f64::NAN, 0.2] {
        filtered.advance(time, &rate(1.0));
        assert!(filtered.sample().gyroscope.value.is_finite());
    }
    assert!((f64::from(filtered.sample().gyroscope.value) - 1.0).abs() < 0.05);
}
