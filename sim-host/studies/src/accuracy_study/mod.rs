//! What accuracy costs in time: a scene followed by every method, step, precision and source of sines, against a reference that is as
//! tight as f64 allows.
//!
//! - [`variant`]: the ways to follow a motion; [`subject`]: the motions; [`probe`]: one motion followed in one way.
//! - [`study`]: errors, wrong outcomes and times of all of them; [`board`]: what a step costs on the microcontroller.
//! - [`row`], [`report`], [`figure`]: what comes out.

pub mod board;
pub mod figure;
mod looks;
pub mod probe;
pub mod report;
pub mod row;
pub mod study;
pub mod subject;
pub mod variant;
