//! Power-series recurrence of a rocking motion over one step.
//!
//! With θ̈ = Σ a_k t^k, of which the equation of motion gives one coefficient after the other over the nodes of a [`Tape`],
//! θ̇_{k+1} = a_k/(k+1) and θ_{k+2} = θ̇_{k+1}/(k+2) (Jorba and Zou 2005).

use crate::equation::motion::Motion;
use crate::math::power_series::Tape;
use crate::math::scalar::{Real, Scalar};
use crate::math::{RECIPROCALS, polynomial};

/// Power series of θ, θ̇ and θ̈; θ̇ has one less than θ, and θ̈ two. What their arrays have beyond is zero.
#[derive(Clone, Copy, Debug)]
pub struct MotionSeries<S, const N: usize> {
    /// Coefficients of θ.
    pub rotation: [S; N],
    /// Coefficients of θ̇.
    pub velocity: [S; N],
    /// Coefficients of θ̈.
    pub acceleration: [S; N],
}

impl<S: Scalar, const N: usize> Default for MotionSeries<S, N> {
    fn default() -> Self {
        let zero = [S::of(0.0); N];
        MotionSeries { rotation: zero, velocity: zero, acceleration: zero }
    }
}

impl<S: Scalar, const N: usize> MotionSeries<S, N> {
    /// Starts at θ (`rotation`, rad) and θ̇ (`velocity`, rad/s), which are quantities 0 and 1 of the `tape`.
    #[inline(always)]
    pub fn start<const SLOTS: usize>(&mut self, tape: &Tape<S, N, SLOTS>, rotation: S, velocity: S) {
        self.rotation[0] = rotation;
        self.rotation[1] = velocity;
        self.velocity[0] = velocity;
        tape.set(0, 0, rotation);
        tape.set(0, 1, velocity);
        tape.set(1, 0, velocity);
    }

    /// Appends a_k = `acceleration`. Returns θ_{k+2}.
    #[inline(always)]
    pub fn extend<const SLOTS: usize>(&mut self, tape: &Tape<S, N, SLOTS>, k: usize, acceleration: S) -> S {
        let v = acceleration * S::of(RECIPROCALS[(k + 1) & 63]);
        let c = v * S::of(RECIPROCALS[(k + 2) & 63]);
        self.acceleration[k] = acceleration;
        self.velocity[k + 1] = v;
        self.rotation[k + 2] = c;
        tape.set(1, k + 1, v);
        tape.set(0, k + 2, c);
        c
    }
}

/// A [`MotionSeries`] that holds from 0 to a length.
#[derive(Clone, Copy, Debug)]
pub struct StepSeries<S, const N: usize> {
    /// Length on which the series holds, s.
    pub length: S,
    /// Coefficients of θ in use.
    pub terms: usize,
    /// The coefficients.
    pub motion: MotionSeries<S, N>,
}

impl<S: Real, const N: usize> StepSeries<S, N> {
    /// An empty one for a step of `length` (s).
    pub fn new(length: S) -> Self {
        StepSeries { length, terms: N, motion: MotionSeries::default() }
    }

    /// Coefficients of θ.
    #[inline(always)]
    pub fn rotation(&self) -> &[S] {
        &self.motion.rotation[..self.terms.min(N)]
    }

    /// Coefficients of θ̇.
    #[inline(always)]
    pub fn velocity(&self) -> &[S] {
        &self.motion.velocity[..self.terms.min(N) - 1]
    }

    /// Coefficients of θ̈.
    #[inline(always)]
    pub fn acceleration(&self) -> &[S] {
        &self.motion.acceleration[..self.terms.min(N) - 2]
    }

    /// The motion at `time` after the start.
    #[inline(always)]
    pub fn at(&self, time: S) -> Motion<S> {
        let MotionSeries { rotation, velocity, acceleration } = &self.motion;
        if time == S::ZERO {
            return Motion { rotation: rotation[0], velocity: velocity[0], acceleration: acceleration[0] };
        }
        Motion {
            rotation: polynomial::value(self.rotation(), time),
            velocity: polynomial::value(self.velocity(), time),
            acceleration: polynomial::value(self.acceleration(), time),
        }
    }

    /// Shortens the step until a term of `order` with this `coefficient` (0 or more) stays below `tolerance`; called for the last two
    /// terms (Jorba and Zou's two-term rule).
    #[inline(always)]
    pub fn shorten(&mut self, order: usize, coefficient: S, tolerance: S) {
        if coefficient != S::ZERO {
            let ratio = (tolerance / coefficient).larger(S::SMALLEST);
            self.length = self.length.smaller(ratio.rough_power(S::of(RECIPROCALS[order & 63])) * S::of(0.95));
        }
    }
}

/// Where a series may break off before its last coefficient: two small terms in a row (every other one may vanish by symmetry) leave
/// nothing that matters behind them, unless the ground's own series continues: at resonance it cancels against the block's for an order
/// or two.
#[derive(Clone, Copy, Debug)]
pub struct Truncation<S> {
    length: S,
    tolerance: S,
    /// length^k.
    pub power: S,
    previous: S,
}

impl<S: Real> Truncation<S> {
    /// For a step of `length` (s), where terms below `tolerance` (rad) do not matter.
    #[inline(always)]
    pub fn new(length: S, tolerance: S) -> Self {
        Truncation { length, tolerance, power: S::ONE, previous: S::ONE }
    }

    /// The larger term of θ_{k+2} and of a coefficient k of the ground.
    #[inline(always)]
    pub fn term(&self, rotation: S, ground: S) -> S {
        (rotation * (self.power * self.length * self.length)).abs().larger((ground * self.power).abs())
    }

    /// Whether the series may end with order k, whose largest term is `term`.
    #[inline(always)]
    pub fn ends_at(&mut self, k: usize, term: S) -> bool {
        let ends = k >= 3 && term <= self.tolerance && self.previous <= self.tolerance * S::of(50.0);
        self.previous = term;
        self.power = self.power * self.length;
        ends
    }
}
