//! Uplift of a block at rest: its time and side.

use super::IdealSystem;
use crate::equation::Equation;
use crate::ground::GroundSegment;
use crate::math::polynomial::first_zero_of;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::motion::state::BlockState;

impl<S: Real> IdealSystem<S> {
    /// First instant in [`from`, `to`) at which the ground acceleration exceeds the uplift threshold, and whether it gets
    /// there by crossing the threshold (so that the bracket is zero) or by a jump.
    #[inline(never)]
    pub(super) fn uplift_time(&self, segment: &dyn GroundSegment<S>, from: S, to: S) -> Option<(S, bool)> {
        let start = segment.acceleration(from);
        if self.lifts(start) {
            return Some((from, false));
        }
        // What the equation holds is the threshold, or within rounding of it.
        let threshold = self.uplift.larger(start.abs());
        if start.abs() == threshold && rises(segment, from, start, to - from) > threshold * S::EPSILON {
            // Cut at the very crossing: a search that starts on a zero might take a short excess for a graze.
            return Some((from, true));
        }
        let end = segment.acceleration(to);
        let crossing = |sign: Sign| {
            first_zero_of(
                |t| (sign.times(segment.acceleration(t)) - threshold, sign.times(segment.slope(t))),
                segment.curvature_bound(),
                (from, to, sign.times(end) - threshold),
                Sign::Negative,
                false,
            )
        };
        let first = [Sign::Positive, Sign::Negative].into_iter().filter_map(crossing).reduce(Real::smaller);
        first.filter(|&t| to - t > to * S::EPSILON * S::of(4.0)).map(|t| (t, true))
    }

    /// Whether a ground acceleration of `ground` (in g) uplifts the block: above the threshold by so little that the rounded equation still
    /// gives θ̈ towards the base, it does not, or uplift and impact would follow each other without end.
    #[inline(never)]
    pub(super) fn lifts(&self, ground: S) -> bool {
        let side = Sign::of(ground, Sign::Positive).opposite();
        ground.abs() > self.uplift && side.times(self.released.acceleration(side.unit(), S::ZERO, S::ZERO, ground)) > S::ZERO
    }

    /// Sets the block in motion, to the side opposite to the ground acceleration.
    pub(super) fn uplift(&self, state: &mut BlockState<S>, ground: S, crossing: bool) {
        let side = Sign::of(ground, Sign::Positive).opposite();
        *state = BlockState { acceleration_is_zero: crossing, ..state.uplifted(side) };
    }
}

/// Bound of the growth of a ground acceleration of `start` (in g) over an interval of `length` (s), by its slope and curvature.
#[inline(never)]
fn rises<S: Real>(segment: &dyn GroundSegment<S>, from: S, start: S, length: S) -> S {
    let slope = Sign::of(start, Sign::Positive).times(segment.slope(from));
    if slope <= S::ZERO {
        return S::ZERO;
    }
    let curvature = segment.curvature_bound();
    // Up to a crest that may come before the end.
    let length = if slope < curvature * length { slope / curvature } else { length };
    slope * length
}
