//! The loop itself: plant, sensors, controller and clutches, tick by tick.

use sprag_shared::control::controller::{Circumstances, Decision};
use sprag_shared::control::law::Wish;
use sprag_shared::control::monitor::fault::Fault;
use sprag_shared::control::sensing::sample::Sample;
use sprag_shared::control::supervisor::Phase as ControllerPhase;
use sprag_shared::motion::state::{BlockState, Phase, Stopped};

use super::disturbance::Disturbance;
use super::driver::Driver;
use super::feedback::{Currents, Feedback};
use super::plant::{Plant, Watcher, Whereabouts};
use crate::interrupt::Interrupt;
use crate::sensor::{Sensors, Suite, Truth};

/// Clock of a loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    /// Period of the control tick, s.
    pub period: f64,
    /// Pieces of a period at whose ends the sensors see the plant; 1 or more.
    pub substeps: u32,
    /// Stillness before the motion, in which the controller tests and calibrates itself, s.
    pub prelude: f64,
    /// When the motion ends, s.
    pub end: f64,
    /// When the ground stops, s; a block that rests after it ends the run.
    pub ground_end: f64,
    /// From a command to a clutch that has moved, s, which the clutches' feedback in the prelude shows.
    pub actuation: f64,
}

/// One tick of a loop.
#[derive(Clone, Copy, Debug)]
pub struct Tick {
    /// The plant.
    pub plant: Whereabouts,
    /// What the controller was given.
    pub sample: Sample,
    /// And said.
    pub decision: Decision,
    /// What the same law would want of the true motion; false where the observer [does not look](TickObserver::looks).
    pub ideal: bool,
    /// |θ| is α or more: a block that overturns has begun to fall.
    pub beyond: bool,
}

/// When somebody looks at [`Tick::ideal`]; nobody else pays for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Looks {
    /// Never.
    Never,
    /// While the block rocks: one that stands has no law to follow.
    Rocking,
    /// Always.
    Always,
}

/// Whatever looks at every tick.
pub trait TickObserver {
    /// A tick.
    fn tick(&mut self, tick: &Tick);

    /// When it looks at [`Tick::ideal`].
    fn looks(&self) -> Looks {
        Looks::Never
    }

    /// The block has overturned, after the last tick.
    fn overturned(&mut self) {}
}

/// Nobody.
impl TickObserver for () {
    fn tick(&mut self, _tick: &Tick) {}
}

/// Every tick.
impl TickObserver for Vec<Tick> {
    fn tick(&mut self, tick: &Tick) {
        self.push(*tick);
    }

    fn looks(&self) -> Looks {
        Looks::Always
    }
}

/// Keeps in `fall` what there was `before` the tick at which |θ| last passed α, as long as it stays `beyond`: nothing of a fall counts.
pub(super) fn follow_fall<T>(fall: &mut Option<T>, beyond: bool, before: impl FnOnce() -> T) {
    if beyond {
        fall.get_or_insert_with(before);
    } else {
        *fall = None;
    }
}

/// Why a loop ended without a result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LoopError {
    /// By the core.
    #[error("{0}")]
    Stopped(Stopped),
    /// Ctrl-C.
    #[error("interrupted")]
    Interrupted,
}

/// How a loop ended.
#[derive(Clone, Debug)]
pub struct Ending {
    /// The block.
    pub motion: BlockState<f64>,
    /// Ticks while the ground or the block moved.
    pub ticks: u64,
    /// Engagements of the inerter: from no clutch engaged to any.
    pub engagements: u32,
    /// The controller's last state; of a block that has overturned, that in which its fall began.
    pub phase: ControllerPhase,
    /// Faults in the order in which they were entered, and when, s; none of a fall: sensors on a falling block read what no rocking
    /// explains.
    pub faults: Vec<(f64, Fault)>,
    /// Engagements that the clutches missed.
    pub missed: u32,
    /// The controller's state when the ground or the block began to move.
    pub began: ControllerPhase,
}

impl Ending {
    /// Whether self-test and calibration were done when the ground or the block began to move.
    pub fn began_ready(&self) -> bool {
        !matches!(self.began, ControllerPhase::Boot | ControllerPhase::SelfTest | ControllerPhase::Calibrate)
    }
}

/// One closed loop.
pub struct ClosedLoop<'a> {
    /// Clock.
    pub clock: Clock,
    /// Sensors.
    pub suite: &'a Suite,
    /// Seed of the noise and scatter of the sensors.
    pub seed: u64,
    /// What shows the controller which clutches are engaged.
    pub feedback: Feedback,
    /// What goes wrong on purpose.
    pub disturbance: &'a mut dyn Disturbance,
    /// α of the block with what it carries, rad: beyond it a block that overturns has begun to fall.
    pub slenderness: f64,
    /// Ctrl-C.
    pub interrupt: &'a Interrupt,
}

impl ClosedLoop<'_> {
    /// Runs it.
    pub fn run(
        self,
        plant: &mut Plant<'_>,
        driver: &mut dyn Driver,
        watcher: &mut dyn Watcher,
        observer: &mut dyn TickObserver,
    ) -> Result<Ending, LoopError> {
        let clock = self.clock;
        let still = Truth::STILL;
        let mut sensors = Sensors::new(self.suite, self.seed, &still);
        let (mut command, mut began) = self.prelude(&mut sensors, driver);
        let mut moves = false;
        plant.preset(command);
        let mut currents = Currents::settled(command);
        let fine = clock.period / f64::from(clock.substeps);
        let mut instants = Vec::with_capacity(clock.substeps as usize);
        let looks = observer.looks();
        let (mut engagements, mut was_engaged) = (0, false);
        let mut faults = Vec::new();
        // Faults so far and the state.
        let mut fall = None;
        let mut last_fault = None;
        let mut phase = ControllerPhase::Boot;
        let mut tick: u64 = 0;
        let start = clock.prelude;
        loop {
            let time = tick as f64 * clock.period;
            let whereabouts = plant.whereabouts();
            if time >= clock.end || whereabouts.motion.phase == Phase::Overturned {
                break;
            }
            if whereabouts.motion.phase == Phase::Rest && time > clock.ground_end {
                break;
            }
            // At each: over a device's line a thousand may take seconds, and the device must be let go of in time.
            if self.interrupt.is_set() {
                return Err(LoopError::Interrupted);
            }
            let mut sample = sensors.sample();
            sample.engaged = if self.feedback == Feedback::Position { whereabouts.engaged } else { currents.engaged };
            let mut circumstances = Circumstances::default();
            self.disturbance.disturb(time, &mut sample, &mut circumstances);
            let decision = driver.tick(&sample, circumstances);
            moves |= whereabouts.motion.phase == Phase::Rocking || whereabouts.ground != [0.0; 2];
            if !moves {
                began = decision.phase;
            }
            let asked = looks == Looks::Always || whereabouts.motion.phase == Phase::Rocking;
            let ideal = looks != Looks::Never && driver.ideal(&whereabouts, asked) != Wish::Release;
            let beyond = whereabouts.motion.rotation.abs() >= self.slenderness;
            follow_fall(&mut fall, beyond, || (faults.len(), phase));
            let engaged = whereabouts.engaged[0] || whereabouts.engaged[1];
            engagements += u32::from(engaged && !was_engaged);
            was_engaged = engaged;
            if decision.fault != last_fault {
                last_fault = decision.fault;
                faults.extend(decision.fault.map(|fault| (time, fault)));
            }
            phase = decision.phase;
            observer.tick(&Tick { plant: whereabouts, sample, decision, ideal, beyond });
            command = self.disturbance.clutches(time, decision.command, command);
            plant.order(command, watcher);
            currents.step(self.feedback, command);
            instants.clear();
            instants.extend((1..clock.substeps).map(|part| (time + f64::from(part) * fine).min(clock.end)));
            instants.push(((tick + 1) as f64 * clock.period).min(clock.end));
            let mut see = |at: f64, truth: &Truth| sensors.advance(start + at, truth);
            plant.advance(&instants, watcher, &mut see).map_err(LoopError::Stopped)?;
            tick += 1;
        }
        plant.end(watcher);
        let end = plant.whereabouts();
        if end.motion.phase == Phase::Overturned {
            observer.overturned();
            if let Some((entered, state)) = fall {
                faults.truncate(entered);
                phase = state;
            }
        }
        Ok(Ending { motion: end.motion, ticks: tick, engagements, phase, faults, missed: end.missed, began })
    }

    /// Stillness: the controller boots, tests its clutches and calibrates its sensors. Returns the last command and the state.
    fn prelude(&self, sensors: &mut Sensors, driver: &mut dyn Driver) -> ([bool; 2], ControllerPhase) {
        let clock = &self.clock;
        let ticks = (clock.prelude / clock.period).round() as u64;
        let lag = (clock.actuation / clock.period).ceil() as usize;
        let mut pending = std::collections::VecDeque::from(vec![[false; 2]; lag + 1]);
        let (mut command, mut phase) = ([false; 2], ControllerPhase::Boot);
        for tick in 0..ticks {
            // The first tick of the motion says so.
            if self.interrupt.is_set() {
                break;
            }
            sensors.advance(tick as f64 * clock.period, &Truth::STILL);
            let mut sample = sensors.sample();
            sample.engaged = pending.pop_front().unwrap_or_default();
            let decision = driver.tick(&sample, Circumstances::default());
            (command, phase) = (decision.command, decision.phase);
            pending.push_back(command);
        }
        (command, phase)
    }
}
