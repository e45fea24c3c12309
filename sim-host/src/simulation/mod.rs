//! One scene, every device: histories and what they amount to.

pub mod demand;
pub mod device_run;
pub mod drive;
pub mod energy;
mod ideal;
mod machine;
pub mod recorder;
pub mod run;
pub mod step_end;
pub mod watchers;

pub use device_run::DeviceRun;
pub use run::{RunError, simulate};

/// Terms of the series in f32: more would only add rounding.
const TERMS_F32: usize = 12;
