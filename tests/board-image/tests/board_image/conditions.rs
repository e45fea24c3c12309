//! The coils' supply and the temperature, under which the pull-in time holds.

use sprag_board_image::model::Model;
use sprag_board_image::rig::Rig;
use sprag_shared::control::monitor::fault::Fault;
use sprag_shared::control::supervisor::Phase;

fn armed(model: Model) -> Rig {
    let mut rig = Rig::armed(model);
    assert_eq!(rig.warnings(), [], "{model:?}");
    rig
}

fn supply(rig: &mut Rig, volts: f64) {
    rig.bench.chip_mut().coils.iter_mut().for_each(|coil| coil.supply = volts);
}

/// C12: by default below 21.6 V, which both clutches still hold with.
#[test]
fn a_coils_supply_that_sags_is_a_warning_and_nothing_more() {
    for model in Model::ALL {
        armed(model).for_each([(22.0, vec![]), (21.0, vec![Fault::SupplyLow])], |rig, (volts, expected)| {
            supply(rig, volts);
            rig.ticks(200);
            assert_eq!(rig.warnings(), expected, "{model:?}: {volts} V");
            // Reported once, and nothing else has come of it.
            supply(rig, 24.0);
            rig.ticks(200);
            supply(rig, volts);
            rig.ticks(200);
            let state = rig.state();
            assert_eq!((state.phase, state.fault, rig.warnings()), (Phase::Armed, None, expected), "{model:?}: {volts} V");
        });
    }
}

/// C12: shorter than a clutch takes to close, but longer than a spike.
#[test]
fn a_sag_of_ten_milliseconds_is_seen_and_one_of_two_is_not() {
    armed(Model::F405).for_each([(4, vec![]), (20, vec![Fault::SupplyLow])], |rig, (ticks, expected)| {
        supply(rig, 18.0);
        rig.ticks(ticks);
        supply(rig, 24.0);
        rig.ticks(100);
        assert_eq!(rig.warnings(), expected, "{ticks} ticks");
    });
}

/// C12: by default from -20 to 70 °C at the block.
#[test]
fn cold_and_heat_beyond_the_settings_are_a_warning() {
    let cases = [(-19.0, vec![]), (-21.0, vec![Fault::TemperatureUnusual]), (71.0, vec![Fault::TemperatureUnusual])];
    for model in Model::ALL {
        armed(model).for_each(cases.clone(), |rig, (celsius, expected)| {
            rig.bench.chip_mut().buses[0].sensor.temperature = celsius;
            // Of the part on the ground nobody asks.
            rig.bench.chip_mut().buses[1].sensor.temperature = 90.0;
            rig.ticks(3000);
            let state = rig.state();
            assert_eq!((state.phase, state.fault, rig.warnings()), (Phase::Armed, None, expected), "{model:?}: {celsius} °C");
        });
    }
}
