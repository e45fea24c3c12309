//! What the equations of motion are written over: a number, or a power series under construction.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::scalar::Scalar;

/// A quantity in an equation of motion. A plain number implements it, and so does a node of a Taylor tape
/// ([`crate::method::taylor`]), so one source serves every method, precision and lane width.
pub trait Value<S: Scalar>:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// The quantity times a constant.
    fn scale(self, factor: S) -> Self;

    /// The quantity plus a constant.
    fn offset(self, term: S) -> Self;

    /// Square of the value.
    fn square(self) -> Self;

    /// Sine and cosine of an angle (rad), |x| ≤ π.
    fn sin_cos(self) -> (Self, Self);
}

impl<S: Scalar> Value<S> for S {
    #[inline(always)]
    fn scale(self, factor: S) -> S {
        self * factor
    }

    #[inline(always)]
    fn offset(self, term: S) -> S {
        self + term
    }

    #[inline(always)]
    fn square(self) -> S {
        self * self
    }

    #[inline(always)]
    fn sin_cos(self) -> (S, S) {
        Scalar::sin_cos(self)
    }
}
