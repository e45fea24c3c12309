//! The proof test of the clutches, in an armed controller.

use super::*;
use crate::control::monitor::coil::{CoilReport, CoilTrouble};

/// At rest and armed, with a law that wants `wish`, shortly before a proof test that is due every three seconds.
fn due(wish: [bool; 2]) -> Rig {
    let mut rig = Rig::new(&Parameters { proof_test_interval: 3.0, ..parameters() });
    (rig.wish, rig.standing) = (wish, true);
    rig.until(Phase::Armed, 8000);
    rig
}

const WISHES: [[bool; 2]; 4] = [[true; 2], [true, false], [false, true], [false; 2]];

/// Runs to the tick at which a test begins.
fn begun(wish: [bool; 2]) -> Rig {
    let mut rig = due(wish);
    while !rig.state.tests_coils() {
        assert_eq!(rig.step().fault, None);
        assert!(rig.tick < 20_000, "no proof test");
    }
    rig
}

#[test]
fn each_clutch_opens_and_engages_while_the_other_is_as_the_law_wants() {
    for wish in WISHES {
        let mut rig = begun(wish);
        let begun = rig.tick;
        let mut seen = std::vec![rig.state.sent];
        while rig.state.tests_coils() {
            let verdict = rig.step();
            assert_eq!((verdict.phase, verdict.fault), (Phase::Armed, None), "{wish:?}");
            if seen.last() != Some(&verdict.command) {
                seen.push(verdict.command);
            }
        }
        let [first, second] = wish;
        let mut expected = std::vec![[false, second], [true, second], [first, false], [first, true], wish];
        expected.dedup();
        assert_eq!(seen, expected);
        assert_eq!(rig.kinds().iter().filter(|kind| **kind == Kind::Tested).count(), 1);
        // Four moves of 10 ms.
        assert!(rig.tick - begun < 100, "{}", rig.tick - begun);
        assert_eq!(rig.complaints(), []);
        // And again after as long.
        rig.quietly(4000);
        assert!(!rig.state.tests_coils());
        rig.quietly(2400);
        assert_eq!(rig.kinds().iter().filter(|kind| **kind == Kind::Tested).count(), 2);
    }
}

#[test]
fn a_motion_at_any_tick_ends_it_with_what_the_law_wants() {
    for wish in WISHES {
        for tick in 0..100 {
            let mut rig = begun(wish);
            rig.run(tick + 1);
            if !rig.state.tests_coils() {
                assert!(tick > 20);
                break;
            }
            rig.velocity = 0.28;
            // A reading comes every other tick, and a jump of the encoder is one at once.
            let mut seen = rig.step();
            if rig.state.tests_coils() {
                seen = rig.step();
            }
            if rig.kinds().contains(&Kind::Tested) {
                // It ended before a reading moved.
                assert!(tick > 20);
                break;
            }
            assert_eq!(seen.command, wish, "{wish:?}, tick {tick}");
            assert!(!rig.state.tests_coils() && matches!(seen.phase, Phase::Armed | Phase::Rocking), "{wish:?}, tick {tick}");
            rig.standing = false;
            rig.wish = [wish[0], wish[1] && !wish[0]];
            rig.quietly(2000);
            assert!(rig.complaints().iter().all(|kind| *kind == Kind::Warning(Fault::SelfTestAbandoned.code())));
            assert!(!rig.kinds().contains(&Kind::Tested));
        }
    }
}

#[test]
fn one_that_was_ended_is_tried_again_soon() {
    let mut rig = begun([true; 2]);
    rig.run(30);
    rig.shaking = 1.0;
    rig.run(10);
    rig.shaking = 0.0;
    assert!(!rig.state.tests_coils());
    rig.quietly(8500);
    assert_eq!(rig.kinds().iter().filter(|kind| **kind == Kind::Tested).count(), 1);
}

/// A test that a swing ends, however quickly that is known, is in the log as such, and does not begin again between two shocks.
#[test]
fn one_that_rocking_ends_is_put_off() {
    for after in 1..30 {
        let mut rig = Rig::new(&Parameters { proof_test_interval: 1000.0, ..parameters() });
        (rig.wish, rig.standing) = ([true; 2], true);
        rig.until(Phase::Armed, 8000);
        rig.state.proof.waited = 998;
        while !rig.state.tests_coils() {
            rig.quietly(1);
        }
        rig.quietly(after);
        (rig.velocity, rig.standing, rig.wish) = (0.28, false, [true, false]);
        rig.until(Phase::Rocking, 10);
        let ended = Kind::Warning(Fault::SelfTestAbandoned.code());
        assert_eq!(rig.complaints(), [ended], "{after}");
        rig.until(Phase::Armed, 40_000);
        (rig.standing, rig.wish) = (true, [true; 2]);
        for _ in 0..10_000 {
            rig.quietly(1);
            assert!(!rig.state.tests_coils(), "{after}");
        }
        // A hundredth of the interval, in averages of a second.
        while !rig.state.tests_coils() {
            rig.quietly(1);
            assert!(rig.tick < 80_000, "{after}");
        }
    }
}

#[test]
fn what_does_not_follow_is_a_fault() {
    for (wheel, unwilling) in
        [(Wheel::First, Fault::ClutchRefuses(Wheel::First)), (Wheel::Second, Fault::ClutchRefuses(Wheel::Second))]
    {
        let mut rig = due([false; 2]);
        let index = usize::from(wheel == Wheel::Second);
        let found = rig.found(20_000, |sample, _| sample.engaged[index] = false);
        assert_eq!(found.map(|(_, fault)| fault), Some(unwilling));
    }
    let mut rig = begun([true; 2]);
    rig.run(25);
    rig.coils = [CoilReport::Well, CoilReport::Trouble(CoilTrouble::WrongCurrent)];
    assert_eq!(rig.step().fault, Some(Fault::WrongCurrent(Wheel::Second)));
    assert!(!rig.state.tests_coils());
}

#[test]
fn none_is_due_by_default_for_a_day_nor_where_the_clutches_are_not_to_be_tested() {
    let never = Parameters { proof_test_interval: 0.0, ..parameters() };
    let untested = Parameters { self_test_clutches: false, proof_test_interval: 1.0, ..parameters() };
    for parameters in [parameters(), never, untested] {
        let mut rig = Rig::new(&parameters);
        rig.standing = true;
        rig.until(Phase::Armed, 8000);
        for _ in 0..40_000 {
            rig.step();
            assert!(!rig.state.tests_coils());
        }
    }
    let supervisor = Supervisor::new(&parameters()).unwrap();
    assert_eq!(supervisor.proof_interval, 30 * 24 * 3600);
}
