//! Resets while the block rocks.

use sprag_board_image::peripheral::rcc::Cause;
use sprag_board_image::rig::{Rig, image, swing};
use sprag_board_image::time::in_milliseconds;
use sprag_shared::control::supervisor::Phase;
use sprag_shared::link::Request;
use sprag_shared::settings::Settings;

/// Armed, and then rocking for 350 ms.
fn rocking() -> (Rig, u64) {
    let mut rig = Rig::new(&image(), Some(&Settings::default()));
    rig.boot();
    let armed = rig.wait(4000, |state| state.phase == Phase::Armed);
    assert_eq!(armed.phase, Phase::Armed, "{:?}", armed.fault);
    let begin = rig.bench.now();
    rig.structure = Box::new(swing(begin));
    rig.ticks(700);
    let state = rig.state();
    assert_eq!((state.phase, state.fault), (Phase::Rocking, None));
    (rig, begin)
}

/// A1: by the watchdog, in mid-swing.
#[test]
fn a_reset_in_motion_is_gone_on_from_within_50_ms() {
    let (mut rig, _) = rocking();
    let begun = rig.bench.now();
    rig.reset(Cause::Watchdog);
    let boot = in_milliseconds(rig.boot());
    // Every tick at a line that is fast enough for it.
    rig.bench.chip_mut().line.haste = 8;
    rig.send(&Request::Stream { every: 1 });
    rig.ticks(400);
    assert!(rig.starts.last().is_some_and(|start| start.resumed), "{:?}", rig.starts);
    let decides = |phase: Phase| matches!(phase, Phase::Armed | Phase::Rocking);
    let first = rig.reports.iter().find(|report| decides(report.decision.phase)).expect("it never decides again");
    let back = boot + 0.5 * f64::from(first.tick);
    let since = in_milliseconds(rig.bench.now() - begun);
    println!("first tick after {boot:.1} ms, in control after {back:.1} ms; watched for {since:.0} ms");
    let faults: Vec<_> = rig.reports.iter().filter_map(|report| report.decision.fault).collect();
    assert!(faults.is_empty(), "{:?}", faults[0]);
    // The start itself is A2's.
    assert!(back - boot < 30.0, "in control {:.1} ms after the first tick", back - boot);
}
