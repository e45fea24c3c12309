//! A system through a whole ground motion and the free time after it.

use sprag_ensemble::hybrid::MOST_EVENTS;
use sprag_loops::{HybridLoop, IdealLoop};
use sprag_shared::math::scalar::Real;
#[cfg(feature = "effects")]
use sprag_shared::motion::ground_pair::GroundPair;
use sprag_shared::motion::hybrid::mode_output::Shaking;
use sprag_shared::motion::hybrid::{HybridState, HybridSystem};
use sprag_shared::motion::ideal::IdealSystem;
use sprag_shared::motion::observer::Observer;
use sprag_shared::motion::state::{BlockState, Limits, Phase, Stopped};
use sprag_shared::observers::checks::Checks;
use sprag_shared::observers::coil_use::CoilUse;
use sprag_shared::observers::peaks::Peaks;
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::{Block, Geometry};

use crate::ground_motion::{GroundMotion, Segment, SumSegment};

/// Arcs that one segment of ground motion may take.
const MOST_ARCS: u32 = 50_000_000;

/// Someone who needs to know which part of the ground motion is shown.
pub trait Segmented {
    /// The segment that follows, or `None` for the free time from `start` (s) on.
    fn segment(&mut self, start: f64, segment: Option<&Segment>);
}

impl<S: Real> Segmented for Peaks<S> {
    fn segment(&mut self, start: f64, _segment: Option<&Segment>) {
        self.origin = S::of(start);
    }
}

impl<S: Real> Segmented for Checks<S> {
    fn segment(&mut self, start: f64, _segment: Option<&Segment>) {
        self.origin = S::of(start);
    }
}

impl Segmented for CoilUse {
    fn segment(&mut self, _start: f64, _segment: Option<&Segment>) {}
}

impl<A: Segmented, B: Segmented> Segmented for (A, B) {
    fn segment(&mut self, start: f64, segment: Option<&Segment>) {
        self.0.segment(start, segment);
        self.1.segment(start, segment);
    }
}

/// When a block counts as overturned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overturning {
    /// As soon as it can be shown not to return.
    Proven,
    /// When it lies on the ground (full model), or at the end of its run is [proven](Overturning::Proven) to come there; the slender model
    /// has no ground, so there it is the proof.
    Reached,
    /// When |θ| reaches α, even if the ground would bring it back.
    Slenderness,
}

/// What to follow, and for how long.
#[derive(Clone, Copy, Debug)]
pub struct Course<'a> {
    /// The block.
    pub block: &'a Block,
    /// Full or slender.
    pub geometry: Geometry,
    /// The horizontal ground motion.
    pub ground: &'a GroundMotion,
    /// The vertical one, with the same segments.
    pub vertical: Option<&'a GroundMotion>,
    /// That of the device's support relative to the ground, with the same segments, if it moves on its own.
    pub support: Option<&'a GroundMotion>,
    /// Time after it, s.
    pub free_time: f64,
    /// When a block counts as overturned.
    pub overturning: Overturning,
}

impl<'a> Course<'a> {
    /// That of `structure`, as it is loaded, over ground that moves horizontally.
    pub fn of(structure: &'a Structure, ground: &'a GroundMotion, free_time: f64, overturning: Overturning) -> Course<'a> {
        Course {
            block: &structure.block,
            geometry: structure.geometry,
            ground,
            vertical: None,
            support: None,
            free_time,
            overturning,
        }
    }

    /// |θ| (rad) at which an outward motion counts as overturned while the ground stays within `bound` (in g).
    pub fn angle<S: Real>(&self, bound: f64) -> S {
        match (self.overturning, self.geometry) {
            (Overturning::Reached, Geometry::Full) => S::of(core::f64::consts::FRAC_PI_2),
            (Overturning::Slenderness, _) => S::of(self.block.slenderness()),
            _ => self.no_return(bound),
        }
    }

    /// |θ| (rad) from which an outward motion does not return while nothing pushes more than `bound` (in g).
    pub(super) fn no_return<S: Real>(&self, bound: f64) -> S {
        S::of(self.geometry.point_of_no_return(self.block.slenderness(), bound))
    }

    /// The block's weight at its lightest, over its weight at rest.
    pub fn lightest(&self) -> f64 {
        self.vertical.map_or(1.0, GroundMotion::lightest)
    }

    /// As [`Course::angle`], for a device ([`HybridSystem::push_bound`]).
    pub fn machine_angle<S: Real>(&self, machine: &HybridSystem<S>, bound: f64, support: f64, lightest: f64) -> S {
        self.angle(machine.push_bound(bound, support, lightest))
    }

    pub(super) fn limits<S: Real>(&self, bound: f64) -> Limits<S> {
        Limits { overturned: self.angle(bound), events: MOST_ARCS }
    }

    /// Follows `state` to the end; `continues` is asked before every segment.
    ///
    /// # Errors
    /// [`Stopped`] by the core. An answer of `false` ends the run early, without an error.
    pub fn follow<S, O>(
        &self,
        system: &IdealSystem<S>,
        method: &dyn IdealLoop<S>,
        state: &mut BlockState<S>,
        observer: &mut O,
        mut continues: impl FnMut() -> bool,
    ) -> Result<(), Stopped>
    where
        S: Real,
        O: Observer<S> + Segmented,
    {
        // The bound of a record falls rarely, and a limit costs an arctangent.
        let (mut bound, mut limits) = (f64::NAN, self.limits(0.0));
        for segment in self.ground.segments() {
            if state.phase == Phase::Overturned || !continues() {
                return Ok(());
            }
            observer.segment(segment.start, Some(segment));
            if segment.bound != bound {
                bound = segment.bound;
                limits = self.limits(bound);
            }
            let duration = S::of(segment.duration);
            // One type for every shape: a branch a call costs less than a second copy of every stepper.
            let piece = segment.shape.to();
            method.advance(system, state, &piece, duration, &limits, observer).map_err(|end| end.after(segment.start))?;
        }
        if state.phase == Phase::Overturned || !continues() {
            return Ok(());
        }
        observer.segment(self.ground.duration(), None);
        let (limits, duration) = (self.limits(0.0), S::of(self.free_time));
        let ended = method.advance(system, state, &SumSegment::QUIET, duration, &limits, observer);
        ended.map_err(|end| end.after(self.ground.duration()))?;
        state.end(self.no_return(0.0), duration, observer);
        Ok(())
    }

    /// Follows a device with a memory as [`Course::follow`] an ideal one, and reports every swing to `observer`.
    ///
    /// # Errors
    /// The errors of [`Course::follow`].
    pub fn follow_machine<S, O>(
        &self,
        machine: &HybridSystem<S>,
        integrator: &dyn HybridLoop<S>,
        state: &mut HybridState<S>,
        observer: &mut O,
        mut continues: impl FnMut() -> bool,
    ) -> Result<(), Stopped>
    where
        S: Real,
        O: Observer<S> + Segmented,
    {
        let lightest = self.lightest();
        let limits = |bound: f64, support: f64| Limits {
            events: MOST_EVENTS,
            overturned: self.machine_angle(machine, bound, support, lightest),
        };
        let [vertical, support] = [self.vertical, self.support].map(|motion| motion.map(GroundMotion::segments));
        for (index, segment) in self.ground.segments().iter().enumerate() {
            if state.motion.phase == Phase::Overturned || !continues() {
                return Ok(());
            }
            observer.segment(segment.start, Some(segment));
            let horizontal = segment.shape.to();
            let up = vertical.and_then(|segments| segments.get(index)).map(|segment| segment.shape.to());
            let support = support.and_then(|segments| segments.get(index));
            let moved = support.map(|segment| segment.shape.to());
            let shaking = Shaking {
                horizontal: &horizontal,
                vertical: up.as_ref().map(|piece| piece as _),
                support: moved.as_ref().map(|piece| piece as _),
            };
            let limits = limits(segment.bound, support.map_or(0.0, |segment| segment.bound));
            let duration = S::of(segment.duration);
            integrator.advance(machine, state, shaking, duration, &limits, observer).map_err(|end| end.after(segment.start))?;
        }
        if state.motion.phase == Phase::Overturned || !continues() {
            return Ok(());
        }
        observer.segment(self.ground.duration(), None);
        let (shaking, duration) = (Shaking::level(&SumSegment::QUIET), S::of(self.free_time));
        let ended = integrator.advance(machine, state, shaking, duration, &limits(0.0, 0.0), observer);
        ended.map_err(|end| end.after(self.ground.duration()))?;
        machine.end(state, duration, observer);
        Ok(())
    }

    /// Gives each segment of the ground, and quiet ground for the free time, to `advance` with its start and duration (s), until that says
    /// that nothing follows any more or `continues` no longer holds.
    ///
    /// # Errors
    /// Those of `advance`, whose times are local to the segment.
    #[cfg(feature = "effects")]
    pub(super) fn in_pairs<S: Real, O: Segmented>(
        &self,
        observer: &mut O,
        continues: impl Fn() -> bool,
        mut advance: impl FnMut(GroundPair<'_, S>, [f64; 2], &mut O) -> Result<bool, Stopped>,
    ) -> Result<(), Stopped> {
        let mut over = |pair: GroundPair<'_, S>, start: f64, duration: f64, observer: &mut O| {
            advance(pair, [start, duration], observer).map_err(|end| end.after(start))
        };
        let vertical = self.vertical.map(GroundMotion::segments);
        for (index, segment) in self.ground.segments().iter().enumerate() {
            if !continues() {
                return Ok(());
            }
            observer.segment(segment.start, Some(segment));
            let horizontal: SumSegment<S> = segment.shape.to();
            let up: Option<SumSegment<S>> = vertical.and_then(|segments| segments.get(index)).map(|segment| segment.shape.to());
            let pair = GroundPair { horizontal: &horizontal, vertical: up.as_ref().map(|piece| piece as _) };
            if over(pair, segment.start, segment.duration, observer)? {
                return Ok(());
            }
        }
        observer.segment(self.ground.duration(), None);
        let pair = GroundPair { horizontal: &SumSegment::QUIET, vertical: None };
        over(pair, self.ground.duration(), self.free_time, observer).map(|_| ())
    }
}
