//! The structure of a closed loop: any device that takes commands, followed over the ground motion a short piece at a time.

use sprag_loops::{HybridLoop, Method, hybrid};
use sprag_shared::equation::Accelerations;
use sprag_shared::equation::body::Body;
use sprag_shared::ground::GroundSegment;
use sprag_shared::math::scalar::Real;
use sprag_shared::method::fixed::{FixedStep, Scheme};
use sprag_shared::motion::device_snapshot::DeviceOutput;
use sprag_shared::motion::hybrid::footing::Footing;
use sprag_shared::motion::hybrid::mode_output::Shaking;
use sprag_shared::motion::hybrid::{HybridState, HybridSystem};
use sprag_shared::motion::observer::{Event, MonotoneInterval, Observer};
use sprag_shared::motion::state::{BlockState, Limits, Phase, Stopped};

use super::path::Path;
use super::truth::{Places, Posture, Shocks};
use crate::ground_motion::{GroundMotion, Segment, SumSegment};
use crate::scene::motions::GroundMotions;
use crate::sensor::Truth;
use crate::simulation::drive::{Course, Segmented};
use crate::simulation::stable_step::{fastest_decay, springs_bear, stable_step};

/// Someone who watches a plant.
pub trait Watcher: Observer<f64> + Segmented {}

impl<T: Observer<f64> + Segmented> Watcher for T {}

/// Steps and events that one piece may take.
const MOST_EVENTS: u32 = 100_000;

/// Where a plant is.
#[derive(Clone, Copy, Debug)]
pub struct Whereabouts {
    /// s.
    pub time: f64,
    /// The block.
    pub motion: BlockState<f64>,
    /// Quantity with the sign of the terminals' acceleration (Eq. 10), 1/s²; 0 at rest.
    pub push: f64,
    /// Ground acceleration in g, horizontal and vertical.
    pub ground: [f64; 2],
    /// Growth of the horizontal one from now on, 1/s; 0 at rest.
    pub ground_rate: f64,
    /// Whether each clutch is engaged.
    pub engaged: [bool; 2],
    /// Speeds of the flywheels over R, 1/s.
    pub spins: [f64; 2],
    /// Engagements missed so far.
    pub missed: u32,
}

/// What a plant is made from beside its machine.
#[derive(Clone, Copy)]
pub struct Surroundings<'a> {
    /// What to follow.
    pub course: Course<'a>,
    /// The same ground motion.
    pub ground: &'a GroundMotions,
    /// θ and θ̇ at the start, if the block is not at rest.
    pub released: Option<(f64, f64)>,
    /// Accelerations at the start.
    pub ground_at_start: Accelerations<f64>,
    /// Duration of the shocks that sensors see, s.
    pub shock: f64,
    /// From a command to the clutch's own delays, s.
    pub latency: f64,
    /// Largest step, s.
    pub step: f64,
    /// Elastic clutches by the exponential midpoint method, as those are whose springs are too stiff for the step.
    pub exponential: bool,
}

/// The ground motion over one segment.
struct Pieces {
    horizontal: SumSegment<f64>,
    vertical: Option<SumSegment<f64>>,
    /// It certainly lifts no block that stands.
    holds: bool,
    /// It accelerates along a straight line.
    straight: bool,
}

impl Pieces {
    /// Accelerations `duration` (s) after `offset` (s).
    fn accelerations(&self, offset: f64, duration: f64) -> Accelerations<f64> {
        let vertical = self.vertical.as_ref().map_or(0.0, |piece| piece.acceleration_after(offset, duration));
        [self.horizontal.acceleration_after(offset, duration), vertical, 0.0]
    }
}

/// Longest step, over the time in which viscous forces use up a speed, whose ends show what is between them: what they miss, (1/100)³/120 of an
/// acceleration, is less than an f32 resolves.
const SHOWN_BY_ENDS: f64 = 0.01;

fn shaking<'a>(horizontal: &'a SumSegment<f64>, vertical: Option<&'a SumSegment<f64>>) -> Shaking<'a, f64> {
    Shaking { horizontal, vertical: vertical.map(|piece| piece as _), support: None }
}

/// A machine and its place in the ground motion.
pub struct Plant<'a> {
    machine: HybridSystem<f64>,
    method: Box<dyn HybridLoop<f64>>,
    state: HybridState<f64>,
    surroundings: Surroundings<'a>,
    shocks: Shocks,
    path: Path,
    places: Places,
    footing: Footing<f64>,
    posture: Posture,
    time: f64,
    index: usize,
    pieces: Option<Pieces>,
    limits: Limits<f64>,
    lightest: f64,
    /// Springs or viscous forces move faster than the ends of a step show.
    stiff: bool,
}

impl<'a> Plant<'a> {
    /// Of `machine`, which takes its commands from a controller from now on.
    pub fn new(mut machine: HybridSystem<f64>, surroundings: Surroundings<'a>) -> Self {
        machine.actuator.controlled = true;
        machine.actuator.engagement_delay += surroundings.latency;
        machine.actuator.release_delay += surroundings.latency;
        let state = match surroundings.released {
            Some((rotation, velocity)) => machine.released_at(rotation, velocity, surroundings.ground_at_start),
            None => machine.at_rest(),
        };
        let block = surroundings.course.block;
        let decay = fastest_decay(&machine);
        // Rounding of a tick's ends must not make a step of its own.
        let step = stable_step(surroundings.step, decay) * (1.0 + 1e-9);
        let method = if surroundings.exponential || !springs_bear(&machine, step) {
            FixedStep { scheme: Scheme::ExponentialMidpoint, step }
        } else {
            FixedStep { scheme: Scheme::RungeKutta4, step }
        };
        let places = Places::new(&machine, block);
        Plant {
            places,
            footing: machine.footing(),
            posture: places.posture(&machine, state.motion.side, state.motion.rotation),
            machine,
            method: hybrid(Method::Fixed(method)),
            state,
            surroundings,
            shocks: Shocks::new(surroundings.shock),
            path: Path::default(),
            time: 0.0,
            index: 0,
            pieces: None,
            limits: Limits { overturned: 0.0, events: MOST_EVENTS },
            lightest: surroundings.course.lightest(),
            stiff: surroundings.step * decay > SHOWN_BY_ENDS || machine.transmission.traits().springs,
        }
    }

    /// [`Whereabouts::push`] in the present posture.
    fn push(&self) -> f64 {
        let motion = &self.state.motion;
        if motion.phase != Phase::Rocking {
            return 0.0;
        }
        let (body, configuration) = (&self.machine.body, &self.posture.configuration);
        body.switching(configuration, motion.velocity, body.driving_moment(configuration, self.ground()))
    }

    /// The ground's acceleration, horizontal and vertical, in g; its support moves with it.
    fn ground(&self) -> [f64; 2] {
        let [horizontal, vertical, _] = self.state.ground;
        [horizontal, vertical]
    }

    /// [`Whereabouts::ground_rate`] now.
    fn ground_rate(&self) -> f64 {
        if self.state.motion.phase != Phase::Rocking {
            return 0.0;
        }
        // At the end of a segment the next one is in force, which is entered only to follow it.
        let ahead = self.surroundings.ground.horizontal.segments().get(self.index..).unwrap_or_default();
        let now = ahead.iter().find(|segment| segment.start + segment.duration > self.time);
        now.map_or(0.0, |segment| segment.shape.slope(self.time - segment.start))
    }

    fn segment(&self) -> Option<&'a Segment> {
        self.surroundings.ground.horizontal.segments().get(self.index)
    }

    /// The pieces of ground motion in force, and the limits that go with them.
    fn enter_segment(&mut self) {
        let horizontal = self.segment();
        let vertical = self.surroundings.ground.vertical.as_ref().map(GroundMotion::segments);
        let up = vertical.and_then(|segments| segments.get(self.index)).map(|segment| segment.shape.to());
        let along = horizontal.map_or(SumSegment::QUIET, |segment| segment.shape.to());
        let duration = horizontal.map_or(0.0, |segment| segment.duration);
        let holds = self.footing.holds(shaking(&along, up.as_ref()), duration).is_some();
        let straight = [Some(&along), up.as_ref()].into_iter().flatten().all(|piece| piece.curvature_bound() == 0.0);
        self.pieces = Some(Pieces { horizontal: along, vertical: up, holds, straight });
        let bound = horizontal.map_or(0.0, |segment| segment.bound);
        self.limits.overturned = self.surroundings.course.machine_angle(&self.machine, bound, 0.0, self.lightest);
    }

    /// The clutches before the motion.
    pub fn preset(&mut self, engaged: [bool; 2]) {
        if self.state.motion.phase == Phase::Rest {
            self.machine.preset(&mut self.state, engaged);
        }
    }

    /// Gives a command to each clutch.
    pub fn order(&mut self, wanted: [bool; 2], watcher: &mut dyn Watcher) {
        watcher.segment(self.time, self.segment());
        self.shocks.origin = self.time;
        self.machine.order(&mut self.state, wanted, &mut (watcher, (&mut self.shocks, &mut self.path)));
    }

    /// Follows it up to the last of `instants` (s, ascending), and gives `see` the truth at each of them; where it goes along a straight line,
    /// at the last alone.
    ///
    /// # Errors
    /// [`Stopped`] by the core.
    pub fn advance(
        &mut self,
        instants: &[f64],
        watcher: &mut dyn Watcher,
        see: &mut dyn FnMut(f64, &Truth),
    ) -> Result<(), Stopped> {
        for instants in instants.chunks(if self.stiff { 1 } else { instants.len().max(1) }) {
            let [between @ .., last] = instants else { break };
            self.advance_past(between, *last, watcher, see)?;
            see(*last, &self.truth());
        }
        Ok(())
    }

    fn advance_past(
        &mut self,
        between: &[f64],
        until: f64,
        watcher: &mut dyn Watcher,
        see: &mut dyn FnMut(f64, &Truth),
    ) -> Result<(), Stopped> {
        let before = self.time;
        while self.time < until && self.state.motion.phase != Phase::Overturned {
            while self.segment().is_some_and(|segment| segment.start + segment.duration <= self.time) {
                self.index += 1;
                self.pieces = None;
            }
            if self.pieces.is_none() {
                self.enter_segment();
                if self.segment().is_none() {
                    watcher.segment(self.time, None);
                }
            }
            let segment = self.segment();
            let (start, end) =
                segment.map_or((self.time, until), |segment| (segment.start, until.min(segment.start + segment.duration)));
            watcher.segment(self.time, segment);
            self.shocks.origin = self.time;
            self.path.begin(self.time, self.state.motion.side);
            if let Some(pieces) = &self.pieces {
                let (offset, duration) = (self.time - start, end - self.time);
                if pieces.holds && self.machine.waits(&self.state, duration) {
                    self.machine.stay(&mut self.state, pieces.accelerations(offset, duration), duration);
                    if pieces.straight && self.shocks.over_at(before) && (before, until) == (self.time, end) {
                        self.time = end;
                        return Ok(());
                    }
                } else {
                    let horizontal = pieces.horizontal.after(offset);
                    let vertical = pieces.vertical.as_ref().map(|piece| piece.after(offset));
                    let shaking = shaking(&horizontal, vertical.as_ref());
                    if !self.machine.stands_through(&self.footing, &mut self.state, shaking, duration) {
                        let mut watched = (&mut *watcher, (&mut self.shocks, &mut self.path));
                        let ended =
                            self.method.advance(&self.machine, &mut self.state, shaking, duration, &self.limits, &mut watched);
                        ended.map_err(|stopped| stopped.after(self.time))?;
                    }
                }
                for instant in between.iter().copied().filter(|&instant| instant > self.time && instant <= end) {
                    let [horizontal, vertical, _] = pieces.accelerations(offset, instant - self.time);
                    let (side, motion) = self.path.at(instant);
                    self.places.follow(&mut self.posture, &self.machine, side, motion.rotation);
                    let (moving, shock) = ((motion.velocity, motion.acceleration), self.shocks.at(instant));
                    see(instant, &self.places.truth(&self.posture, moving, shock, [horizontal, vertical]));
                }
            }
            self.time = end;
        }
        Ok(())
    }

    /// Ends its motion, on ground that has come to rest.
    pub fn end(&mut self, watcher: &mut dyn Watcher) {
        watcher.segment(self.time, None);
        self.machine.end(&mut self.state, 0.0, watcher);
    }

    fn take_posture(&mut self) {
        let BlockState { side, rotation, .. } = self.state.motion;
        self.places.follow(&mut self.posture, &self.machine, side, rotation);
    }

    /// Where it is.
    pub fn whereabouts(&mut self) -> Whereabouts {
        self.take_posture();
        let wheels = &self.state.device.wheels;
        Whereabouts {
            time: self.time,
            motion: self.state.motion,
            push: self.push(),
            ground: self.ground(),
            ground_rate: self.ground_rate(),
            engaged: [wheels[0].coupling.is_engaged(), wheels[1].coupling.is_engaged()],
            spins: self.machine.spins_now(&self.state, &self.posture.configuration),
            missed: self.state.device.missed,
        }
    }

    /// What perfect sensors would read.
    pub fn truth(&mut self) -> Truth {
        self.take_posture();
        let acceleration = self.machine.acceleration_now(&self.state, &self.posture.configuration);
        let moving = (self.state.motion.velocity, acceleration);
        self.places.truth(&self.posture, moving, self.shocks.at(self.time), self.ground())
    }
}

/// Follows only what a study counts: the largest rotation and how it ended.
#[derive(Clone, Copy, Debug, Default)]
pub struct Extremes {
    /// As simulations have them; the acceleration stays 0.
    pub peaks: sprag_shared::observers::peaks::Peaks<f64>,
}

impl Observer<f64> for Extremes {
    fn device_interval(&mut self, _output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
        let (first, last) = (interval.first.rotation.abs(), interval.last.rotation.abs());
        self.peaks.rotation = self.peaks.rotation.larger(first).larger(last);
    }

    fn event(&mut self, event: Event, time: f64, state: &BlockState<f64>) {
        self.peaks.event(event, time, state);
    }
}

impl Segmented for Extremes {
    fn segment(&mut self, start: f64, _segment: Option<&Segment>) {
        self.peaks.origin = start;
    }
}
