//! A device with the firmware on it: in the emulator or on a serial port, as a controller for closed loops or to talk to.
//!
//! - [`mod@line`]: bytes to and from it; [`emulator`], [`serial`]: the two kinds; [`faulty`]: one that loses and damages frames;
//! - [`image`]: what runs in it; [`info`]: who it is and how it is; [`log`]: what it logs;
//! - [`session`]: requests and replies; [`parameters`]: its settings, [`setting_text`]: as text, [`derived`]: those that follow
//!   from others; [`event_table`]: its event log; [`recordings`]: its flight recorder;
//! - [`strip_chart`]: its last seconds, drawn in the terminal;
//! - [`driver`]: it in the place of the host's controller, compared with it at every tick; [`device_loop`]: a loop that it closes;
//!   [`report`]: what that comes to.

pub mod derived;
pub mod device_loop;
pub mod driver;
pub mod emulator;
pub mod event_table;
pub mod faulty;
pub mod image;
pub mod info;
pub mod line;
#[cfg_attr(not(feature = "defmt"), path = "no_log.rs")]
pub mod log;
pub mod parameters;
pub mod recordings;
pub mod report;
#[cfg_attr(not(feature = "serial"), path = "no_serial.rs")]
pub mod serial;
pub mod session;
pub mod setting_text;
pub mod step_cost;
pub mod strip_chart;
