//! The sign of a quantity, kept as a state of its own.

use super::scalar::Real;
use serde::{Deserialize, Serialize};

/// Which way: the sign of a rotation, a velocity or an acceleration, kept as a state of its own so that a value
/// that is zero to rounding never decides anything.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Sign {
    /// About the right-hand toe (Figure 1).
    #[default]
    Positive,
    /// About the left-hand toe.
    Negative,
}

impl Sign {
    /// The sign of `x`; of zero, `otherwise`.
    #[inline(always)]
    pub fn of<S: Real>(x: S, otherwise: Sign) -> Sign {
        if x > S::ZERO {
            Sign::Positive
        } else if x < S::ZERO {
            Sign::Negative
        } else {
            otherwise
        }
    }

    /// The other sign.
    #[inline(always)]
    pub fn opposite(self) -> Sign {
        match self {
            Sign::Positive => Sign::Negative,
            Sign::Negative => Sign::Positive,
        }
    }

    /// ±1.
    #[inline(always)]
    pub fn unit<S: Real>(self) -> S {
        self.times(S::ONE)
    }

    /// `x` or `-x`.
    #[inline(always)]
    pub fn times<S: Real>(self, x: S) -> S {
        match self {
            Sign::Positive => x,
            Sign::Negative => -x,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sign_of_zero_is_the_one_it_was_given() {
        assert_eq!(Sign::of(0.0_f64, Sign::Negative), Sign::Negative);
        assert_eq!(Sign::of(-0.0_f32, Sign::Positive), Sign::Positive);
        assert_eq!(Sign::of(f64::NAN, Sign::Negative), Sign::Negative);
        assert_eq!(Sign::Negative.opposite().times(2.0_f32), 2.0);
    }
}
