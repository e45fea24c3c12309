//! The block of one lane as the core sees it: its state, and the steps that the core takes or answers.

use sprag_loops::HybridLoop;
use sprag_shared::drivetrain::clutch_state::{Guard, ModeCoefficients};
use sprag_shared::motion::hybrid::{HybridSystem, Progress};
use sprag_shared::motion::state::{Limits, Phase, Stopped};
use sprag_shared::observers::peaks::Peaks;

use super::ground::{Ground, Sampled};
use super::located::{Expanded, LaneSeries};
use super::{HybridBlock, HybridMotion, MOST_EVENTS, Steps};

/// Share of the uplift threshold below which the core need not look at a block that stands.
const QUIET: f64 = 0.999_999;

/// A block, where it is in its ground motion, and its state there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seat<'a> {
    pub(super) block: HybridBlock<'a>,
    /// Interval of the ground motion.
    pub(super) interval: usize,
    /// How far it is into it.
    pub(super) progress: Progress<f64>,
    pub(super) motion: HybridMotion,
}

impl<'a> Seat<'a> {
    pub(super) fn new(block: HybridBlock<'a>) -> Seat<'a> {
        let motion = HybridMotion {
            state: block.system.at_rest(),
            peaks: Peaks::default(),
            checks: block.checks.copied(),
            coils: block.coils,
            steps: Steps::default(),
        };
        Seat { block, interval: 0, progress: Progress::default(), motion }
    }

    /// Whether the ground motion is over or the block has overturned.
    #[inline(always)]
    pub(super) fn is_over(&self) -> bool {
        self.interval >= self.block.ground.intervals() || self.motion.state.motion.phase == Phase::Overturned
    }

    /// |θ| (rad) at which an outward motion counts as overturned from here on.
    #[inline(always)]
    pub(super) fn overturned(&self) -> f64 {
        self.block.overturned(self.block.ground.bound(self.interval))
    }

    /// Time to the end of the interval, s.
    #[inline(always)]
    pub(super) fn left(&self) -> f64 {
        self.block.ground.length(self.interval) - self.progress.time
    }

    /// The lane has followed it for `time` (s); whether it goes on from there, which is not the end of a record nor of a piece.
    #[inline(always)]
    pub(super) fn moves(&mut self, time: f64) -> bool {
        if let Ground::Record(_) = self.block.ground {
            self.go_on();
            return !self.is_over();
        }
        let left = self.left();
        let HybridSystem { slenderness, speed, .. } = self.block.system;
        self.progress.go_on(time.min(left), slenderness / speed);
        time < left
    }

    /// It is at a new interval.
    #[inline(always)]
    pub(super) fn go_on(&mut self) {
        self.interval += 1;
        self.progress = Progress::default();
    }

    /// At the start of an interval the ground may have jumped.
    fn begin(&mut self) {
        if self.progress.time == 0.0 {
            let (ground, system) = (self.block.ground, self.block.system);
            let (state, mut watch) = self.motion.watched(ground.start(self.interval));
            ground.over(self.interval, |shaking| system.ground_at_start(state, shaking.at(0.0), &mut watch));
        }
    }

    /// One step of the core's loop: by its own series, or by that which a lane has expanded. Without `pressed` no force on it is larger than ever.
    fn step(&mut self, method: &dyn HybridLoop<f64>, pressed: bool) -> Result<(), Stopped> {
        self.begin();
        let limits = Limits { overturned: self.overturned(), events: MOST_EVENTS };
        let HybridBlock { system, ground, .. } = self.block;
        let length = ground.length(self.interval);
        let (state, mut watch) = self.motion.watched(ground.start(self.interval));
        watch.pressed = pressed;
        ground.over(self.interval, |shaking| {
            method.step(system, state, (shaking, length), &mut self.progress, &limits, &mut watch)
        })?;
        if self.progress.time >= length {
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

    /// Skips intervals on which the lines of a record cannot lift a block that stands.
    fn stand(&mut self) {
        let HybridBlock { system, ground: Ground::Record(record), .. } = self.block else { return };
        // The threshold grows linearly with the weight; on straight lines the largest excess is at a sample.
        let [weightless, whole] = [0.0, 1.0].map(|weight| QUIET * system.least_uplift(&self.motion.state, weight));
        let lifts = |sample: usize| {
            let [level, up] = record.at(sample);
            level.abs() > weightless + (whole - weightless) * (1.0 + up)
        };
        if lifts(self.interval) {
            return;
        }
        let Sampled { samples, factor, vertical } = record;
        let last = self.block.ground.intervals();
        let beyond = match vertical {
            None => samples.beyond(self.interval, whole / factor.abs()),
            Some(_) => (self.interval + 1..=last).find(|sample| lifts(*sample)),
        };
        let until = beyond.map_or(last, |beyond| beyond - 1);
        if until > self.interval {
            let time = samples.step * (until - self.interval) as f64 - self.progress.time;
            system.has_stood(&mut self.motion.state, time, record.at(until));
            (self.interval, self.progress) = (until, Progress::default());
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
            } else {
                // The lines of a record meet at its samples.
                if matches!(self.block.ground, Ground::Pieces(_)) {
                    self.begin();
                }
                if let Some(law) = self.block.system.mode(&self.motion.state)
                    && self.knows(&law)
                {
                    return Ok(Some(law));
                }
            }
            self.step_by_core(method)?;
        }
        Ok(None)
    }

    /// The lane has taken the block to (θ, θ̇) where it is in its ground motion, no faster than `fastest` (rad/s), and flywheels whose plates
    /// slip to the speeds `spins`, in `time` (s) since the core had it.
    pub(super) fn take(&mut self, place: (f64, f64), fastest: f64, spins: [f64; 2], time: f64) {
        if let Some(coils) = &mut self.motion.coils {
            coils.moves(self.motion.state.device.wheels.map(|wheel| wheel.coupling.is_engaged()), fastest, time);
        }
        let ground = match &self.block.ground {
            Ground::Record(record) => record.at(self.interval),
            ground => ground.over(self.interval, |shaking| {
                let [level, up, _] = shaking.at(self.progress.time);
                [level, up]
            }),
        };
        self.block.system.has_moved(&mut self.motion.state, place, spins, time, ground);
    }
}
