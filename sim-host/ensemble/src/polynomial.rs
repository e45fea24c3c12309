//! Values, zeros and extremes of a step's series, of several blocks at once.
//!
//! As [`sprag_shared::math::polynomial`], but where that one halves an interval until its zeros are isolated, these lanes use what the
//! coefficients show ([`shape`]); the rest is done by shorter steps or by the core.

use std::array::from_fn;

use sprag_shared::math::polynomial::{curvature_bound, largest_magnitude};
pub use sprag_shared::math::polynomial::{value, value_and_slope};
use sprag_shared::math::scalar::Scalar;

use crate::{Mask, Number, number};

/// Square root, exact to rounding as IEEE has it.
#[inline(always)]
fn root_of(x: Number) -> Number {
    let mut root = x;
    for value in &mut root.0 {
        *value = value.sqrt();
    }
    root
}

/// By how much t^k at most departs from its chord on [0, 1]: (1 − 1/k) k^{−1/(k−1)}, rounded up.
const SAG: [f64; 32] = [
    0.0, 0.0, 0.2501, 0.3850, 0.4725, 0.5350, 0.5824, 0.6198, 0.6502, 0.6754, 0.6969, 0.7154, 0.7315, 0.7457, 0.7583, 0.7696,
    0.7798, 0.7891, 0.7975, 0.8052, 0.8124, 0.8190, 0.8251, 0.8308, 0.8361, 0.8411, 0.8458, 0.8502, 0.8543, 0.8582, 0.8619,
    0.8655,
];

/// What is known of a polynomial on [0, t] without looking inside.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// Value of the polynomial at t.
    pub end: Number,
    /// It has no extreme in between.
    pub monotone: Mask,
    /// Its second derivative has no zero in between.
    pub bent: Mask,
    /// Its third derivative has none.
    pub twisted: Mask,
    /// How far it departs from its chord at most.
    pub sag: Number,
}

/// The [`Shape`] of Σ c_k t^k on [0, `time`].
#[inline(always)]
pub fn shape(coefficients: &[Number], time: Number) -> Shape {
    let zero = number(0.0);
    let (mut end, mut sag, mut slope, mut curvature, mut twist) = (zero, zero, zero, zero, zero);
    for (k, &c) in coefficients.iter().enumerate().skip(4).rev() {
        let size = c.abs();
        let k_number = k as f64;
        end = end * time + c;
        sag = sag * time + size * number(SAG[k & 31]);
        slope = slope * time + size * number(k_number);
        curvature = curvature * time + size * number(k_number * (k_number - 1.0));
        twist = twist * time + size * number(k_number * (k_number - 1.0) * (k_number - 2.0));
    }
    let none = Mask::NONE;
    let [c0, c1, c2, c3, ..] = coefficients else { return Shape { end, monotone: none, bent: none, twisted: none, sag } };
    let size = c3.abs();
    let twisted = (size * number(6.0)).exceeds(twist * time);
    end = end * time + *c3;
    sag = sag * time + size * number(SAG[3]);
    slope = slope * time + size * number(3.0);
    curvature = curvature * time + size * number(6.0);
    let size = c2.abs();
    end = ((end * time + *c2) * time + *c1) * time + *c0;
    sag = (sag * time + size * number(SAG[2])) * (time * time);
    slope = (slope * time + size * number(2.0)) * time;
    let monotone = c1.abs().exceeds(slope);
    let bent = (size * number(2.0)).exceeds(curvature * time);
    Shape { end, monotone, bent, twisted, sag }
}

/// The zero in (0, `high`] of polynomials with the sign of `before` at 0 and, where `wanted`, another at `high`, where it is the only
/// one; `high` elsewhere. Newton steps in a bracket that always shrinks.
#[inline(always)]
pub fn zero(coefficients: &[Number], before: Number, end: Number, high: Number, wanted: Mask) -> Number {
    let (mut low, mut top) = (number(0.0), high);
    // The first zero of the parabola with the start's value and slope and the end's value.
    let (start, slope) = (coefficients[0] * before, coefficients[1] * before * high);
    let bend = end * before - start - slope;
    let discriminant = slope * slope - number(4.0) * bend * start;
    let share = (start + start) / (root_of(discriminant.larger(number(0.0))) - slope + number(1e-300));
    let inside = share.exceeds(number(1e-6)) & number(1.0).exceeds(share);
    let mut x = wanted.choose(high * inside.choose(share, number(0.5)), high);
    let mut open = wanted;
    for _ in 0..60 {
        let (value, slope) = value_and_slope(coefficients, x);
        let still_before = (value * before).exceeds(number(0.0));
        low = still_before.choose(x, low);
        top = still_before.choose(top, x);
        let newton = x - value / slope;
        let inside = newton.exceeds(low) & top.exceeds(newton);
        let middle = number(0.5) * (low + top);
        let change = (newton - x).abs();
        // A change below the last bit may leave the bracket; after one below 1e-9 Newton's next error is about its square.
        let last_bit = number(2.3e-16) * x;
        let next = (inside | !change.exceeds(last_bit)).choose(newton, middle);
        let done = (inside & !change.exceeds(number(1e-9) * x)) | !change.exceeds(last_bit) | !(top - low).exceeds(last_bit);
        x = open.choose(next, x);
        open = open & !done;
        if !open.any() {
            break;
        }
    }
    x
}

/// The value of polynomials at their only extreme in (0, `end`), where `wanted`; their slopes at both ends are given and differ in sign.
#[inline(always)]
pub fn extreme(coefficients: &[Number], slopes: (Number, Number), end: Number, wanted: Mask) -> Number {
    let nothing = number(0.0);
    let (mut low, mut top) = (nothing, end);
    let mut x = end * (slopes.0 / (slopes.0 - slopes.1));
    let mut found = nothing;
    let mut open = wanted;
    for _ in 0..40 {
        let (mut value, mut slope, mut half_curvature) = (nothing, nothing, nothing);
        for &c in coefficients.iter().rev() {
            half_curvature = half_curvature * x + slope;
            slope = slope * x + value;
            value = value * x + c;
        }
        let before = (slope * slopes.0).exceeds(nothing);
        low = before.choose(x, low);
        top = before.choose(top, x);
        let change = slope / (half_curvature + half_curvature);
        let newton = x - change;
        let inside = newton.exceeds(low) & top.exceeds(newton);
        // At an extreme the value's error is the square of the time's.
        let near = !change.abs().exceeds(number(1e-6) * end);
        found = open.choose(value - change * (slope - half_curvature * change), found);
        x = inside.choose(newton, number(0.5) * (low + top));
        open = open & !(near | !(top - low).exceeds(number(1e-9) * end));
        if !open.any() {
            break;
        }
    }
    found
}

/// The larger of `known` and the largest magnitude of one lane's polynomial, of at most `N` coefficients, up to `end` (time, value), by the core's
/// search.
#[inline(never)]
pub fn largest_in_lane<const N: usize>(coefficients: &[Number], lane: usize, end: (f64, f64), known: f64) -> f64 {
    let own: [f64; N] = from_fn(|k| coefficients.get(k).map_or(0.0, |c| c.0[lane]));
    largest_magnitude(&own, curvature_bound(&own, end.0), (0.0, own[0]), end, known)
}
