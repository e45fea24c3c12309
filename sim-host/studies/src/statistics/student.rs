//! Student's t distribution for whole degrees of freedom.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2};

use sprag_shared::math::{cos, sin, square_root, tan};

/// The t with A(t|ν) = `probability`, from 0 up to, not including, 1, for `freedom` ν ≥ 1; NaN outside. A(t|ν), the probability
/// that |T| ≤ t, is a finite sum in cos θ with θ = arctan(t/√ν) (Abramowitz and Stegun 26.7.3 and 26.7.4). t is the half-width, in
/// standard errors, of the band that holds with that probability. Relative error below 1e-13 where A is not within 1e-3 of 1,
/// and below 2e-16/(1 − A) beyond.
///
/// By Newton's method for θ from 0: A is concave in it, so no step overshoots.
pub fn central_quantile(probability: f64, freedom: u32) -> f64 {
    if freedom == 0 || !(0.0..1.0).contains(&probability) {
        return f64::NAN;
    }
    let mut angle = 0.0;
    for _ in 0..100 {
        let at = sum(angle, freedom);
        let step = (probability - at.probability) / at.slope;
        angle += step;
        if step <= 2.0 * f64::EPSILON * angle {
            break;
        }
    }
    square_root(f64::from(freedom)) * tan(angle.min(FRAC_PI_2))
}

/// A and its derivative with respect to θ.
struct Central {
    probability: f64,
    slope: f64,
}

/// For ν = 1: A = 2θ/π. Odd: 2/π [θ + sin θ (cos θ + 2/3 cos³θ + … + (2·4…(ν−3))/(3·5…(ν−2)) cos^(ν−2) θ)]. Even:
/// sin θ [1 + 1/2 cos²θ + … + (1·3…(ν−3))/(2·4…(ν−2)) cos^(ν−2) θ]. All terms are positive. The derivative is that of the
/// density, C cos^(ν−1) θ, where C continues the coefficients by one.
fn sum(angle: f64, freedom: u32) -> Central {
    let (sine, cosine) = (sin(angle), cos(angle));
    let (odd, narrow) = (freedom % 2 == 1, sine * sine < 0.5);
    // The term of cos^k, and the sum up to there.
    let (mut term, mut sum) = if odd { (cosine, 0.0) } else { (1.0, 0.0) };
    let mut k = f64::from(u32::from(odd));
    while k < f64::from(freedom) - 1.0 {
        sum += term;
        if narrow {
            // A factor cos² would repeat its rounding in every term.
            term -= term * (1.0 + (k + 1.0) * sine * sine) / (k + 2.0);
        } else {
            term *= (k + 1.0) / (k + 2.0) * cosine * cosine;
        }
        k += 2.0;
    }
    // `term` is now that of cos^ν for odd ν and of cos^ν for even ν; its coefficient times ν and one cosine less give the
    // slope.
    let slope = f64::from(freedom) * term / cosine;
    if odd {
        Central { probability: FRAC_2_PI * (angle + sine * sum), slope: FRAC_2_PI * slope }
    } else {
        Central { probability: sine * sum, slope }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_degrees_of_freedom_match_closed_forms() {
        for probability in [0.01, 0.3, 0.5, 0.9, 0.95, 0.99] {
            // Cauchy: tan(πA/2). ν = 2: √2 A/√(1 − A²).
            let one = tan(FRAC_PI_2 * probability);
            let two = std::f64::consts::SQRT_2 * probability / square_root(1.0 - probability * probability);
            assert!((central_quantile(probability, 1) / one - 1.0).abs() < 2e-14);
            assert!((central_quantile(probability, 2) / two - 1.0).abs() < 2e-14);
        }
    }

    #[test]
    fn quantiles_match_exact_ones_to_the_last_digits() {
        // By mpmath 1.3 with 40 digits, from the incomplete beta function.
        for (probability, freedom, expected) in [
            (0.01, 1, 0.015709255323664916),
            (0.01, 3, 0.013604054691036678),
            (0.01, 5, 0.013171984672646882),
            (0.01, 10, 0.012850279188571376),
            (0.01, 30, 0.012638348785835286),
            (0.01, 198, 0.012549307017575081),
            (0.01, 1998, 0.012535038104497735),
            (0.5, 1, 1.0),
            (0.5, 3, 0.7648923284043453),
            (0.5, 5, 0.7266868438004227),
            (0.5, 10, 0.6998120613124317),
            (0.5, 30, 0.6827556933212926),
            (0.5, 198, 0.6757308423855869),
            (0.5, 1998, 0.674612560361078),
            (0.68, 1, 1.8189932472810666),
            (0.68, 3, 1.1889286364770173),
            (0.68, 5, 1.1036682729560625),
            (0.68, 10, 1.0464226104979648),
            (0.68, 30, 1.0112157453924329),
            (0.68, 198, 0.996961534926749),
            (0.68, 1998, 0.9947054326776553),
            (0.95, 1, 12.706204736174694),
            (0.95, 3, 3.1824463052837086),
            (0.95, 5, 2.5705818356363146),
            (0.95, 10, 2.2281388519862744),
            (0.95, 30, 2.0422724563012378),
            (0.95, 198, 1.9720174778363144),
            (0.95, 1998, 1.9611520148367054),
            (0.99, 1, 63.656741162871526),
            (0.99, 3, 5.840909309733355),
            (0.99, 5, 4.032142983555227),
            (0.99, 10, 3.169272672616951),
            (0.99, 30, 2.749995653567225),
            (0.99, 198, 2.6008872779905103),
            (0.99, 1998, 2.578292252720635),
            (0.999, 1, 636.6192487687191),
            (0.999, 3, 12.92397863668748),
            (0.999, 5, 6.868826625881109),
            (0.999, 10, 4.586893858702635),
            (0.999, 30, 3.6459586350420214),
            (0.999, 198, 3.3403402774547084),
            (0.999, 1998, 3.2954030195709403),
        ] {
            let found = central_quantile(probability, freedom);
            assert!(
                (found / expected - 1.0).abs() < 1e-13 + 2e-16 / (1.0 - probability),
                "{probability} {freedom}: {found:e} {:e}",
                found / expected - 1.0
            );
        }
    }

    #[test]
    fn many_degrees_of_freedom_near_the_normal_distribution() {
        // Next term of the expansion in 1/ν: z + (z³ + z)/(4ν).
        let z: f64 = 1.959963984540054;
        let expected = z + (z * z * z + z) / 4e6;
        assert!((central_quantile(0.95, 1_000_000) - expected).abs() < 1e-11);
    }

    #[test]
    fn what_is_outside_is_no_number() {
        for (probability, freedom) in [(1.0, 3), (-0.1, 3), (f64::NAN, 3), (0.5, 0)] {
            assert!(central_quantile(probability, freedom).is_nan());
        }
    }
}
