//! Sensors, converter and their wires fail while the board is armed.

use sprag_board_image::model::Model;
use sprag_board_image::peripheral::spi::Wire;
use sprag_board_image::rig::Rig;
use sprag_shared::control::supervisor::Phase;
use sprag_shared::link::Request;

fn armed() -> Rig {
    let mut rig = Rig::armed(Model::F405);
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
    let cases = [(0, 11), (1, 31)].into_iter().flat_map(|(bus, code)| [false, true].map(|level| (bus, code, level)));
    armed().for_each(cases, |rig, (bus, code, level)| {
        rig.bench.chip_mut().buses[bus].wire = Wire::Stuck(level);
        assert_eq!(fault(rig), code, "bus {bus} stuck at {level}");
    });
}

#[test]
fn a_sensor_that_loses_its_supply_is_configured_anew_and_trusted_again() {
    armed().for_each([(0, 11), (1, 31)], |rig, (bus, code)| {
        let now = rig.bench.now();
        rig.bench.chip_mut().buses[bus].sensor.brown_out(now);
        assert_eq!(fault(rig), code, "bus {bus}");
        let state = rig.wait(16_000, |state| state.phase == Phase::Armed && state.fault.is_none());
        assert_eq!((state.phase, state.fault), (Phase::Armed, None), "bus {bus}");
    });
}

#[test]
fn a_converter_that_is_stuck_is_a_fault_of_a_clutch() {
    armed().for_each([(0, 53..=54), (4095, 58..=59)], |rig, (counts, codes)| {
        rig.bench.chip_mut().converter.stuck = Some(counts);
        let code = fault(rig);
        assert!(codes.contains(&code), "stuck at {counts}: {code}");
    });
}

/// Bits that flip, one in 10⁴: words are wrong now and then, but no sensor is given up, nothing is reset, and rest is found again. What the block's
/// gyroscope says wrongly changes no command.
#[test]
fn bits_that_flip_are_no_fault_and_leave_nothing_behind() {
    for bus in 0..2 {
        let mut rig = armed();
        rig.bench.chip_mut().buses[bus].wire = Wire::Noisy(1e-4);
        let mut changes = 0;
        let mut last = switches(&rig);
        for _ in 0..1000 {
            rig.ticks(1);
            let before = std::mem::replace(&mut last, switches(&rig));
            changes += u32::from(before != last);
        }
        let state = rig.state();
        println!("bus {bus}: {changes} changes of command, {:?} {:?}", state.phase, state.fault);
        assert!(state.fault.is_none() && (bus == 1 || changes == 0), "bus {bus}: {:?}, {changes} changes", state.fault);
        rig.bench.chip_mut().buses[bus].wire = Wire::Whole;
        let state = rig.wait(16_000, |state| state.phase == Phase::Armed);
        assert_eq!((state.phase, state.fault, rig.starts.len()), (Phase::Armed, None, 1), "bus {bus}");
    }
}

/// The high sides as they are commanded.
fn switches(rig: &Rig) -> [bool; 2] {
    [0, 1].map(|coil| rig.bench.chip().drive(coil).0)
}

/// The supply of the chip, or of the coils, for 30 ms: what a coil then does not hold is found, one clutch stays commanded or is released
/// where it is the ill one, and somebody who asks brings the board back.
#[test]
fn a_supply_that_sags_for_longer_is_a_fault_of_a_clutch_until_somebody_asks() {
    for (volts, rail, code) in [(2.87, 24.0, Some(54)), (3.3, 12.0, None), (3.3, 6.0, Some(53)), (3.3, 0.0, Some(53))] {
        let mut rig = armed();
        rig.bench.chip_mut().set_volts(volts);
        rig.bench.chip_mut().coils.iter_mut().for_each(|coil| coil.supply = rail);
        rig.ticks(60);
        let during = switches(&rig);
        rig.bench.chip_mut().set_volts(3.3);
        rig.bench.chip_mut().coils.iter_mut().for_each(|coil| coil.supply = 24.0);
        rig.ticks(20);
        let fault = rig.state().fault.map(|fault| fault.code());
        println!("{volts} V, {rail} V: fault {fault:?}, commanded {during:?}");
        assert_eq!(fault, code, "{volts} V, {rail} V");
        let expected = match code {
            Some(54) => [true, false],
            Some(_) => [false, true],
            None => [true, true],
        };
        assert_eq!(during, expected, "{volts} V, {rail} V");
        // After four seconds of stillness.
        rig.ticks(8000);
        rig.ask(&Request::Clear);
        let state = rig.wait(8000, |state| state.phase == Phase::Armed);
        assert_eq!((state.phase, state.fault, rig.starts.len()), (Phase::Armed, None, 1), "{volts} V, {rail} V");
    }
}
