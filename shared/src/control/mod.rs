//! The controller: from sensor readings to the two clutches. One piece of code that the host simulates and the firmware flashes.
//!
//! In the order in which a tick goes through it ([`controller`]):
//! - [`sensing`]: readings, less their biases, in the units of the equations;
//! - [`estimation`]: the motion now, and when the clutch will have moved, by the [`model`] of the structure;
//! - [`law`]: when a flywheel shall resist, which one, and how soon again;
//! - [`monitor`], [`supervisor`]: whether sensors and clutches can be believed, and who decides; [`ticks`]: its clock.
//!
//! The room imports `math`, `equation` and `structure`; nothing of the motion wing.

pub mod clutch_position;
pub mod controller;
pub mod estimation;
pub mod law;
pub mod model;
pub mod monitor;
pub mod sensing;
pub mod supervisor;
#[cfg(test)]
mod tests;
pub mod ticks;
