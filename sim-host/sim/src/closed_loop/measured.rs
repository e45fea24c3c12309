//! A closed loop as the run of its device: outcome and peaks, and what the scene's `[checks]` ask of forces, travel, teeth and coils.

use super::run::{Tick, TickObserver};
use super::{LoopFailure, LoopTask};
use crate::simulation::DeviceRun;
use crate::simulation::coil_use::CoilUse;
use crate::simulation::device_run::Found;
use crate::simulation::run::Task;

/// The coils of both clutches, as the controller drives them.
struct Commanded {
    used: CoilUse,
    /// Of a tick, s.
    period: f64,
}

impl TickObserver for Commanded {
    fn tick(&mut self, tick: &Tick) {
        self.used.hold(tick.decision.command, self.period);
    }
}

impl LoopTask<'_> {
    /// Runs the loop by the law of its table. The coils take what the controller commands, also while the block stands with its clutches
    /// engaged.
    pub fn measured(&self) -> Result<DeviceRun, LoopFailure> {
        self.measured_at(f64::INFINITY)
    }

    /// As [`LoopTask::measured`], with a history sampled every `interval` (s) and at events.
    pub fn measured_at(&self, interval: f64) -> Result<DeviceRun, LoopFailure> {
        let task = Task { interval, ..self.task() };
        let mut watchers = task.watchers(&task.loaded()?)?;
        let mut coils = Commanded { used: CoilUse::default(), period: self.clock().period };
        let mut driver = self.driver()?;
        let ending = self.run_with(&mut *driver, &mut (), &mut watchers, &mut coils)?;
        watchers.asked.commanded(coils.used);
        let peaks = watchers.peaks;
        let mut found = Found::watched(&task, watchers);
        found.missed_engagements = ending.missed;
        Ok(DeviceRun::of(&task, &ending.motion, &peaks, found))
    }
}
