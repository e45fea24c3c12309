//! Several independent blocks in one value, for the registers of a wide machine.

use core::array::from_fn;
use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::math::wide_sine;
use crate::scalar::Scalar;

/// `N` numbers that go through the same arithmetic, lane by lane. A plain array: the compiler turns the loops into
/// SIMD for whatever machine it is told to build for, and the bits of a lane do not depend on its width or its
/// neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct Lanes<S, const N: usize>(pub [S; N]);

macro_rules! lane_operator {
    ($operator:ident, $method:ident) => {
        impl<S: Scalar, const N: usize> $operator for Lanes<S, N> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Lanes(from_fn(|lane| self.0[lane].$method(other.0[lane])))
            }
        }
    };
}

lane_operator!(Add, add);
lane_operator!(Sub, sub);
lane_operator!(Mul, mul);
lane_operator!(Div, div);

impl<S: Scalar, const N: usize> Neg for Lanes<S, N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Lanes(from_fn(|lane| -self.0[lane]))
    }
}

impl<const N: usize> Scalar for Lanes<f64, N> {
    type Mask = [bool; N];

    #[inline(always)]
    fn of(value: f64) -> Self {
        Lanes([value; N])
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        // libm branches, so it cannot fill a register; this polynomial does not.
        wide_sine::sin_cos(self)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Lanes(from_fn(|lane| Scalar::abs(self.0[lane])))
    }

    #[inline(always)]
    fn exceeds(self, other: Self) -> [bool; N] {
        from_fn(|lane| self.0[lane] > other.0[lane])
    }

    #[inline(always)]
    fn select(mask: [bool; N], yes: Self, no: Self) -> Self {
        Lanes(from_fn(|lane| if mask[lane] { yes.0[lane] } else { no.0[lane] }))
    }
}
