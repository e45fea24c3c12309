//! The controller: from sensor readings to the two clutches. One piece of code that the host simulates and the firmware flashes.
//!
//! In the order in which a tick goes through it ([`controller`]):
//! - [`sample`]: what the sensors say; [`instruments`]: in the units of the equations; [`calibration`]: less their biases;
//! - [`model`]: the structure as it is believed to be;
//! - [`estimator`]: [`model_aided`], [`kalman`] or [`complementary`], with [`standing`] for a block on both toes, to an [`estimate`];
//! - [`prediction`]: the motion when the clutch will have moved; [`signs`]: with hysteresis;
//! - [`law`]: what is wanted, by a table of signs or by [`look_ahead`]; [`turns`]: of which flywheel; [`gate`]: how soon again;
//! - [`supervisor`]: who decides, watched by [`monitor`] and [`actuator_monitor`], with a [`fault`] code and an [`event_log`]; [`ticks`]:
//!   its clock.

pub mod actuator_monitor;
pub mod calibration;
pub mod complementary;
pub mod controller;
pub mod estimate;
pub mod estimator;
pub mod event_log;
pub mod fault;
pub mod gate;
pub mod instruments;
pub mod kalman;
pub mod law;
pub mod look_ahead;
pub mod model;
pub mod model_aided;
pub mod monitor;
pub mod prediction;
pub mod sample;
pub mod signs;
pub mod standing;
pub mod supervisor;
#[cfg(test)]
mod tests;
pub mod ticks;
pub mod turns;
