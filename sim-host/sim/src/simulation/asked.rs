//! What a scene asks for beyond history, peaks and forces: the energy ledger, and what coils take.

use sprag_shared::math::scalar::Real;
use sprag_shared::motion::device_snapshot::DeviceOutput;
use sprag_shared::motion::observer::{Event, MonotoneInterval, Observer};
use sprag_shared::motion::rest::impact_accumulation::Accumulation;
use sprag_shared::motion::state::BlockState;
use sprag_shared::observers::coil_use::CoilUses;
use sprag_shared::observers::ledger::{Entries, Ledger};
use sprag_shared::structure::Structure;

use super::coils::Coils;
use super::drive::Segmented;
use super::energy::EnergyReport;
use super::run::{Failure, Task};
use crate::ground_motion::Segment;

/// Each where the scene asks for it.
#[derive(Debug)]
pub struct Asked<S> {
    energy: Option<EnergyHistory<S>>,
    coils: Option<Coils<S>>,
}

impl<S: Real> Asked<S> {
    /// Of `task`, whose block with what it carries is `loaded`.
    pub(super) fn of(task: &Task<'_>, loaded: &Structure) -> Result<Asked<S>, Failure> {
        let energy = || {
            EnergyHistory::new(Ledger::new(&loaded.block, task.scene.geometry(), &task.device().account(loaded)), task.interval)
        };
        let coils = task.scene.file.checks.as_ref().and_then(|checks| checks.coil_use(task.device(), loaded, task.carried()));
        let coils = coils.map(|used| Coils::new(used, loaded.block.slenderness()));
        Ok(Asked { energy: task.scene.file.output.energy.then(energy), coils })
    }

    /// What a controller has commanded, in the place of what the clutches did.
    pub(crate) fn commanded(&mut self, commanded: CoilUses) {
        if let Some(coils) = &mut self.coils {
            coils.commanded = Some(commanded);
        }
    }

    /// What the coils did; none where nobody looked, and without a clutch that has one.
    pub(super) fn coils(&self) -> Option<CoilUses> {
        self.coils.as_ref().map(Coils::uses)
    }

    /// What the ledger found.
    pub(super) fn energy(self) -> Option<EnergyReport> {
        self.energy.map(|mut energy| {
            energy.catch_up();
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
        self.energy.device_interval(output, interval);
        self.coils.device_interval(output, interval);
    }

    fn device_at_rest(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        self.energy.device_at_rest(output, interval);
        self.coils.device_at_rest(output, interval);
    }

    fn event(&mut self, event: Event, time: S, state: &BlockState<S>) {
        self.energy.event(event, time, state);
        self.coils.event(event, time, state);
    }

    fn accumulation(&mut self, tail: &Accumulation<S>) {
        self.coils.accumulation(tail);
    }
}

impl<S: Real> Segmented for Asked<S> {
    fn segment(&mut self, start: f64, segment: Option<&Segment>) {
        if let Some(energy) = &mut self.energy {
            if segment.is_none() {
                energy.catch_up();
            }
            energy.origin = start;
        }
    }
}

/// A ledger, written down at a regular interval, and on both sides of every event at which something may jump.
#[derive(Debug)]
struct EnergyHistory<S> {
    ledger: Ledger<S>,
    /// Time (s) and entries, 1/s².
    samples: Vec<(f64, Entries<f64>)>,
    origin: f64,
    interval: f64,
    /// Of the next multiple of `interval`.
    next: u64,
    /// How far the ledger goes, s.
    reached: f64,
}

impl<S: Real> EnergyHistory<S> {
    /// Writes `ledger` down every `interval` (s) in which the block moves, at the times of the history.
    fn new(ledger: Ledger<S>, interval: f64) -> EnergyHistory<S> {
        EnergyHistory { ledger, samples: Vec::new(), origin: 0.0, interval, next: 0, reached: 0.0 }
    }

    fn grid(&self) -> f64 {
        self.next as f64 * self.interval
    }

    /// Writes down the entries at `time` (s).
    fn write(&mut self, time: f64) {
        let entries = self.ledger.entries;
        // Where two pieces of ground motion meet, their own times may differ in the last bit.
        let time = self.samples.last().map_or(time, |last| time.max(last.0));
        self.samples.push((time, entries.each(Real::to_f64)));
        while self.grid() <= time {
            self.next += 1;
        }
    }

    /// Writes down where the ground motion or the run ends while the block moves.
    fn catch_up(&mut self) {
        if self.samples.last().is_some_and(|last| last.0 < self.reached) {
            self.write(self.reached);
        }
    }
}

impl<S: Real> Observer<S> for EnergyHistory<S> {
    #[inline(never)]
    fn device_interval(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        let start = self.origin + interval.start.to_f64();
        // Summed as the core sums them, so that an interval ends on the very instant at which the next one starts.
        let at = |origin: f64, time: S| origin + (interval.start + time).to_f64();
        let (from, to) = (at(self.origin, interval.from), at(self.origin, interval.to));
        if self.samples.is_empty() {
            // A released block, which no uplift has announced.
            self.ledger.device_interval(output, &MonotoneInterval { to: interval.from, last: interval.first, ..*interval });
            self.write(from);
        }
        let mut rest = *interval;
        while self.grid() < to {
            let time = self.grid();
            let until = S::of(time - start).larger(rest.from).smaller(rest.to);
            let last = output.motion().at(until);
            self.ledger.device_interval(output, &MonotoneInterval { to: until, last, ..rest });
            (rest.from, rest.first) = (until, last);
            self.write(time);
        }
        self.ledger.device_interval(output, &rest);
        self.reached = to;
    }

    fn device_at_rest(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        self.device_interval(output, interval);
    }

    fn event(&mut self, event: Event, time: S, state: &BlockState<S>) {
        let at = self.origin + time.to_f64();
        // Both sides of a jump.
        if (event == Event::Impact || event == Event::Switch) && !self.samples.is_empty() {
            self.write(at);
        }
        self.ledger.event(event, time, state);
        // Of a clutch that answers the release of a block the ledger has not seen the block yet.
        if event == Event::Uplift || !self.samples.is_empty() {
            self.write(at);
        }
    }
}

#[cfg(test)]
mod tests {
    use sprag_shared::observers::ledger::Account;
    use sprag_shared::structure::block::{Block, Geometry};

    use super::super::{DeviceRun, runs_of};
    use super::*;
    use crate::history::Sample;

    const INTERVAL: f64 = 0.002;

    /// A slender block of p = 2 1/s without a device, under `keys`.
    fn slender(keys: &str) -> DeviceRun {
        let text = format!(
            "block = {{ geometry = 'slender', frequency_parameter_1_s = 2.0, slenderness_deg = 10.0{keys}
             device = [{{ kind = 'none' }}]
             output = {{ energy = true, interval_s = {INTERVAL} }}"
        );
        runs_of(&text).remove(0)
    }

    /// `part` of a history at `time` (s), on the straight line between its samples.
    fn between(samples: &[Sample], time: f64, part: impl Fn(&Sample) -> f64) -> f64 {
        let after = samples.partition_point(|sample| sample.time_s < time).clamp(1, samples.len() - 1);
        let [a, b] = [&samples[after - 1], &samples[after]];
        let share = if b.time_s > a.time_s { (time - a.time_s) / (b.time_s - a.time_s) } else { 1.0 };
        part(a) + share * (part(b) - part(a))
    }

    /// Under a pulse a step of the series lasts as long as a swing.
    #[test]
    fn a_ledger_is_as_fine_as_the_history() {
        let shaken =
            slender(" }\nground = [{ motion = 'sine', amplitude_ratio = 1.5, frequency_ratio = 4.0 }]\nrun.free_time_s = 10.0");
        // Ends while the block still swings.
        let released = slender(", initial_rotation_ratio = 0.8 }\nground = []\nrun.free_time_s = 5.0013");
        for run in [&shaken, &released] {
            let (samples, energy) = (&run.history.samples, run.energy.as_ref().unwrap());
            assert!(run.impacts > 1, "{}", run.impacts);
            for (time, shares) in &energy.history {
                let ratio = between(samples, *time, |sample| sample.rotation_rad.abs()) / run.history.slenderness_rad;
                // A chord is h² θ''/8 from its arc at most.
                let potential = 1.0 - (1.0 - ratio) * (1.0 - ratio);
                assert!((shares.potential - potential).abs() < 2e-5, "{time}: {} and {potential}", shares.potential);
                assert!(shares.residual.abs() < 1e-12, "{time}: {:e}", shares.residual);
            }
            let moves = |pair: &&[Sample]| pair.iter().any(|sample| sample.velocity_rad_s != 0.0);
            let moving: f64 = samples.windows(2).filter(moves).map(|pair| pair[1].time_s - pair[0].time_s).sum();
            assert!(energy.history.len() as f64 >= moving / INTERVAL, "{} rows in {moving} s", energy.history.len());
            for pair in energy.history.windows(2).filter(|pair| pair.iter().any(|(_, shares)| shares.potential > 0.0)) {
                assert!(pair[1].0 - pair[0].0 < INTERVAL * (1.0 + 1e-9), "{} {}", pair[0].0, pair[1].0);
            }
            assert_eq!(energy.history.last().unwrap().1, energy.entries);
        }
        let (first, last) = (released.energy.as_ref().unwrap().history[0], released.history.samples.last().unwrap());
        assert!(first.0 == 0.0 && (first.1.initial - 0.96).abs() < 1e-14 && first.1.initial == first.1.potential);
        let end = released.energy.as_ref().unwrap().history.last().unwrap().0;
        assert!((end - last.time_s).abs() < 1e-12 && last.velocity_rad_s != 0.0);
    }

    #[test]
    fn a_ledger_leaves_no_time_of_the_history_out_where_steps_end_on_them() {
        let scene = "block = { frequency_parameter_1_s = 2.0, slenderness_deg = 10.0 }
             device = [{ kind = 'none' }]
             ground = [{ motion = 'sine', amplitude_ratio = 1.5, frequency_ratio = 4.0 }]
             accuracy = { method = 'runge-kutta-4', step_s = 0.01 }
             output = { energy = true, interval_s = 0.01 }";
        let run = runs_of(scene).remove(0);
        let history = &run.energy.as_ref().unwrap().history;
        let moves = |sample: &&Sample| sample.rotation_rad != 0.0 && sample.velocity_rad_s != 0.0;
        for Sample { time_s, .. } in run.history.samples.iter().filter(moves) {
            assert!(history.iter().any(|(time, _)| (time - time_s).abs() < 1e-9), "{time_s}");
        }
    }

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
