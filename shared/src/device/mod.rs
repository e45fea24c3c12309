//! The device around the controller: what it is told over the link, what it keeps over a reset, what it shows.

pub mod coil;
pub mod counter;
mod device;
pub mod inertial;
pub mod kept;
pub mod light;
mod mailbox;
pub mod reset;

pub use device::{Answer, Device, Surroundings};
pub use mailbox::Mailbox;
