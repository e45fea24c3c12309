//! A closed loop with a device in the place of the host's controller.

use std::time::{Duration, Instant};

use sprag_sim::closed_loop::report::LoopReport;
use sprag_sim::closed_loop::{LoopFailure, LoopTask};
use sprag_sim::simulation::DeviceRun;

use super::driver::{DeviceDriver, Farewell};
use super::line::{DeviceError, Line};
use super::session::Session;

/// A loop that a device has closed.
#[derive(Clone, Debug)]
pub struct DeviceLoop {
    /// The loop.
    pub report: LoopReport,
    /// What the device said of it.
    pub farewell: Farewell,
    /// How long it took.
    pub took: Duration,
}

/// Reasons why a device has closed no loop.
#[derive(Debug, thiserror::Error)]
pub enum DeviceLoopError {
    /// The device.
    #[error("{0}")]
    Device(#[from] DeviceError),
    /// The loop.
    #[error("{0}")]
    Loop(#[from] LoopFailure),
}

impl DeviceLoop {
    /// Closes the loop of `task` over the device on `line`, which gets its settings from the task and is detached in the end; `ideal` is the run
    /// of the ideal pair without a controller.
    ///
    /// # Errors
    /// [`DeviceLoopError`]; a device that has gone explains whatever became of the loop.
    pub fn run<L: Line>(task: &LoopTask<'_>, line: L, ideal: DeviceRun) -> Result<DeviceLoop, DeviceLoopError> {
        let settings = task.settings().map_err(LoopFailure::from)?;
        let own = task.driver().map_err(LoopFailure::from)?;
        let mut driver = DeviceDriver::attach(Session::new(line), &settings, own)?;
        let begun = Instant::now();
        let looped = task.looped(&mut driver, &mut ());
        let took = begun.elapsed();
        let farewell = driver.finish()?;
        Ok(DeviceLoop { report: LoopReport::new(task, looped?, ideal), farewell, took })
    }
}
