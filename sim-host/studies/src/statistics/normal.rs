//! The standard normal distribution, to the last digits in both tails.

use std::f64::consts::FRAC_1_SQRT_2;

use sprag_shared::math::{erf, erfc, exp, ln, log1p, square_root};

/// ln √(2π).
const LN_ROOT_TWO_PI: f64 = 0.918_938_533_204_672_8;
/// Where the continued fraction takes over from erfc.
const TAIL: f64 = 5.0;
/// Terms of the continued fraction: from [`TAIL`] on more of them change no bit.
const TERMS: u32 = 60;

/// Density φ(z) = exp(−z²/2)/√(2π), for any z.
pub fn density(z: f64) -> f64 {
    exp(-0.5 * z * z - LN_ROOT_TWO_PI)
}

/// Cumulative distribution Φ(z) = ½ erfc(−z/√2), for any z; relative error below 2e-13 wherever it is a normal number
/// (z > −37).
pub fn cumulative(z: f64) -> f64 {
    0.5 * erfc(-z * FRAC_1_SQRT_2)
}

/// ln Φ(z), for any z, without cancellation; for Φ below the smallest f64 too. Relative error below 1e-14 for z ≤ 5,
/// that of [`cumulative`] above.
///
/// Below −5 with Laplace's continued fraction (Abramowitz and Stegun 26.2.14):
/// ln Φ(−t) = −t²/2 − ln √(2π) − ln(t + 1/(t + 2/(t + 3/(t + …)))).
pub fn ln_cumulative(z: f64) -> f64 {
    if z < -TAIL {
        -0.5 * z * z - LN_ROOT_TWO_PI - ln(excess(-z) - z)
    } else if z < 0.0 {
        ln(cumulative(z))
    } else {
        log1p(-cumulative(-z))
    }
}

/// Derivatives of ln Φ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InverseMills {
    /// The first, m(z) = φ(z)/Φ(z): the inverse Mills ratio.
    pub ratio: f64,
    /// The second with its sign changed, m (m + z), between 0 and 1: ln Φ is concave.
    pub curvature: f64,
}

/// Derivatives of [`ln_cumulative`], for any finite z, without cancellation.
pub fn inverse_mills(z: f64) -> InverseMills {
    if z < -TAIL {
        let excess = excess(-z);
        let ratio = excess - z;
        InverseMills { ratio, curvature: ratio * excess }
    } else {
        let ratio = density(z) / cumulative(z);
        InverseMills { ratio, curvature: ratio * (ratio + z) }
    }
}

/// φ(t)/Φ(−t) − t = 1/(t + 2/(t + 3/(t + …))) for t ≥ [`TAIL`].
fn excess(t: f64) -> f64 {
    1.0 / (2..=TERMS).rev().fold(t, |tail, k| t + f64::from(k) / tail)
}

/// Quantile Φ⁻¹(p) of `probability` p, 0 to 1: −∞ at 0, ∞ at 1, NaN outside. Relative error below 1e-14, next to the median
/// too.
///
/// By Newton's method, on ln Φ for p < ¼ and on erf above, each from a point from which it cannot overshoot.
pub fn quantile(probability: f64) -> f64 {
    if !(0.0..=1.0).contains(&probability) {
        f64::NAN
    } else if probability > 0.5 {
        // Exact in this half.
        -lower_quantile(1.0 - probability)
    } else {
        lower_quantile(probability)
    }
}

fn lower_quantile(probability: f64) -> f64 {
    if probability == 0.0 {
        return f64::NEG_INFINITY;
    }
    if probability >= 0.25 {
        // ½ erf(t/√2) is concave for t > 0, so that every tangent reaches the value before it does.
        let target = 0.5 - probability;
        return -rising(0.0, |t| (target - 0.5 * erf(t * FRAC_1_SQRT_2)) / density(t));
    }
    // ln Φ is concave, and Φ(−t) < ½ exp(−t²/2): below the quantile.
    let target = ln(probability);
    rising(-square_root(-2.0 * target), |z| (target - ln_cumulative(z)) / inverse_mills(z).ratio)
}

/// Where Newton's method ends that rises from `start`: steps of rounding are the first that are not upwards or too small.
fn rising(start: f64, step: impl Fn(f64) -> f64) -> f64 {
    let mut place = start;
    for _ in 0..100 {
        let step = step(place);
        place += step;
        if step <= 4.0 * f64::EPSILON * place.abs() {
            break;
        }
    }
    place
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_2_PI, LN_2};

    use super::*;

    fn close(found: f64, expected: f64, relative: f64) {
        assert!((found - expected).abs() <= relative * expected.abs(), "{found:e} {expected:e} {:e}", found / expected - 1.0);
    }

    /// z, ln Φ(z), φ(z)/Φ(z), m (m + z), by mpmath 1.3 with 50 digits.
    const REFERENCE: [(f64, f64, f64, f64); 13] = [
        (-200.0, -20006.21728089819, 200.00499975003123, 0.999975003749219),
        (-40.0, -804.6084420137538, 40.02496884720726, 0.9993773316214086),
        (-20.0, -203.91715537109727, 20.04975306852785, 0.9975367383849478),
        (-10.0, -53.23128515051247, 10.098093233962512, 0.9905546221743438),
        (-6.0, -20.736768949974707, 6.158482604544599, 0.9760123632108332),
        (-5.0, -15.064998393988725, 5.186503967125842, 0.9673035653828878),
        (-3.0, -6.607726221510349, 3.2830986549304364, 0.9294408132147319),
        (-1.0, -1.8410216450092636, 1.525135276160981, 0.8009023344296512),
        (0.0, -LN_2, 0.7978845608028654, FRAC_2_PI),
        (1.0, -0.17275377902344988, 0.2875999709391784, 0.3703137142233946),
        (5.0, -2.866516129637636e-07, 1.4867199409049056e-06, 7.433601914860711e-06),
        (20.0, -2.7536241186062337e-89, 5.520948362159764e-88, 1.1041896724319527e-86),
        (37.0, -5.725571222524577e-300, 2.1200065515246056e-298, 7.84402424064104e-297),
    ];

    #[test]
    fn logarithms_and_their_derivatives_are_exact_in_the_tails() {
        for (z, logarithm, ratio, curvature) in REFERENCE {
            close(ln_cumulative(z), logarithm, if z > 5.0 { 2e-13 } else { 1e-14 });
            // The rounding of z² counts in what falls like exp(−z²/2).
            close(inverse_mills(z).ratio, ratio, if z > 0.0 { 4e-14 + 1e-16 * z * z } else { 1e-14 });
            close(inverse_mills(z).curvature, curvature, if z > 0.0 { 4e-14 + 1e-16 * z * z } else { 1e-13 });
            if z > -37.0 {
                close(cumulative(z), exp(logarithm), 2e-13);
            }
        }
        // 40² / 2 is 800: Φ is no normal number there, its logarithm is.
        assert_eq!(cumulative(-40.0), 0.0);
        assert_eq!(ln_cumulative(f64::NEG_INFINITY), f64::NEG_INFINITY);
        assert_eq!(ln_cumulative(f64::INFINITY), 0.0);
    }

    #[test]
    fn both_forms_meet() {
        for z in [-TAIL * (1.0 + 1e-15), -TAIL] {
            close(ln_cumulative(z), -15.064998393988725, 1e-14);
            close(inverse_mills(z).ratio, 5.186503967125842, 1e-13);
        }
    }

    #[test]
    fn quantiles_are_those_of_tables_and_undo_the_distribution() {
        // Probability and quantile by mpmath with 50 digits.
        for (probability, expected) in [
            (1e-300, -37.0470962993612),
            (1e-100, -21.273453560965326),
            (1e-20, -9.262340089798407),
            (1e-05, -4.264890793922825),
            (0.01, -2.326347874040841),
            (0.1, -1.2815515655446004),
            (0.2499, -0.67480447011061),
            (0.25, -0.6744897501960817),
            (0.3, -0.5244005127080408),
            (0.49, -0.025068908258711057),
            (0.5000000001, 2.506628482030354e-10),
            (0.8, 0.8416212335729144),
            (0.975, 1.9599639845400538),
            (0.999999, 4.753424308817087),
        ] {
            close(quantile(probability), expected, 2e-15);
        }
        for z in [-30.0, -8.0, -2.0, -0.7, -0.6, -1e-3] {
            close(quantile(cumulative(z)), z, 1e-13);
        }
        assert_eq!(quantile(0.5), 0.0);
        assert_eq!(quantile(0.0), f64::NEG_INFINITY);
        assert_eq!(quantile(1.0), f64::INFINITY);
        assert!(quantile(-1e-9).is_nan() && quantile(1.1).is_nan() && quantile(f64::NAN).is_nan());
    }
}
