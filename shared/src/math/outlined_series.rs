//! The power series that a device's equations are written over.
//!
//! A device has many equations, and each is a program of its own: the arithmetic of series is called here, not copied into
//! every one as for ideal devices ([`super::power_series`]).

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::power_series::Node;
use super::scalar::Real;
use super::value::Value;

/// Nodes that the largest device may use.
pub const SLOTS: usize = 136;

/// A quantity of which the coefficients below some order are known.
pub struct Quantity<'t, S, const N: usize>(pub Node<'t, S, N, SLOTS>);

impl<S, const N: usize> Clone for Quantity<'_, S, N> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<S, const N: usize> Copy for Quantity<'_, S, N> {}

impl<S: Real, const N: usize> Add for Quantity<'_, S, N> {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Quantity(self.0 + other.0)
    }
}

impl<S: Real, const N: usize> Sub for Quantity<'_, S, N> {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        Quantity(self.0 - other.0)
    }
}

impl<S: Real, const N: usize> Neg for Quantity<'_, S, N> {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Quantity(-self.0)
    }
}

impl<S: Real, const N: usize> Mul for Quantity<'_, S, N> {
    type Output = Self;

    #[inline(never)]
    fn mul(self, other: Self) -> Self {
        Quantity(self.0 * other.0)
    }
}

impl<S: Real, const N: usize> Div for Quantity<'_, S, N> {
    type Output = Self;

    #[inline(never)]
    fn div(self, other: Self) -> Self {
        Quantity(self.0 / other.0)
    }
}

impl<S: Real, const N: usize> Value<S> for Quantity<'_, S, N> {
    #[inline]
    fn scale(self, factor: S) -> Self {
        Quantity(self.0.scale(factor))
    }

    #[inline]
    fn offset(self, term: S) -> Self {
        Quantity(self.0.offset(term))
    }

    #[inline(never)]
    fn square(self) -> Self {
        Quantity(self.0.square())
    }

    #[inline(never)]
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.0.sin_cos();
        (Quantity(sine), Quantity(cosine))
    }
}
