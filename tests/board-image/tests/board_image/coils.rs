//! Coils and switches that fail, as the self-test and the operation see them.

use sprag_board_image::peripheral::coil::{Coil, Switch};
use sprag_board_image::rig::{Rig, image};
use sprag_shared::control::supervisor::Phase;
use sprag_shared::link::State;
use sprag_shared::settings::Settings;

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
