//! Sensors, converter and their wires fail while the board is armed.

use sprag_board_image::peripheral::spi::Wire;
use sprag_board_image::rig::{Rig, image};
use sprag_shared::control::supervisor::Phase;
use sprag_shared::settings::Settings;

fn armed() -> Rig {
    let mut rig = Rig::new(&image(), Some(&Settings::default()));
    rig.boot();
    let state = rig.wait(4000, |state| state.phase == Phase::Armed);
    assert_eq!(state.phase, Phase::Armed, "{:?}", state.fault);
    rig.ticks(100);
    rig
}

/// The code of the fault that the board reports after 40 ms, whether or not something else stands in for what has failed.
fn fault(rig: &mut Rig) -> u16 {
    rig.ticks(80);
    rig.state().fault.map_or(0, |fault| fault.code())
}

#[test]
fn a_wire_that_is_stuck_is_a_stale_sensor() {
    for (bus, code) in [(0, 11), (1, 31)] {
        for level in [false, true] {
            let mut rig = armed();
            rig.bench.chip_mut().buses[bus].wire = Wire::Stuck(level);
            assert_eq!(fault(&mut rig), code, "bus {bus} stuck at {level}");
        }
    }
}

#[test]
fn a_sensor_that_loses_its_supply_is_configured_anew_and_trusted_again() {
    for (bus, code) in [(0, 11), (1, 31)] {
        let mut rig = armed();
        let now = rig.bench.now();
        rig.bench.chip_mut().buses[bus].sensor.brown_out(now);
        assert_eq!(fault(&mut rig), code, "bus {bus}");
        let state = rig.wait(16_000, |state| state.phase == Phase::Armed && state.fault.is_none());
        assert_eq!((state.phase, state.fault), (Phase::Armed, None), "bus {bus}");
    }
}

#[test]
fn a_converter_that_is_stuck_is_a_fault_of_a_clutch() {
    for (counts, codes) in [(0, 53..=54), (4095, 58..=59)] {
        let mut rig = armed();
        rig.bench.chip_mut().converter.stuck = Some(counts);
        let code = fault(&mut rig);
        assert!(codes.contains(&code), "stuck at {counts}: {code}");
    }
}
