//! Number types that the equations are written over: f32, f64 and [`super::lanes::Lanes`] of them.
//!
//! Arithmetic is plain IEEE addition, multiplication and division in the order written; nothing here fuses or
//! reassociates, which is why a run gives the same bits on every machine.

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// What an equation of motion and a branch-free stepper need of a number.
pub trait Scalar:
    Copy + Debug + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self> + 'static
{
    /// The result of a comparison: `bool`, or one per lane.
    type Mask: Copy;

    /// The constant nearest to `value`.
    fn of(value: f64) -> Self;

    /// Sine and cosine of an angle with |x| ≤ π (rad): a block never turns further.
    fn sin_cos(self) -> (Self, Self);

    /// Absolute value.
    fn abs(self) -> Self;

    /// Mask of the lanes where `self > other`.
    fn exceeds(self, other: Self) -> Self::Mask;

    /// `yes` where the mask holds, `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
}

/// A single number that may steer control flow: f32 or f64.
pub trait Real: Scalar<Mask = bool> + PartialOrd + Default {
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// 1/2.
    const HALF: Self;
    /// Distance from 1 to the next number.
    const EPSILON: Self;
    /// Smallest number with all its digits (below it they are denormal).
    const SMALLEST: Self;
    /// Terms of the series of Stumpff's c₂ and c₃ ([`super::stumpff`]) for |z| ≤ 1.
    const STUMPFF_TERMS: usize;

    /// Sine and cosine of any phase (rad); accurate to rounding for |x| up to a few thousand turns.
    fn sin_cos_of_phase(self) -> (Self, Self);

    /// e^x.
    fn exp(self) -> Self;

    /// Square root; NaN below 0.
    fn square_root(self) -> Self;

    /// The whole number `count` (exact up to 2²⁴ in f32, 2⁵³ in f64).
    fn count(count: u32) -> Self;

    /// `self` to the `exponent` to about 7 %, for choosing step sizes only; `self` positive and finite.
    fn rough_power(self, exponent: Self) -> Self;

    /// The number as f64, exactly.
    fn to_f64(self) -> f64;

    /// Its bits, for digests; f32 in the low half.
    fn bits(self) -> u64;

    /// False for NaN and infinities.
    fn is_finite(self) -> bool;

    /// The larger of two numbers (neither NaN).
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        if other > self { other } else { self }
    }

    /// The smaller of two numbers (neither NaN).
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        if other < self { other } else { self }
    }
}

macro_rules! single_number {
    ($number:ty, $bits:ty, $signed:ty, $one_bits:expr, $sin_cos:path, $phase:path, $exp:path, $sqrt:path, $stumpff_terms:literal) => {
        impl Scalar for $number {
            type Mask = bool;

            #[inline(always)]
            fn of(value: f64) -> Self {
                value as $number
            }

            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                $sin_cos(self)
            }

            #[inline(always)]
            fn abs(self) -> Self {
                <$number>::from_bits(self.to_bits() & (<$bits>::MAX >> 1))
            }

            #[inline(always)]
            fn exceeds(self, other: Self) -> bool {
                self > other
            }

            #[inline(always)]
            fn select(mask: bool, yes: Self, no: Self) -> Self {
                if mask { yes } else { no }
            }
        }

        impl Real for $number {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const HALF: Self = 0.5;
            const EPSILON: Self = <$number>::EPSILON;
            const SMALLEST: Self = <$number>::MIN_POSITIVE;
            const STUMPFF_TERMS: usize = $stumpff_terms;

            #[inline]
            fn sin_cos_of_phase(self) -> (Self, Self) {
                $phase(self)
            }

            #[inline]
            fn exp(self) -> Self {
                $exp(self)
            }

            #[inline]
            fn square_root(self) -> Self {
                $sqrt(self)
            }

            #[inline(always)]
            fn count(count: u32) -> Self {
                count as $number
            }

            #[inline]
            fn rough_power(self, exponent: Self) -> Self {
                // Read as an integer, the bits of a float are a piecewise-linear log₂: scaling them is a power.
                const ONE_BITS: $signed = $one_bits;
                let logarithm = (self.to_bits() as $signed - ONE_BITS) as $number;
                <$number>::from_bits(((logarithm * exponent) as $signed + ONE_BITS) as $bits)
            }

            #[inline(always)]
            fn to_f64(self) -> f64 {
                self as f64
            }

            #[inline(always)]
            fn bits(self) -> u64 {
                self.to_bits() as u64
            }

            #[inline(always)]
            fn is_finite(self) -> bool {
                <$number>::is_finite(self)
            }
        }
    };
}

single_number!(
    f32,
    u32,
    i32,
    0x3f80_0000,
    crate::math::sine32::sin_cos,
    crate::math::sine32::sin_cos_of_phase,
    crate::math::exp32,
    crate::math::square_root32,
    5
);
single_number!(
    f64,
    u64,
    i64,
    0x3ff0_0000_0000_0000,
    crate::math::sin_cos,
    crate::math::sin_cos,
    crate::math::exp,
    crate::math::square_root,
    9
);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rough_power_is_close_enough_for_a_step_size() {
        for base in [1e-30_f64, 1e-9, 0.3, 1.0, 7.0, 1e20] {
            for exponent in [1.0 / 22.0, 1.0 / 8.0] {
                let exact = crate::math::pow(base, exponent);
                assert!((base.rough_power(exponent) / exact - 1.0).abs() < 0.07, "{base}^{exponent}");
                let single = (base as f32).rough_power(exponent as f32);
                assert!((f64::from(single) / exact - 1.0).abs() < 0.07, "{base}^{exponent} in f32");
            }
        }
    }
}
