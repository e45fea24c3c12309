//! What is done without a sensor or a clutch.

use super::*;
use crate::control::monitor::coil::{CoilReport, CoilTrouble};

type Spoil = fn(&mut Sample, &Sample);

/// Those of the model-aided estimator.
fn model_aided() -> Parameters {
    Parameters { required: Required { block_accelerometer: false, ..Required::ALL }, ..noisy() }
}

#[test]
fn another_sensor_stands_in_for_one_that_is_lost() {
    let losses: [(Sensor, Spoil); 3] = [
        (Sensor::Gyroscope, |sample, held| sample.gyroscope = held.gyroscope),
        (Sensor::GroundAccelerometer, |sample, held| sample.ground_accelerometer = held.ground_accelerometer),
        (Sensor::Encoder, |sample, held| sample.encoder = held.encoder),
    ];
    for rig in [Rig::armed(&model_aided()), Rig::rocking(&model_aided())] {
        for (sensor, spoil) in losses {
            let mut rig = rig.clone();
            rig.wish = [false, true];
            let (tick, fault) = rig.found(10, spoil).unwrap();
            assert_eq!((fault, rig.state.phase() == Phase::Fault), (Fault::Stale(sensor), false), "{tick}");
            let verdict = rig.spoilt(spoil);
            assert_eq!((verdict.command, verdict.fault), ([false, true], Some(fault)), "the law continues and reports the fault");
            let index = Sensor::ALL.iter().position(|other| *other == sensor).unwrap();
            assert_eq!(rig.state.trusted(), core::array::from_fn(|other| other != index));
            assert_eq!(rig.complaints(), [Kind::Warning(fault.code())]);
            // A second one is too much.
            let mut worse = rig.clone();
            let second: Spoil = |sample, held| {
                (sample.gyroscope, sample.encoder) = (held.gyroscope, held.encoder);
                sample.ground_accelerometer = held.ground_accelerometer;
            };
            for _ in 0..10 {
                worse.spoilt(second);
            }
            assert_eq!((worse.state.phase(), worse.step().command), (Phase::Fault, [true, false]));
            // It is taken again when it has been good for long, an encoder once it has been calibrated.
            for _ in 0..2000 {
                assert_eq!(rig.step().fault, Some(fault));
            }
            rig.run(10);
            let taken = sensor != Sensor::Encoder || rig.state.phase() == Phase::Calibrate;
            assert_eq!(rig.state.trusted() == [true; 4], taken);
            rig.until(Phase::Armed, 100_000);
            rig.run(20_000);
            assert_eq!((rig.state.trusted(), rig.step().fault, rig.state.phase()), ([true; 4], None, Phase::Armed));
        }
    }
}

#[test]
fn two_rates_that_contradict_each_other_leave_one_clutch_engaged() {
    let mut rig = Rig::rocking(&model_aided());
    let (_, fault) = rig.found(200, |sample, _| sample.gyroscope.value += 0.5).unwrap();
    assert!(matches!(fault, Fault::Contradiction(_)), "{fault:?}");
    assert_eq!((rig.state.phase(), rig.step().command), (Phase::Fault, [true, false]));
}

#[test]
fn both_are_released_only_where_an_engaged_clutch_is_the_fault() {
    for wheel in Wheel::ALL {
        // Engaged unbidden, with none or with the other one commanded.
        for (wish, both) in [([false; 2], false), (wheel.other().alone(), true)] {
            let mut rig = Rig::rocking(&noisy());
            rig.wish = wish;
            rig.quietly(100);
            let (_, fault) = rig.found(200, |sample, _| sample.engaged[wheel as usize] = true).unwrap();
            assert_eq!(fault, if both { Fault::BothClutches } else { Fault::ClutchEngagedUnbidden(wheel) });
            assert_eq!(rig.spoilt(|sample, _| sample.engaged[wheel as usize] = true).command, [false; 2]);
        }
        for (trouble, command) in [
            (CoilTrouble::OverCurrent, [false; 2]),
            (CoilTrouble::HighSideClosed, [false; 2]),
            (CoilTrouble::LowSideClosed, [false; 2]),
            (CoilTrouble::WrongCurrent, [wheel == Wheel::Second, wheel == Wheel::First]),
        ] {
            let mut rig = Rig::rocking(&noisy());
            rig.coils[wheel as usize] = CoilReport::Trouble(trouble);
            rig.run(1);
            let expected = if trouble == CoilTrouble::WrongCurrent && wheel == Wheel::Second { [true, false] } else { command };
            assert_eq!(rig.step().command, expected, "{trouble:?} {wheel:?}");
        }
        // One that refuses leaves it to the other.
        let mut rig = Rig::rocking(&noisy());
        rig.wish = wheel.alone();
        let (_, fault) = rig.found(200, |sample, _| sample.engaged[wheel as usize] = false).unwrap();
        assert_eq!(fault, Fault::ClutchRefuses(wheel));
        assert_eq!(rig.spoilt(|sample, _| sample.engaged[wheel as usize] = false).command, wheel.other().alone());
    }
    // A clutch that is found to be engaged later is released as well, and stays so.
    let mut rig = Rig::rocking(&noisy());
    for tick in 0..400 {
        rig.spoilt(|sample, _| {
            sample.gyroscope.value = f32::NAN;
            sample.engaged[1] |= tick > 100;
        });
    }
    assert_eq!((rig.state.phase(), rig.run(100).command), (Phase::Fault, [false; 2]));
}

/// Whatever fault came first, and whichever came with it, the clutch that can be engaged is, unless an engaged one is a fault.
#[test]
fn what_a_clutch_lacks_is_remembered_beside_another_fault() {
    let mut rig = Rig::rocking(&noisy());
    rig.wish = [false, true];
    rig.quietly(100);
    let spoil: Spoil = |sample, _| (sample.gyroscope.value, sample.engaged[0]) = (f32::NAN, false);
    assert_eq!(rig.found(10, spoil), Some((1, Fault::NotFinite(Sensor::Gyroscope))));
    for _ in 0..400 {
        rig.spoilt(spoil);
    }
    assert!(rig.complaints().contains(&Kind::Fault(Fault::ClutchRefuses(Wheel::First).code())), "{:?}", rig.complaints());
    assert_eq!(rig.spoilt(spoil).command, [false, true]);
    // The sensor is good again, the clutch is not.
    for _ in 0..10_000 {
        rig.spoilt(|sample, _| sample.engaged[0] = false);
    }
    assert_eq!(rig.spoilt(|sample, _| sample.engaged[0] = false).command, [false, true]);
    // A short in the one coil while the other clutch refuses.
    let mut rig = Rig::rocking(&noisy());
    rig.wish = [true, false];
    rig.quietly(100);
    for tick in 0..400 {
        let refuses = rig.found(1, |sample, _| sample.engaged[0] = false);
        rig.coils[1] = if tick >= 8 { CoilReport::Trouble(CoilTrouble::OverCurrent) } else { CoilReport::Well };
        assert!(tick < 50 || refuses.is_some());
    }
    assert_eq!(rig.spoilt(|sample, _| sample.engaged[0] = false).command, [false; 2]);
}
