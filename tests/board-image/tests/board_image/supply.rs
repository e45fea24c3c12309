//! The supply of 3.3 V sags, and the crystal stops.

use std::collections::BTreeSet;

use sprag_board_image::bench::Stop;
use sprag_board_image::model::Model;
use sprag_board_image::peripheral::rcc::Cause;
use sprag_board_image::rig::{Rig, image_for};
use sprag_board_image::time::{in_milliseconds, milliseconds};
use sprag_shared::control::supervisor::Phase;
use sprag_shared::link::reset_cause;
use sprag_shared::settings::{Item, Settings};

/// A board whose safe state is to release both clutches.
fn armed(model: Model) -> Rig {
    let mut settings = Settings::default();
    settings.set(Item::SafeState.index(), 0).expect("in range");
    let mut rig = Rig::new(&image_for(model), Some(&settings));
    rig.arm();
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

/// C1: the interrupt between any two instructions of the coils' driver, from where it looks at the supply on: what the tick still writes is
/// not what it had in mind before.
#[test]
fn a_supply_that_falls_at_any_instruction_of_the_coils_driver_releases_them() {
    for model in Model::ALL {
        let mut rig = armed(model);
        let places = between_looks(&mut rig);
        let mut times = 0;
        for place in &places {
            rig.bench.stop_before(Some(*place));
            let begun = rig.bench.now();
            while rig.bench.run(rig.bench.now() + milliseconds(1)) != Stop::Place {
                assert!(rig.bench.now() < begun + milliseconds(4), "{model:?}: never at {place:#x}");
            }
            rig.bench.stop_before(None);
            rig.bench.chip_mut().set_volts(2.87);
            while rig.bench.run(rig.bench.now() + milliseconds(1)) != Stop::Tick {}
            assert_eq!(drives(&rig), RELEASED, "{model:?}, {place:#x}");
            rig.bench.chip_mut().set_volts(3.3);
            // Long enough for the currents to come back: a clutch that is let go again and again refuses.
            rig.ticks(12);
            assert_ne!(drives(&rig), RELEASED, "{model:?}, {place:#x}: the supply is back; {:?}", rig.state());
            times += 1;
        }
        println!("{model:?}: {times} instructions");
        assert!(times > 20, "{model:?}: {times} instructions between the first look and the last");
    }
}

/// Addresses of the instructions that a tick carries out from its first look at the supply to its last.
fn between_looks(rig: &mut Rig) -> BTreeSet<u32> {
    rig.settle(milliseconds(1));
    let looks = rig.bench.chip().supply.looks;
    let mut blocks = BTreeSet::new();
    while rig.bench.chip().supply.looks < looks + 2 {
        let now = rig.bench.now();
        let first = rig.bench.chip().supply.looks == looks;
        let profile = rig.bench.chip_mut().profile.replace(Default::default()).unwrap_or_default();
        if first {
            blocks.clear();
        }
        blocks.extend(profile.into_keys());
        assert_eq!(rig.bench.run(now + 1), Stop::Time);
    }
    blocks.extend(rig.bench.chip_mut().profile.take().unwrap_or_default().into_keys());
    let chip = rig.bench.chip();
    let mut places = BTreeSet::new();
    for (address, size) in blocks {
        // Up to four instructions under the condition of an IT: Unicorn cannot continue in the middle of them.
        let mut conditional = 0;
        for place in chip.instructions_of(address, size) {
            if conditional == 0 {
                places.insert(place);
            }
            let half = chip.flash.memory.word(place & !3) >> (8 * (place & 2)) & 0xFFFF;
            let begins = half >> 8 == 0xBF && half & 0xF != 0;
            conditional = if begins { 4 - half.trailing_zeros() } else { u32::saturating_sub(conditional, 1) };
        }
    }
    places
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
        rig.ticks(20);
        assert_eq!(rig.starts.last().map(|start| start.cause), Some(reset_cause::Cause::ClockFailure));
    }
}
