//! A closed loop as the run of its device: outcome and peaks, and what the scene's `[checks]` ask of forces, travel, teeth and coils.

use sprag_shared::observers::coil_use::{CoilUse, CoilUses};

use super::disturbance::Disturbance;
use super::driver::Driver;
use super::plant::Extremes;
use super::run::{Ending, Looks, Tick, TickObserver, follow_fall};
use super::{LoopFailure, LoopTask};
use crate::scene::checks::ChecksTable;
use crate::simulation::DeviceRun;
use crate::simulation::demand::Demand;
use crate::simulation::device_run::Found;
use crate::simulation::run::Task;

/// The coils of both clutches, as the controller drives them.
struct Commanded {
    used: CoilUse,
    /// Up to where |θ| last passed α; none below it.
    fall: Option<CoilUse>,
    overturned: bool,
    /// Of a tick, s.
    period: f64,
}

impl Commanded {
    fn uses(&self) -> CoilUses {
        CoilUses { whole: self.used, before_fall: self.fall.filter(|_| self.overturned).unwrap_or(self.used) }
    }
}

impl TickObserver for Commanded {
    fn tick(&mut self, tick: &Tick) {
        follow_fall(&mut self.fall, tick.beyond, || self.used);
        self.used.hold(tick.decision.command, self.period);
    }

    fn overturned(&mut self) {
        self.overturned = true;
    }
}

/// The coils, and whoever looks at the ticks.
struct Both<'a>(Commanded, &'a mut dyn TickObserver);

impl TickObserver for Both<'_> {
    fn tick(&mut self, tick: &Tick) {
        self.0.tick(tick);
        self.1.tick(tick);
    }

    fn looks(&self) -> Looks {
        self.1.looks()
    }

    fn overturned(&mut self) {
        self.0.overturned();
        self.1.overturned();
    }
}

impl LoopTask<'_> {
    fn coils(&self) -> Commanded {
        Commanded { used: CoilUse::default(), fall: None, overturned: false, period: self.clock().period }
    }

    /// As [`LoopTask::run_with`], and says what its device asks for, which `table` wants to know.
    pub(super) fn checked(
        &self,
        table: &ChecksTable,
        driver: &mut dyn Driver,
        disturbance: &mut dyn Disturbance,
        ticks: &mut dyn TickObserver,
    ) -> Result<(Ending, Extremes, Demand), LoopFailure> {
        let task = self.task();
        let mut watched = (Extremes::default(), task.checks(&task.loaded()?)?);
        let mut seen = Both(self.coils(), ticks);
        let ending = self.run_with(driver, disturbance, &mut watched, &mut seen)?;
        let demand = Demand::of(&task, table, &watched.1, table.coil.map(|_| seen.0.uses()));
        Ok((ending, watched.0, demand))
    }

    /// Runs the loop by the law of its table. The coils take what the controller commands, also while the block stands with its clutches
    /// engaged.
    pub fn measured(&self) -> Result<DeviceRun, LoopFailure> {
        self.measured_at(f64::INFINITY)
    }

    /// As [`LoopTask::measured`], with a history sampled every `interval` (s) and at events.
    pub fn measured_at(&self, interval: f64) -> Result<DeviceRun, LoopFailure> {
        let task = Task { interval, ..self.task() };
        let mut watchers = task.watchers(&task.loaded()?)?;
        let mut coils = self.coils();
        let mut driver = self.driver()?;
        let ending = self.run_with(&mut *driver, &mut (), &mut watchers, &mut coils)?;
        watchers.asked.commanded(coils.uses());
        let peaks = watchers.peaks;
        let mut found = Found::watched(&task, watchers);
        found.missed_engagements = ending.missed;
        Ok(DeviceRun::of(&task, &ending.motion, &peaks, found))
    }
}
