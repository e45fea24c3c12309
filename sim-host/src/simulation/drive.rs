//! A system through a whole ground motion and the free time after it.

use sprag_shared::arc::Method;
use sprag_shared::block::{Block, Geometry};
use sprag_shared::clutch::Clutch;
use sprag_shared::equation::Equation;
use sprag_shared::ground::{Linear, Quiet};
use sprag_shared::observer::{Observer, Peaks};
use sprag_shared::rocking::{Limits, Phase, State, Stopped, System};
use sprag_shared::scalar::Real;

use crate::ground_motion::{GroundMotion, Segment, ShapePiece};

/// Arcs that one segment of ground motion may take.
const MOST_ARCS: u32 = 50_000_000;

/// An observer that needs to know which part of the ground motion it is shown.
pub trait GroundObserver<S: Real>: Observer<S> {
    /// The segment that follows, or `None` for the free time from `start` (s) on.
    fn segment(&mut self, start: f64, segment: Option<&Segment>);
}

impl<S: Real> GroundObserver<S> for Peaks<S> {
    fn segment(&mut self, start: f64, _segment: Option<&Segment>) {
        self.origin = S::of(start);
    }
}

/// When a block counts as overturned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overturning {
    /// As soon as it can be shown not to return.
    Proven,
    /// When it lies on the ground (full model); the slender model has no ground, so there it is the proof.
    Reached,
}

/// What to follow, and for how long.
#[derive(Clone, Copy, Debug)]
pub struct Course<'a> {
    /// The block.
    pub block: &'a Block,
    /// Full or slender.
    pub geometry: Geometry,
    /// The ground motion.
    pub ground: &'a GroundMotion,
    /// Time after it, s.
    pub free_time: f64,
    /// When a block counts as overturned.
    pub overturning: Overturning,
}

impl Course<'_> {
    /// |θ| (rad) at which an outward motion counts as overturned while the ground stays within `bound` (in g).
    pub fn angle<S: Real>(&self, bound: f64) -> S {
        S::of(match (self.overturning, self.geometry) {
            (Overturning::Reached, Geometry::Full) => core::f64::consts::FRAC_PI_2,
            _ => self.geometry.point_of_no_return(self.block, bound),
        })
    }

    fn limits<S: Real>(&self, bound: f64) -> Limits<S> {
        Limits { overturned: self.angle(bound), events: MOST_ARCS }
    }

    /// Follows `state` to the end; `goes_on` is asked before every segment.
    ///
    /// # Errors
    /// [`Stopped`] by the core. An answer of `false` ends the run early, without an error.
    pub fn follow<S, R, E, C, M, O>(
        &self,
        system: &System<S, R, E, C>,
        method: &M,
        state: &mut State<S>,
        observer: &mut O,
        mut goes_on: impl FnMut() -> bool,
    ) -> Result<(), Stopped>
    where
        S: Real,
        R: Equation<S>,
        E: Equation<S>,
        C: Clutch,
        M: Method<S>,
        O: GroundObserver<S>,
    {
        // The bound of a record falls rarely, and a limit costs an arctangent.
        let (mut bound, mut limits) = (f64::NAN, self.limits(0.0));
        for segment in self.ground.segments() {
            if state.phase == Phase::Overturned || !goes_on() {
                return Ok(());
            }
            observer.segment(segment.start, Some(segment));
            if segment.bound != bound {
                bound = segment.bound;
                limits = self.limits(bound);
            }
            let duration = S::of(segment.duration);
            // One type for every shape: a branch a call costs less than a second copy of every stepper.
            system.advance(method, state, &ShapePiece::of(&segment.shape), duration, &limits, observer)?;
        }
        if state.phase == Phase::Overturned || !goes_on() {
            return Ok(());
        }
        observer.segment(self.ground.duration(), None);
        let (limits, duration) = (self.limits(0.0), S::of(self.free_time));
        if O::EVERY_SWING {
            system.advance(method, state, &ShapePiece::Linear(Linear::constant(S::ZERO)), duration, &limits, observer)
        } else {
            system.advance(method, state, &Quiet, duration, &limits, observer)
        }
    }
}
