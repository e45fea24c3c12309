//! A device with the firmware on it: in the emulator or on a serial port, as a controller for closed loops or to talk to.
//!
//! - [`line`]: bytes to and from it; [`emulator`], [`serial`]: the two kinds; [`faulty`]: one that loses and damages frames;
//! - [`image`]: building what runs in it; [`log`]: what it logs;
//! - [`session`]: requests and replies; [`parameters`]: its settings;
//! - [`driver`]: it in the place of the host's controller, compared with it at every tick; [`report`]: what that comes to.

pub mod driver;
pub mod emulator;
pub mod faulty;
pub mod image;
pub mod line;
pub mod log;
pub mod parameters;
pub mod report;
pub mod serial;
pub mod session;
