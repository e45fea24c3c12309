//! What a device in the emulator has recorded of a closed loop, compared with what it reported and what the host decided.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::time::Duration;

use sprag_cli::board::driver::{DeviceDriver, DeviceTick};
use sprag_cli::board::emulator::{Emulator, Way};
use sprag_cli::board::image::Image;
use sprag_cli::board::line::{DeviceError, Line};
use sprag_cli::board::parameters;
use sprag_cli::board::recordings::{self, Parts, Recording};
use sprag_cli::board::session::Session;
use sprag_shared::control::supervisor::Phase;
use sprag_shared::control::supervisor::event_log::{Entry, Kind};
use sprag_shared::device::recorder::BEFORE;
use sprag_shared::device::recorder::record::{GROUND_STEP, ROTATION_STEP, VELOCITY_STEP};
use sprag_shared::link::reset_cause::Cause;
use sprag_shared::link::{Mishap, Pace, RecorderActivity, Request, TickReport};
use sprag_sim::closed_loop::plant::Extremes;
use sprag_sim::interrupt::Interrupt;
use sprag_tests::device_loop::{mid_swing, on_the_host, pulse};
use sprag_tests::emulation::controller_firmware;

/// The emulator, which outlives the loop that it closes.
#[derive(Clone)]
struct Kept(Rc<RefCell<Emulator>>);

impl Line for Kept {
    fn send(&mut self, bytes: &[u8]) -> Result<(), DeviceError> {
        self.0.borrow_mut().send(bytes)
    }

    fn receive(&mut self, patience: Duration) -> Result<Vec<u8>, DeviceError> {
        self.0.borrow_mut().receive(patience)
    }

    fn pace(&self) -> Pace {
        self.0.borrow().pace()
    }
}

struct Flight {
    ticks: Vec<DeviceTick>,
    session: Session<Kept>,
    parts: Parts,
    recordings: Vec<Recording>,
}

impl Flight {
    /// Closes the loop of a pulse, with a reset at a time of the motion, s, and downloads what the device recorded.
    fn new(reset: Option<f64>) -> Flight {
        let scene = pulse(&["run.free_time_s=0.6"]);
        let line = Kept(Rc::new(RefCell::new(Emulator::start(Image::File(controller_firmware()), Way::Streams, None).unwrap())));
        let interrupt = Interrupt::default();
        let task = scene.task(scene.pairs[0], scene.controller.sensors.seed(), &interrupt);
        let clock = task.clock();
        let settings = task.settings().unwrap();
        let own = task.driver().unwrap();
        let mut session = Session::new(line.clone());
        parameters::write(&mut session, &settings, true).unwrap();
        let mut driver = DeviceDriver::attach(session, &settings, own).unwrap();
        if let Some(time) = reset {
            driver = driver.with_mishap(((clock.prelude + time) / clock.period).round() as u32, Mishap::Reset);
        }
        task.run_with(&mut driver, &mut (), &mut Extremes::default(), &mut Vec::new()).unwrap();
        let ticks = driver.finish().unwrap().ticks;
        let mut session = Session::new(line);
        while recordings::state(&mut session).unwrap().activity != RecorderActivity::Ready {}
        let parts = recordings::list(&mut session).unwrap();
        let read = |(key, part): (&(u16, u8), &recordings::Part)| {
            assert!(part.pages.iter().all(|(_, header)| header.attached && header.check == settings.check()));
            recordings::read(&mut session, *key, &part.pages, |_| {}).unwrap()
        };
        let recordings = parts.iter().map(read).collect();
        Flight { ticks, session, parts, recordings }
    }

    fn reports(&self) -> impl Iterator<Item = &TickReport> {
        self.ticks.iter().filter_map(|tick| tick.report.as_ref())
    }
}

/// Every tick of a recording is the report of that tick, to within the steps of its record. How many there were.
fn compare<'a>(recording: &Recording, reports: impl Iterator<Item = &'a TickReport>) -> usize {
    let reports: BTreeMap<u32, &TickReport> = reports.map(|report| (report.tick, report)).collect();
    let mut compared = 0;
    for (tick, moment) in &recording.moments {
        // One that could not be sent is missing.
        let Some(report) = reports.get(tick) else { continue };
        let (estimate, decision) = (&report.decision.estimate, &report.decision);
        assert!((moment.rotation - estimate.rotation).abs() < ROTATION_STEP, "tick {tick}: {moment:?} {estimate:?}");
        assert!((moment.velocity - estimate.velocity).abs() < VELOCITY_STEP, "tick {tick}: {moment:?} {estimate:?}");
        assert!((moment.ground - estimate.ground[0]).abs() < GROUND_STEP, "tick {tick}: {moment:?} {estimate:?}");
        let exact = (moment.command, moment.phase, moment.standing, moment.fault);
        let fault = decision.fault.map(|fault| fault.code());
        assert_eq!(exact, (decision.command, decision.phase, estimate.standing, fault), "tick {tick}");
        compared += 1;
    }
    compared
}

fn moves(report: &TickReport) -> bool {
    report.decision.phase == Phase::Rocking && !report.decision.estimate.standing
}

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn a_recording_is_what_the_host_decided() {
    let mut flight = Flight::new(None);
    assert!(flight.ticks.iter().all(|tick| !tick.differs), "the host decides otherwise");
    let [recording] = &flight.recordings[..] else { panic!("{:?}", flight.parts) };
    assert_eq!((recording.number, recording.part, recording.torn), (1, 0, 0));
    let first = flight.reports().find(|report| moves(report)).unwrap().tick;
    let last = flight.reports().filter(|report| moves(report)).last().unwrap().tick;
    let ticks: Vec<u32> = recording.moments.iter().map(|(tick, _)| *tick).collect();
    assert!(ticks.windows(2).all(|pair| pair[1] == pair[0] + 1));
    assert_eq!(ticks[0], first - BEFORE.min(first - 1));
    assert!(*ticks.last().unwrap() >= last);
    let compared = compare(recording, flight.reports());
    println!("{} ticks recorded, {compared} of them compared", ticks.len());
    assert!(compared as u32 > last - first, "{compared}");
    let moments = || recording.moments.iter().map(|(_, moment)| moment);
    assert!(moments().any(|moment| moment.engaged == [true, false]) && moments().any(|moment| moment.engaged == [false, true]));
    // Erased, there is nothing left.
    flight.session.order(&Request::EraseRecordings).unwrap();
    while recordings::state(&mut flight.session).unwrap().activity != RecorderActivity::Ready {}
    assert!(recordings::list(&mut flight.session).unwrap().is_empty());
}

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn a_reset_in_motion_is_recorded_in_two_parts_and_the_log_continues() {
    let (host, _) = on_the_host(&pulse(&["run.free_time_s=0.6"]));
    let mut flight = Flight::new(Some(mid_swing(&host)));
    let keys: Vec<(u16, u8)> = flight.parts.keys().copied().collect();
    assert_eq!(keys, [(1, 0), (1, 1)]);
    // At most a page is missing before the reset.
    let before: Vec<&TickReport> = {
        let ticks: Vec<&TickReport> = flight.reports().collect();
        let reset = ticks.windows(2).position(|pair| pair[1].tick < pair[0].tick).unwrap();
        ticks[..=reset].to_vec()
    };
    let (one, two) = (&flight.recordings[0], &flight.recordings[1]);
    let missing = before.last().unwrap().tick - one.moments.last().unwrap().0;
    println!("{missing} ticks before the reset are missing");
    assert!((missing as usize) <= sprag_shared::device::recorder::CAPACITY + 4 && one.torn <= 1, "{missing} {}", one.torn);
    assert!(compare(one, before.iter().copied()) > 250);
    let compared = compare(two, flight.reports().skip(before.len()));
    println!("{} ticks after it, {compared} of them compared", two.moments.len());
    assert!(compared > 500, "{compared} of {}", two.moments.len());
    let (entries, total) = flight.session.log().unwrap();
    let started = entries.iter().position(|entry| entry.kind == Kind::Started(Cause::Software as u8));
    let before: &[Entry] = &entries[..started.expect("the log says that there was a reset")];
    assert!(before.iter().any(|entry| entry.kind == Kind::Phase(Phase::Rocking)), "{before:?}");
    assert!(total as usize >= entries.len());
}
