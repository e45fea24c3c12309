//! In a program without effects there are ideal devices only.

use super::device_run::DeviceRun;
use super::run::{Failure, Task};

/// Refuses `task`.
pub(super) fn run(_task: &Task<'_>) -> Result<DeviceRun, Failure> {
    Err(Failure::NoEffects)
}
