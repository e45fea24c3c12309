//! Integrals of smooth functions.

use super::scalar::Real;

/// Nodes and weights of the Gauss-Legendre rule with eight points on [-1, 1] (Abramowitz and Stegun 1964, Table 25.4), one
/// of each symmetric pair. It is exact for polynomials to degree 15.
const RULE: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

/// Most panels of one integral.
const MOST_PANELS: u32 = 64;

/// ∫ `function` from `from` to `to`, in equal panels no longer than `longest` (at most 64 of them).
///
/// A step of the Taylor method is so short that the series' last term is at rounding, hence the power on it is close to a
/// polynomial of low degree: with eight points the error is below 1e-16 of the integral.
pub fn integral<S: Real, const N: usize>(from: S, to: S, longest: S, mut function: impl FnMut(S) -> [S; N]) -> [S; N] {
    let span = to - from;
    let mut panels = 1;
    while S::count(panels) * longest < span && panels < MOST_PANELS {
        panels += 1;
    }
    let half = S::HALF * span / S::count(panels);
    let mut sum = [S::ZERO; N];
    for panel in 0..panels {
        let middle = from + S::count(2 * panel + 1) * half;
        for (node, weight) in RULE {
            let offset = S::of(node) * half;
            for time in [middle - offset, middle + offset] {
                for (total, value) in sum.iter_mut().zip(function(time)) {
                    *total = *total + S::of(weight) * value;
                }
            }
        }
    }
    sum.map(|total| total * half)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math;

    #[test]
    fn degree_15_is_exact_and_16_is_not() {
        let power = |n: u32| integral(0.0, 1.0, 2.0, |t: f64| [(0..n).fold(1.0, |value, _| value * t)])[0] * f64::from(n + 1);
        for n in 0..16 {
            assert!((power(n) - 1.0).abs() < 4e-15, "{n}: {}", power(n));
        }
        assert!((power(16) - 1.0).abs() > 1e-10);
    }

    #[test]
    fn panels_bring_a_long_oscillation_to_rounding() {
        let integrate = |longest: f64| integral(1.0, 9.0, longest, |t: f64| [math::sin(3.0 * t), math::exp(-t)]);
        let [sine, decay] = integrate(0.5);
        assert!((sine - (math::cos(3.0) - math::cos(27.0)) / 3.0).abs() < 1e-14);
        assert!((decay - (math::exp(-1.0) - math::exp(-9.0))).abs() < 1e-15);
        assert!((integrate(8.0)[0] - sine).abs() > 1e-3, "one panel is not enough here");
    }

    #[test]
    fn nothing_is_zero() {
        assert_eq!(integral(0.3, 0.3, 0.1, |t: f64| [t]), [0.0]);
    }
}
