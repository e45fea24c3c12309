//! A device whose board is not to be relied upon, or that nobody may change.

use super::*;
use crate::control::monitor::fault::{Fault, Recovery};

/// What stands aside for: in Fault with the safe state, until a new start.
fn stands_aside(bench: &mut Bench, fault: Fault) {
    assert_eq!(fault.recovery(), Recovery::ByStart);
    bench.ticks(10);
    let decision = bench.device.decision();
    assert_eq!((decision.phase, decision.fault, decision.command), (Phase::Fault, Some(fault), bench.device.safe_command()));
    assert!(!bench.device.retained().deciding);
    assert_eq!(bench.ask(Request::Clear), DONE);
    let apply = Request::Apply { check: Settings::default().check(), store: true };
    assert_eq!(bench.ask(apply), Reply::Done(Done::Stored));
    bench.ticks(5000);
    assert_eq!(bench.device.decision().fault, Some(fault), "neither a request nor storing mends it");
}

#[test]
fn a_fault_of_the_board_stands_until_a_new_start() {
    for fault in [Fault::ImageDamaged, Fault::MemoryDamaged, Fault::ClockWrong] {
        let mut bench = Bench::rocking();
        bench.device.accuse(fault);
        stands_aside(&mut bench, fault);
        let faults = bench.device.state.supervisor().log.iter().filter(|entry| entry.kind == Kind::Fault(fault.code())).count();
        assert_eq!(faults, 1);
        // The first one stays.
        bench.device.accuse(Fault::SettingsDamaged);
        assert_eq!(bench.device.barred(), Some(fault));
        let retained = bench.device.retained();
        let mut again = Bench::with(&Settings::default(), Some(&retained));
        assert!(!again.device.resumes());
        again.until(Phase::Armed, 5000);
    }
}

/// What has released a clutch that must not be engaged does not become less true by a fault of the board.
#[test]
fn a_released_clutch_stays_released_when_the_board_stands_aside() {
    for fault in [Fault::ImageDamaged, Fault::MemoryDamaged, Fault::ClockWrong] {
        let mut bench = Bench::rocking();
        assert_eq!(bench.device.safe_command(), Settings::default().safe_command());
        let found = (0..4000).any(|_| bench.spoilt(|sample| sample.engaged[1] = true).phase == Phase::Fault);
        assert_eq!((found, bench.device.safe_command()), (true, [false; 2]), "{:?}", bench.device.decision());
        bench.device.accuse(fault);
        for _ in 0..10 {
            let decision = bench.spoilt(|sample| sample.engaged[1] = true);
            assert_eq!((decision.fault, decision.command), (Some(fault), [false; 2]));
        }
    }
    // The clutches of a host are not the board's.
    let mut bench = Bench::armed();
    bench.ask(Request::Attach { pace: Pace::Sample });
    for number in 1..9000 {
        bench.rig.shakes = number > 5000;
        let mut sample = bench.rig.sample();
        sample.engaged[1] |= bench.rig.shakes;
        bench.answer(Request::Sample(TickSample { sample, ..host_sample(number) }));
        bench.device.tick(|_| panic!("its own sensors"), 0.0);
        bench.rig.advance(bench.device.decision().command);
    }
    assert_eq!((bench.device.decision().phase, bench.device.decision().command), (Phase::Fault, [false; 2]));
    assert_eq!(bench.device.safe_command(), Settings::default().safe_command());
}

#[test]
fn a_reset_in_motion_does_not_resume_with_a_damaged_program() {
    let retained = Bench::rocking().device.retained();
    let mut bench = Bench::with(&Settings::default(), Some(&retained));
    assert!(bench.device.resumes());
    bench.device.accuse(Fault::ImageDamaged);
    assert!(!bench.device.resumes());
    stands_aside(&mut bench, Fault::ImageDamaged);
}

#[test]
fn what_must_not_change_is_the_controller_and_its_settings() {
    let bench = Bench::armed();
    let [(controller, bytes), (settings, words)] = bench.device.constants();
    let device = core::ptr::from_ref(&bench.device).addr();
    assert!(controller >= device && settings + words <= device + size_of::<Device>());
    assert_eq!((words, bytes % 4, controller % 4, settings % 4), (4 * COUNT, 0, 0, 0));
}

#[test]
fn without_the_jumper_nothing_is_changed_tested_or_attached() {
    let locked = Surroundings { locked: true, sealed: true, ..Surroundings::default() };
    let mut words = [0; WORD_BLOCK];
    words[0] = 7;
    let check = changed(Item::Dwell, 7).check();
    let guarded = [
        Request::Write(Words { first: Item::Dwell.index(), count: 1, words }),
        Request::Apply { check, store: false },
        Request::Apply { check, store: true },
        Request::SelfTest,
        Request::Attach { pace: Pace::Timer },
        Request::Attach { pace: Pace::Sample },
        Request::Protect,
    ];
    let bare = Bench::of(&Beginning::of(None, None, 0.0).unwrap(), None);
    for mut bench in [Bench::armed(), bare] {
        for request in guarded {
            let answer = bench.device.answer_storing(&request, &mut bench.store, &locked);
            assert_eq!(answer, Answer::Reply(Reply::Refused(Refusal::NoJumper)), "{request:?}");
        }
        assert_eq!(bench.device.draft, Settings::default());
        assert_eq!(Store::open(bench.store.clone().release()).1, None);
        for request in [Request::Identify, Request::State, Request::Clear, Request::Discard, Request::Detach] {
            let answer = bench.device.answer_storing(&request, &mut bench.store, &locked);
            assert!(!matches!(answer, Answer::Reply(Reply::Refused(_))), "{request:?}");
        }
    }
    let mut bench = Bench::armed();
    for request in &guarded[..2] {
        let answer = bench.device.answer_storing(request, &mut bench.store, &Surroundings { locked: false, ..locked });
        assert!(!matches!(answer, Answer::Reply(Reply::Refused(_))), "{request:?}: {answer:?}");
    }
}

#[test]
fn only_a_sealed_program_at_rest_is_protected() {
    let sealed = Surroundings { sealed: true, ..Surroundings::default() };
    let mut bench = Bench::armed();
    assert_eq!(bench.ask(Request::Protect), Reply::Refused(Refusal::NotSealed));
    assert_eq!(bench.device.answer(&Request::Protect, &sealed), Answer::Protect);
    let mut bench = Bench::rocking();
    let answer = bench.device.answer(&Request::Protect, &sealed);
    assert_eq!(answer, Answer::Reply(Reply::Refused(Refusal::Busy(Phase::Rocking))));
}

#[test]
fn a_warning_is_in_the_event_log() {
    let mut bench = Bench::new();
    bench.device.warn(Fault::OlderFirmware);
    let Reply::Log(block) = bench.ask(Request::Log { from: 0 }) else { panic!() };
    assert_eq!(block.entries[0].entry().map(|entry| entry.kind), Some(Kind::Warning(77)));
}
