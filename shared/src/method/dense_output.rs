//! Contract of an integrator, and dense output: θ, θ̇ and θ̈ at any time of a step.

use crate::equation::Equation;
use crate::equation::any_equation::AnyEquation;
use crate::equation::motion::Motion;
use crate::ground::GroundSegment;
use crate::math::root::{newton_bracketed, zero_shown};
use crate::math::scalar::Real;
use crate::math::sign::Sign;

/// Start of a step: state, equation and ground motion.
#[derive(Clone, Copy)]
pub struct StepStart<'a, S> {
    /// The equation of motion in force.
    pub equation: &'a AnyEquation<S>,
    /// The ground motion.
    pub segment: &'a dyn GroundSegment<S>,
    /// s = sgn θ.
    pub side: Sign,
    /// θ, rad.
    pub rotation: S,
    /// θ̇, rad/s.
    pub velocity: S,
    /// Local time in the ground segment, s.
    pub time: S,
    /// Largest length of the step, s; above 0.
    pub length: S,
    /// θ̈ here, where it is known: from the step before, which has evaluated it, or zero because an event was located on it, so that the
    /// equation's rounding error must not count.
    pub acceleration: Option<S>,
    /// Size of a rotation that matters (rad), for tolerances.
    pub scale: S,
}

impl<S: Real> StepStart<'_, S> {
    /// θ̈ at the start, from `equation` where it is not known.
    #[inline(always)]
    pub fn first_acceleration<E: Equation<S>>(&self, equation: &E) -> S {
        self.acceleration.unwrap_or_else(|| {
            equation.acceleration(self.side.unit(), self.rotation, self.velocity, self.segment.acceleration(self.time))
        })
    }
}

/// Dense output: the motion from a [`StepStart`] over times from 0 to [`DenseOutput::length`], θ and θ̇ and θ̈ at any instant of it.
pub trait DenseOutput<S: Real> {
    /// Length of the step, s; at most the one asked for.
    fn length(&self) -> S;

    /// The motion at `time` after the start.
    fn at(&self, time: S) -> Motion<S>;

    /// Time at which a monotone θ reaches `level` between two times, where θ − `level` has the sign `before` at first.
    #[inline]
    fn crossing(&self, level: S, before: Sign, (from, to): (S, S)) -> S {
        newton_bracketed(from, to, before, S::HALF * (from + to), |t| {
            let motion = self.at(t);
            (motion.rotation - level, motion.velocity)
        })
    }

    /// Switching function of the clutch (Eq. 10), where it is not θ̈ itself.
    #[inline]
    fn switching(&self, time: S) -> S {
        self.at(time).acceleration
    }

    /// First zero of θ̈ in (`from`, `to`], where θ̈ has the sign `sign` just after `from`. `from_zero` says that θ̈ is
    /// zero at `from`.
    ///
    /// The default sees what the ends of the step show; a method with a series overrides it and proves its answer.
    #[inline(always)]
    fn acceleration_zero(&self, from: S, to: S, sign: Sign, _from_zero: bool) -> Option<S> {
        zero_shown(from, to, sign, |t| self.at(t).acceleration)
    }

    /// First zero of the switching function, as [`DenseOutput::acceleration_zero`]; called only where the two differ.
    fn switching_zero(&self, from: S, to: S, sign: Sign, _from_zero: bool) -> Option<S> {
        zero_shown(from, to, sign, |t| self.switching(t))
    }

    /// θ̈ at [`DenseOutput::length`] where the step has evaluated the equation there: that of the next step's start.
    #[inline]
    fn evaluated_end(&self) -> Option<S> {
        None
    }

    /// Largest |θ̈| between the times `from.0` and `to.0`, at which θ̈ is `from.1` and `to.1`, if above `floor`; else `floor`.
    ///
    /// The default sees what the ends show: enough for steps that are short beside the swings of θ̈.
    fn largest_acceleration(&self, from: (S, S), to: (S, S), floor: S) -> S {
        floor.larger(from.1.abs()).larger(to.1.abs())
    }
}

/// Integrator with dense output: fixed steps or steps of its own choice.
pub trait Integrator<S: Real> {
    /// Dense output of its steps.
    type Output<'a>: DenseOutput<S>
    where
        Self: 'a;

    /// The step from `start`.
    fn integrate<'a>(&'a self, start: &'a StepStart<'a, S>) -> Self::Output<'a>;

    /// The fixed step (s), if it has one: then steps end on whole multiples of it from the start of each ground segment.
    fn step(&self) -> Option<S>;
}
