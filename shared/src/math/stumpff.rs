//! Stumpff functions: cosine and sine, circular and hyperbolic alike, without the terms that cancel in a short step.
//!
//! c_k(z) = Σ_j (−z)^j / (k + 2j)!, so that with z = x²
//!
//! c₂(x²) = (1 − cos x)/x²,  c₃(x²) = (x − sin x)/x³,  c₂(−x²) = (cosh x − 1)/x²,  c₃(−x²) = (sinh x − x)/x³,
//!
//! and cos x = 1 − z c₂, sin x = x (1 − z c₃) (Stumpff 1959; Danby, *Fundamentals of Celestial Mechanics*, 1988, § 6.9).
//! What a linear oscillator does over a time τ is a polynomial in τ with these as coefficients, and as exact for a step of
//! 1e-9 of a period as for a whole one. They need no square root for short steps.

use super::scalar::Real;

/// 1/(first + 2j)!.
pub(super) const fn reciprocal_factorials<const N: usize>(first: usize) -> [f64; N] {
    let mut table = [0.0; N];
    let (mut j, mut k, mut factorial) = (0, 1, 1.0);
    while j < N {
        while k <= first + 2 * j {
            factorial *= k as f64;
            k += 1;
        }
        table[j] = 1.0 / factorial;
        j += 1;
    }
    table
}

const SECOND: [f64; 9] = reciprocal_factorials(2);
const THIRD: [f64; 9] = reciprocal_factorials(3);

/// c₂(z) and c₃(z) for |z| ≤ 1, to a unit in the last place.
#[inline]
fn series<S: Real>(z: S) -> (S, S) {
    let (mut c2, mut c3) = (S::ZERO, S::ZERO);
    for j in (0..S::STUMPFF_TERMS).rev() {
        c2 = S::of(SECOND[j]) - z * c2;
        c3 = S::of(THIRD[j]) - z * c3;
    }
    (c2, c3)
}

/// c₂(z) and c₃(z) for any z, to a few units in the last place (at z far above 1 c₂ has the absolute error of a cosine). Below −z = x²
/// they grow as e^x/(2x²) and e^x/(2x³), and overflow with e^x.
#[inline]
pub fn c2_c3<S: Real>(z: S) -> (S, S) {
    if z.abs() <= S::ONE {
        series(z)
    } else if z > S::ZERO {
        let x = z.square_root();
        let (sine, cosine) = x.sin_cos_of_phase();
        ((S::ONE - cosine) / z, (x - sine) / (x * z))
    } else {
        let x = (-z).square_root();
        let growth = x.exp();
        let decay = S::ONE / growth;
        ((S::HALF * (growth + decay) - S::ONE) / -z, (S::HALF * (growth - decay) - x) / (x * -z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{cosh, exp, ln, sin_cos, sinh};

    /// Largest relative error of c₂ and c₃ against double precision.
    fn against(z: f64, (exact_c2, exact_c3): (f64, f64)) -> [f64; 2] {
        let error = |found: f64, exact: f64| (found / exact - 1.0).abs();
        let (c2, c3) = c2_c3(z);
        let (single_c2, single_c3) = c2_c3(z as f32);
        // The function of the z that f32 has.
        let (rounded_c2, rounded_c3) = c2_c3(f64::from(z as f32));
        [
            error(c2, exact_c2).max(error(c3, exact_c3)),
            error(f64::from(single_c2), rounded_c2).max(error(f64::from(single_c3), rounded_c3)),
        ]
    }

    #[test]
    fn they_are_what_is_left_of_sines_and_cosines() {
        let (mut double, mut single) = (0.0_f64, 0.0_f64);
        for k in 0..=4000 {
            // From 0.3 on nothing much cancels.
            let x = 0.3 * exp(f64::from(k) * (ln(60.0) / 4000.0));
            let z = x * x;
            let (sine, cosine) = sin_cos(x);
            let grows = ((cosh(x) - 1.0) / z, (sinh(x) - x) / (x * z));
            let turns = ((1.0 - cosine) / z, (x - sine) / (x * z));
            for [of_double, of_single] in [against(-z, grows), if x < 3.0 { against(z, turns) } else { [0.0; 2] }] {
                (double, single) = (double.max(of_double), single.max(of_single));
            }
        }
        // 1 − sin x/x loses six bits at x = 0.3, in the comparison, not in the series.
        assert!(double < 1e-14 && single < 3e-6, "{double:e} {single:e}");
    }

    #[test]
    fn nothing_cancels_in_a_short_step() {
        for k in 1..300 {
            let z = exp(-0.1 * f64::from(k));
            for z in [z, -z] {
                // c₂ = 1/2 − z/24 + z²/720 − …, summed in the other order.
                let (mut c2, mut c3, mut term) = (0.0, 0.0, 1.0);
                for j in 0..12 {
                    c2 += term / ((2 * j + 1) * (2 * j + 2)) as f64;
                    c3 += term / ((2 * j + 1) * (2 * j + 2) * (2 * j + 3)) as f64;
                    term *= -z / ((2 * j + 1) * (2 * j + 2)) as f64;
                }
                let [double, single] = against(z, (c2, c3));
                assert!(double < 5e-16 && single < 2.5e-7, "{z}: {double:e} {single:e}");
            }
        }
        assert_eq!(c2_c3(0.0_f64), (0.5, 1.0 / 6.0));
        assert_eq!(c2_c3(0.0_f32), (0.5, 1.0 / 6.0));
    }

    #[test]
    fn nothing_jumps_where_the_formula_changes() {
        for z in [1.0_f64, -1.0] {
            let (inside, outside) = (c2_c3(z), c2_c3(z * (1.0 + 1e-15)));
            assert!((inside.0 - outside.0).abs() < 1e-15 && (inside.1 - outside.1).abs() < 1e-15);
            let (inside, outside) = (c2_c3(z as f32), c2_c3(z as f32 * (1.0 + 2e-7)));
            assert!((inside.0 - outside.0).abs() < 3e-7 && (inside.1 - outside.1).abs() < 3e-7);
        }
    }
}
