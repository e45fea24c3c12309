//! What sensors do to a controller over days and at their limits: constant readings, counters that wrap, biases, and time that jumps.
//! Every tick of every case goes through [`Player`], which holds what must hold whatever happens.

use std::sync::LazyLock;

use sprag_shared::control::controller::Decision;
use sprag_shared::control::monitor::fault::Fault;
use sprag_shared::control::sensing::sample::Sample;
use sprag_shared::control::sensing::sensor::Sensor;
use sprag_shared::control::supervisor::Phase;
use sprag_sim::scene::controller::EstimatorName;
use sprag_tests::sample_tape::{Player, Tape, numbered_on};

/// Ticks a second.
const RATE: usize = 2000;

/// Sensors without an error, so that a reading at rest is one number for ever.
static IDEAL: LazyLock<Vec<Tape>> = LazyLock::new(|| tapes("ideal"));

/// Sensors that one can buy.
static REAL: LazyLock<Vec<Tape>> = LazyLock::new(|| tapes("adis16470"));

fn tapes(suite: &str) -> Vec<Tape> {
    EstimatorName::ALL.iter().map(|&estimator| Tape::new(estimator, suite)).collect()
}

/// Constant errors of every sensor, and a count that is not 0 at θ = 0.
#[derive(Clone, Copy, Default)]
struct Errors {
    gyroscope: f32,
    accelerometer: f32,
    count: i32,
}

impl Errors {
    fn of(self, sample: &Sample) -> Sample {
        let mut sample = *sample;
        sample.gyroscope.value += self.gyroscope;
        for reading in sample.block_accelerometer.iter_mut().chain(&mut sample.ground_accelerometer) {
            reading.value += self.accelerometer;
        }
        sample.encoder.counts = sample.encoder.counts.wrapping_add(self.count);
        sample
    }
}

/// An hour in which nothing happens, of readings that are off and never change, while their numbers wrap: the motion after it is
/// estimated, and decided, as it is after five seconds, to the last bit. A clock or an angle that were summed up would have moved.
#[test]
fn an_hour_of_constant_readings_leaves_no_trace() {
    let errors = Errors { gyroscope: 0.015, accelerometer: 0.9, count: i32::MAX - 20_000 };
    std::thread::scope(|scope| {
        for tape in IDEAL.iter() {
            scope.spawn(move || {
                let still = errors.of(&tape.prelude[tape.prelude.len() / 2]);
                let after = |ticks: u32, first: u32| -> (Vec<Decision>, u32) {
                    let mut player = Player::new(&tape.controller);
                    for number in 0..ticks {
                        let decision = player.tick(&numbered_on(&still, first.wrapping_add(number)));
                        let armed = number > 3 * RATE as u32;
                        let stands = decision.estimate.standing && decision.estimate.rotation == 0.0;
                        assert!(!armed || (decision.phase == Phase::Armed && stands), "{decision:?}");
                    }
                    let later = first.wrapping_add(ticks).wrapping_sub(still.gyroscope.number);
                    let moved: Vec<_> = tape.motion.iter().map(|sample| numbered_on(&errors.of(sample), later)).collect();
                    (player.play(&moved), player.state.supervisor().log.count())
                };
                let (soon, events) = after(5 * RATE as u32, 1);
                let (late, later_events) = after(3600 * RATE as u32, u32::MAX - 1800 * RATE as u32);
                assert!(soon.iter().any(|decision| decision.phase == Phase::Rocking));
                assert_eq!((soon, events), (late, later_events));
            });
        }
    });
}

/// Biases that have wandered since they were calibrated, by ten times what the sensors' sheet has: no angle comes of them in an hour.
#[test]
fn a_bias_that_wanders_turns_no_standing_block_in_an_hour() {
    let wandered = Errors { gyroscope: 4e-4, accelerometer: 0.01, count: 2 };
    std::thread::scope(|scope| {
        for tape in REAL.iter() {
            scope.spawn(move || {
                let mut player = Player::new(&tape.controller);
                player.play(&tape.prelude);
                let last = tape.prelude[tape.prelude.len() - 1];
                for (tick, sample) in tape.stillness_after(&last).take(3600 * RATE).enumerate() {
                    let share = (tick as f32 / (60.0 * RATE as f32)).min(1.0);
                    let Errors { gyroscope, accelerometer, count } = wandered;
                    let errors = Errors { gyroscope: share * gyroscope, accelerometer: share * accelerometer, count };
                    let decision = player.tick(&errors.of(&sample));
                    assert_eq!(decision.phase, Phase::Armed, "{decision:?} at {tick}");
                    assert!(decision.estimate.rotation.abs() < 2e-5, "{decision:?} at {tick}");
                }
                assert_eq!(player.complaints(), []);
            });
        }
    });
}

/// From the tick after that of the calibration on: before it nobody knows where the count is 0.
fn armed(decisions: Vec<Decision>) -> Vec<Decision> {
    decisions.into_iter().skip_while(|decision| decision.phase != Phase::Armed).skip(1).collect()
}

/// Numbers of readings and counts of the encoder mean nothing but their differences: wherever they start, and wherever they wrap, every
/// decision of the motion is the same to the last bit.
#[test]
fn numbers_and_counts_may_wrap_at_any_instant_of_a_motion() {
    for tape in REAL.iter() {
        let whole = tape.whole(2 * RATE);
        let middle = whole[tape.prelude.len() + tape.motion.len() / 8].gyroscope.number;
        let reference = armed(Player::new(&tape.controller).play(&whole));
        assert!(reference.iter().any(|decision| decision.command != [false; 2]));
        let farthest = whole.iter().map(|sample| sample.encoder.counts).max().unwrap();
        assert!(farthest > 100);
        for (numbers, counts) in [
            // Through 2^32 in mid-motion, through 2^31, and each of the counts' ends in mid-swing.
            (u32::MAX - middle, 0),
            ((1 << 31) - middle, i32::MAX - farthest / 2),
            (0x5555_5555, i32::MIN + farthest / 2),
            (u32::MAX - middle - 1, i32::MAX),
            (7, i32::MIN),
        ] {
            let errors = Errors { count: counts, ..Errors::default() };
            let moved: Vec<_> = whole.iter().map(|sample| numbered_on(&errors.of(sample), numbers)).collect();
            assert!(armed(Player::new(&tape.controller).play(&moved)) == reference, "{numbers} {counts}");
        }
    }
}

/// Days without a reading lost are days in which numbers go up: a jump of any size is one new reading.
#[test]
fn numbers_that_jump_are_one_new_reading() {
    for tape in REAL.iter() {
        let whole = tape.whole(RATE);
        let reference = Player::new(&tape.controller).play(&whole);
        let later = |tick: usize| (tick as u32).wrapping_mul(172_800_000 + 1);
        let jumping: Vec<_> = whole.iter().map(|sample| numbered_on(sample, later(sample.gyroscope.number as usize))).collect();
        let fresh =
            |samples: &[Sample]| samples.windows(2).filter(|pair| pair[0].gyroscope.number != pair[1].gyroscope.number).count();
        assert_eq!(fresh(&jumping), fresh(&whole));
        assert_eq!(Player::new(&tape.controller).play(&jumping), reference);
    }
}

/// Just inside of what a calibration accepts the bias is gone from the estimate; just outside it is a fault of that sensor where the
/// estimator needs it, of which the calibration is tried again and again.
#[test]
fn biases_at_the_limits_of_calibration() {
    for tape in REAL.iter() {
        let whole = tape.whole(2 * RATE);
        let reference = armed(Player::new(&tape.controller).play(&whole));
        for sign in [1.0, -1.0] {
            let inside = Errors { gyroscope: sign * 0.19, accelerometer: sign * 0.9, count: 0 };
            let biased: Vec<_> = whole.iter().map(|sample| inside.of(sample)).collect();
            let decisions = Player::new(&tape.controller).play(&biased);
            assert!(decisions.iter().all(|decision| decision.fault.is_none()));
            for (decision, expected) in armed(decisions).iter().zip(&reference) {
                let off = (decision.estimate.rotation - expected.estimate.rotation).abs();
                assert!(off < 1e-3, "{decision:?} {expected:?}");
            }
            let required = tape.controller.estimator.required();
            for (errors, sensors) in [
                (Errors { gyroscope: sign * 0.21, ..Errors::default() }, vec![Sensor::Gyroscope]),
                (
                    Errors { accelerometer: sign * 3.0, ..Errors::default() },
                    vec![Sensor::BlockAccelerometer, Sensor::GroundAccelerometer],
                ),
            ] {
                let needed = sensors.iter().find(|&&sensor| required.contains(sensor)).copied();
                let still = tape.prelude.iter().copied().chain(tape.stillness_after(&tape.prelude[tape.prelude.len() - 1]));
                let biased: Vec<_> = still.take(20 * RATE).map(|sample| errors.of(&sample)).collect();
                let mut player = Player::new(&tape.controller);
                let last = *player.play(&biased).last().unwrap();
                match needed {
                    Some(sensor) => {
                        assert_ne!(last.phase, Phase::Armed, "{last:?}");
                        let tries = player.complaints().iter().filter(|&&fault| fault == Fault::Contradiction(sensor)).count();
                        assert!(tries >= 3, "{:?}", player.complaints());
                    }
                    None => assert_eq!(last.phase, Phase::Armed, "{last:?}"),
                }
            }
        }
    }
}

/// A tick that is late by far, or not a number, stops the controller until somebody has looked; a little, once, does not.
#[test]
fn time_that_jumps_is_an_overrun_until_it_is_cleared() {
    for tape in REAL.iter() {
        let whole = tape.whole(20 * RATE);
        let at = tape.prelude.len() + tape.motion.len() / 10;
        for (lateness, stops) in [(0.001, false), (0.01, true), (f32::INFINITY, true), (f32::NAN, true), (-1.0, false)] {
            let mut player = Player::new(&tape.controller);
            let mut before = Phase::Boot;
            for (tick, sample) in whole.iter().enumerate() {
                player.asked.clear = tick + 8 * RATE == whole.len();
                let decision = player.tick_late(sample, if tick == at { lateness } else { 0.0 });
                if (at..whole.len() - 8 * RATE - 1).contains(&tick) {
                    let expected = if stops { Some(Fault::Overrun) } else { None };
                    assert_eq!(decision.fault, expected, "{lateness} at {tick}");
                }
                before = decision.phase;
            }
            assert_eq!(before, Phase::Armed, "{lateness}");
        }
    }
}
