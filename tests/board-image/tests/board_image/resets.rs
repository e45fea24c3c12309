//! Resets while the block rocks.

use sprag_board_image::peripheral::rcc::Cause;
use sprag_board_image::rig::{Rig, image, swing};
use sprag_board_image::time::in_milliseconds;
use sprag_shared::control::supervisor::Phase;
use sprag_shared::link::Request;
use sprag_shared::settings::Settings;

/// Armed, and then rocking for so many ticks.
fn rocking(ticks: usize) -> Rig {
    let mut rig = Rig::new(&image(), Some(&Settings::default()));
    rig.boot();
    let armed = rig.wait(4000, |state| state.phase == Phase::Armed);
    assert_eq!(armed.phase, Phase::Armed, "{:?}", armed.fault);
    let begin = rig.bench.now();
    rig.structure = Box::new(swing(begin));
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

/// A1: by the watchdog, at twenty phases of a swing of 1.05 s.
#[test]
fn a_reset_in_motion_is_gone_on_from_within_50_ms() {
    let mut worst = (0.0_f64, 0.0_f64);
    for phase in 0..20 {
        let (boot, time) = back(&mut rocking(600 + 105 * phase));
        assert!(time < 50.0, "phase {phase}: {time} ms");
        worst = (worst.0.max(boot), worst.1.max(time));
    }
    println!("of 20 phases the worst: first tick {:.1} ms after the reset, in control after {:.1} ms", worst.0, worst.1);
}
