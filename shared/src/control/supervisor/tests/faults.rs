//! Every class of fault, at rest, in mid-swing and at an impact: found in its time, and not before.

use super::*;
use crate::control::monitor::coil::{CoilReport, CoilTrouble};
use crate::control::sensing::sample::Reading;

type Spoil = fn(&mut Sample, &Sample);

fn set(readings: &mut [Reading], value: f32) {
    readings.iter_mut().for_each(|reading| reading.value = value);
}

fn keep_values(readings: &mut [Reading], held: &[Reading]) {
    readings.iter_mut().zip(held).for_each(|(reading, held)| reading.value = held.value);
}

/// A fault that a sensor shows by itself, and after how many ticks it must be found: from and to, as 1 is the first sample of it.
const ALONE: [(Fault, Spoil, [u32; 2]); 16] = {
    use Sensor::{BlockAccelerometer, Encoder, GroundAccelerometer, Gyroscope};
    [
        (Fault::Stale(Gyroscope), |sample, held| sample.gyroscope = held.gyroscope, [4, 6]),
        (Fault::Stale(BlockAccelerometer), |sample, held| sample.block_accelerometer[1] = held.block_accelerometer[1], [4, 6]),
        (Fault::Stale(GroundAccelerometer), |sample, held| sample.ground_accelerometer = held.ground_accelerometer, [4, 6]),
        (Fault::Stale(Encoder), |sample, held| sample.encoder = held.encoder, [4, 6]),
        (Fault::Stuck(Gyroscope), |sample, held| sample.gyroscope.value = held.gyroscope.value, [6, 10]),
        (
            Fault::Stuck(BlockAccelerometer),
            |sample, held| keep_values(&mut sample.block_accelerometer, &held.block_accelerometer),
            [6, 10],
        ),
        (
            Fault::Stuck(GroundAccelerometer),
            |sample, held| keep_values(&mut sample.ground_accelerometer, &held.ground_accelerometer),
            [6, 10],
        ),
        (Fault::Saturated(Gyroscope), |sample, _| sample.gyroscope.value = -8.7, [4, 5]),
        (Fault::Saturated(BlockAccelerometer), |sample, _| sample.block_accelerometer[0].value = 78.0, [8, 9]),
        (Fault::Saturated(GroundAccelerometer), |sample, _| sample.ground_accelerometer[1].value = -78.0, [8, 9]),
        (Fault::NotFinite(Gyroscope), |sample, _| sample.gyroscope.value = f32::NAN, [1, 1]),
        (Fault::NotFinite(Gyroscope), |sample, _| sample.gyroscope.value = f32::INFINITY, [1, 1]),
        (Fault::NotFinite(BlockAccelerometer), |sample, _| sample.block_accelerometer[1].value = f32::NAN, [1, 1]),
        (Fault::NotFinite(BlockAccelerometer), |sample, _| set(&mut sample.block_accelerometer, f32::NEG_INFINITY), [1, 1]),
        (Fault::NotFinite(GroundAccelerometer), |sample, _| set(&mut sample.ground_accelerometer, f32::NAN), [1, 1]),
        (Fault::NotFinite(GroundAccelerometer), |sample, _| sample.ground_accelerometer[0].value = f32::INFINITY, [1, 1]),
    ]
};

#[test]
fn what_a_sensor_shows_by_itself() {
    for (place, rig) in [("rest", Rig::armed(&noisy())), ("swing", Rig::rocking(&noisy())), ("impact", Rig::impact(&noisy()))] {
        for later in 0..2 {
            let mut rig = rig.clone();
            rig.quietly(later);
            for (fault, spoil, [from, to]) in ALONE {
                let mut rig = rig.clone();
                let (tick, found) = rig.found(20, spoil).unwrap_or_else(|| panic!("{fault} at {place}"));
                // A gyroscope at full scale, or stuck or silent in a jolt, is contradicted by the encoder before its time is up, and an accelerometer
                // that sticks at the top of a spike is saturated too: found no later, under another name.
                let otherwise = match fault {
                    Fault::Saturated(Sensor::Gyroscope) => matches!(found, Fault::Contradiction(_) | Fault::Stuck(_)),
                    Fault::Stale(Sensor::Gyroscope) | Fault::Stuck(Sensor::Gyroscope) => {
                        place == "impact" && found == Fault::Contradiction(Sensor::Encoder)
                    }
                    Fault::Stuck(Sensor::BlockAccelerometer) => {
                        place == "impact" && found == Fault::Saturated(Sensor::BlockAccelerometer)
                    }
                    _ => false,
                };
                assert!(found == fault || otherwise, "{place} {later}: {fault} found as {found}");
                assert!(tick <= to && (tick >= from || otherwise), "{place} {later}: {fault} after {tick}");
                assert!(rig.complaints().contains(&Kind::Fault(found.code())));
            }
        }
    }
}

#[test]
fn shorter_than_that_is_no_fault() {
    for rig in [Rig::armed(&noisy()), Rig::rocking(&noisy()), Rig::impact(&noisy())] {
        for (fault, spoil, [from, _]) in ALONE.into_iter().filter(|(fault, ..)| *fault != Fault::Saturated(Sensor::Gyroscope)) {
            let mut rig = rig.clone();
            assert_eq!(rig.found(from - 1, spoil), None, "{fault}");
            // What a frozen or saturated reading leaves must be gone as well.
            rig.quietly(400);
        }
    }
}

#[test]
fn a_sensor_without_noise_may_be_constant_at_rest() {
    for (index, (fault, spoil, _)) in ALONE.into_iter().enumerate().filter(|(_, (fault, ..))| matches!(fault, Fault::Stuck(_))) {
        let mut rig = Rig::armed(&parameters());
        assert_eq!(rig.found(4000, spoil), None, "{fault}");
        // In motion it may not; of the ground nothing is known.
        let found = Rig::rocking(&parameters()).found(10, spoil).map(|(_, found)| found);
        assert_eq!(found, Some(fault).filter(|_| index < 6), "{fault}");
    }
}

#[test]
fn a_gyroscope_against_the_encoder() {
    let offset: Spoil = |sample, _| sample.gyroscope.value += 1.0;
    let (tick, found) = Rig::armed(&noisy()).found(20, offset).unwrap();
    assert_eq!(found, Fault::Contradiction(Sensor::Gyroscope), "the accelerometer says that nothing moves");
    assert!(tick <= 10, "{tick}");
    for mut rig in [Rig::rocking(&noisy()), Rig::impact(&noisy())] {
        let (tick, found) = rig.found(20, offset).unwrap();
        assert_eq!(found, Fault::Contradiction(Sensor::Encoder));
        assert!(tick <= 10, "{tick}");
    }
    // A gyroscope of the wrong sign or scale.
    let (tick, _) = Rig::rocking(&noisy()).found(20, |sample, _| sample.gyroscope.value = BIAS - sample.gyroscope.value).unwrap();
    assert!(tick <= 10, "{tick}");
    // A small bias takes the slow window.
    let (tick, found) = Rig::armed(&noisy()).found(300, |sample, _| sample.gyroscope.value += 0.06).unwrap();
    assert!(found == Fault::Contradiction(Sensor::Gyroscope) && tick <= 144, "{found} {tick}");
}

#[test]
fn an_encoder_that_stays_is_known_when_it_should_move() {
    let stays: Spoil = |sample, held| sample.encoder.counts = held.encoder.counts;
    let (tick, found) = Rig::rocking(&noisy()).found(20, stays).unwrap();
    assert_eq!(found, Fault::Stuck(Sensor::Encoder));
    assert!(tick <= 10, "{tick}");
    let mut rig = Rig::armed(&noisy());
    assert_eq!(rig.found(4000, stays), None);
    rig.velocity = 0.28;
    let (tick, found) = rig.found(20, stays).unwrap();
    assert_eq!(found, Fault::Stuck(Sensor::Encoder));
    assert!(tick <= 10, "{tick}");
    // One that jumps is known at once.
    let (tick, found) = Rig::rocking(&noisy()).found(20, |sample, _| sample.encoder.counts += 5000).unwrap();
    assert_eq!((tick, found), (1, Fault::Contradiction(Sensor::Encoder)));
    let mut limited = noisy();
    limited.monitor.encoder.travel = 25_000;
    let travelled: Spoil = |sample, _| sample.encoder.counts -= 26_000;
    assert_eq!(Rig::armed(&limited).found(20, travelled), Some((1, Fault::Saturated(Sensor::Encoder))));
}

#[test]
fn accelerometers_against_gravity_at_rest() {
    let block: Spoil = |sample, _| sample.block_accelerometer[0].value += 0.8;
    let ground: Spoil = |sample, _| sample.ground_accelerometer[1].value += 0.8;
    for (spoil, sensor) in [(block, Sensor::BlockAccelerometer), (ground, Sensor::GroundAccelerometer)] {
        let (tick, found) = Rig::armed(&noisy()).found(300, spoil).unwrap();
        assert_eq!(found, Fault::Contradiction(sensor));
        assert!((199..=203).contains(&tick), "{tick}");
        // In motion nothing is known about it.
        assert_eq!(Rig::rocking(&noisy()).found(300, spoil), None);
    }
}

#[test]
fn a_calibration_refuses_what_cannot_be() {
    let cases: [(Spoil, Sensor); 3] = [
        (|sample, _| sample.gyroscope.value += 0.3, Sensor::Gyroscope),
        (|sample, _| sample.block_accelerometer[0].value += 3.0, Sensor::BlockAccelerometer),
        (|sample, _| sample.ground_accelerometer[1].value -= 3.0, Sensor::GroundAccelerometer),
    ];
    for (spoil, sensor) in cases {
        let mut parameters = noisy();
        let found = Rig::new(&parameters).found(4000, spoil).map(|(_, fault)| fault);
        assert_eq!(found, Some(Fault::Contradiction(sensor)));
        parameters.required = Required::NONE;
        let mut rig = Rig::new(&parameters);
        assert_eq!(rig.found(4000, spoil), None);
        assert_eq!(rig.complaints()[0], Kind::Warning(Fault::Contradiction(sensor).code()));
        let Calibration { gyroscope, block, ground, .. } = rig.state.calibration;
        assert!([gyroscope, block[0], ground[1]].into_iter().all(|bias| bias.abs() < 0.06));
    }
}

#[test]
fn clutches_that_do_not_obey() {
    for wheel in Wheel::ALL {
        for mut rig in [Rig::armed(&noisy()), Rig::rocking(&noisy()), Rig::impact(&noisy())] {
            // By itself: 3 ms.
            let engaged = |sample: &mut Sample| sample.engaged = wheel.alone();
            assert_eq!(rig.clone().found(100, |sample, _| engaged(sample)), Some((7, Fault::ClutchEngagedUnbidden(wheel))));
            assert_eq!(rig.clone().found(100, |sample, _| sample.engaged = [true; 2]), Some((7, Fault::BothClutches)));
            // On command: 30 ms, the first of its ticks being the one that sends the command.
            rig.wish = wheel.alone();
            assert_eq!(rig.clone().found(100, |sample, _| sample.engaged = [false; 2]), Some((62, Fault::ClutchRefuses(wheel))));
            rig.quietly(100);
            rig.wish = [false; 2];
            assert_eq!(rig.found(100, |sample, _| engaged(sample)), Some((62, Fault::ClutchEngagedUnbidden(wheel))));
        }
    }
}

#[test]
fn a_self_test_that_fails() {
    let cases: [(Spoil, Wheel, SafeState); 4] = [
        (|sample, _| sample.engaged[0] = false, Wheel::First, SafeState::Engaged(Wheel::First)),
        (|sample, _| sample.engaged[1] = false, Wheel::Second, SafeState::Engaged(Wheel::First)),
        (|sample, _| sample.engaged[0] = true, Wheel::First, SafeState::Engaged(Wheel::First)),
        (|sample, _| sample.engaged[1] = true, Wheel::Second, SafeState::Released),
    ];
    for (spoil, wheel, safe_state) in cases {
        let (_, fault) = Rig::new(&Parameters { safe_state, ..parameters() }).found(1000, spoil).unwrap();
        assert_eq!(fault, Fault::SelfTestFailed(wheel));
    }
}

/// At the tick that reports it, whatever the feedback says and whatever the phase.
#[test]
fn what_a_coils_current_shows_is_a_fault_at_once() {
    let cases = [
        (CoilTrouble::OverCurrent, Fault::OverCurrent as fn(Wheel) -> Fault),
        (CoilTrouble::HighSideClosed, Fault::HighSideClosed),
        (CoilTrouble::LowSideClosed, Fault::LowSideClosed),
        (CoilTrouble::WrongCurrent, Fault::WrongCurrent),
    ];
    for rig in [Rig::new(&noisy()), Rig::armed(&noisy()), Rig::rocking(&noisy()), Rig::impact(&noisy())] {
        for (trouble, fault) in cases {
            for wheel in Wheel::ALL {
                let mut rig = rig.clone();
                rig.run(100);
                rig.coils[wheel as usize] = CoilReport::Trouble(trouble);
                assert_eq!(rig.found(10, |_, _| {}), Some((1, fault(wheel))));
            }
        }
    }
}

#[test]
fn feedback_is_not_judged_while_switches_are_tried() {
    let mut rig = Rig::new(&parameters());
    rig.until(Phase::SelfTest, 100);
    rig.coils[0] = CoilReport::Testing;
    assert_eq!(rig.found(1000, |sample, _| sample.engaged[0] = false), None, "for as long as it takes");
    assert_eq!(rig.state.phase(), Phase::SelfTest);
    rig.coils[0] = CoilReport::Well;
    rig.until(Phase::Armed, 8000);
}

#[test]
fn ticks_that_come_too_late() {
    for mut rig in [Rig::armed(&noisy()), Rig::rocking(&noisy()), Rig::impact(&noisy())] {
        for _ in 0..50 {
            rig.lateness = 0.001;
            rig.quietly(2);
            rig.lateness = 0.0;
            rig.quietly(1);
        }
        rig.lateness = 0.0001;
        assert_eq!(rig.clone().found(10, |_, _| {}), Some((3, Fault::Overrun)));
        for lateness in [0.0021, f32::NAN, f32::INFINITY] {
            rig.lateness = lateness;
            assert_eq!(rig.clone().found(10, |_, _| {}), Some((1, Fault::Overrun)));
        }
    }
}

#[test]
fn an_estimate_that_is_lost() {
    for mut rig in [Rig::armed(&noisy()), Rig::rocking(&noisy()), Rig::impact(&noisy())] {
        rig.estimate_lost = true;
        assert_eq!(rig.clone().found(10, |_, _| {}), Some((1, Fault::EstimateNotFinite)));
        // Its sensor is the cause where that is bad.
        let found = rig.found(10, |sample, _| sample.gyroscope.value = f32::NAN);
        assert_eq!(found, Some((1, Fault::NotFinite(Sensor::Gyroscope))));
        assert_eq!(rig.complaints().len(), 1);
    }
}

#[test]
fn boot_waits_for_what_is_required() {
    let silent: Spoil = |sample, _| sample.ground_accelerometer[1] = Reading::default();
    let found = Rig::new(&parameters()).found(4000, silent);
    assert_eq!(found, Some((2001, Fault::Stale(Sensor::GroundAccelerometer))));
    let found = Rig::new(&parameters()).found(4000, |sample, _| sample.gyroscope.value = f32::NAN);
    assert_eq!(found, Some((2001, Fault::NotFinite(Sensor::Gyroscope))));
    let mut rig = Rig::new(&Parameters { required: Required { ground_accelerometer: false, ..Required::ALL }, ..parameters() });
    assert_eq!(rig.found(4000, silent), None);
    assert_eq!(
        (rig.state.phase(), rig.complaints().len()),
        (Phase::Armed, 0),
        "a sensor that is not there is nothing to warn of"
    );
}
