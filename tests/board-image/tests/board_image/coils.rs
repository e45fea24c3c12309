//! Coils and switches that fail, as the self-test and the operation see them.

use sprag_board_image::model::Model;
use sprag_board_image::peripheral::coil::{Coil, Switch};
use sprag_board_image::rig::{Rig, image};
use sprag_shared::control::supervisor::Phase;
use sprag_shared::link::State;
use sprag_shared::settings::{Item, Settings};

/// The state after the self-test of a board whose first coil is made ill.
fn tested(ill: impl Fn(&mut Coil)) -> (State, f64) {
    let mut rig = Rig::new(&image(), Some(&Settings::default()));
    ill(&mut rig.bench.chip_mut().coils[0]);
    rig.boot();
    let state = rig.wait(4000, |state| matches!(state.phase, Phase::Armed | Phase::Fault));
    (state, rig.bench.chip().coils[0].peak)
}

fn is_found(name: &str, ill: impl Fn(&mut Coil)) {
    let (state, peak) = tested(ill);
    println!("{name}: {:?} {:?}, peak {peak:.1} A", state.phase, state.fault.map(|fault| fault.code()));
    assert!(state.phase == Phase::Fault && state.fault.is_some(), "{name}: {:?}", state.phase);
}

#[test]
fn whole_coils_pass_the_self_test() {
    let (state, peak) = tested(|_| ());
    assert_eq!((state.phase, state.fault), (Phase::Armed, None), "peak {peak} A");
    assert!((1.0..1.25).contains(&peak), "{peak} A");
}

/// The coil of docs/hardware/coil.md, whose current takes longer to die than its feedback takes to say that it has.
#[test]
fn slow_coils_pass_the_self_test() {
    let mut settings = Settings::default();
    settings.set(Item::CoilFullCurrent.index(), (24.0_f32 / 28.8).to_bits()).unwrap();
    let mut rig = Rig::new(&image(), Some(&settings));
    for coil in &mut rig.bench.chip_mut().coils {
        (coil.resistance, coil.inductance) = (28.8, 0.25);
    }
    rig.boot();
    let state = rig.wait(4000, |state| matches!(state.phase, Phase::Armed | Phase::Fault));
    assert_eq!((state.phase, state.fault), (Phase::Armed, None));
}

#[test]
fn a_broken_wire_is_found() {
    is_found("open", |coil| coil.resistance = f64::INFINITY);
}

#[test]
fn both_switches_closed_are_found() {
    is_found("both closed", |coil| (coil.high, coil.low) = (Switch::Closed, Switch::Closed));
}

/// B1.
#[test]
fn a_short_is_found() {
    is_found("shorted", |coil| (coil.resistance, coil.inductance) = (0.5, 0.0015));
}

/// B1.
#[test]
fn a_high_side_that_stays_closed_is_found() {
    is_found("high side closed", |coil| coil.high = Switch::Closed);
}

/// B1.
#[test]
fn a_low_side_that_stays_closed_is_found() {
    is_found("low side closed", |coil| coil.low = Switch::Closed);
}

#[test]
fn switches_that_never_close_are_found() {
    is_found("high side open", |coil| coil.high = Switch::Open);
    is_found("low side open", |coil| coil.low = Switch::Open);
}

/// B1: a coil that is shorted in operation is switched off by a comparator at the timer's break, long before the next tick.
#[test]
fn the_break_ends_an_over_current_within_microseconds() {
    for model in Model::ALL {
        let mut rig = Rig::armed(model);
        rig.ticks(100);
        let held = [0, 1].map(|coil| rig.bench.chip().drive(coil).1 > 0.0);
        let coil = held.iter().position(|held| *held).expect("one is engaged at rest");
        let ill = &mut rig.bench.chip_mut().coils[coil];
        (ill.resistance, ill.inductance, ill.peak) = (0.5, 0.0015, 0.0);
        rig.ticks(20);
        let (peak, drive) = (rig.bench.chip().coils[coil].peak, rig.bench.chip().drive(coil));
        let fault = rig.state().fault.map(|fault| fault.code());
        println!("{model:?}: {peak:.2} A, then {drive:?}, fault {fault:?}");
        assert!(peak < 1.3, "{model:?}: {peak} A");
        assert_eq!((drive.1, fault), (0.0, Some(58 + coil as u16)), "{model:?}");
    }
}
