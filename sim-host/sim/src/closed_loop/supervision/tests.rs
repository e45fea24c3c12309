//! What supervises sensors and clutches waits long enough that nothing sound is a fault.

use std::f64::consts::PI;
use std::path::Path;

use sprag_shared::math;

use super::super::LoopScene;
use super::super::disturbance::Disturbance;
use super::super::failing::{Failing, Injected, Part};
use super::super::plant::Extremes;
use super::*;
use crate::interrupt::Interrupt;
use crate::scene::Scene;
use crate::sensor::preset::{self, ACCELEROMETERS, GYROSCOPES, SUITES};

/// A loop over a pulse with `sensors`, tables of TOML.
fn desk(sensors: &str) -> LoopScene {
    let block = "slenderness_deg = 12.0";
    desk_of(block, "engagement = 'rigid'", "amplitude_g = 0.4, frequency_hz = 1.3", &format!("sensors = {{ {sensors} }}"))
}

/// The same with keys of block, device, pulse and controller.
fn desk_of(block: &str, device: &str, pulse: &str, controller: &str) -> LoopScene {
    let text = format!(
        "block = {{ size_m = 2.0, {block} }}
        device = [{{ kind = 'clutched-pair', mass_ratio = 0.5, {device} }}]
        ground = [{{ motion = 'sine', {pulse} }}]
        [controller]
        {controller}"
    );
    LoopScene::new(Scene::parse(&text, "scene").unwrap()).unwrap()
}

/// What its supervisor allows.
fn monitor(sensors: &str) -> MonitorParameters {
    let (desk, interrupt) = (desk(sensors), Interrupt::default());
    let task = desk.task(0, 1, &interrupt);
    let (structure, table) = (task.believed().unwrap(), &desk.controller);
    let design = SensorDesign::new(&structure, &desk.suite, table.estimator, 5e-4, table.shock_s, 0.02).unwrap();
    supervision(&structure, &desk.suite, &design, table, (0.0, 0.0)).monitor
}

/// The scene that ships, with one key changed.
fn shipped_with(change: &str) -> LoopScene {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/controller.toml");
    LoopScene::new(Scene::load(&scene, &[change.to_owned()]).unwrap()).unwrap()
}

fn faults(desk: &LoopScene, seed: u64) -> usize {
    faults_with(desk, seed, &mut ())
}

/// The same with something that goes wrong.
fn faults_with(desk: &LoopScene, seed: u64, disturbance: &mut dyn Disturbance) -> usize {
    let interrupt = Interrupt::default();
    let task = desk.task(0, seed, &interrupt);
    let mut driver = task.driver().unwrap();
    task.run_with(&mut *driver, disturbance, &mut Extremes::default(), &mut ()).unwrap().faults.len()
}

#[test]
fn noise_behind_a_slow_low_pass_is_not_stuck() {
    for sensors in [
        "suite = 'icm-42688-p', gyroscope = { bandwidth_hz = 42 }",
        "suite = 'icm-42688-p', ground_accelerometer = { bandwidth_hz = 20 }",
    ] {
        let desk = desk(sensors);
        for seed in 1..=4 {
            assert_eq!(faults(&desk, seed), 0, "{sensors}, seed {seed}");
        }
    }
    // However slow, the monitor's limits are ones that it may have.
    let slowest = "block_accelerometer = { bandwidth_hz = 0.1, noise_density_ug_rthz = 10000, resolution_mg = 0.2 }";
    assert_eq!(monitor(slowest).block_accelerometer.stuck_time, LONGEST_WAIT);
    assert!(desk(slowest).task(0, 1, &Interrupt::default()).driver().is_ok());
}

/// Dry friction holds a block in mid-swing, where its gyroscope says 0 in every bit; a bias that is not known yet repeats at rest.
#[test]
fn a_sensor_without_noise_may_repeat_itself() {
    let held = desk_of(
        "slenderness_deg = 12.8, restitution = 0.35",
        "rack = { dry_friction_ratio = 0.042 }",
        "amplitude_ratio = 1.294, frequency_ratio = 3.0",
        "law = 'passive'",
    );
    assert_eq!(faults(&held, 1), 0);
    assert_eq!(faults(&desk("gyroscope = { bias_deg_s = 3.0 }"), 1), 0);
    // With noise, however little, no two readings are equal.
    let noisy = monitor("gyroscope = { noise_density_deg_s_rthz = 0.001, bandwidth_hz = 100.0 }");
    assert_eq!((noisy.gyroscope.stuck_time_moving, noisy.block_accelerometer.stuck_time_moving), (0.004, 0.0));
}

/// Bound of the chance that `repeats` readings in a row, each `apart` over 1/bandwidth after the one before, are equal to a first one:
/// noise of a standard deviation of `steps` behind a Butterworth filter of second order, whose correlation over t is e^(−x) (cos x + sin x)
/// with x = √2 π t bandwidth. In a box of one step about (c, …, c) a normal density is at most that of (c, …, c) in the mean over c, which
/// Durbin's recursion gives reading by reading.
fn chance_of_repeats(apart: f64, steps: f64, repeats: usize) -> f64 {
    let correlation = |readings: usize| {
        let x = 2_f64.sqrt() * PI * apart * readings as f64;
        math::exp(-x) * (math::cos(x) + math::sin(x))
    };
    let (mut weights, mut variance, mut chance, mut precision) = (Vec::<f64>::new(), 1.0_f64, 1.0_f64, 1.0_f64);
    for reading in 1..=repeats {
        let known: f64 = weights.iter().enumerate().map(|(ago, weight)| weight * correlation(reading - 1 - ago)).sum();
        let last = (correlation(reading) - known) / variance;
        let turned: Vec<f64> = weights.iter().rev().map(|weight| last * weight).collect();
        weights.iter_mut().zip(turned).for_each(|(weight, turned)| *weight -= turned);
        weights.push(last);
        variance *= 1.0 - last * last;
        chance /= steps * (2.0 * PI * variance).sqrt();
        let rest = 1.0 - weights.iter().sum::<f64>();
        precision += rest * rest / variance;
    }
    chance / f64::sqrt(precision)
}

#[test]
fn the_bound_of_the_chance_is_close() {
    // Independent readings: two are equal with 1/(2 √π) over the noise in steps, three with 1/(2 π √3) over its square.
    assert!((chance_of_repeats(9.0, 4.0, 1) - 0.282_095 / 4.0).abs() < 1e-6);
    assert!((chance_of_repeats(9.0, 4.0, 2) - 0.159_15 / 16.0 / 3_f64.sqrt()).abs() < 1e-6);
    // Of an MPU-6050 that is simulated for 3e6 readings 9 repeats are counted 10 times.
    let nine = chance_of_repeats(0.098, 3.4, 9);
    assert!((1e-6..1e-5).contains(&nine), "{nine}");
}

/// Also where a low-pass lets one reading follow the other: every second, third, … of them has to repeat too.
#[test]
fn readings_of_parts_as_they_are_sold_repeat_for_the_stuck_time_once_in_1e9() {
    for preset in [GYROSCOPES, ACCELEROMETERS].concat().iter().filter(|preset| preset.part.resolution > 0.0) {
        let part = preset.part;
        let steps = output_deviation(part.noise_density, part.bandwidth, part.sampling.rate) / part.resolution;
        for rate in [250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0] {
            let between = between_readings(&part.sampling, 1.0 / rate);
            let stuck = f64::from(stuck_time(steps as f32, independent(&part, between) as f32));
            let repeats = (stuck / between * (1.0 + 1e-6)) as usize;
            let of_each = |each: usize| chance_of_repeats(between * part.bandwidth * each as f64, steps, repeats / each);
            let chance = (1..=repeats).map(of_each).fold(1.0, f64::min);
            assert!(chance < 1e-9, "{} at {rate} Hz, {stuck} s: {chance}", preset.name);
        }
    }
}

#[test]
fn an_encoder_is_late_as_far_as_it_is_read_late() {
    let close = |value: f32, expected: f64| assert!((f64::from(value) / expected - 1.0).abs() < 1e-6, "{value} {expected}");
    let ideal = monitor("encoder = { resolution_m = 1e-6 }");
    close(ideal.encoder.stale_time, 0.003);
    close(ideal.sensor_delay, 0.002);
    // Three readings missed and the latency; a period and twice the latency, at either end, after two ticks of the gyroscope.
    for synchronous in [false, true] {
        let slow = monitor(&format!("encoder = {{ rate_hz = 250, synchronous = {synchronous}, latency_s = 0.002 }}"));
        close(slow.encoder.stale_time, 0.014);
        close(slow.sensor_delay, 0.001 + 2.0 * (0.004 + 2.0 * 0.002));
        close(slow.contradiction_time, 0.004 + 2.0 * 0.002);
        close(slow.slow_contradiction_time, 4.0 * 0.017);
    }
    // The slowest and latest that a scene may have.
    assert!(
        desk("encoder = { rate_hz = 1, synchronous = true, latency_s = 0.1 }").task(0, 1, &Interrupt::default()).driver().is_ok()
    );
}

/// 2 m cos 6° of lever at α/2 are 1.989e9 counts of a nanometre.
#[test]
fn the_finest_encoder_is_compared_with_the_gyroscope() {
    let sensors = "encoder = { resolution_m = 1e-9 }";
    let counts = f64::from(monitor(sensors).encoder.counts_per_radian);
    assert!((counts / 1.989_044e9 - 1.0).abs() < 1e-6, "{counts}");
    let desk = desk(sensors);
    assert_eq!(faults(&desk, 1), 0);
    assert!(faults_with(&desk, 1, &mut Injected::new(Failing::Stuck(Part::Encoder), 0.5)) > 0);
    assert!(desk.task(0, 1, &Interrupt::default()).settings().is_ok());
}

/// The delay of a gyroscope without noise is more than a filter that believes it at once can bear.
#[test]
fn gains_that_a_board_refuses_are_named_with_their_values() {
    let sensors = "suite = 'mpu-6050', gyroscope = { noise_density_deg_s_rthz = 0, resolution_deg_s = 0 }";
    let controller = format!("estimator = 'kalman'\n sensors = {{ {sensors} }}");
    let desk = desk_of("slenderness_deg = 12.0", "engagement = 'rigid'", "amplitude_g = 0.4, frequency_hz = 1.3", &controller);
    let (interrupt, sound) = (Interrupt::default(), self::desk(""));
    let error = desk.task(0, 1, &interrupt).settings().unwrap_err();
    assert_eq!(error.parameter, "estimator.rotation_by_encoder");
    assert!(error.value.is_finite(), "{error}");
    let warning = desk.task(0, 1, &interrupt).warning().unwrap();
    assert!(warning.starts_with("scene: the controller of ") && warning.contains(&error.to_string()), "{warning}");
    assert_eq!(sound.task(0, 1, &interrupt).warning(), None);
}

#[test]
fn a_slow_or_late_encoder_is_no_fault() {
    for encoder in ["rate_hz = 250", "rate_hz = 1000, latency_s = 0.01"] {
        assert_eq!(faults(&desk(&format!("suite = 'adis16470', encoder = {{ {encoder} }}")), 1), 0, "{encoder}");
    }
    // One that keeps its count is found all the same.
    for encoder in ["rate_hz = 30", "rate_hz = 10, synchronous = true"] {
        let desk = desk(&format!("suite = 'adis16470', encoder = {{ {encoder} }}"));
        assert!(faults_with(&desk, 1, &mut Injected::new(Failing::Stuck(Part::Encoder), 0.5)) > 0, "{encoder}");
    }
}

/// Others tell of a motion, and of its end, long before them.
#[test]
fn the_slowest_sensors_are_no_fault() {
    for sensor in [
        "encoder = { rate_hz = 2, synchronous = true }",
        "encoder = { rate_hz = 4, synchronous = true }",
        "encoder = { rate_hz = 8, synchronous = true, latency_s = 0.1 }",
        "encoder = { rate_hz = 6, synchronous = false }",
        "encoder = { rate_hz = 50, synchronous = true }",
        "gyroscope = { rate_hz = 6, synchronous = true }",
        "gyroscope = { rate_hz = 6, synchronous = false }",
        "gyroscope = { bandwidth_hz = 2.3 }",
        "block_accelerometer = { bandwidth_hz = 0.1 }",
        "block_accelerometer = { bandwidth_hz = 1 }",
        "block_accelerometer = { rate_hz = 1, synchronous = true }",
        "ground_accelerometer = { bandwidth_hz = 2.3 }",
        "ground_accelerometer = { rate_hz = 1, synchronous = true }",
    ] {
        assert_eq!(faults(&shipped_with(&format!("controller.sensors.{sensor}")), 1), 0, "{sensor}");
    }
}

/// After a move, or until all that was commanded before has moved it, in order.
#[test]
fn a_clutch_that_its_dwell_holds_is_no_fault() {
    for actuation in [
        "dwell_s = 0.05",
        "dwell_s = 0.5",
        "engagement_delay_s = 0.01, dwell_s = 0.01, delay = 'transport'",
        "engagement_delay_s = 0.01, dwell_s = 0.05, delay = 'transport'",
    ] {
        let desk = shipped_with(&format!("device.0.actuation={{ {actuation} }}"));
        assert_eq!(faults(&desk, 1), 0, "{actuation}");
        // One that stays open is found all the same.
        assert!(faults_with(&desk, 1, &mut Injected::new(Failing::Refuses, 0.5)) > 0, "{actuation}");
    }
    // No dwell is longer than a monitor may wait.
    let longest =
        desk_of("slenderness_deg = 12.0", "actuation = { dwell_s = 10.0 }", "amplitude_g = 0.4, frequency_hz = 1.3", "");
    assert!(longest.task(0, 1, &Interrupt::default()).driver().is_ok());
}

#[test]
fn windows_of_sensors_as_they_are_sold_are_the_default_ones() {
    let windows = |monitor: MonitorParameters| {
        [monitor.contradiction_time, monitor.slow_contradiction_time, monitor.rest_contradiction_time]
    };
    for suite in preset::names(SUITES) {
        let sold = windows(monitor(&format!("suite = '{suite}'")));
        assert_eq!(sold, windows(MonitorParameters::default()), "{suite}");
    }
}

/// The last that the count moves may come while the gyroscope shows no rate any more.
#[test]
fn an_impact_that_stops_the_block_is_no_fault() {
    for (degrees, amplitude, controller) in [
        (10.0, 2.2, "rate_hz = 400"),
        (10.0, 2.2, "rate_hz = 1000"),
        (10.0, 2.2, "rate_hz = 2000"),
        (10.0, 2.4, "sensors = { encoder = { latency_s = 0.002 } }"),
        (25.0, 2.5, "rate_hz = 400\nsensors = { suite = 'adis16470' }"),
    ] {
        let desk = desk_of(
            &format!("slenderness_deg = {degrees}, restitution = 0.0"),
            "",
            &format!("amplitude_ratio = {amplitude}, frequency_ratio = 4.0"),
            &format!("law = 'passive'\n{controller}"),
        );
        assert_eq!(faults(&desk, 1), 0, "{controller}");
        assert!(faults_with(&desk, 1, &mut Injected::new(Failing::Stuck(Part::Encoder), 0.5)) > 0, "{controller}");
    }
    // Parts as they are sold follow a stop for longer than a tick.
    let default = MonitorParameters::default().count_tolerance;
    for suite in preset::names(SUITES).filter(|suite| *suite != "ideal") {
        assert_eq!(monitor(&format!("suite = '{suite}'")).count_tolerance, default, "{suite}");
    }
}

/// Its gyroscope's bias is not known yet, and by its count alone nobody knows where it is.
#[test]
fn a_block_that_lifts_off_before_it_is_calibrated_has_no_fault() {
    for (controller, seeds) in [
        ("prelude_s = 0.0\nlatency_s = 0.001\nsensors = { suite = 'adis16470' }", 1..=4),
        ("latency_s = 0.001\nsensors = { suite = 'mpu-6050' }", 128..=128),
    ] {
        let block = "slenderness_deg = 20.0, restitution = 0.85";
        let desk = desk_of(block, "", "amplitude_ratio = 3.0, frequency_ratio = 4.0", controller);
        for seed in seeds {
            assert_eq!(faults(&desk, seed), 0, "{controller}, seed {seed}");
        }
    }
}

/// Racks that travel half as far per radian at θ = 0 as at balance.
#[test]
fn a_lever_that_changes_over_a_swing_is_no_fault() {
    for (block, device, pulse) in [
        (
            "slenderness_deg = 20.0",
            "mount = 'tying-point', mount_height_m = 0.2, pulley_ratio = 4.0",
            "amplitude_g = 0.5, frequency_hz = 1.0",
        ),
        ("slenderness_deg = 60.0", "mount = 'centre-of-mass'", "amplitude_g = 2.6, frequency_hz = 1.0"),
    ] {
        for sensors in ["suite = 'ideal'", "suite = 'adis16470'"] {
            let desk = desk_of(block, device, pulse, &format!("sensors = {{ {sensors} }}"));
            assert_eq!(faults(&desk, 1), 0, "{device}, {sensors}");
            for failing in [Failing::Stuck(Part::Encoder), Failing::Contradicts(Part::Encoder)] {
                assert!(faults_with(&desk, 1, &mut Injected::new(failing, 0.5)) > 0, "{device}, {sensors}: {failing}");
            }
        }
    }
}

/// A shock rings in a low-pass of 94 Hz for several milliseconds.
#[test]
fn an_impact_beyond_full_scale_behind_a_slow_low_pass_is_no_fault() {
    let block = "slenderness_deg = 20.0, restitution = 0.5";
    for estimator in ["kalman", "complementary"] {
        let controller = format!("estimator = '{estimator}'\nsensors = {{ suite = 'mpu-6050' }}");
        let desk = desk_of(block, "mount = 'centre-of-mass'", "amplitude_g = 0.8, frequency_hz = 1.0", &controller);
        assert_eq!(faults(&desk, 1), 0, "{estimator}");
    }
    // A fast part has the default.
    assert!((monitor("suite = 'adis16470'").block_accelerometer.saturation_time - 0.004).abs() < 1e-6);
}
