//! Sine and cosine in double precision without a branch, for SIMD lanes: the half-angle scheme of
//! [`super::sine32`] with longer polynomials (truncation error below 1e-18).

use super::scalar::Scalar;

/// S(y), ascending.
const SINE: [f64; 8] = [
    -0.041_666_666_666_666_664,
    0.000_520_833_333_333_332_2,
    -3.100_198_412_696_089_7e-6,
    1.076_457_781_998_563_8e-8,
    -2.446_494_884_472_283_4e-11,
    3.920_648_757_925_802_5e-14,
    -4.665_509_214_354_597e-17,
    4.167_853_953_531_493_4e-20,
];
/// C(y), ascending.
const COSINE: [f64; 9] = [
    -0.125,
    0.002_604_166_666_666_666_5,
    -2.170_138_888_888_877_5e-5,
    9.688_120_039_670_565e-8,
    -2.691_144_454_843_071e-10,
    5.096_864_316_106_012e-13,
    -7.001_156_012_496_936e-16,
    7.289_741_347_801_749e-19,
    -5.786_577_975_182_008e-22,
];

/// `low` + `high` y.
#[inline(always)]
fn pair<S: Scalar>(y: S, low: f64, high: f64) -> S {
    S::of(low) + y * S::of(high)
}

/// sin x and 1 − cos x for |x| ≤ π, each lane to 1e-15, the latter of itself.
#[inline(always)]
pub fn sin_versine<S: Scalar>(x: S) -> (S, S) {
    let y = x * x;
    // Pairs shorten the chain of dependent operations.
    let y2 = y * y;
    let sine = pair(y, SINE[2], SINE[3]) + y2 * (pair(y, SINE[4], SINE[5]) + y2 * pair(y, SINE[6], SINE[7]));
    let sine = S::of(SINE[0]) + y * (S::of(SINE[1]) + y * sine);
    let cosine = pair(y, COSINE[6], COSINE[7]) + y2 * S::of(COSINE[8]);
    let cosine = pair(y, COSINE[2], COSINE[3]) + y2 * (pair(y, COSINE[4], COSINE[5]) + y2 * cosine);
    let cosine = S::of(COSINE[0]) + y * (S::of(COSINE[1]) + y * cosine);
    let twice_half_sine = x + x * (y * sine);
    let half_cosine = S::of(1.0) + y * cosine;
    (twice_half_sine * half_cosine, S::of(0.5) * (twice_half_sine * twice_half_sine))
}

/// sin x and cos x for |x| ≤ π, each lane to 1e-15.
#[inline(always)]
pub fn sin_cos<S: Scalar>(x: S) -> (S, S) {
    let (sine, versine) = sin_versine(x);
    (sine, S::of(1.0) - versine)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_libm() {
        let mut worst = 0.0_f64;
        for k in -200_000..=200_000_i32 {
            let x = f64::from(k) * (core::f64::consts::PI / 200_000.0);
            let (sine, cosine) = sin_cos(x);
            let (exact_sine, exact_cosine) = crate::math::sin_cos(x);
            worst = worst.max((sine - exact_sine).abs()).max((cosine - exact_cosine).abs());
        }
        assert!(worst < 1e-15, "worst absolute error {worst:e}");
        for x in [1e-9, 1e-4, 0.3, -2.0] {
            let half = crate::math::sin(0.5 * x);
            assert!((sin_versine(x).1 / (2.0 * half * half) - 1.0).abs() < 1e-15, "{x}");
        }
    }
}
