//! One scene, every device: histories and what they amount to.

pub mod drive;
pub mod recorder;
pub mod run;
pub mod step_end;

pub use run::{DeviceRun, RunError, simulate};
