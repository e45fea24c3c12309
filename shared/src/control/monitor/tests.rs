use super::*;
use crate::math;

fn monitor() -> Monitor {
    MonitorParameters::default().resolve(0.0005, 0.2)
}

fn still(number: u32) -> Sample {
    let of = |value| Reading { value, number };
    Sample {
        gyroscope: of(0.0),
        block_accelerometer: [of(0.0), of(9.81)],
        ground_accelerometer: [of(0.0), of(9.81)],
        encoder: crate::control::sensing::sample::Count { counts: 0, number },
        engaged: [false; 2],
    }
}

const CONTEXT: Context<'_> = Context {
    calibration: &Calibration { gyroscope: 0.0, block: [0.0; 2], ground: [0.0; 2], encoder_zero: 0 },
    calibrated: true,
    at_rest: true,
    lever: 1.0,
};

#[test]
fn a_sensor_that_has_not_spoken_is_neither_good_nor_bad() {
    let (monitor, mut state) = (monitor(), MonitorState::default());
    for _ in 0..100 {
        let found = monitor.step(&mut state, &Sample::default(), &CONTEXT);
        assert_eq!((found.faults(), found.good()), ([None; 4], [false; 4]));
    }
    let mut expected = MonitorState::expecting([true, false, true, false]);
    let mut found = Findings::default();
    for _ in 0..10 {
        found = *monitor.step(&mut expected, &Sample::default(), &CONTEXT);
    }
    assert_eq!(found.seen(), [false; 4]);
    assert_eq!(
        found.faults(),
        [Some(Fault::Stale(Sensor::Gyroscope)), None, Some(Fault::Stale(Sensor::GroundAccelerometer)), None]
    );
}

#[test]
fn an_ideal_sensor_at_rest_is_good() {
    let (monitor, mut state) = (monitor(), MonitorState::default());
    for tick in 0..10_000_u32 {
        let found = monitor.step(&mut state, &still(1 + tick / 2), &CONTEXT);
        assert_eq!((found.faults(), found.good()), ([None; 4], [true; 4]));
    }
}

#[test]
fn one_axis_makes_a_sensor_wrong() {
    let monitor = monitor();
    for axis in 0..2 {
        let mut state = MonitorState::default();
        let mut sample = still(1);
        assert_eq!(monitor.step(&mut state, &sample, &CONTEXT).faults(), [None; 4]);
        sample.block_accelerometer[axis].value = f32::NAN;
        let found = monitor.step(&mut state, &sample, &CONTEXT);
        assert_eq!(found.faults()[1], Some(Fault::NotFinite(Sensor::BlockAccelerometer)));
        assert_eq!(found.good(), [true, false, true, true]);
    }
}

#[test]
fn a_gap_does_not_look_like_a_difference() {
    let parameters = MonitorParameters {
        encoder: EncoderLimits { counts_per_radian: 1e5, ..MonitorParameters::default().encoder },
        ..MonitorParameters::default()
    };
    let monitor = parameters.resolve(0.0005, 0.2);
    let mut state = MonitorState::default();
    let turning = |tick: u32, lost: bool| {
        let mut sample = still(1 + tick);
        // A rate of 1 rad/s, in noise too small to repeat.
        sample.gyroscope.value = if lost { f32::NAN } else { 1.0 + 1e-6 * tick as f32 };
        sample.block_accelerometer[0].value = 1e-3 * tick as f32;
        sample.encoder.counts = 50 * tick as i32;
        sample
    };
    for tick in 0..1000 {
        let lost = (300..400).contains(&tick);
        let found = monitor.step(&mut state, &turning(tick, lost), &Context { at_rest: false, ..CONTEXT });
        assert_eq!(found.faults()[0].is_some(), lost, "{tick}");
        assert_eq!(found.faults()[1..], [None; 3], "{tick}");
    }
}

/// A gyroscope whose bias no calibration takes turns beside an encoder that stands: it is the one that is wrong, from the first tick on.
#[test]
fn after_a_calibration_the_third_witness_is_still_there() {
    let parameters = MonitorParameters {
        encoder: EncoderLimits { counts_per_radian: 1e5, ..MonitorParameters::default().encoder },
        ..MonitorParameters::default()
    };
    let monitor = parameters.resolve(0.0005, 0.2);
    let mut state = MonitorState::default();
    let turning = |tick: u32| {
        let mut sample = still(1 + tick);
        // In noise too small to count.
        sample.gyroscope.value = 0.21 + 1e-6 * tick as f32;
        sample.block_accelerometer[0].value = 1e-5 * tick as f32;
        sample
    };
    for tick in 0..1000 {
        let found = monitor.step(&mut state, &turning(tick), &Context { calibrated: false, ..CONTEXT });
        assert_eq!(found.faults(), [None; 4], "{tick}");
    }
    state.recalibrated();
    let mut seen = false;
    for tick in 1000..1100 {
        let [gyroscope, others @ ..] = monitor.step(&mut state, &turning(tick), &CONTEXT).faults();
        assert_eq!(others, [None; 3], "{tick}");
        seen |= gyroscope == Some(Fault::Contradiction(Sensor::Gyroscope));
    }
    assert!(seen);
}

#[test]
fn the_stuck_time_follows_the_noise() {
    assert_eq!(stuck_time(0.0, 0.001), 0.0);
    assert_eq!(stuck_time(f32::NAN, 0.001), 0.0);
    let times = [0.5, 1.0, 3.0, 10.0, 30.0, 100.0, f32::INFINITY].map(|steps| stuck_time(steps, 0.001));
    assert!(times.windows(2).all(|pair| pair[0] >= pair[1]));
    assert!(times[4] < 0.0051 && times[6] > 0.0039);
}

/// Independent readings of a normal noise, whose steps lie about its mean: all of them are in one step.
#[test]
fn a_noise_repeats_for_the_stuck_time_once_in_1e9_readings() {
    for noise in [0.5_f64, 0.79, 0.8, 1.39, 1.4, 2.99, 3.0, 4.19, 4.2, 12.9, 13.0, 29.9, 30.0, 99.0, 100.0] {
        let repeats = stuck_time(noise as f32, 1.0) as u32;
        let below = |edge: f64| 0.5 * math::erf(edge / (noise * core::f64::consts::SQRT_2));
        let in_step = |step: i32| below(f64::from(step) + 0.5) - below(f64::from(step) - 0.5);
        let all_in = |step: i32| (0..=repeats).map(|_| in_step(step)).product::<f64>();
        let farthest = (7.0 * noise) as i32;
        let chance: f64 = (-farthest..=farthest).map(all_in).sum();
        assert!(chance < 1e-9, "{noise} steps, {repeats} repeats: {chance}");
    }
}
