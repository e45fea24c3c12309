//! Resets while the block rocks.

use std::rc::Rc;

use sprag_board_image::model::Model;
use sprag_board_image::peripheral::rcc::Cause;
use sprag_board_image::rig::{Rig, swing};
use sprag_board_image::time::in_milliseconds;
use sprag_shared::control::supervisor::Phase;
use sprag_shared::link::Request;

/// Armed, and then rocking for so many ticks.
pub fn rocking(model: Model, ticks: usize) -> Rig {
    let mut rig = Rig::armed(model);
    let begin = rig.bench.now();
    rig.structure = Rc::new(swing(begin));
    rig.ticks(ticks);
    let state = rig.state();
    assert_eq!((state.phase, state.fault), (Phase::Rocking, None));
    rig
}

/// From the reset to the first tick, and to the first one that the law decides, ms.
fn back(rig: &mut Rig) -> (f64, f64) {
    rig.reset(Cause::Watchdog);
    let boot = in_milliseconds(rig.boot());
    // Every tick at a line that is fast enough for it.
    rig.bench.chip_mut().line.haste = 8;
    rig.reports.clear();
    rig.send(&Request::Stream { every: 1 });
    rig.ticks(150);
    assert!(rig.starts.last().is_some_and(|start| start.resumed), "{:?}", rig.starts);
    let fault = rig.reports.iter().find_map(|report| report.decision.fault);
    assert_eq!(fault, None);
    let decides = |phase: Phase| matches!(phase, Phase::Armed | Phase::Rocking);
    let first = rig.reports.iter().find(|report| decides(report.decision.phase)).expect("it never decides again");
    (boot, boot + 0.5 * f64::from(first.tick))
}

/// A1: by the watchdog, at so many phases of a swing of 1.05 s.
#[test]
fn a_reset_in_motion_is_resumed_from_within_50_ms() {
    for (model, phases) in [(Model::F405, 20), (Model::G474, 5)] {
        let mut rig = rocking(model, 600);
        let mut worst = (0.0_f64, 0.0_f64);
        for phase in 0..phases {
            let before = rig.snapshot();
            let (boot, time) = back(&mut rig);
            assert!(time < 50.0, "{model:?}, phase {phase}: {time} ms");
            worst = (worst.0.max(boot), worst.1.max(time));
            rig.restore(&before);
            rig.ticks(2100 / phases);
        }
        let (boot, time) = worst;
        println!(
            "{model:?}, of {phases} phases the worst: first tick {boot:.1} ms after the reset, in control after {time:.1} ms"
        );
    }
}

/// A tick of a G4 in motion costs what one of an F4 does, and none is late.
#[test]
fn a_tick_in_motion_costs_the_same_on_every_chip() {
    let [first, second] = Model::ALL.map(|model| {
        let mut rig = rocking(model, 600);
        rig.costs.clear();
        rig.ticks(400);
        assert_eq!(rig.state().worst_lateness, 0, "{model:?}");
        let worst = rig.costs.iter().map(|cost| cost.instructions).max().unwrap_or(0);
        println!("{model:?}: {worst} instructions at most");
        worst
    });
    assert!(second < first * 12 / 10, "{first} and {second} instructions");
}

/// A board that is brought back to a snapshot does what one does that went on, instruction by instruction.
#[test]
fn a_snapshot_goes_on_as_the_board_did() {
    for model in Model::ALL {
        let mut rig = rocking(model, 600);
        let before = rig.snapshot();
        let mut goes_on = || {
            rig.send(&Request::Stream { every: 1 });
            rig.ticks(300);
            let state = rig.state();
            let done = (rig.costs.split_off(rig.costs.len() - 300), std::mem::take(&mut rig.reports), state, rig.bench.now());
            rig.reset(Cause::Power);
            rig.boot();
            rig.restore(&before);
            done
        };
        assert_eq!(goes_on(), goes_on(), "{model:?}");
    }
}
