//! What a fault leads to, and the ways back.

use super::*;

fn fail_sensor(rig: &mut Rig) {
    assert_eq!(rig.spoilt(|sample, _| sample.gyroscope.value = f32::NAN).fault, Some(Fault::NotFinite(Sensor::Gyroscope)));
}

#[test]
fn the_safe_state_is_the_configured_one() {
    for (safe_state, command) in [
        (SafeState::Released, [false; 2]),
        (SafeState::Engaged(Wheel::First), [true, false]),
        (SafeState::Engaged(Wheel::Second), [false, true]),
    ] {
        let mut rig = Rig::new(&Parameters { safe_state, ..parameters() });
        rig.wish = [false, true];
        assert_eq!(rig.step().command, command, "before it is armed");
        rig.until(Phase::Calibrate, 1000);
        assert_eq!(rig.step().command, command);
        rig.until(Phase::Armed, 3000);
        assert_eq!(rig.run(100).command, [false, true]);
        rig.velocity = 0.28;
        rig.quietly(100);
        fail_sensor(&mut rig);
        for wish in [[false; 2], [true, false], [false, true], [true; 2]] {
            rig.wish = wish;
            let verdict = rig.run(100);
            assert_eq!((verdict.command, verdict.phase), (command, Phase::Fault));
        }
    }
}

#[test]
fn a_sensor_recovers_once_good_and_at_rest() {
    let mut rig = Rig::armed(&parameters());
    fail_sensor(&mut rig);
    // 2 s at rest: the bad reading was no motion, but nobody knew.
    let ticks = rig.until(Phase::Calibrate, 5000);
    assert!((2000..=4002).contains(&ticks), "{ticks}");
    assert!((2000..2100).contains(&rig.until(Phase::Armed, 5000)));
    // Not while it rocks.
    let mut rig = Rig::rocking(&parameters());
    fail_sensor(&mut rig);
    while rig.velocity != 0.0 {
        let verdict = rig.step();
        assert_eq!((verdict.phase, verdict.fault), (Phase::Fault, Some(Fault::NotFinite(Sensor::Gyroscope))));
    }
    assert!(rig.impacts > 10);
    let ticks = rig.until(Phase::Calibrate, 5000);
    assert!((3500..=4010).contains(&ticks), "{ticks}");
}

#[test]
fn every_bad_reading_starts_the_time_again() {
    let mut parameters = parameters();
    parameters.recover_after = 3.0;
    let mut rig = Rig::armed(&parameters);
    for _ in 0..5 {
        fail_sensor(&mut rig);
        assert_eq!(rig.run(5900).phase, Phase::Fault);
    }
    assert!(rig.until(Phase::Calibrate, 200) >= 100);
}

#[test]
fn the_first_cause_is_kept_and_later_ones_are_logged() {
    let mut rig = Rig::rocking(&parameters());
    fail_sensor(&mut rig);
    rig.run(50);
    let found = rig.spoilt(|sample, _| sample.encoder.counts += 90_000);
    assert_eq!(found.fault, Some(Fault::NotFinite(Sensor::Gyroscope)));
    let codes: Vec<Kind> = rig.complaints();
    assert_eq!(codes, [Kind::Fault(14), Kind::Fault(45)]);
}

#[test]
fn the_rest_waits_for_a_request_at_rest() {
    let mut rig = Rig::rocking(&parameters());
    rig.estimate_lost = true;
    assert_eq!(rig.step().fault, Some(Fault::EstimateNotFinite));
    rig.estimate_lost = false;
    // In motion it is refused, and so is one that was made then and is still there.
    rig.requests.clear = true;
    while rig.velocity != 0.0 {
        assert_eq!(rig.step().phase, Phase::Fault);
    }
    assert_eq!(rig.run(10_000).phase, Phase::Fault);
    rig.requests.clear = false;
    assert_eq!(rig.run(10_000).phase, Phase::Fault, "by itself it never leaves");
    rig.shaking = 1.0;
    rig.run(100);
    rig.requests.clear = true;
    assert_eq!(rig.step().phase, Phase::Fault, "the ground shakes");
    (rig.requests.clear, rig.shaking) = (false, 0.0);
    assert_eq!(rig.run(4100).phase, Phase::Fault);
    rig.requests.clear = true;
    assert_eq!(rig.step().phase, Phase::SelfTest);
    rig.until(Phase::Armed, 5000);
}

#[test]
fn a_later_fault_of_a_clutch_takes_a_request_too() {
    let mut rig = Rig::armed(&Parameters { safe_state: SafeState::Released, ..parameters() });
    fail_sensor(&mut rig);
    for _ in 0..100 {
        rig.spoilt(|sample, _| sample.engaged = [true, false]);
    }
    let verdict = rig.run(20_000);
    assert_eq!((verdict.phase, verdict.fault), (Phase::Fault, Some(Fault::NotFinite(Sensor::Gyroscope))));
    rig.requests.clear = true;
    assert_eq!(rig.step().phase, Phase::SelfTest);
    // What is still broken is found again.
    let (_, fault) = rig.found(1000, |sample, _| sample.engaged = [true, false]).unwrap();
    assert_eq!(fault, Fault::SelfTestFailed(Wheel::First));
}

#[test]
fn a_fault_behind_another_counts_too() {
    let mut rig = Rig::armed(&Parameters { safe_state: SafeState::Released, ..parameters() });
    for tick in 0..500 {
        rig.spoilt(|sample, _| {
            sample.gyroscope.value = f32::NAN;
            sample.engaged[0] |= (100..300).contains(&tick);
        });
    }
    assert_eq!(rig.complaints(), [Kind::Fault(14), Kind::Fault(51)]);
    assert_eq!(rig.run(20_000).phase, Phase::Fault);
}

#[test]
fn what_is_not_required_is_a_warning() {
    let required = Required { gyroscope: true, ..Required::NONE };
    for mut rig in [Rig::armed(&Parameters { required, ..noisy() }), Rig::rocking(&Parameters { required, ..noisy() })] {
        let found = rig.found(400, |sample, held| {
            sample.block_accelerometer[0].value = f32::NAN;
            sample.ground_accelerometer = held.ground_accelerometer;
            sample.encoder.counts = held.encoder.counts.wrapping_mul(3).wrapping_add(12_345);
        });
        assert_eq!(found, None);
        let kinds = rig.complaints();
        for fault in [
            Fault::NotFinite(Sensor::BlockAccelerometer),
            Fault::Stale(Sensor::GroundAccelerometer),
            Fault::Contradiction(Sensor::Encoder),
        ] {
            assert!(kinds.contains(&Kind::Warning(fault.code())), "{fault}");
        }
        assert!(kinds.iter().all(|kind| matches!(kind, Kind::Warning(_))), "{kinds:?}");
        fail_sensor(&mut rig);
    }
}

#[test]
fn a_boot_that_failed_is_tested_when_it_comes_back() {
    let mut rig = Rig::new(&parameters());
    assert!(rig.found(3000, |sample, _| sample.encoder.number = 0).is_some());
    rig.until(Phase::SelfTest, 5000);
    rig.until(Phase::Armed, 5000);
}

#[test]
fn the_log_keeps_the_last() {
    let mut rig = Rig::armed(&parameters());
    let before = rig.state.log.count();
    for flip in 0..100 {
        rig.wish = [flip % 2 == 0, false];
        rig.quietly(70);
    }
    assert_eq!(rig.state.log.count(), before + 100);
    let kinds = rig.kinds();
    assert_eq!(kinds.len(), LOG_ENTRIES);
    assert!(kinds.chunks(2).all(|pair| pair == [Kind::Engaged(Wheel::First), Kind::Released(Wheel::First)]));
    let ticks: Vec<u32> = rig.state.log.iter().map(|entry| entry.tick).collect();
    assert!(ticks.windows(2).all(|pair| pair[0] + 70 == pair[1]));
}
