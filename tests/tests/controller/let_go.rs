//! A device behind a line, and what a loop does to it however it ends.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;
use std::time::Duration;

use sprag_cli::board::driver::DeviceDriver;
use sprag_cli::board::line::{DeviceError, Line};
use sprag_cli::board::parameters;
use sprag_cli::board::session::Session;
use sprag_shared::control::controller::{Circumstances, Controller};
use sprag_shared::control::sensing::sample::Sample;
use sprag_shared::device::beginning::Beginning;
use sprag_shared::device::{Answer, Device, Surroundings};
use sprag_shared::link::{Deframer, MAX_FRAME, Pace, Reply, Request, encode};
use sprag_shared::settings::store::Store;
use sprag_shared::settings::{Item, LAYOUT, Settings};
use sprag_sim::closed_loop::driver::{Driver, Shared};
use sprag_tests::flash::Flash;

/// A device, as a board on a serial port has it, in this process.
struct Here {
    device: Device,
    store: Store<Flash>,
    deframer: Deframer,
    said: VecDeque<u8>,
    pace: Pace,
    /// What it says its settings mean.
    layout: u32,
    /// It has lost its tongue for reports.
    silent: bool,
    /// Its next answers to this are lost.
    deaf_to: fn(&Request) -> bool,
}

impl Here {
    fn new() -> Rc<RefCell<Here>> {
        let settings = Settings::default();
        let device = Device::new(&Beginning::of(Some(&settings), None, 0.0).unwrap(), None);
        let (store, _) = Store::open(Flash::default());
        Rc::new(RefCell::new(Here {
            device,
            store,
            deframer: Deframer::new(),
            said: VecDeque::new(),
            pace: Pace::Sample,
            layout: LAYOUT,
            silent: false,
            deaf_to: |_| false,
        }))
    }

    fn say(&mut self, tag: u8, reply: &Reply) {
        let mut frame = [0; MAX_FRAME];
        let length = encode(tag, reply, &mut frame).unwrap();
        self.said.extend(&frame[..length]);
    }

    fn tick(&mut self) {
        self.device.tick(|_| {}, 0.0);
        if let Some(report) = self.device.report(1, 0).filter(|_| !self.silent) {
            self.say(0, &Reply::Tick(report));
        }
    }

    fn hear(&mut self, tag: u8, request: &Request) {
        match self.device.answer_storing(request, &mut self.store, &Surroundings::default()) {
            Answer::Reply(mut reply) | Answer::Restarted(mut reply) => {
                if let Reply::Identity(identity) = &mut reply {
                    identity.layout = self.layout;
                }
                if !(self.deaf_to)(request) {
                    self.say(tag, &reply);
                }
            }
            Answer::Sample if self.pace == Pace::Sample => self.tick(),
            Answer::Sample => {}
            answer => panic!("{answer:?}"),
        }
    }
}

struct Wire(Rc<RefCell<Here>>);

impl Line for Wire {
    fn send(&mut self, bytes: &[u8]) -> Result<(), DeviceError> {
        for &byte in bytes {
            let mut here = self.0.borrow_mut();
            if let Some(Ok(received)) = here.deframer.feed::<Request>(byte) {
                here.hear(received.tag, &received.message);
            }
        }
        Ok(())
    }

    fn receive(&mut self, patience: Duration) -> Result<Vec<u8>, DeviceError> {
        let mut here = self.0.borrow_mut();
        if here.pace == Pace::Timer {
            here.tick();
        }
        let said: Vec<u8> = here.said.drain(..).collect();
        if said.is_empty() && here.pace == Pace::Sample {
            std::thread::sleep(patience);
        }
        Ok(said)
    }

    fn pace(&self) -> Pace {
        self.0.borrow().pace
    }
}

/// Settings that a loop brings along.
fn brought() -> Settings {
    let mut settings = Settings::default();
    settings.set(Item::Law.index(), 1).unwrap();
    settings
}

fn attached(here: &Rc<RefCell<Here>>) -> Result<DeviceDriver<Wire>, DeviceError> {
    let own = Shared::new(Controller::of(&brought()).unwrap());
    DeviceDriver::attach(Session::new(Wire(here.clone())), &brought(), Box::new(own))
}

fn is_let_go(here: &Rc<RefCell<Here>>) {
    let here = here.borrow();
    assert_eq!(here.device.attached(), None);
    assert_eq!(*here.device.settings(), Settings::default());
}

#[test]
fn a_loop_that_ends_well_lets_go_of_the_device() {
    let here = Here::new();
    let mut driver = attached(&here).unwrap();
    assert_eq!(here.borrow().device.attached(), Some(Pace::Sample));
    for _ in 0..10 {
        driver.tick(&Sample::default(), Circumstances::default());
    }
    let farewell = driver.finish().unwrap();
    // It is asked how it is before it starts anew.
    assert_eq!((farewell.ticks.len(), farewell.state.ticks, farewell.state.attached), (10, 10, Some(Pace::Sample)));
    is_let_go(&here);
}

#[test]
fn a_loop_that_is_dropped_lets_go_of_the_device() {
    let here = Here::new();
    let mut driver = attached(&here).unwrap();
    driver.tick(&Sample::default(), Circumstances::default());
    drop(driver);
    is_let_go(&here);
}

/// An order whose answer is lost has been obeyed all the same.
#[test]
fn an_attempt_to_attach_lets_go_of_the_device() {
    let here = Here::new();
    here.borrow_mut().deaf_to = |request| matches!(request, Request::Attach { .. });
    assert!(matches!(attached(&here), Err(DeviceError::Silent(_))));
    is_let_go(&here);
}

#[test]
fn a_device_that_was_left_attached_in_motion_can_be_attached_anew() {
    let here = Here::new();
    let mut driver = attached(&here).unwrap();
    driver.tick(&Sample::default(), Circumstances::default());
    std::mem::forget(driver);
    assert_eq!(here.borrow().device.attached(), Some(Pace::Sample));
    drop(attached(&here).unwrap());
    is_let_go(&here);
}

#[test]
fn a_device_that_reports_no_tick_ends_the_loop() {
    let here = Here::new();
    here.borrow_mut().pace = Pace::Timer;
    let mut driver = attached(&here).unwrap();
    here.borrow_mut().silent = true;
    for tick in 0..200 {
        driver.tick(&Sample::default(), Circumstances::default());
        if tick == 50 {
            // One report is as good as a new beginning.
            here.borrow_mut().silent = false;
            driver.tick(&Sample::default(), Circumstances::default());
            here.borrow_mut().silent = true;
        }
    }
    let reported: Vec<usize> =
        (0..).zip(driver.ticks()).filter(|(_, tick)| tick.report.is_some()).map(|(number, _)| number).collect();
    assert_eq!(reported, [51]);
    assert!(matches!(driver.finish(), Err(DeviceError::Unreported(100))));
    is_let_go(&here);
}

#[test]
fn as_many_settings_in_another_order_are_not_touched() {
    let here = Here::new();
    here.borrow_mut().layout = !LAYOUT;
    let mut session = Session::new(Wire(here.clone()));
    let refused = |result| matches!(result, Err(DeviceError::Layout { device, own: LAYOUT }) if device == !LAYOUT);
    assert!(refused(parameters::read(&mut session).map(|_| ())));
    assert!(refused(parameters::write(&mut session, &brought(), true)));
    assert_eq!(*here.borrow().device.settings(), Settings::default());
    assert_eq!(Store::open(here.borrow().store.clone().release()).1, None);
    here.borrow_mut().layout = LAYOUT;
    parameters::write(&mut session, &brought(), true).unwrap();
    assert_eq!(Store::open(here.borrow().store.clone().release()).1, Some(brought()));
}
