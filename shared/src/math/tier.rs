//! Tiers of the sine: the same equations with another sine, to be timed and judged beside each other.
//!
//! | tier | f32 | f64 | largest absolute error on \[−π, π\] |
//! | --- | --- | --- | --- |
//! | [`Libm`] | libm's, in double precision inside | libm's | 6e-8, 1.2e-16 |
//! | [`OwnPolynomial`] | [`sine32`] | [`wide_sine`] | 5.7e-7, 1e-15 |
//! | [`Micromath`] | micromath's parabola | none | 1.1e-3 |
//!
//! A tier is a type, so a run with one has no trace of the others in its loop. [`Tiered`](super::tiered::Tiered) makes a number of it.

use core::fmt::Debug;

use micromath::F32Ext;

use super::{sine32, wide_sine};

/// Where the sines of a number type come from.
pub trait Tier<S>: Copy + Debug + Default + PartialEq + PartialOrd + Send + Sync + 'static {
    /// Name in tables.
    const NAME: &'static str;

    /// Sine and cosine for |x| ≤ π (rad).
    fn sin_cos(x: S) -> (S, S);

    /// Sine and cosine of any phase (rad), up to ±10,000 in f32 and ±1e6 in f64.
    #[inline]
    fn sin_cos_of_phase(x: S) -> (S, S) {
        Self::sin_cos(x)
    }
}

/// libm: what a Rust program without `std` uses unless it says otherwise. Right to the last bit or the one before it.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct Libm;

/// The project's own polynomials, without a branch or a table.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct OwnPolynomial;

/// The crate micromath: a squared parabola. It is exact at multiples of π/2 and off by up to 1.1e-3 between them (its own
/// documentation promises 2e-3). Its slope is off by up to 1.2 %, at 0, where that makes a block's frequency 0.6 % too low. It removes whole
/// turns from sine and cosine each, which costs a Cortex-M4F more than the own polynomial's longer polynomials.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct Micromath;

impl Tier<f32> for Libm {
    const NAME: &'static str = "libm";

    #[inline]
    fn sin_cos(x: f32) -> (f32, f32) {
        (libm::sinf(x), libm::cosf(x))
    }
}

impl Tier<f64> for Libm {
    const NAME: &'static str = "libm";

    #[inline]
    fn sin_cos(x: f64) -> (f64, f64) {
        super::sin_cos(x)
    }
}

impl Tier<f32> for OwnPolynomial {
    const NAME: &'static str = "own polynomial";

    #[inline(always)]
    fn sin_cos(x: f32) -> (f32, f32) {
        sine32::sin_cos(x)
    }

    #[inline]
    fn sin_cos_of_phase(x: f32) -> (f32, f32) {
        sine32::sin_cos_of_phase(x)
    }
}

impl Tier<f64> for OwnPolynomial {
    const NAME: &'static str = "own polynomial";

    #[inline(always)]
    fn sin_cos(x: f64) -> (f64, f64) {
        wide_sine::sin_cos(x)
    }

    #[inline]
    fn sin_cos_of_phase(x: f64) -> (f64, f64) {
        // 2π in three parts; the products of the first two, of 33 bits each, with a turn count below 2²⁰ are exact.
        const TURN_HIGH: f64 = 6.283_185_306_936_502_5;
        const TURN_MIDDLE: f64 = 2.430_840_202_521_586_4e-10;
        const TURN_LOW: f64 = 8.089_064_995_183_803e-21;
        const PER_RADIAN: f64 = 0.159_154_943_091_895_35;
        let turns = x * PER_RADIAN;
        let whole = f64::from((if turns < 0.0 { turns - 0.5 } else { turns + 0.5 }) as i32);
        wide_sine::sin_cos(((x - whole * TURN_HIGH) - whole * TURN_MIDDLE) - whole * TURN_LOW)
    }
}

impl Tier<f32> for Micromath {
    const NAME: &'static str = "micromath";

    #[inline]
    fn sin_cos(x: f32) -> (f32, f32) {
        // By name: on a host the methods of `std` would come first.
        (F32Ext::sin(x), F32Ext::cos(x))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;

    /// Largest absolute error of sine or cosine at 400,001 angles of [−`reach`, `reach`].
    fn worst(reach: f64, tier: impl Fn(f64) -> (f64, f64, f64)) -> f64 {
        let mut worst = 0.0_f64;
        for k in -200_000..=200_000_i32 {
            let (x, sine, cosine) = tier(f64::from(k) * (reach / 200_000.0));
            let (exact_sine, exact_cosine) = crate::math::sin_cos(x);
            worst = worst.max((sine - exact_sine).abs()).max((cosine - exact_cosine).abs());
        }
        worst
    }

    /// In f32, at the angle that f32 has.
    fn single<T: Tier<f32>>(reach: f64, function: impl Fn(f32) -> (f32, f32)) -> f64 {
        let worst = worst(reach, |x| {
            let x = x as f32;
            let (sine, cosine) = function(x);
            (f64::from(x), f64::from(sine), f64::from(cosine))
        });
        std::println!("{} in f32 on ±{reach:.4}: {worst:.3e}", T::NAME);
        worst
    }

    fn double<T: Tier<f64>>(reach: f64, function: impl Fn(f64) -> (f64, f64)) -> f64 {
        let worst = worst(reach, |x| {
            let (sine, cosine) = function(x);
            (x, sine, cosine)
        });
        std::println!("{} in f64 on ±{reach:.4}: {worst:.3e}", T::NAME);
        worst
    }

    /// Half a unit in the last place of 1 is 3e-8; the own polynomial's bound is proven over every f32 elsewhere.
    #[test]
    fn errors_of_every_tier_over_a_turn() {
        assert!(single::<Libm>(PI, Libm::sin_cos) < 3.1e-8);
        assert!(single::<OwnPolynomial>(PI, OwnPolynomial::sin_cos) < sine32::ERROR_BOUND);
        // libm is what the others are compared with: 0 by construction, and no more is claimed here.
        assert!(double::<Libm>(PI, Libm::sin_cos) == 0.0);
        assert!(double::<OwnPolynomial>(PI, OwnPolynomial::sin_cos) < 1e-15);
        // The best weights of parabola and squared parabola leave ±1.09e-3 (0.225 is the best weight to three digits), so
        // this is the method's own error and not one of rounding: no precision would better it.
        let parabola = single::<Micromath>(PI, Micromath::sin_cos);
        assert!((1.0e-3..1.1e-3).contains(&parabola), "{parabola:e}");
    }

    #[test]
    fn phases_of_many_turns() {
        // The phase itself is exact; removing its turns is what errs.
        assert!(single::<Libm>(1000.0, Libm::sin_cos_of_phase) < 3.1e-8);
        assert!(single::<OwnPolynomial>(1000.0, OwnPolynomial::sin_cos_of_phase) < 1e-6);
        assert!(double::<OwnPolynomial>(1000.0, OwnPolynomial::sin_cos_of_phase) < 1e-15);
        assert!(double::<OwnPolynomial>(1e6, OwnPolynomial::sin_cos_of_phase) < 1e-15);
        // micromath removes turns in f32: the fraction of a turn at 1000 rad is known to 8e-6 of it.
        assert!(single::<Micromath>(1000.0, Micromath::sin_cos_of_phase) < 1.2e-3);
    }

    /// A block's frequency is the slope of its restoring moment: this error is one of the model, and no step makes it smaller.
    #[test]
    fn micromath_has_a_slope_of_its_own() {
        let slope = |x: f32| f64::from(Micromath::sin_cos(x + 0.03).0 - Micromath::sin_cos(x - 0.03).0) / 0.06;
        let worst = (-300..=300_i16)
            .map(|k| f32::from(k) * 0.01)
            .map(|x| (slope(x) - crate::math::cos(f64::from(x))).abs())
            .fold(0.0, f64::max);
        std::println!("largest error of micromath's slope: {worst:.3e}; at 0 it is {:.4}", slope(0.0));
        assert!((0.011..0.013).contains(&worst), "{worst}");
    }
}
