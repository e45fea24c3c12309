//! The supply of 3.3 V sags, and the crystal stops.

use sprag_board_image::bench::Stop;
use sprag_board_image::model::Model;
use sprag_board_image::peripheral::rcc::Cause;
use sprag_board_image::rig::{Rig, image_for};
use sprag_board_image::time::in_milliseconds;
use sprag_shared::control::supervisor::Phase;
use sprag_shared::link::reset_cause;
use sprag_shared::settings::{Item, Settings};

/// A board whose safe state is to release both clutches.
fn armed(model: Model) -> Rig {
    let mut settings = Settings::default();
    settings.set(Item::SafeState.index(), 0).expect("in range");
    let mut rig = Rig::new(&image_for(model), Some(&settings));
    rig.boot();
    let state = rig.wait(4000, |state| state.phase == Phase::Armed);
    assert_eq!(state.phase, Phase::Armed, "{:?}", state.fault);
    // The pull-in is over.
    rig.ticks(100);
    rig
}

/// What both coils are commanded: high side, duty of the low side.
fn drives(rig: &Rig) -> [(bool, f64); 2] {
    [rig.bench.chip().drive(0), rig.bench.chip().drive(1)]
}

const RELEASED: [(bool, f64); 2] = [(false, 0.0); 2];

#[test]
fn the_voltage_detector_releases_the_coils_at_once() {
    for model in Model::ALL {
        let mut rig = armed(model);
        assert_ne!(drives(&rig), RELEASED, "nothing is engaged at rest");
        rig.bench.chip_mut().set_volts(2.87);
        let now = rig.bench.now();
        // Some microseconds: the interrupt, and the ports.
        rig.bench.run(now + sprag_board_image::time::microseconds(5));
        assert_eq!(drives(&rig), RELEASED);
        rig.ticks(4);
        assert_eq!(drives(&rig), RELEASED, "a control tick engages while the supply is low");
        rig.bench.chip_mut().set_volts(3.3);
        rig.ticks(4);
        assert_ne!(drives(&rig), RELEASED, "the supply is back; {:?}", rig.state());
    }
}

#[test]
fn below_the_brown_out_level_the_chip_waits_and_then_starts() {
    for model in Model::ALL {
        let mut rig = armed(model);
        rig.bench.chip_mut().set_volts(2.7);
        assert_eq!(rig.bench.run(rig.bench.now() + 672_000), Stop::Time);
        assert_eq!(drives(&rig), RELEASED);
        rig.bench.chip_mut().set_volts(3.3);
        rig.boot();
        rig.ticks(20);
        assert_eq!(rig.starts.last().map(|start| start.cause), Some(reset_cause::Cause::BrownOut));
    }
}

/// Without the crystal a board starts by its internal oscillator, at the same rate.
#[test]
fn a_board_without_crystal_starts_and_arms() {
    for model in Model::ALL {
        let mut rig = Rig::new(&image_for(model), Some(&Settings::default()));
        rig.bench.chip_mut().rcc.crystal = false;
        let boot = rig.boot();
        println!("first tick after {:.1} ms", in_milliseconds(boot));
        assert_eq!(rig.bench.chip().rcc.core_hz(), 168_000_000);
        assert_eq!(rig.wait(4000, |state| state.phase == Phase::Armed).phase, Phase::Armed);
    }
}

/// The clock security system's interrupt puts the coils into the safe state, and a reset follows, without the crystal.
#[test]
fn a_crystal_that_stops_ends_in_the_safe_state_and_a_new_start() {
    for model in Model::ALL {
        let mut rig = armed(model);
        rig.bench.chip_mut().crystal_stops();
        assert_eq!(rig.tick(), Stop::Reset(Cause::Software));
        rig.boot();
        assert_eq!(rig.bench.chip().rcc.core_hz(), 168_000_000);
    }
}
