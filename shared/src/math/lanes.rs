//! Several independent blocks in one value, for the registers of a wide machine.

use core::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

use super::scalar::Scalar;
use super::wide_sine;

/// `N` (1, 2, 4, 8 or 16) numbers that go through the same arithmetic, lane by lane. A plain array: the compiler turns operations on it into
/// SIMD for the machine it builds for, and the bits of a lane do not depend on its width or its
/// neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct Lanes<S, const N: usize>(pub [S; N]);

/// One answer for every lane, as registers hold what they compare to and choose by: all bits or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(align(64))]
pub struct LaneMask<const N: usize>([u64; N]);

impl<const N: usize> LaneMask<N> {
    /// Yes everywhere.
    pub const ALL: Self = LaneMask([u64::MAX; N]);
    /// No everywhere.
    pub const NONE: Self = LaneMask([0; N]);

    /// The answer of `lane` (below `N`).
    #[inline(always)]
    pub fn at(&self, lane: usize) -> bool {
        self.0[lane] != 0
    }

    /// Changes the answer of `lane` (below `N`).
    #[inline(always)]
    pub fn set(&mut self, lane: usize, answer: bool) {
        self.0[lane] = all_or_none(answer);
    }
}

#[inline(always)]
fn all_or_none(answer: bool) -> u64 {
    if answer { u64::MAX } else { 0 }
}

#[inline(always)]
fn chosen(mask: u64, yes: f64, no: f64) -> f64 {
    f64::from_bits((mask & yes.to_bits()) | (!mask & no.to_bits()))
}

/// An operation on every lane. Written out, not as a loop or a closure: those are inlined or not as the compiler sees fit, and registers
/// are filled only where they are.
macro_rules! operator {
    ($lanes:ty, $operator:ident, $method:ident, $($lane:literal)+) => {
        impl $operator for $lanes {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self([$(self.0[$lane].$method(other.0[$lane])),+])
            }
        }
    };
}

macro_rules! lanes {
    ($n:literal: $($lane:literal)+) => {
        operator!(Lanes<f64, $n>, Add, add, $($lane)+);
        operator!(Lanes<f64, $n>, Sub, sub, $($lane)+);
        operator!(Lanes<f64, $n>, Mul, mul, $($lane)+);
        operator!(Lanes<f64, $n>, Div, div, $($lane)+);
        operator!(LaneMask<$n>, BitAnd, bitand, $($lane)+);
        operator!(LaneMask<$n>, BitOr, bitor, $($lane)+);
        operator!(LaneMask<$n>, BitXor, bitxor, $($lane)+);

        impl Default for Lanes<f64, $n> {
            fn default() -> Self {
                Lanes([0.0; $n])
            }
        }

        impl Neg for Lanes<f64, $n> {
            type Output = Self;

            #[inline(always)]
            fn neg(self) -> Self {
                Lanes([$(-self.0[$lane]),+])
            }
        }

        impl Not for LaneMask<$n> {
            type Output = Self;

            #[inline(always)]
            fn not(self) -> Self {
                LaneMask([$(!self.0[$lane]),+])
            }
        }

        impl LaneMask<$n> {
            /// Whether any lane says yes.
            #[inline(always)]
            pub fn any(self) -> bool {
                (0 $(| self.0[$lane])+) != 0
            }

            /// `yes` where it holds, `no` elsewhere.
            #[inline(always)]
            pub fn choose(self, yes: Lanes<f64, $n>, no: Lanes<f64, $n>) -> Lanes<f64, $n> {
                Lanes([$(chosen(self.0[$lane], yes.0[$lane], no.0[$lane])),+])
            }

            /// +1 where it holds, −1 elsewhere.
            #[inline(always)]
            pub fn sign(self) -> Lanes<f64, $n> {
                self.choose(Lanes([1.0; $n]), Lanes([-1.0; $n]))
            }
        }

        impl Lanes<f64, $n> {
            /// The larger of two numbers (neither NaN), lane by lane.
            #[inline(always)]
            pub fn larger(self, other: Self) -> Self {
                Lanes([$(if self.0[$lane] > other.0[$lane] { self.0[$lane] } else { other.0[$lane] }),+])
            }

            /// The smaller of two numbers (neither NaN), lane by lane.
            #[inline(always)]
            pub fn smaller(self, other: Self) -> Self {
                Lanes([$(if self.0[$lane] < other.0[$lane] { self.0[$lane] } else { other.0[$lane] }),+])
            }
        }

        impl Scalar for Lanes<f64, $n> {
            type Mask = LaneMask<$n>;

            #[inline(always)]
            fn of(value: f64) -> Self {
                Lanes([value; $n])
            }

            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                // libm branches, so it cannot fill a register; this polynomial does not.
                wide_sine::sin_cos(self)
            }

            #[inline(always)]
            fn abs(self) -> Self {
                Lanes([$(Scalar::abs(self.0[$lane])),+])
            }

            #[inline(always)]
            fn exceeds(self, other: Self) -> LaneMask<$n> {
                LaneMask([$(all_or_none(self.0[$lane] > other.0[$lane])),+])
            }

            #[inline(always)]
            fn select(mask: LaneMask<$n>, yes: Self, no: Self) -> Self {
                mask.choose(yes, no)
            }
        }
    };
}

lanes!(1: 0);
lanes!(2: 0 1);
lanes!(4: 0 1 2 3);
lanes!(8: 0 1 2 3 4 5 6 7);
lanes!(16: 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_choose_each_for_itself() {
        let (a, b) = (Lanes([1.0, -2.0, f64::INFINITY, 0.0]), Lanes([0.5, 3.0, 7.0, -0.0]));
        let mask = a.exceeds(b);
        assert_eq!([0, 1, 2, 3].map(|lane| mask.at(lane)), [true, false, true, false]);
        assert_eq!(mask.choose(a, b), Lanes([1.0, 3.0, f64::INFINITY, -0.0]));
        assert_eq!(mask.choose(a, b).0[3].to_bits(), (-0.0_f64).to_bits());
        assert_eq!(mask.sign(), Lanes([1.0, -1.0, 1.0, -1.0]));
        assert_eq!((a.larger(b), a.smaller(b)), (Lanes([1.0, 3.0, f64::INFINITY, -0.0]), Lanes([0.5, -2.0, 7.0, -0.0])));
        assert!(!Lanes([f64::NAN]).exceeds(Lanes([0.0])).any());
    }

    #[test]
    fn answers_combine() {
        let mut mask = LaneMask::<4>::NONE;
        assert!(!mask.any());
        mask.set(1, true);
        assert!(mask.any() && mask.at(1) && !mask.at(0));
        assert_eq!(!mask | mask, LaneMask::ALL);
        assert_eq!(mask & !mask, LaneMask::NONE);
        assert_eq!(mask ^ LaneMask::ALL, !mask);
        mask.set(1, false);
        assert_eq!(mask, LaneMask::NONE);
    }
}
