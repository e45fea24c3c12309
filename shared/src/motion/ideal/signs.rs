//! The signs that are part of a block's state, read anew where the ground or the equation may have jumped.

use super::IdealSystem;
use crate::equation::Equation;
use crate::equation::any_equation::AnyEquation;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::method::dense_output::DenseOutput;
use crate::motion::state::BlockState;

impl<S: Real> IdealSystem<S> {
    /// At the start of a ground segment the ground may have jumped, and the signs with it. True when the clutch follows, so that
    /// another equation is in force. Rare enough not to be copied into every loop.
    #[inline(never)]
    pub(super) fn jumped<A: DenseOutput<S>>(
        &self,
        equation: &AnyEquation<S>,
        state: &mut BlockState<S>,
        output: &A,
        separate_terminal_sign: bool,
    ) -> bool {
        let start = output.at(S::ZERO);
        let before = self.clutch.engages(state.direction, state.terminal_acceleration_sign);
        let (side, rotation, velocity) = (state.side.unit(), state.rotation, state.velocity);
        state.acceleration_sign = beyond_rounding(start.acceleration, state.acceleration_sign, || {
            equation.acceleration(side, rotation, velocity, S::ZERO)
        });
        state.terminal_acceleration_sign = if separate_terminal_sign {
            beyond_rounding(output.switching(S::ZERO), state.terminal_acceleration_sign, || {
                equation.switching(side, rotation, velocity, S::ZERO)
            })
        } else {
            state.acceleration_sign
        };
        if start.velocity == S::ZERO {
            state.direction = state.acceleration_sign;
        }
        self.clutch.follows_signs() && before != self.clutch.engages(state.direction, state.terminal_acceleration_sign)
    }

    /// Signs of θ̈ and of the terminals' acceleration from the equations.
    #[inline(never)]
    pub(super) fn read_signs(&self, state: &mut BlockState<S>, ground: S) {
        let inward = state.side.opposite();
        state.terminal_acceleration_sign =
            Sign::of(self.engaged.switching(state.side.unit(), state.rotation, state.velocity, ground), inward);
        self.read_acceleration_sign(state, ground);
        state.acceleration_is_zero = false;
    }

    #[inline(never)]
    pub(super) fn read_acceleration_sign(&self, state: &mut BlockState<S>, ground: S) {
        let side = state.side.unit();
        let equation = self.equation(state.direction, state.terminal_acceleration_sign);
        let acceleration = equation.acceleration(side, state.rotation, state.velocity, ground);
        state.acceleration_sign = Sign::of(acceleration, state.side.opposite());
    }
}

/// The sign of `value`, whose part without the ground is `quiet`; the `known` one where the two parts cancel to rounding, because
/// that is where an event at the end of the last ground segment has left it.
fn beyond_rounding<S: Real>(value: S, known: Sign, quiet: impl FnOnce() -> S) -> Sign {
    let sign = Sign::of(value, known);
    if sign == known {
        return known;
    }
    let quiet = quiet();
    let size = (value - quiet).abs() + quiet.abs();
    if value.abs() <= size * S::EPSILON * S::of(32.0) { known } else { sign }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sign_changes_beyond_rounding_only() {
        // −1 + (1 + 4 ε): the two parts cancel.
        let left = 4.0 * f64::EPSILON;
        assert_eq!(beyond_rounding(left, Sign::Negative, || -1.0), Sign::Negative);
        assert_eq!(beyond_rounding(left, Sign::Positive, || -1.0), Sign::Positive);
        assert_eq!(beyond_rounding(1e-12, Sign::Negative, || -1.0), Sign::Positive);
        // Without a ground motion nothing cancels, however small it is.
        assert_eq!(beyond_rounding(-1e-300, Sign::Positive, || -1e-300), Sign::Negative);
        assert_eq!(beyond_rounding(0.0, Sign::Negative, || 0.0), Sign::Negative);
    }
}
