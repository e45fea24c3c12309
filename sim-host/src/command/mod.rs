//! The subcommands of `sprag`. Each has its arguments and a `run` that returns the exit code: 0 well, 2 bad input or
//! output, 130 interrupted.

pub mod batch;
#[cfg(feature = "effects")]
pub mod closed_loop;
#[cfg(feature = "effects")]
pub mod device;
#[cfg(feature = "effects")]
mod device_line;
pub mod effects;
pub mod explain;
#[cfg(feature = "effects")]
pub mod hil;
#[cfg(feature = "effects")]
pub mod loop_scene;
#[cfg(feature = "effects")]
pub mod loop_study;
pub mod record;
pub mod sensitivity;
pub mod simulate;
pub mod synthesize;

/// Exit code for bad input, and for output that cannot be written.
pub const BAD_INPUT: i32 = 2;
