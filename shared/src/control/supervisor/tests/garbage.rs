//! Samples of no sense at all: no panic, never both clutches, never NaN in what is handed on; and parameters that are refused.

use super::*;
use crate::control::sensing::sample::{Count, Reading};

fn value(random: &mut Random) -> f32 {
    match random.bits() % 12 {
        0 => f32::NAN,
        1 => f32::INFINITY,
        2 => f32::NEG_INFINITY,
        3 => f32::from_bits(random.bits()),
        4 => f32::MAX,
        5 => 1e-40,
        6 => 9.81,
        _ => 10.0 * random.noise(),
    }
}

fn reading(random: &mut Random, mostly: Reading, rarely: u32) -> Reading {
    if random.bits().is_multiple_of(rarely) {
        Reading { value: value(random), number: random.bits() }
    } else {
        Reading { number: mostly.number.wrapping_add(1), ..mostly }
    }
}

#[test]
fn garbage_is_survived() {
    // From nonsense at every tick to once in a long while, so that every phase is reached and spoilt.
    for (seed, rarely) in [(1, 1), (2, 2), (3, 50), (4, 2000), (5, 20_000)] {
        let mut random = Random(seed);
        let parameters = Parameters {
            required: if seed % 2 == 0 { Required::ALL } else { Required::NONE },
            calibration_time: 0.1,
            calibration_patience: 0.2,
            quiet_time: 0.1,
            recover_after: 0.1,
            self_test_clutches: seed != 4,
            ..with_noise(0.0)
        };
        let supervisor = Supervisor::new(&parameters).unwrap();
        let mut state = SupervisorState::default();
        let mut phases = Vec::new();
        let mut sample = Sample { block_accelerometer: still(), ground_accelerometer: still(), ..Sample::default() };
        for tick in 0..100_000_u32 {
            sample.gyroscope = reading(&mut random, sample.gyroscope, rarely);
            sample.block_accelerometer = sample.block_accelerometer.map(|last| reading(&mut random, last, rarely));
            sample.ground_accelerometer = sample.ground_accelerometer.map(|last| reading(&mut random, last, rarely));
            sample.encoder.number = sample.encoder.number.wrapping_add(1);
            if random.bits().is_multiple_of(rarely) {
                sample.encoder = Count { counts: random.bits() as i32, number: random.bits() };
            }
            if tick % 500 == 499 && rarely > 1 {
                // Back to something that a calibration accepts.
                sample = Sample { block_accelerometer: still(), ground_accelerometer: still(), ..sample };
                sample.gyroscope.value = 0.01;
            }
            let bits = random.bits();
            sample.engaged = [bits & 1 == 0, bits & 2 == 0];
            let spoilt = bits.is_multiple_of(rarely);
            let input = SupervisorInput {
                sample: &sample,
                wish: [bits & 4 == 0, bits & 8 == 0],
                standing: false,
                estimate: if spoilt { (value(&mut random), value(&mut random)) } else { (0.0, 0.0) },
                lever: 1.0,
                lateness: if spoilt { value(&mut random) } else { 0.0 },
                requests: Requests { clear: bits & 16 == 0 },
                coils: Default::default(),
                slower: None,
            };
            let verdict = supervisor.step(&mut state, &input);
            assert!(verdict.command != [true; 2]);
            let Calibration { gyroscope, block, ground, .. } = *state.calibration();
            assert!([gyroscope, block[0], block[1], ground[0], ground[1]].iter().all(|bias| bias.abs() <= 1.0));
            assert!(verdict.fault.is_some() || verdict.phase != Phase::Fault);
            if !phases.contains(&verdict.phase) {
                phases.push(verdict.phase);
            }
        }
        assert!(rarely < 2000 || phases.len() >= 4, "{phases:?}");
    }
}

fn still() -> [Reading; 2] {
    [Reading { value: 0.0, number: 1 }, Reading { value: 9.81, number: 1 }]
}

#[test]
fn parameters_outside_their_ranges_are_named() {
    type Change = fn(&mut Parameters, f32);
    let cases: [(&str, Change, &[f32]); 24] = [
        ("period", |p, x| p.period = x, &[0.0, 0.02, f32::NAN]),
        ("boot_time", |p, x| p.boot_time = x, &[0.0, 11.0, f32::NAN]),
        ("actuator_time", |p, x| p.actuator_time = x, &[0.0, 11.0]),
        ("feedback_time", |p, x| p.feedback_time = x, &[-1.0, 11.0]),
        ("stillness_time", |p, x| p.stillness_time = x, &[0.0, f32::INFINITY]),
        ("calibration_time", |p, x| p.calibration_time = x, &[0.0, 4000.0]),
        ("calibration_patience", |p, x| p.calibration_patience = x, &[0.0, 1.0, 4000.0]),
        ("quiet_time", |p, x| p.quiet_time = x, &[0.0, f32::NAN]),
        ("recover_after", |p, x| p.recover_after = x, &[0.0, f32::NAN]),
        ("plausible.gyroscope", |p, x| p.plausible.gyroscope = x, &[0.0, f32::INFINITY]),
        ("plausible.accelerometer", |p, x| p.plausible.accelerometer = x, &[-1.0]),
        ("shaking", |p, x| p.shaking = x, &[0.0, f32::NAN]),
        ("overrun_limit", |p, x| p.overrun_limit = x, &[0.0, 1.1]),
        ("gyroscope.stale_time", |p, x| p.monitor.gyroscope.stale_time = x, &[0.0, 11.0]),
        ("block_accelerometer.stuck_time", |p, x| p.monitor.block_accelerometer.stuck_time = x, &[-1.0, f32::NAN]),
        ("ground_accelerometer.full_scale", |p, x| p.monitor.ground_accelerometer.full_scale = x, &[0.0, f32::INFINITY]),
        ("encoder.stale_time", |p, x| p.monitor.encoder.stale_time = x, &[0.0]),
        ("encoder.counts_per_radian", |p, x| p.monitor.encoder.counts_per_radian = x, &[2e12, f32::NAN]),
        ("contradiction_time", |p, x| p.monitor.contradiction_time = x, &[0.0, 2.0]),
        ("slow_contradiction_time", |p, x| p.monitor.slow_contradiction_time = x, &[0.001, 2.0]),
        ("lever_tolerance", |p, x| p.monitor.lever_tolerance = x, &[-0.1, 1.0]),
        ("count_tolerance", |p, x| p.monitor.count_tolerance = x, &[0.0]),
        ("moving_rate", |p, x| p.monitor.moving_rate = x, &[0.0, f32::NAN]),
        ("gravity", |p, x| p.monitor.gravity = x, &[0.0]),
    ];
    for (name, change, values) in cases {
        for value in values {
            let mut parameters = parameters();
            change(&mut parameters, *value);
            let error = Supervisor::new(&parameters).unwrap_err();
            assert_eq!(error.parameter, name, "{error}");
        }
    }
    let negative = Parameters { moving_counts: -1, ..parameters() };
    assert_eq!(Supervisor::new(&negative).unwrap_err().parameter, "moving_counts");
    let none = Parameters { overrun_ticks: 0, ..parameters() };
    assert_eq!(Supervisor::new(&none).unwrap_err().parameter, "overrun_ticks");
    assert!(Supervisor::new(&Parameters::default()).is_ok());
}
