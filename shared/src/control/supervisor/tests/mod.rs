use super::*;
use crate::control::sensing::sample::Sample;
use rig::{BIAS, Random, Rig, noisy, parameters, with_noise};
use std::vec::Vec;

mod faults;
mod garbage;
mod ladder;
mod proof_test;
mod recovery;
mod rig;
mod scale;
mod wraps;

#[test]
fn from_boot_to_rocking_and_back() {
    let mut rig = Rig::new(&parameters());
    rig.wish = [true, false];
    assert_eq!(rig.state.phase(), Phase::Boot);
    assert!(rig.until(Phase::SelfTest, 10) <= 2);
    // 0.1 s of stillness and four moves of 10 ms; then 1 s of averages.
    assert!((280..320).contains(&rig.until(Phase::Calibrate, 1000)));
    let ticks = rig.until(Phase::Armed, 3000);
    assert!((2000..2010).contains(&ticks), "{ticks}");
    let verdict = rig.step();
    assert_eq!(verdict.command, [true, false]);
    let found = *rig.state.calibration();
    for bias in [found.gyroscope, found.block[0], found.block[1], found.ground[0], found.ground[1]] {
        assert!((bias - BIAS).abs() < 3e-3, "{found:?}");
    }
    rig.velocity = 0.28;
    assert!(rig.until(Phase::Rocking, 10) <= 3);
    rig.until(Phase::Armed, 40_000);
    assert!(rig.impacts > 10 && rig.rotation == 0.0);
    let phases: Vec<Kind> = rig.kinds().into_iter().filter(|kind| matches!(kind, Kind::Phase(_) | Kind::Calibrated)).collect();
    let expected = [Phase::SelfTest, Phase::Calibrate, Phase::Armed, Phase::Rocking, Phase::Armed].map(Kind::Phase);
    assert_eq!(phases[..2], expected[..2]);
    assert_eq!(phases[2], Kind::Calibrated);
    assert_eq!(phases[3..], expected[2..]);
    assert_eq!(rig.complaints(), []);
}

#[test]
fn estimators_get_the_biases_once() {
    let mut rig = Rig::new(&parameters());
    let armed: Vec<bool> = (0..5000)
        .map(|_| rig.step())
        .filter(|verdict| verdict.biases == Biases::Measured)
        .map(|v| v.phase == Phase::Armed)
        .collect();
    assert_eq!(armed, [true]);
}

#[test]
fn a_shaking_ground_wakes_it_too() {
    let mut rig = Rig::armed(&parameters());
    rig.shaking = 1.0;
    assert!(rig.until(Phase::Rocking, 10) <= 3);
    rig.quietly(10_000);
    rig.shaking = 0.0;
    let ticks = rig.until(Phase::Armed, 5000);
    assert!((4000..4050).contains(&ticks), "{ticks}");
    assert_eq!(rig.complaints(), []);
}

#[test]
fn counters_wrap_unnoticed() {
    for first_count in [i32::MAX - 500, i32::MIN + 500, i32::MAX] {
        let mut rig = Rig::new(&noisy());
        (rig.first_number, rig.first_count) = (u32::MAX - 4300, first_count);
        rig.until(Phase::Armed, 4000);
        rig.quietly(3000);
        rig.velocity = 0.28;
        rig.quietly(10_000);
        assert_eq!(rig.complaints(), []);
        assert!(rig.impacts >= 2, "{}", rig.impacts);
        let zero = rig.state.calibration.encoder_zero;
        assert!(zero.wrapping_sub(first_count).abs() <= 1);
    }
}

#[test]
fn no_alarm_without_a_fault() {
    for parameters in [parameters(), noisy()] {
        for spike in [0.0, 5.0, 100.0, 300.0, -300.0] {
            for velocity in [0.05, 0.15, 0.29, -0.295, 0.2999] {
                let mut rig = Rig::armed(&parameters);
                (rig.velocity, rig.spike, rig.shaking) = (velocity, spike, if spike == 5.0 { 2.0 } else { 0.0 });
                rig.quietly(12_000);
                assert_eq!(rig.complaints(), [], "{spike} {velocity}");
            }
        }
    }
}

#[test]
fn a_calibration_starts_again_when_something_moves() {
    let mut rig = Rig::new(&parameters());
    rig.until(Phase::Calibrate, 1000);
    rig.run(1900);
    rig.shaking = 1.0;
    rig.run(100);
    rig.shaking = 0.0;
    let ticks = rig.until(Phase::Armed, 4000);
    assert!((2000..2050).contains(&ticks), "{ticks}");
    assert_eq!(rig.complaints(), []);
    assert!((rig.state.calibration.ground[0] - BIAS).abs() < 3e-3);
}

#[test]
fn an_earthquake_does_not_find_it_waiting() {
    // While it calibrates.
    let mut rig = Rig::new(&parameters());
    rig.until(Phase::Calibrate, 1000);
    rig.shaking = 1.0;
    let ticks = rig.until(Phase::Armed, 7000);
    assert!((6000..6010).contains(&ticks), "{ticks}");
    assert_eq!(rig.complaints(), [Kind::Warning(Fault::CalibrationAbandoned.code())]);
    assert_eq!(rig.state.calibration, Calibration::default());
    rig.wish = [false, true];
    let verdict = rig.step();
    assert_eq!((verdict.phase, verdict.command), (Phase::Rocking, [false, true]));
    // Its biases are those of a motion, as far as it knows; the first rest measures them.
    rig.quietly(10_000);
    rig.shaking = 0.0;
    let ticks = rig.until(Phase::Calibrate, 5000);
    assert!((4000..4050).contains(&ticks), "{ticks}");
    rig.until(Phase::Armed, 2100);
    assert!((rig.state.calibration.gyroscope - BIAS).abs() < 3e-3);
    rig.quietly(5000);
    assert_eq!((rig.state.phase, rig.complaints().len()), (Phase::Armed, 1));
    // And before it can test its clutches.
    let mut rig = Rig::new(&parameters());
    rig.shaking = 1.0;
    let ticks = rig.until(Phase::Armed, 7000);
    assert!((6000..6010).contains(&ticks), "{ticks}");
    let warnings = [Fault::SelfTestAbandoned, Fault::CalibrationAbandoned].map(|fault| Kind::Warning(fault.code()));
    assert_eq!(rig.complaints(), warnings);
    assert!(!rig.kinds().contains(&Kind::Engaged(Wheel::Second)), "a pulse while it shakes");
}

/// A shock in the calibration that follows a motion is answered at once, by the biases of before.
#[test]
fn an_aftershock_does_not_wait_for_the_first_calibration() {
    let mut rig = Rig::new(&parameters());
    rig.until(Phase::Calibrate, 1000);
    rig.shaking = 1.0;
    rig.until(Phase::Rocking, 7000);
    rig.shaking = 0.0;
    rig.until(Phase::Calibrate, 5000);
    rig.quietly(1000);
    assert_eq!(rig.state.phase, Phase::Calibrate);
    rig.shaking = 1.0;
    assert!(rig.until(Phase::Rocking, 50) <= 42);
    rig.shaking = 0.0;
    rig.until(Phase::Armed, 7000);
    assert!((rig.state.calibration.ground[0] - BIAS).abs() < 3e-3);
}

/// An accelerometer that is off by less than a calibration takes is none that contradicts gravity, however long the calibration takes.
#[test]
fn biases_are_not_held_against_accelerometers_before_they_are_measured() {
    let slow = Parameters { calibration_time: 2.5, calibration_patience: 5.0, ..noisy() };
    for (block, ground) in [(0.0, 0.7), (0.7, 0.0), (0.0, -0.9)] {
        let mut rig = Rig::new(&slow);
        let armed = (0..10_000).any(|_| {
            let verdict = rig.spoilt(|sample, _| {
                sample.block_accelerometer[0].value += block;
                sample.ground_accelerometer[0].value += ground;
            });
            assert_eq!(verdict.fault, None, "{block} {ground}");
            verdict.phase == Phase::Armed
        });
        assert!(armed && rig.complaints().is_empty(), "{block} {ground}: {:?}", rig.complaints());
        assert!((rig.state.calibration.ground[0] - BIAS - ground).abs() < 3e-3);
    }
}

#[test]
fn a_motion_stops_a_pulse() {
    let mut rig = Rig::new(&parameters());
    while !rig.kinds().contains(&Kind::Engaged(Wheel::Second)) {
        rig.step();
    }
    rig.shaking = 1.0;
    assert_eq!(rig.run(3).command, rig.supervisor.safe());
    assert_eq!(rig.step().phase, Phase::SelfTest);
    rig.shaking = 0.0;
    rig.until(Phase::Armed, 5000);
    assert_eq!(rig.complaints(), []);
}

#[test]
fn a_self_test_that_begins_in_motion_holds_the_safe_state() {
    let mut rig = Rig::new(&parameters());
    rig.shaking = 1.0;
    rig.until(Phase::SelfTest, 10);
    while rig.step().phase == Phase::SelfTest {
        assert_eq!(rig.state.sent, rig.supervisor.safe());
    }
    assert_eq!(rig.complaints(), [Kind::Warning(Fault::SelfTestAbandoned.code())]);
}

#[test]
fn without_a_self_test_no_clutch_moves() {
    let mut rig = Rig::new(&Parameters { self_test_clutches: false, safe_state: SafeState::Released, ..parameters() });
    rig.until(Phase::Armed, 2100);
    assert!(rig.kinds().iter().all(|kind| !matches!(kind, Kind::Engaged(_))));
}

#[test]
fn a_run_may_begin_with_the_motion() {
    let mut rig = Rig::new(&parameters());
    let calibration = Calibration { gyroscope: BIAS, block: [BIAS; 2], ground: [BIAS; 2], encoder_zero: 0 };
    rig.state = rig.supervisor.started(calibration);
    (rig.rotation, rig.velocity, rig.wish) = (0.15, 0.0, [true, false]);
    let verdict = rig.step();
    assert_eq!((verdict.phase, verdict.command, *rig.state.calibration()), (Phase::Rocking, [true, false], calibration));
    rig.quietly(20_000);
    assert_eq!(rig.complaints(), []);
    // A sensor that never says anything is found as if it had.
    let mut rig = Rig::new(&parameters());
    rig.state = rig.supervisor.started(calibration);
    let found = rig.found(20, |sample, _| sample.encoder.number = 0);
    assert_eq!(found, Some((6, Fault::Stale(Sensor::Encoder))));
}

#[test]
fn both_at_once_only_where_allowed() {
    let mut rig = Rig::armed(&parameters());
    for (wish, command) in [([true; 2], [false; 2]), ([false, true], [false, true]), ([true; 2], [false, true])] {
        rig.wish = wish;
        let verdict = rig.run(100);
        assert_eq!((verdict.command, verdict.fault), (command, None));
    }
    let warning = Kind::Warning(Fault::BothClutches.code());
    assert_eq!(rig.complaints(), [warning, warning]);
    // At rest nothing turns, and what has been engaged there is left alone when the block begins to move.
    let mut rig = Rig::armed(&parameters());
    (rig.wish, rig.standing) = ([true; 2], true);
    assert_eq!(rig.run(100).command, [true; 2]);
    (rig.wish, rig.standing) = ([false, true], false);
    assert_eq!((rig.run(100).command, rig.run(1).fault), ([false, true], None));
    assert_eq!(rig.complaints(), []);
    let mut rig = Rig::armed(&Parameters { both_allowed: true, ..parameters() });
    rig.wish = [true; 2];
    assert_eq!(rig.run(100).command, [true; 2]);
    assert_eq!(rig.complaints(), []);
}

#[test]
fn engagements_are_logged_as_sent() {
    let mut rig = Rig::rocking(&parameters());
    rig.wish = [false, true];
    rig.run(100);
    rig.wish = [true, false];
    rig.run(2);
    let entries: Vec<Entry> = rig.state.log.iter().copied().collect();
    let last: Vec<Kind> = entries.iter().rev().take(3).map(|entry| entry.kind).collect();
    assert_eq!(last, [Kind::Released(Wheel::Second), Kind::Engaged(Wheel::First), Kind::Engaged(Wheel::Second)]);
    let newest = entries[entries.len() - 1];
    assert_eq!(newest.tick, rig.tick - 1);
    assert!((newest.rotation - rig.rotation).abs() < 1e-3 && newest.velocity > 0.0);
}

#[test]
fn it_is_small() {
    use core::mem::size_of;
    assert!(size_of::<SupervisorState>() < 2600, "{}", size_of::<SupervisorState>());
    assert!(size_of::<Supervisor>() < 400, "{}", size_of::<Supervisor>());
}
