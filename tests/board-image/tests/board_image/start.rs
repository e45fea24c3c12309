//! From the supply's coming to Armed.

use sprag_board_image::model::Model;
use sprag_board_image::peripheral::flash::{Pace, Work};
use sprag_board_image::peripheral::rcc::Cause;
use sprag_board_image::rig::{Rig, image, image_for, keep};
use sprag_board_image::time::in_milliseconds;
use sprag_shared::control::supervisor::{Parameters, Phase};
use sprag_shared::link::{Reply, Request};
use sprag_shared::settings::Settings;

#[test]
fn a_commissioned_board_arms_itself_and_says_who_it_is() {
    Model::ALL.into_iter().for_each(arms_itself);
}

fn arms_itself(model: Model) {
    let mut rig = Rig::new(&image_for(model), Some(&Settings::default()));
    rig.boot();
    let Reply::Identity(identity) = rig.ask(&Request::Identify) else { panic!("no identity") };
    assert_eq!((&identity.board[..4], identity.check), (model.name().as_bytes(), Settings::default().check()));
    let state = rig.wait(4000, |state| state.phase == Phase::Armed);
    println!(
        "armed after {:.0} ms, worst tick {} cycles, stack {} bytes",
        in_milliseconds(rig.bench.now()),
        state.worst_cost,
        state.stack
    );
    assert_eq!((state.phase, state.fault, state.worst_lateness), (Phase::Armed, None, 0));
    assert!(rig.starts.len() == 1 && rig.starts[0].stored && !rig.starts[0].resumed, "{:?}", rig.starts);
    let chip = rig.bench.chip();
    assert!(chip.unknown.is_empty(), "registers without a model: {:x?}", chip.unknown);
    assert_eq!(chip.buses.each_ref().map(|bus| bus.sensor.forbidden), [0; 2], "stores that the sensor's data sheet forbids");
}

/// A5: on its own defaults, which are those of some other structure, a board must not take part.
#[test]
fn a_board_without_settings_of_its_own_stays_in_the_safe_state() {
    let mut rig = Rig::new(&image(), None);
    rig.boot();
    let state = rig.wait(4000, |state| state.phase == Phase::Armed);
    assert!(
        state.phase == Phase::Fault && state.fault.is_some_and(|fault| fault.code() == 63),
        "{:?} {:?}",
        state.phase,
        state.fault
    );
    let commanded = rig.bench.chip().coils.each_ref().map(|coil| coil.current > 0.0);
    assert_eq!(commanded, Parameters::default().safe_state.command());
}

/// A2: a start after a reset takes less than 20 ms, whatever the flash holds and however slow it is.
#[test]
fn a_restart_is_short_whatever_the_flash_holds() {
    for stores in [0, 1, 8, 16, 33, 34] {
        let mut rig = Rig::new(&image(), None);
        rig.boot();
        keep(&mut rig.bench.chip_mut().flash, &Settings::default(), stores);
        rig.bench.chip_mut().flash.pace = Pace::Slowest;
        let works = rig.bench.chip().flash.works.len();
        rig.reset(Cause::Watchdog);
        let time = in_milliseconds(rig.boot());
        println!("{stores} stores: first tick {time:.1} ms after the reset");
        assert_eq!(rig.bench.chip().flash.works.len(), works, "{stores} stores: the flash was written or erased");
        assert!(time < 20.0, "{stores} stores: {time} ms");
    }
}

/// The first start of a chip programs its option bytes; every later one finds them as they shall be.
#[test]
fn the_brown_out_reset_is_switched_on_once_in_a_chips_life() {
    for (model, level) in [(Model::F405, 2.83), (Model::G474, 2.8)] {
        let mut rig = Rig::new(&image_for(model), Some(&Settings::default()));
        rig.boot();
        assert_eq!(rig.bench.chip().flash.brown_out(), Some(level), "{model:?}");
        let works = rig.bench.chip().flash.works.clone();
        // Beside them only its firmware's version.
        assert_eq!(works.iter().filter(|work| matches!(work, Work::Options(_))).count(), 1, "{model:?}: {works:?}");
        // A G4 takes them over by a reset.
        let reloads = rig.bench.resets.iter().filter(|(_, cause)| *cause == Cause::OptionReload).count();
        assert_eq!(reloads, usize::from(model == Model::G474), "{model:?}");
        rig.reset(Cause::Power);
        rig.boot();
        assert_eq!(rig.bench.chip().flash.works, works, "{model:?}");
    }
}
