//! When a block at rest starts to rock, and to which side.

use crate::clutch::Clutch;
use crate::equation::Equation;
use crate::ground::Piece;
use crate::polynomial::first_zero_of;
use crate::rocking::{Phase, State, System};
use crate::scalar::{Real, Sign};

impl<S: Real, R: Equation<S>, E: Equation<S>, C: Clutch> System<S, R, E, C> {
    /// First instant in [`from`, `to`) at which the ground pushes harder than the weight holds, and whether it gets
    /// there by crossing the threshold (so that the bracket is zero) or by a jump.
    pub(super) fn uplift_time<P: Piece<S>>(&self, piece: &P, from: S, to: S) -> Option<(S, bool)> {
        if piece.acceleration(from).abs() > self.uplift {
            return Some((from, false));
        }
        let end = piece.acceleration(to);
        let crossing = |sign: Sign| {
            first_zero_of(
                |t| (sign.times(piece.acceleration(t)) - self.uplift, sign.times(piece.slope(t))),
                piece.curvature_bound(),
                (from, to, sign.times(end) - self.uplift),
                Sign::Negative,
                false,
            )
        };
        let positive = crossing(Sign::Positive);
        let negative = crossing(Sign::Negative);
        let first = match (positive, negative) {
            (Some(a), Some(b)) => Some(a.smaller(b)),
            (a, b) => a.or(b),
        };
        // What the clock cannot tell from the end of the piece is left to the next one.
        first.filter(|&t| to - t > to * S::EPSILON * S::of(4.0)).map(|t| (t, true))
    }

    /// Sets the block in motion, to the side opposite to the push.
    pub(super) fn uplift(&self, state: &mut State<S>, ground: S, crossing: bool) {
        let side = Sign::of(ground, Sign::Positive).opposite();
        *state = State {
            phase: Phase::Rocking,
            side,
            direction: side,
            push: side,
            drive: side,
            push_is_zero: crossing,
            impacts: state.impacts,
            ..State::default()
        };
    }
}
