//! What a scene asks for beyond history, peaks and forces: the energy ledger, and what coils take.

use sprag_shared::math::scalar::Real;
use sprag_shared::motion::device_snapshot::DeviceOutput;
use sprag_shared::motion::observer::{Event, MonotoneInterval, Observer};
use sprag_shared::motion::state::BlockState;
use sprag_shared::observers::ledger::{Entries, Ledger};
use sprag_shared::structure::Structure;

use super::coil_use::CoilUse;
use super::drive::Segmented;
use super::energy::EnergyReport;
use super::run::{Failure, Task};
use crate::ground_motion::Segment;

/// Each where the scene asks for it.
#[derive(Debug)]
pub struct Asked<S> {
    energy: Option<EnergyHistory<S>>,
    coils: Option<CoilUse>,
}

impl<S: Real> Asked<S> {
    /// Of `task`, whose block with what it carries is `loaded`.
    pub(super) fn of(task: &Task<'_>, loaded: &Structure) -> Result<Asked<S>, Failure> {
        let energy = || {
            EnergyHistory::new(Ledger::new(&loaded.block, task.scene.geometry(), &task.device().account(loaded)), task.interval)
        };
        let coils = task.scene.file.checks.as_ref().is_some_and(|checks| checks.coil.is_some()) && task.device().takes_commands();
        Ok(Asked { energy: task.scene.file.output.energy.then(energy), coils: coils.then(|| CoilUse::of(task.carried())) })
    }

    /// What a controller has commanded, in the place of what the clutches did.
    pub(crate) fn commanded(&mut self, commanded: CoilUse) {
        self.coils = self.coils.map(|_| commanded);
    }

    /// What the coils took; none where nobody looked, and without a clutch that has one.
    pub(super) fn coils(&self) -> Option<CoilUse> {
        self.coils
    }

    /// What the ledger found.
    pub(super) fn energy(self) -> Option<EnergyReport> {
        self.energy.map(|energy| {
            let barrier = energy.ledger.barrier.to_f64();
            let last = energy.ledger.entries.each(Real::to_f64);
            let shares = |entries: Entries<f64>| entries.scaled(1.0 / barrier);
            EnergyReport {
                entries: shares(last).into(),
                history: energy.samples.iter().map(|(time, entries)| (*time, shares(*entries).into())).collect(),
            }
        })
    }
}

impl<S: Real> Observer<S> for Asked<S> {
    // What nobody asks for costs a look at two options, and no call.
    #[inline(always)]
    fn device_interval(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        if let Some(energy) = &mut self.energy {
            energy.device_interval(output, interval);
        }
        if let Some(coils) = &mut self.coils {
            coils.device_interval(output, interval);
        }
    }

    fn device_at_rest(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        if let Some(energy) = &mut self.energy {
            energy.device_at_rest(output, interval);
        }
        if let Some(coils) = &mut self.coils {
            coils.device_at_rest(output, interval);
        }
    }

    fn event(&mut self, event: Event, time: S, state: &BlockState<S>) {
        if let Some(energy) = &mut self.energy {
            energy.event(event, time, state);
        }
        if let Some(coils) = &mut self.coils {
            coils.event(event, time, state);
        }
    }
}

impl<S: Real> Segmented for Asked<S> {
    fn segment(&mut self, start: f64, _segment: Option<&Segment>) {
        if let Some(energy) = &mut self.energy {
            energy.origin = start;
        }
    }
}

/// A ledger, written down at a regular interval.
#[derive(Debug)]
struct EnergyHistory<S> {
    ledger: Ledger<S>,
    /// Time (s) and entries, 1/s².
    samples: Vec<(f64, Entries<f64>)>,
    origin: f64,
    interval: f64,
}

impl<S: Real> EnergyHistory<S> {
    /// Writes `ledger` down at least every `interval` (s) in which the block moves.
    fn new(ledger: Ledger<S>, interval: f64) -> EnergyHistory<S> {
        EnergyHistory { ledger, samples: Vec::new(), origin: 0.0, interval }
    }

    /// Writes down the entries at `time` (s).
    fn write(&mut self, time: f64) {
        let entries = self.ledger.entries;
        // Where two pieces of ground motion meet, their own times may differ in the last bit.
        let time = self.samples.last().map_or(time, |last| time.max(last.0));
        self.samples.push((time, entries.each(Real::to_f64)));
    }
}

impl<S: Real> Observer<S> for EnergyHistory<S> {
    #[inline(never)]
    fn device_interval(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        self.ledger.device_interval(output, interval);
        let time = self.origin + (interval.start + interval.to).to_f64();
        if self.samples.last().is_none_or(|last| time >= last.0 + self.interval) {
            self.write(time);
        }
    }

    fn device_at_rest(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        self.device_interval(output, interval);
    }

    fn event(&mut self, event: Event, time: S, state: &BlockState<S>) {
        let at = self.origin + time.to_f64();
        // Both sides of a jump.
        if event == Event::Impact || event == Event::Switch {
            self.write(at);
        }
        self.ledger.event(event, time, state);
        if event != Event::Turn {
            self.write(at);
        }
    }
}

#[cfg(test)]
mod tests {
    use sprag_shared::observers::ledger::Account;
    use sprag_shared::structure::block::{Block, Geometry};

    use super::*;

    #[test]
    fn times_of_a_ledger_do_not_go_back() {
        let account = Account::default();
        let block = Block::new(2.0, 0.2, 4.0 / 3.0).unwrap();
        let mut history = EnergyHistory::<f64>::new(Ledger::new(&block, Geometry::Slender, &account), 0.01);
        // The end of one piece of ground motion, and the start of the next.
        history.write(1.0 + f64::EPSILON);
        history.write(1.0);
        assert!(history.samples.is_sorted_by_key(|sample| sample.0));
    }
}
