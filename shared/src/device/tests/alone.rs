//! A device without settings of its own, without its host, or that cannot start well.

use super::*;
use crate::control::monitor::fault::Fault;
use crate::device::HOST_SILENCE;
use crate::device::beginning::MOST_STARTS;

/// With what flash holds after resets, if it holds anything.
fn started(found: Option<&Settings>, retained: Option<&Retained>, least_period: f32) -> Bench {
    Bench::of(&Beginning::of(found, retained, least_period).unwrap(), retained)
}

/// It does nothing, says why, and nothing but a store mends it.
fn is_barred(bench: &mut Bench, fault: Fault) {
    for _ in 0..5000 {
        assert_eq!(bench.tick(), Phase::Fault);
        assert_eq!((bench.device.decision().fault, bench.device.decision().command), (Some(fault), bench.device.safe_command()));
    }
    let Reply::State(state) = bench.ask(Request::State) else { panic!() };
    assert_eq!((state.phase, state.fault, state.log_count), (Phase::Fault, Some(fault), 1));
    assert_eq!(bench.device.shown().fault, Some(fault.code()));
    assert_eq!(bench.ask(Request::Clear), DONE);
    assert_eq!(bench.tick(), Phase::Fault);
    assert_eq!(bench.ask(Request::SelfTest), Reply::Refused(Refusal::Busy(Phase::Fault)));
    assert!(!bench.device.retained().deciding);
}

#[test]
fn without_settings_of_its_own_it_does_not_arm() {
    let mut bench = started(None, None, 0.0);
    is_barred(&mut bench, Fault::NotCommissioned);
    // Others that are not stored change nothing.
    assert_eq!(bench.draft(Item::Dwell, 7), DONE);
    let wanted = changed(Item::Dwell, 7);
    assert_eq!(bench.ask(Request::Apply { check: wanted.check(), store: false }), DONE);
    assert_eq!(bench.tick(), Phase::Fault);
    // One store commissions it.
    assert_eq!(bench.answer(Request::Apply { check: wanted.check(), store: true }), Answer::Restarted(Reply::Done(Done::Stored)));
    bench.until(Phase::Armed, 5000);
}

/// The count of its ticks goes on while it stands aside, and nothing that is logged afterwards is earlier.
#[test]
fn the_log_has_one_clock() {
    let mut bench = started(None, None, 0.0);
    bench.ticks(10_000);
    let check = Settings::default().check();
    assert_eq!(bench.answer(Request::Apply { check, store: true }), Answer::Restarted(Reply::Done(Done::Stored)));
    bench.until(Phase::Armed, 5000);
    let armed = bench.device.ticks;
    bench.device.warn(Fault::SupplyLow);
    let logged: Vec<(Kind, u32)> = bench.device.logged(0).0.map(|(_, entry)| (entry.kind, entry.tick)).collect();
    assert!(logged.is_sorted_by_key(|(_, tick)| *tick), "{logged:?}");
    for kind in [Kind::Phase(Phase::Armed), Kind::Warning(Fault::SupplyLow.code())] {
        assert!(logged.contains(&(kind, armed)), "{kind:?} not at {armed}: {logged:?}");
    }
}

#[test]
fn a_host_may_run_it_without_settings_of_its_own() {
    let mut bench = started(None, None, 0.0);
    bench.ticks(10);
    assert_eq!(bench.answer(Request::Attach { pace: Pace::Sample }), Answer::Restarted(DONE));
    bench.arm_by_host();
    assert_eq!(bench.answer(Request::Detach), Answer::Restarted(DONE));
    assert_eq!(bench.tick(), Phase::Fault);
}

/// Attached, armed, and with a law that the host has brought.
fn visited() -> (Bench, u32) {
    let mut bench = Bench::armed();
    assert_eq!(bench.draft(Item::Law, 1), DONE);
    assert_eq!(bench.ask(Request::Apply { check: changed(Item::Law, 1).check(), store: false }), DONE);
    assert_eq!(bench.ask(Request::Attach { pace: Pace::Timer }), DONE);
    let number = bench.arm_by_host();
    (bench, number)
}

#[test]
fn detached_it_is_as_it_was() {
    for rocks in [false, true] {
        let (mut bench, mut number) = visited();
        bench.rig.shakes = rocks;
        while rocks && bench.device.decision().phase != Phase::Rocking {
            number += 1;
            bench.host_tick(number);
        }
        let Reply::State(state) = bench.ask(Request::State) else { panic!() };
        assert_eq!((state.attached, bench.device.shown().attached), (Some(Pace::Timer), true));
        // Never refused: the motion is the host's, and the structure stands without protection.
        assert_eq!(bench.answer(Request::Detach), Answer::Restarted(DONE));
        assert_eq!(*bench.device.settings(), Settings::default());
        let Reply::State(state) = bench.ask(Request::State) else { panic!() };
        assert_eq!((state.attached, bench.device.shown().attached), (None, false));
        bench.rig = Rig::new(Beginning::of(None, None, 0.0).unwrap().controller.model);
        bench.until(Phase::Armed, 5000);
    }
}

#[test]
fn a_host_that_falls_silent_is_left() {
    let (mut bench, number) = visited();
    let most = (HOST_SILENCE / bench.device.settings().period()) as u32;
    bench.ticks_without(most as usize - 1);
    // A host that says something else is not there for its samples, and one sample is enough.
    assert!(matches!(bench.ask(Request::State), Reply::State(_)));
    assert!(!bench.device.deserted());
    let sample = TickSample { sample: bench.rig.sample(), ..host_sample(number + 1) };
    assert_eq!(bench.answer(Request::Sample(sample)), Answer::Sample);
    for _ in 0..=most {
        bench.ticks_without(1);
        assert!(!bench.device.deserted());
    }
    bench.ticks_without(2);
    assert!(bench.device.deserted());
    assert_eq!(bench.answer(Request::Detach), Answer::Restarted(DONE));
    assert!(!bench.device.deserted());
    bench.until(Phase::Armed, 5000);
    // Nor does one that never sends any hold it.
    for pace in [Pace::Timer, Pace::Sample] {
        assert_eq!(bench.answer(Request::Attach { pace }), Answer::Restarted(DONE));
        bench.ticks_without(most as usize + 2);
        assert!(bench.device.deserted());
    }
}

#[test]
fn what_a_host_said_is_not_resumed_from_by_a_board() {
    let (bench, _) = visited();
    let retained = Retained::of(&bench.device.retained().words(1)).unwrap();
    assert_eq!(retained.attached, Some(Pace::Timer));
    let mut again = Bench::with(&Settings::default(), Some(&retained.alone()));
    assert_eq!((again.device.attached(), again.device.resumes(), again.device.restarts()), (None, false, 1));
    again.until(Phase::Armed, 5000);
    // What it knew of its own it resumes from.
    let retained = Bench::rocking().device.retained();
    assert_eq!(retained.alone(), retained);
}

#[test]
fn a_period_that_the_board_has_no_time_for_is_refused() {
    let around = Surroundings { least_period: 250e-6, ..Surroundings::default() };
    let mut bench = Bench::armed();
    for (period, fits) in [(10e-6_f32, false), (249e-6, false), (250e-6, true)] {
        let mut wanted = Settings::default();
        for (item, word) in [(Item::Period, period.to_bits()), (Item::ContradictionTime, 0.01_f32.to_bits())] {
            wanted.set(item.index(), word).unwrap();
            assert_eq!(bench.draft(item, word), DONE);
        }
        let apply = Request::Apply { check: wanted.check(), store: true };
        let answer = bench.device.answer_storing(&apply, &mut bench.store, &around);
        if fits {
            assert_eq!(answer, Answer::Restarted(Reply::Done(Done::Stored)));
        } else {
            assert_eq!(answer, Answer::Reply(Reply::Refused(Refusal::TooFast { period, least: 250e-6 })));
            assert_eq!(Store::open(bench.store.clone().release()).1, None);
        }
        // Nor is it begun with, where flash holds it from another time.
        let beginning = Beginning::of(Some(&wanted), None, 250e-6).unwrap();
        assert_eq!(beginning.barred, if fits { None } else { Some(Fault::NotCommissioned) });
        assert!(beginning.settings.period() >= 250e-6);
    }
}

/// Settings that reset it again and again must not keep the link from answering.
#[test]
fn settings_that_end_in_resets_are_given_up() {
    let settings = changed(Item::SafeState, 1);
    let mut bench = started(Some(&settings), None, 0.0);
    for restart in 1..=MOST_STARTS {
        bench.ticks(40);
        let retained = bench.device.retained();
        bench = started(Some(&settings), Some(&retained), 0.0);
        assert_eq!((bench.device.restarts(), bench.device.barred()), (restart, None));
    }
    let retained = bench.device.retained();
    bench = started(Some(&settings), Some(&retained), 0.0);
    assert_eq!(*bench.device.settings(), settings, "but for the safe state they are the defaults");
    is_barred(&mut bench, Fault::GivenUp);
    assert_eq!(bench.device.decision().command, [true, false]);
    // However long that has been: they have not become better.
    let retained = bench.device.retained();
    bench = started(Some(&settings), Some(&retained), 0.0);
    assert_eq!(bench.device.barred(), Some(Fault::GivenUp));
    // Until somebody stores others, or the same in earnest.
    assert_eq!(
        bench.answer(Request::Apply { check: settings.check(), store: true }),
        Answer::Restarted(Reply::Done(Done::Stored))
    );
    assert_eq!(bench.device.restarts(), 0);
    bench.until(Phase::Armed, 5000);
}
