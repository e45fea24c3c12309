//! Horizontal and vertical ground motion together.

use crate::ground::GroundSegment;
use crate::math::scalar::Real;

/// Longest step times the fastest rate that it follows: some 60 steps a period.
pub(super) const LONGEST_STEP: f64 = 0.1;

/// Horizontal and vertical ground motion over one ground segment.
#[derive(Clone, Copy)]
pub struct GroundPair<'a, S> {
    /// Horizontal.
    pub horizontal: &'a dyn GroundSegment<S>,
    /// Vertical, if the ground moves so.
    pub vertical: Option<&'a dyn GroundSegment<S>>,
}

impl<S: Real> GroundPair<'_, S> {
    /// ü_g/g and the weight 1 + v̈_g/g at the local time `time` (s).
    pub(super) fn at(&self, time: S) -> [S; 2] {
        let up = self.vertical.map_or(S::ZERO, |vertical| vertical.acceleration(time));
        [self.horizontal.acceleration(time), S::ONE + up]
    }

    /// `step` (s), or the longest that follows the fastest wave of the ground where that is shorter.
    pub(super) fn step(&self, step: S) -> S {
        let up = self.vertical.map_or(S::ZERO, |vertical| vertical.angular_frequency());
        let fastest = self.horizontal.angular_frequency().larger(up);
        if fastest > S::ZERO { step.smaller(S::of(LONGEST_STEP) / fastest) } else { step }
    }
}
