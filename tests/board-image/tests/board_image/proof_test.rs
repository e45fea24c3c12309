//! The proof test of the coils in operation: each by itself while the board is armed, with an interval that makes it soon.

use std::rc::Rc;

use sprag_board_image::model::Model;
use sprag_board_image::peripheral::coil::{Coil, Switch};
use sprag_board_image::rig::{Rig, image_for, swing};
use sprag_shared::control::monitor::fault::Fault;
use sprag_shared::control::supervisor::Phase;
use sprag_shared::control::supervisor::event_log::Kind;
use sprag_shared::link::{Reply, Request};
use sprag_shared::settings::{Item, Settings};

/// Every two seconds.
fn soon() -> Settings {
    let mut settings = Settings::default();
    settings.set(Item::ProofTestInterval.index(), 2.0_f32.to_bits()).expect("in range");
    settings
}

fn armed(model: Model) -> Rig {
    let mut rig = Rig::new(&image_for(model), Some(&soon()));
    rig.arm();
    rig
}

/// High side and share of the low side of each coil.
fn drives(rig: &Rig) -> [(bool, f64); 2] {
    [0, 1].map(|coil| rig.bench.chip().drive(coil))
}

/// Whether the high side of each coil is on.
fn high(rig: &Rig) -> [bool; 2] {
    drives(rig).map(|(high, _)| high)
}

/// Runs to the first tick of a test, which releases a coil that was held; ticks that took.
fn to_the_test(rig: &mut Rig) -> usize {
    rig.ticks(100);
    assert_eq!(high(rig), [true; 2], "both are held at rest");
    for tick in 0..20_000 {
        rig.ticks(1);
        if high(rig) != [true; 2] {
            return tick;
        }
    }
    panic!("no proof test");
}

fn kinds(rig: &mut Rig) -> Vec<Kind> {
    let (mut kinds, mut from) = (Vec::new(), 0);
    loop {
        let Reply::Log(block) = rig.ask(&Request::Log { from }) else { panic!("no log") };
        kinds.extend(block.entries[..usize::from(block.count)].iter().filter_map(|entry| Some(entry.entry()?.kind)));
        from = block.from + u32::from(block.count);
        if from >= block.total {
            return kinds;
        }
    }
}

#[test]
fn coils_are_tried_one_by_one_while_the_board_is_armed() {
    for model in Model::ALL {
        let mut rig = armed(model);
        to_the_test(&mut rig);
        // Alone each switch, pull-in and hold, of two coils: some 0.2 s.
        let (mut off, mut ticks) = ([0; 2], 0);
        while high(&rig) != [true; 2] || ticks < 400 {
            let now = high(&rig);
            assert_ne!(now, [false; 2], "{model:?}: both off at once");
            (0..2).for_each(|coil| off[coil] += u32::from(!now[coil]));
            rig.ticks(1);
            ticks += 1;
            assert!(ticks < 1000, "{model:?}");
        }
        println!("{model:?}: released for {off:?} ticks");
        assert!(off.iter().all(|ticks| (20..200).contains(ticks)), "{model:?}: {off:?}");
        let state = rig.state();
        assert_eq!((state.phase, state.fault, state.worst_lateness), (Phase::Armed, None, 0), "{model:?}");
        assert_eq!(kinds(&mut rig).iter().filter(|kind| **kind == Kind::Tested).count(), 1, "{model:?}");
    }
}

/// At any part of a test the block begins to move: the law's command is driven at the next tick.
#[test]
fn the_first_sign_of_motion_ends_a_test_at_once() {
    let mut rig = armed(Model::F405);
    to_the_test(&mut rig);
    rig.for_each((0..220).step_by(31), |rig, later| {
        rig.ticks(later);
        rig.ask(&Request::Stream { every: 1 });
        let begun = rig.bench.now();
        rig.structure = Rc::new(swing(begun));
        let mut moved = None;
        let ended = (0..200).find(|tick| {
            rig.ticks(1);
            // Three counts are more than a count at rest does.
            moved = moved.or(Some(*tick).filter(|_| swing(begun)(rig.bench.now()).travel.abs() > 2));
            let rocks = rig.reports.last().is_some_and(|report| report.decision.phase == Phase::Rocking);
            moved.is_some() && (rocks || drives(rig).iter().all(|(high, low)| *high && *low > 0.0))
        });
        let (moved, ended) = (moved.expect("it moves"), ended.expect("it ends"));
        println!("{later} ticks into the test: moves at tick {moved}, driven by the law at tick {ended}");
        assert!(ended <= moved + 2, "{later}: {ended} ticks, {moved}");
        let state = rig.wait(200, |state| state.phase == Phase::Rocking);
        assert_eq!((state.phase, state.fault), (Phase::Rocking, None), "{later}");
    });
}

/// A coil that fails while the board stands armed shows nothing until it is tried.
fn is_found(name: &str, ill: impl Fn(&mut Coil), faults: &[Fault]) {
    let mut rig = armed(Model::F405);
    rig.ticks(100);
    ill(&mut rig.bench.chip_mut().coils[0]);
    let before = rig.state();
    assert_eq!((before.phase, before.fault), (Phase::Armed, None), "{name}: shows at once");
    let state = rig.wait(16_000, |state| state.phase == Phase::Fault);
    println!("{name}: {:?}", state.fault);
    assert!(state.fault.is_some_and(|fault| faults.contains(&fault)), "{name}: {:?}", state.fault);
}

#[test]
fn what_has_failed_in_operation_is_found_by_the_next_test() {
    use sprag_shared::control::monitor::fault::Wheel::First;
    is_found("high side closed", |coil| coil.high = Switch::Closed, &[Fault::HighSideClosed(First)]);
}
