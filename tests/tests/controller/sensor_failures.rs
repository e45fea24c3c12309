//! Sensors that fail in mid-motion in every way, by turns and for seconds: what every estimator does meanwhile, and how it comes back.

use std::sync::LazyLock;

use sprag_shared::control::monitor::fault::Fault;
use sprag_shared::control::sensing::sample::{Reading, Sample};
use sprag_shared::control::sensing::sensor::Sensor;
use sprag_shared::control::supervisor::Phase;
use sprag_sim::scene::controller::EstimatorName;
use sprag_tests::device_loop::decides;
use sprag_tests::sample_tape::{Player, Tape};

/// Ticks a second.
const RATE: usize = 2000;

/// Sensors that one can buy.
static REAL: LazyLock<Vec<Tape>> =
    LazyLock::new(|| EstimatorName::ALL.iter().map(|&estimator| Tape::new(estimator, "adis16470")).collect());

fn readings(sample: &mut Sample, sensor: Sensor) -> &mut [Reading] {
    match sensor {
        Sensor::Gyroscope => std::slice::from_mut(&mut sample.gyroscope),
        Sensor::BlockAccelerometer => &mut sample.block_accelerometer,
        Sensor::GroundAccelerometer => &mut sample.ground_accelerometer,
        Sensor::Encoder => &mut [],
    }
}

/// What became of a motion with spoilt samples.
struct Seen {
    /// Causes of Fault, one after the other.
    faults: Vec<Fault>,
    /// Spoilt ticks at which the law decided.
    decided: usize,
    /// Of the command, from the first tick on.
    changes: usize,
    /// In the log.
    complaints: Vec<Fault>,
    last: Phase,
}

/// Plays a tape of which `spoil` may change the samples of `seconds` from an early swing on, and stillness after it.
fn played(tape: &Tape, seconds: f64, spoil: impl Fn(usize, &mut Sample)) -> Seen {
    let whole = tape.whole(15 * RATE);
    let from = tape.prelude.len() + tape.motion.len() / 10;
    let to = from + (seconds * RATE as f64) as usize;
    let mut player = Player::new(&tape.controller);
    let mut seen = Seen { faults: Vec::new(), decided: 0, changes: 0, complaints: Vec::new(), last: Phase::Boot };
    let mut command = None;
    for (tick, sample) in whole.iter().enumerate() {
        let mut sample = *sample;
        let spoilt = (from..to).contains(&tick);
        if spoilt {
            spoil(tick - from, &mut sample);
        }
        let decision = player.tick(&sample);
        assert!(tick >= from || decision.fault.is_none(), "{decision:?} at {tick}");
        seen.changes += usize::from(command.replace(decision.command) != Some(decision.command));
        seen.decided += usize::from(spoilt && decides(&decision));
        if let Some(fault) = decision.fault
            && seen.faults.last() != Some(&fault)
        {
            seen.faults.push(fault);
        }
        seen.last = decision.phase;
    }
    seen.complaints = player.complaints();
    seen
}

/// Full scale for three seconds: known within 6 ms, and over once the block rests and the sensor is good.
#[test]
fn a_sensor_saturated_for_seconds_is_left_alone_until_it_is_good() {
    for tape in REAL.iter() {
        for sensor in [Sensor::Gyroscope, Sensor::BlockAccelerometer, Sensor::GroundAccelerometer] {
            for sign in [1.0, -1.0] {
                let seen = played(tape, 3.0, |_, sample| {
                    for reading in readings(sample, sensor) {
                        reading.value = sign * 2000.0;
                    }
                });
                if tape.controller.estimator.required().contains(sensor) {
                    assert_eq!(seen.faults.first().and_then(|fault| fault.sensor()), Some(sensor), "{:?}", seen.faults);
                    let continues = tape.controller.estimator.required().has_substitutes();
                    assert!(continues || seen.decided <= 12, "{sensor}: the law decided for {} ticks", seen.decided);
                }
                assert!(seen.complaints.contains(&Fault::Saturated(sensor)), "{:?}", seen.complaints);
                assert_eq!(seen.last, Phase::Armed, "{sensor} {sign}");
            }
        }
    }
}

/// One reading of any kind in mid-motion. What is no number is a fault at once; the smallest numbers there are are numbers.
#[test]
fn readings_that_are_no_numbers_are_faults_and_the_smallest_numbers_are_not() {
    for tape in REAL.iter() {
        for sensor in Sensor::ALL {
            for value in [f32::NAN, -f32::NAN, f32::from_bits(0x7F80_0001), f32::INFINITY, f32::NEG_INFINITY] {
                let seen = played(tape, 0.001, |_, sample| {
                    readings(sample, sensor).iter_mut().for_each(|reading| reading.value = value)
                });
                let needed = tape.controller.estimator.required().contains(sensor) && sensor != Sensor::Encoder;
                assert_eq!(seen.faults.first(), Some(&Fault::NotFinite(sensor)).filter(|_| needed), "{sensor} {value}");
                // Another sensor stands in for one of the model-aided estimator's.
                let continues = tape.controller.estimator.required().has_substitutes();
                assert_eq!(seen.decided, if needed && !continues { 0 } else { 2 });
                assert_eq!(seen.last, Phase::Armed, "{sensor} {value}");
            }
            // For one tick a rate or an acceleration may well be nothing.
            for value in [f32::from_bits(1), -f32::from_bits(1), f32::MIN_POSITIVE, 1e-40, -0.0] {
                let seen = played(tape, 0.0005, |_, sample| {
                    readings(sample, sensor).iter_mut().for_each(|reading| reading.value = value)
                });
                assert_eq!((seen.faults.as_slice(), seen.last), (&[] as &[Fault], Phase::Armed), "{sensor} {value}");
            }
        }
    }
}

/// The two that every estimator needs fail by turns, every tick or every few: it is one fault after the other, never a gap between
/// them, and over when both are good.
#[test]
fn sensors_that_fail_by_turns_keep_the_safe_state() {
    for tape in REAL.iter() {
        let required = tape.controller.estimator.required();
        let needed: Vec<Sensor> = Sensor::ALL.into_iter().filter(|&s| required.contains(s) && s != Sensor::Encoder).collect();
        assert!(needed.len() >= 2);
        for every in [1, 2, 3, 7, 50, 1000] {
            let seen = played(tape, 3.0, |tick, sample| {
                let sensor = needed[tick / every % needed.len()];
                readings(sample, sensor).iter_mut().for_each(|reading| reading.value = f32::NAN);
            });
            // Another sensor stands in for the first one, until the second fails as well.
            let continues = if required.has_substitutes() { every } else { 0 };
            assert_eq!(seen.decided, continues, "every {every} ticks");
            assert_eq!(seen.faults[0], Fault::NotFinite(needed[0]), "the first cause is kept");
            assert_eq!(seen.last, Phase::Armed, "every {every} ticks");
            let codes = seen.complaints;
            assert!(needed.iter().all(|&sensor| codes.contains(&Fault::NotFinite(sensor))), "{codes:?}");
        }
        // Now and then one bad reading, by turns, for 3 s of good ones in between: each time the way back begins anew.
        let seen = played(tape, 9.0, |tick, sample| {
            if tick % (RATE / 2) == 0 {
                let sensor = needed[tick / (RATE / 2) % needed.len()];
                readings(sample, sensor).iter_mut().for_each(|reading| reading.value = f32::INFINITY);
            }
        });
        let continues = if required.has_substitutes() { RATE / 2 } else { 0 };
        assert_eq!((seen.decided, seen.last), (continues, Phase::Armed));
    }
}

/// A sensor that says nothing new for a while, and then continues. Without it a block that has come to rest is found to stand all the same:
/// the clutches move hardly more often than with it.
#[test]
fn a_sensor_that_falls_silent_is_stale_and_comes_back() {
    for tape in REAL.iter() {
        let whole = tape.whole(0);
        let frozen = whole[tape.prelude.len() + tape.motion.len() / 10];
        let undisturbed = played(tape, 0.0, |_, _| {}).changes;
        for sensor in Sensor::ALL.into_iter().filter(|&sensor| tape.controller.estimator.required().contains(sensor)) {
            for seconds in [0.01, 2.0] {
                let seen = played(tape, seconds, |_, sample| {
                    let mut held = frozen;
                    let last: Vec<Reading> = readings(&mut held, sensor).to_vec();
                    readings(sample, sensor).copy_from_slice(&last);
                    if sensor == Sensor::Encoder {
                        sample.encoder = frozen.encoder;
                    }
                });
                let named =
                    format!("{sensor} for {seconds} s, {:?}, {:?}", tape.controller.estimator.required(), seen.complaints);
                assert_eq!(seen.faults.first().and_then(|fault| fault.sensor()), Some(sensor), "{named}: {:?}", seen.faults);
                assert!(seen.complaints.contains(&Fault::Stale(sensor)), "{named}");
                assert_eq!(seen.last, Phase::Armed, "{named}");
                assert!(seen.changes <= 2 * undisturbed, "{named}: {} changes, {undisturbed} undisturbed", seen.changes);
            }
        }
    }
}

/// A count that jumps anywhere, even by half of all there are, and stays there: the encoder contradicts the gyroscope, and the new
/// calibration takes the new zero.
#[test]
fn a_count_that_jumps_is_found_and_calibrated_away() {
    for tape in REAL.iter() {
        let whole = tape.whole(20 * RATE);
        let at = tape.prelude.len() + tape.motion.len() / 10;
        for jump in [100_000, -100_000, i32::MAX, i32::MIN] {
            let mut player = Player::new(&tape.controller);
            let mut first = None;
            let mut last = Phase::Boot;
            for (tick, sample) in whole.iter().enumerate() {
                let mut sample = *sample;
                if tick >= at {
                    sample.encoder.counts = sample.encoder.counts.wrapping_add(jump);
                }
                let decision = player.tick(&sample);
                first = first.or(decision.fault.map(|fault| (tick - at, fault)));
                last = decision.phase;
            }
            let (late, fault) = first.unwrap_or_else(|| panic!("{jump} is not found"));
            // The estimator without a gyroscope has none to compare with, unless it is fitted all the same.
            assert_eq!(fault.sensor(), Some(Sensor::Encoder), "{jump}: {fault}");
            assert!(late <= 12, "{jump}: after {late} ticks");
            assert_eq!(last, Phase::Armed, "{jump}");
            let zero = tape.prelude[0].encoder.counts.wrapping_add(jump);
            let off = player.state.calibration().encoder_zero.wrapping_sub(zero).unsigned_abs();
            assert!(off <= 2, "{jump}: off by {off}");
        }
    }
}
