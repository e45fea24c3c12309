//! Inertial parts that are tested by themselves, or whose rest is not 1 g.

use sprag_board_image::model::Model;
use sprag_board_image::peripheral::rcc::Cause;
use sprag_board_image::rig::{Rig, image_for};
use sprag_board_image::time::in_milliseconds;
use sprag_shared::control::monitor::fault::{Fault, Place};
use sprag_shared::control::supervisor::Phase;
use sprag_shared::link::{Reply, Request};
use sprag_shared::settings::Settings;

/// A board that has armed itself, after `ill` has been done to its new parts.
fn armed(model: Model, ill: impl FnOnce(&mut Rig)) -> Rig {
    let mut rig = Rig::new(&image_for(model), Some(&Settings::default()));
    ill(&mut rig);
    rig.arm();
    rig.ticks(600);
    rig
}

fn tests(rig: &Rig) -> [u32; 2] {
    rig.bench.chip().buses.each_ref().map(|bus| bus.sensor.tests)
}

/// C6.
#[test]
fn parts_that_answer_as_in_the_factory_pass_and_are_tested_anew_on_request() {
    for model in Model::ALL {
        let mut rig = armed(model, |_| ());
        println!("{model:?}: armed and looked at after {:.0} ms", in_milliseconds(rig.bench.now()));
        assert_eq!((tests(&rig), rig.warnings()), ([1; 2], vec![]), "{model:?}");
        assert!(matches!(rig.ask(&Request::SelfTest), Reply::Done(_)));
        let state = rig.wait(6000, |state| state.phase == Phase::Armed);
        rig.ticks(600);
        assert_eq!((state.phase, tests(&rig), rig.warnings()), (Phase::Armed, [2; 2], vec![]), "{model:?}");
        let forbidden = rig.bench.chip().buses.each_ref().map(|bus| bus.sensor.forbidden);
        assert_eq!(forbidden, [0; 2], "stores that the sensor's data sheet forbids");
    }
}

/// C6: an axis that does not answer, or by as much as one of another range does.
#[test]
fn a_part_that_fails_its_self_test_is_a_warning() {
    let cases =
        [(0, 0, 0.0, Some(Place::Block)), (0, 1, 2.0, Some(Place::Block)), (1, 0, 0.4, Some(Place::Ground)), (1, 1, 0.0, None)];
    for (bus, sensor, answer, place) in cases {
        let mut rig = armed(Model::F405, |rig| rig.bench.chip_mut().buses[bus].sensor.answers[sensor][2] = answer);
        let expected: Vec<Fault> = place.map(Fault::AnswersWrongly).into_iter().collect();
        assert_eq!(rig.warnings(), expected, "bus {bus}, sensor {sensor}: {answer}");
    }
}

/// A reset in motion has no time for it, whatever is wrong with the parts.
#[test]
fn a_reset_while_the_board_is_armed_tests_no_part() {
    let mut rig = armed(Model::F405, |_| ());
    rig.reset(Cause::Watchdog);
    let time = in_milliseconds(rig.boot());
    rig.ticks(100);
    assert!(time < 20.0 && rig.starts.last().is_some_and(|start| start.resumed), "{time} ms, {:?}", rig.starts);
    assert_eq!(tests(&rig), [1; 2]);
}

/// C6: both parts in another range than they are read with, each by the registers as it should be: they contradict nothing.
#[test]
fn accelerometers_that_measure_twice_too_much_are_reported_within_ten_seconds() {
    let mut rig = armed(Model::F405, |_| ());
    rig.gravity = 8192.0;
    for _ in 0..20 {
        rig.ticks(1000);
        if rig.warnings().len() == 2 {
            break;
        }
    }
    assert_eq!(rig.warnings(), Place::ALL.map(Fault::ScaleWrong));
    let state = rig.state();
    assert!(state.fault.is_none() && matches!(state.phase, Phase::Armed | Phase::Rocking), "{:?} {:?}", state.phase, state.fault);
}
