//! Sensors of the controller: readings, calibration, and the conversion to the units of the equations.
//!
//! The room imports `math` and `structure`.

pub mod calibration;
pub mod instruments;
pub mod required;
pub mod sample;
pub mod sensor;
