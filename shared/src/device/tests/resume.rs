//! A reset in the middle of an earthquake.

use super::*;
use crate::control::monitor::fault::Fault;
use crate::control::sensing::sensor::Sensor;

/// What happens to a device at a reset: its memory but for the retained state is gone, and the encoder continues from the retained count.
fn reset(bench: &Bench) -> Bench {
    let retained = Retained::of(&bench.device.retained().words(0)).unwrap();
    Bench { rig: bench.rig.clone(), ..Bench::with(bench.device.settings(), Some(&retained)) }
}

impl Bench {
    /// As on a board after a reset: the encoder counts from the first tick on, while inertial sensors are `silent` for some.
    fn start_tick(&mut self, silent: bool) -> Decision {
        let now = self.rig.sample();
        let seen = |own: &Sample| if silent { Sample { encoder: now.encoder, engaged: now.engaged, ..*own } } else { now };
        self.device.tick(|own| *own = seen(own), 0.0);
        *self.device.decision()
    }
}

#[test]
fn it_resumes_where_it_was() {
    let mut bench = Bench::rocking();
    let mut worst = [0.0_f32; 2];
    // Over half a second, at every phase of the motion.
    for _ in 0..50 {
        bench.ticks(20);
        let mut again = reset(&bench);
        assert!(again.device.resumes());
        assert_eq!(again.device.retained().spins, bench.device.retained().spins);
        let mut steady = Bench { device: bench.device.clone(), store: Store::open(Flash::default()).0, rig: bench.rig.clone() };
        for number in 0..40 {
            assert_eq!(again.tick(), Phase::Rocking);
            steady.tick();
            if number < 10 {
                continue;
            }
            let [own, before] = [&again, &steady].map(Bench::errors);
            for ((worst, own), before) in worst.iter_mut().zip(own).zip(before) {
                *worst = worst.max(own - before);
            }
        }
        let [calibration, before] = [&again, &steady].map(|bench| bench.device.retained().calibration);
        assert_eq!(calibration, before);
    }
    // As near to the truth as one that was not interrupted, but that an impact, or a flywheel that is taken on, may come a tick earlier or later,
    // which is worth a quarter of some 0.3 rad/s for that tick.
    assert!(worst[0] < 1e-5 && worst[1] < 0.1, "{worst:?}");
}

#[test]
fn sensors_that_start_anew_are_waited_for_in_the_safe_state() {
    for silent in [0, 1, 3, 5, 6, 7, 10, 40, 120, 199] {
        let mut again = reset(&Bench::rocking());
        for tick in 0..4000 {
            let decision = again.start_tick(tick < silent);
            if tick < silent {
                assert!(again.device.resumes() && decision.command == again.device.safe_command(), "{silent}: {decision:?}");
            } else {
                assert_eq!((decision.phase, decision.fault), (Phase::Rocking, None), "{silent} silent, tick {tick}");
            }
            if tick > silent + 20 {
                assert!(again.errors()[0] < 2.5e-4, "{silent} silent, tick {tick}: {:?}", again.errors());
            }
            again.rig.advance(decision.command);
        }
    }
    // What is logged after the waiting counts the ticks of the waiting, too.
    let mut again = reset(&Bench::armed());
    for _ in 0..100 {
        again.device.tick(|_| {}, 0.0);
    }
    again.until(Phase::Calibrate, 5000);
    let entered = again.device.logged(0).0.find(|(_, entry)| entry.kind == Kind::Phase(Phase::Calibrate));
    assert_eq!(entered.map(|(_, entry)| entry.tick), Some(again.device.ticks));
    // One that never comes is a fault like any other, found from the beginning.
    let mut again = reset(&Bench::rocking());
    let mut phases = (0..4000).map(|_| {
        let now = again.rig.sample();
        again.device.tick(|own| (own.encoder, own.ground_accelerometer) = (now.encoder, now.ground_accelerometer), 0.0);
        again.rig.advance(again.device.decision().command);
        again.device.decision().fault
    });
    assert_eq!(phases.find_map(|fault| fault), Some(Fault::Stale(Sensor::Gyroscope)));
}

/// Counts that were lost over a reset are gone for good once nothing moves, and a shock meanwhile does not find the device waiting.
#[test]
fn what_the_encoder_missed_is_made_good_at_rest() {
    const LOST: i32 = 700;
    let mut again = reset(&Bench::rocking());
    let tick = |bench: &mut Bench| {
        let mut sample = bench.rig.sample();
        sample.encoder.counts = sample.encoder.counts.wrapping_sub(LOST);
        bench.device.tick(|own| *own = sample, 0.0);
        bench.rig.advance(bench.device.decision().command);
        *bench.device.decision()
    };
    let until = |bench: &mut Bench, phase, most: usize| {
        assert!((0..most).any(|_| tick(bench).phase == phase), "{phase:?} never came: {:?}", bench.device.decision());
    };
    (0..2000).for_each(|_| assert_eq!(tick(&mut again).phase, Phase::Rocking));
    again.rig.shakes = false;
    until(&mut again, Phase::Calibrate, 40_000);
    (0..500).for_each(|_| assert_eq!(tick(&mut again).phase, Phase::Calibrate));
    again.rig.shakes = true;
    until(&mut again, Phase::Rocking, 200);
    again.rig.shakes = false;
    until(&mut again, Phase::Calibrate, 40_000);
    until(&mut again, Phase::Armed, 3000);
    let zero = again.device.retained().calibration.encoder_zero;
    let mut stood = 0;
    for _ in 0..4000 {
        let decision = tick(&mut again);
        assert_eq!((decision.phase, decision.fault), (Phase::Armed, None));
        stood += u32::from(decision.estimate.standing);
    }
    assert!(again.errors()[0] < 1e-5 && stood > 3900, "{:?}, {stood} ticks standing, zero {zero}", again.errors());
    // It is not calibrated again and again.
    again.rig.shakes = true;
    until(&mut again, Phase::Rocking, 1000);
    again.rig.shakes = false;
    until(&mut again, Phase::Armed, 40_000);
}

#[test]
fn while_it_resumes_nothing_is_changed() {
    let mut again = reset(&Bench::rocking());
    let busy = |reply| matches!(reply, Reply::Refused(Refusal::Busy(_)));
    assert!(busy(again.ask(Request::Attach { pace: Pace::Timer })));
    assert!(busy(again.ask(Request::Apply { check: Settings::default().check(), store: true })));
    assert_eq!(again.answer(Request::Detach), Answer::Reply(DONE));
    again.tick();
    assert_eq!(again.device.decision().phase, Phase::Rocking);
}

#[test]
fn where_it_did_not_decide_it_starts_from_the_beginning() {
    let mut bench = Bench::new();
    bench.until(Phase::Calibrate, 2000);
    let mut again = reset(&bench);
    assert!(!again.device.resumes());
    assert!(matches!(again.tick(), Phase::Boot | Phase::SelfTest));
    again.until(Phase::Armed, 5000);
}

#[test]
fn attached_it_waits_for_a_sample_but_not_for_ever() {
    let mut bench = Bench::new();
    bench.ask(Request::Attach { pace: Pace::Timer });
    let number = bench.arm_by_host();
    // It continues with the sample that comes.
    let mut again = reset(&bench);
    assert_eq!(again.device.attached(), Some(Pace::Timer));
    again.ticks_without(50);
    assert!(again.device.resumes() && again.device.decision().command == again.device.safe_command());
    again.host_tick(number + 1);
    assert!(!again.device.resumes() && again.device.decision().phase == Phase::Rocking);
    assert_eq!(again.device.retained().calibration, bench.device.retained().calibration);
    // Or starts from the beginning, where the sender is gone too.
    let mut again = reset(&bench);
    again.ticks_without(201);
    assert!(!again.device.resumes() && again.device.decision().phase != Phase::Rocking);
}

#[test]
fn restarts_are_counted_forgotten_and_given_up() {
    let mut bench = Bench::rocking();
    // Good work of a second in between forgets them.
    for _ in 0..2 * MOST_RESTARTS {
        bench = reset(&bench);
        assert_eq!((bench.device.restarts(), bench.device.resumes()), (1, true));
        bench.ticks(2010);
        assert_eq!(bench.device.restarts(), 0);
    }
    // Less does not.
    for restart in 1..=MOST_RESTARTS {
        bench = reset(&bench);
        assert_eq!((bench.device.restarts(), bench.device.resumes()), (restart, true));
        bench.ticks(100);
    }
    bench = reset(&bench);
    assert_eq!((bench.device.restarts(), bench.device.resumes()), (MOST_RESTARTS + 1, false));
    assert_eq!(bench.device.decision().command, bench.device.safe_command());
    assert_ne!(bench.tick(), Phase::Rocking);
}

#[test]
fn resets_before_the_first_tick_count_too() {
    let mut bench = Bench::rocking();
    for restart in 1..=MOST_RESTARTS {
        bench = reset(&bench);
        assert_eq!((bench.device.restarts(), bench.device.resumes()), (restart, true));
    }
    assert!(!reset(&bench).device.resumes());
}

/// Reset at every third tick of half a second, before impacts too.
#[test]
fn reset_at_any_tick_it_knows_where_the_block_is() {
    const SILENT: usize = 13;
    let mut bench = Bench::rocking();
    for begun in 0..330 {
        let mut again = reset(&bench);
        for tick in 0..400 {
            let decision = again.start_tick(tick < SILENT);
            if tick >= SILENT {
                assert!(decision.estimate.located(0.174_532_92), "reset {begun}, tick {tick}: {:?}", decision.estimate);
                assert!(again.errors()[0] < 1e-3, "reset {begun}, tick {tick}: {:?}", again.errors());
            }
            again.rig.advance(decision.command);
        }
        bench.ticks(3);
    }
}
