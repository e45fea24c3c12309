//! The block of one lane as the core sees it: its state, and the steps that the core takes or answers.

use sprag_loops::HybridLoop;
use sprag_shared::drivetrain::clutch_state::{Guard, ModeCoefficients};
use sprag_shared::ground::{GroundSegment, Linear};
use sprag_shared::motion::hybrid::Progress;
use sprag_shared::motion::hybrid::mode_output::Shaking;
use sprag_shared::motion::state::{Limits, Phase, Stopped};
use sprag_shared::observers::peaks::Peaks;

use super::located::{Expanded, LaneSeries};
use super::{HybridBlock, HybridMotion, MOST_EVENTS, Steps};

/// Share of the uplift threshold below which the core need not look at a block that stands.
const QUIET: f64 = 0.999_999;

/// A block, where it is in its record, and its state there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seat<'a> {
    pub(super) block: HybridBlock<'a>,
    /// The last sample.
    pub(super) sample: usize,
    /// How far the core is beyond it.
    pub(super) progress: Progress<f64>,
    pub(super) motion: HybridMotion,
}

impl<'a> Seat<'a> {
    pub(super) fn new(block: HybridBlock<'a>) -> Seat<'a> {
        let motion = HybridMotion {
            state: block.system.at_rest(),
            peaks: Peaks::default(),
            checks: block.checks.copied(),
            steps: Steps::default(),
        };
        Seat { block, sample: 0, progress: Progress::default(), motion }
    }

    fn last(&self) -> usize {
        self.block.samples.values.len() - 1
    }

    /// Whether the record is over or the block has overturned.
    #[inline(always)]
    pub(super) fn is_over(&self) -> bool {
        self.sample >= self.last() || self.motion.state.motion.phase == Phase::Overturned
    }

    /// Ground acceleration (in g) at `sample`.
    #[inline(always)]
    pub(super) fn ground(&self, sample: usize) -> [f64; 2] {
        let HybridBlock { samples, factor, vertical, .. } = self.block;
        [factor * samples.values[sample], vertical.map_or(0.0, |(up, factor)| factor * up.values[sample])]
    }

    /// Ground acceleration up to the next sample, horizontal and vertical.
    #[inline(always)]
    pub(super) fn lines(&self) -> [Linear<f64>; 2] {
        let (from, to) = (self.ground(self.sample), self.ground(self.sample + 1));
        [0, 1].map(|way| Linear::between(from[way], to[way], self.block.samples.step))
    }

    /// |θ| (rad) at which an outward motion counts as overturned from here on.
    #[inline(always)]
    pub(super) fn overturned(&self) -> f64 {
        self.block.overturned(self.block.factor.abs() * self.block.samples.bounds[self.sample])
    }

    /// The lane is at a new sample.
    #[inline(always)]
    pub(super) fn go_on(&mut self) {
        self.sample += 1;
        self.progress = Progress::default();
    }

    /// One step of the core's loop: by its own series, or by that which a lane has expanded. Without `pressed` no force is larger than ever.
    fn step(&mut self, method: &dyn HybridLoop<f64>, pressed: bool) -> Result<(), Stopped> {
        let [level, up] = self.lines();
        let vertical = self.block.vertical.map(|_| &up as &dyn GroundSegment<f64>);
        let shaking = Shaking { horizontal: &level, vertical, support: None };
        let limits = Limits { overturned: self.overturned(), events: MOST_EVENTS };
        let step = self.block.samples.step;
        let (state, mut watch) = self.motion.watched(step * self.sample as f64);
        watch.checks = watch.checks.filter(|_| pressed);
        if self.progress.time == 0.0 {
            self.block.system.ground_at_start(state, shaking.at(0.0), &mut watch);
        }
        method.step(self.block.system, state, (shaking, step), &mut self.progress, &limits, &mut watch)?;
        if self.progress.time >= step {
            self.go_on();
        }
        Ok(())
    }

    /// The core's step on which something may happen in the `series` of a lane; `pressed` where that may be a force larger than ever.
    pub(super) fn locate(&mut self, series: &LaneSeries, pressed: bool) -> Result<(), Stopped> {
        self.motion.steps.located += 1;
        self.step(&Expanded { series, device: self.motion.state.device }, pressed)
    }

    /// The core's step by its own series.
    pub(super) fn step_by_core(&mut self, method: &dyn HybridLoop<f64>) -> Result<(), Stopped> {
        let rested = self.motion.state.motion.phase == Phase::Rest;
        self.step(method, true)?;
        let rests_on = rested && self.motion.state.motion.phase == Phase::Rest;
        self.motion.steps.by_core += u32::from(!rests_on);
        Ok(())
    }

    /// Skips intervals on which the ground cannot lift a block that stands.
    fn stand(&mut self) {
        let HybridBlock { system, samples, factor, vertical, .. } = self.block;
        // The threshold grows linearly with the weight; on straight lines the largest excess is at a sample.
        let [weightless, whole] = [0.0, 1.0].map(|weight| QUIET * system.least_uplift(&self.motion.state, weight));
        let lifts = |sample: usize| {
            let [level, up] = self.ground(sample);
            level.abs() > weightless + (whole - weightless) * (1.0 + up)
        };
        if lifts(self.sample) {
            return;
        }
        let beyond = match vertical {
            None => samples.beyond(self.sample, whole / factor.abs()),
            Some(_) => (self.sample + 1..samples.values.len()).find(|sample| lifts(*sample)),
        };
        let until = beyond.map_or(self.last(), |beyond| beyond - 1);
        if until > self.sample {
            let time = samples.step * (until - self.sample) as f64 - self.progress.time;
            let ground = self.ground(until);
            system.has_stood(&mut self.motion.state, time, ground);
            (self.sample, self.progress) = (until, Progress::default());
        }
    }

    /// Whether lanes have the guards of the mode `law`.
    fn knows(&self, law: &ModeCoefficients<f64>) -> bool {
        let turns = |wheel: usize| self.motion.state.device.wheels[wheel].turning.is_some();
        let plates = |(wheel, guard): (usize, &Guard<f64>)| match *guard {
            Guard::Nothing => true,
            Guard::Capacity(_, growth) => growth == 0.0,
            Guard::Slip(_, _) => law.slip_growth[wheel & 1] == 0.0 && turns(wheel & 1),
            _ => false,
        };
        matches!(law.watch[0], Guard::Nothing | Guard::Command(_)) && law.watch[1..].iter().enumerate().all(plates)
    }

    /// By the core up to where lanes know the mode, or none where the motion is over.
    pub(super) fn next_mode(&mut self, method: &dyn HybridLoop<f64>) -> Result<Option<ModeCoefficients<f64>>, Stopped> {
        while !self.is_over() {
            if self.motion.state.motion.phase == Phase::Rest {
                self.stand();
                if self.is_over() {
                    break;
                }
            } else if let Some(law) = self.block.system.mode(&self.motion.state)
                && self.knows(&law)
            {
                return Ok(Some(law));
            }
            self.step_by_core(method)?;
        }
        Ok(None)
    }

    /// The lane has taken the block to (θ, θ̇) at its sample, and flywheels whose plates slip to the speeds `spins`, in `time` (s) since the
    /// core had it.
    pub(super) fn take(&mut self, place: (f64, f64), spins: [f64; 2], time: f64) {
        let ground = self.ground(self.sample);
        self.block.system.has_moved(&mut self.motion.state, place, spins, time, ground);
    }
}
