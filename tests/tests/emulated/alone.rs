//! A device in the emulator without settings, without its host, or that cannot start well.
//!
//! The numbers of `docs/faults.md` come from `cargo test -p sprag-tests --test emulated alone -- --ignored --nocapture`, with the image that
//! `cargo xtask test` builds.

use std::time::Duration;

use sprag_cli::board::emulator::{Emulator, Way};
use sprag_cli::board::image::Image;
use sprag_cli::board::parameters;
use sprag_cli::board::session::Session;
use sprag_shared::control::monitor::fault::Fault;
use sprag_shared::control::supervisor::Phase;
use sprag_shared::device::HOST_SILENCE;
use sprag_shared::device::beginning::MOST_STARTS;
use sprag_shared::link::{Mishap, Pace, Request, Started, State};
use sprag_shared::settings::{Item, Settings};
use sprag_tests::device_loop::row;
use sprag_tests::emulation::controller_firmware;

/// Longest silence of a device that has not hung, on any machine that tests run on.
const PATIENCE: Duration = Duration::from_secs(20);

fn start() -> Session<Emulator> {
    Session::new(Emulator::start(Image::File(controller_firmware()), Way::Streams, None).unwrap())
}

/// So many control periods.
fn periods(session: &mut Session<Emulator>, count: u32) {
    for _ in 0..count {
        session.receive(PATIENCE).unwrap();
        while session.take_tick().is_some() {}
    }
}

fn fault(state: &State) -> (Phase, Option<Fault>, Option<Pace>) {
    (state.phase, state.fault, state.attached)
}

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn a_device_without_settings_or_host_stays_in_the_safe_state() {
    let mut session = start();
    periods(&mut session, 10);
    assert_eq!(fault(&session.state().unwrap()), (Phase::Fault, Some(Fault::NotCommissioned), None));
    row(
        "no settings in flash",
        "a new board",
        &format!("Fault {}: {}", Fault::NotCommissioned.code(), Fault::NotCommissioned),
        Some(0.0),
        None,
        "a_device_without_settings_or_host_stays_in_the_safe_state",
    );
    // A host may run it, as long as it is there.
    session.order(&Request::Attach { pace: Pace::Timer }).unwrap();
    let period = f64::from(Settings::default().period());
    let silence = (f64::from(HOST_SILENCE) / period) as u32;
    periods(&mut session, silence - 100);
    assert_eq!(session.state().unwrap().attached, Some(Pace::Timer));
    periods(&mut session, 200);
    assert_eq!(fault(&session.state().unwrap()), (Phase::Fault, Some(Fault::NotCommissioned), None));
    row(
        "its host is killed",
        "no frames from the host for 5 s",
        "detaches itself: its own sensors, the settings in its flash",
        None,
        None,
        "a_device_without_settings_or_host_stays_in_the_safe_state",
    );
    // Settings of its own commission it, now and at the next start.
    parameters::write(&mut session, &Settings::default(), true).unwrap();
    periods(&mut session, 10);
    assert_eq!(session.state().unwrap().fault, None);
    assert!(reset(&mut session).stored);
    assert_eq!(session.state().unwrap().fault, None);
}

fn reset(session: &mut Session<Emulator>) -> Started {
    session.rehearse(Mishap::Reset).unwrap();
    for _ in 0..100 {
        periods(session, 1);
        if let Some(started) = session.take_started() {
            return started;
        }
    }
    panic!("it does not start anew");
}

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn settings_that_end_in_resets_are_given_up() {
    let mut session = start();
    let mut settings = Settings::default();
    settings.set(Item::Dwell.index(), 7).unwrap();
    parameters::write(&mut session, &settings, true).unwrap();
    session.take_started();
    for restart in 1..=MOST_STARTS {
        let started = reset(&mut session);
        assert_eq!((started.restarts, started.stored), (restart, true));
        assert_eq!(parameters::read(&mut session).unwrap(), settings);
    }
    let started = reset(&mut session);
    assert!(!started.stored, "{started:?}");
    periods(&mut session, 10);
    assert_eq!(fault(&session.state().unwrap()), (Phase::Fault, Some(Fault::GivenUp), None));
    assert_eq!(parameters::read(&mut session).unwrap(), Settings::default());
    row(
        &format!("{} resets in a row", MOST_STARTS + 1),
        "Mishap::Reset as soon as it has started",
        &format!("Fault {}: {}; the link answers", Fault::GivenUp.code(), Fault::GivenUp),
        Some(0.0),
        None,
        "settings_that_end_in_resets_are_given_up",
    );
    parameters::write(&mut session, &settings, true).unwrap();
    let started = reset(&mut session);
    assert_eq!((started.restarts, started.stored), (1, true));
}
