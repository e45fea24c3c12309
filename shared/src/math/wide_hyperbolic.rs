//! What a hyperbolic cosine and sine have beyond their first terms, in double precision without a branch, for SIMD lanes: series in z = x², truncated
//! below 1e-16.

use super::scalar::Scalar;
use super::stumpff::reciprocal_factorials;

/// Largest z.
pub const LARGEST: f64 = 4.0;

const COSINE: [f64; 12] = reciprocal_factorials(2);
const SINE: [f64; 12] = reciprocal_factorials(3);

/// Σ c_k z^k, in pairs and fours that shorten the chain of dependent operations.
#[inline(always)]
fn sum<S: Scalar>(c: &[f64; 12], z: S, z2: S, z4: S) -> S {
    let pair = |k: usize| S::of(c[k]) + z * S::of(c[k + 1]);
    let four = |k: usize| pair(k) + z2 * pair(k + 2);
    four(0) + z4 * (four(4) + z4 * four(8))
}

/// (cosh x − 1)/x² and (sinh x − x)/x³ of z = x², 0 ≤ z ≤ [`LARGEST`], each lane to 1e-15 of itself: Stumpff's c₂(−z) and c₃(−z)
/// ([`super::stumpff`]).
#[inline(always)]
pub fn c2_c3<S: Scalar>(z: S) -> (S, S) {
    let z2 = z * z;
    let z4 = z2 * z2;
    (sum(&COSINE, z, z2, z4), sum(&SINE, z, z2, z4))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::stumpff;

    #[test]
    fn agrees_with_stumpff_functions_and_with_libm() {
        for k in 0..=100_000_u32 {
            let x = 2.0 * f64::from(k) / 100_000.0;
            let (c2, c3) = c2_c3(x * x);
            let (exact_c2, exact_c3) = stumpff::c2_c3(-x * x);
            assert!((c2 / exact_c2 - 1.0).abs() < 2e-15, "{x}: {c2} {exact_c2}");
            // Beyond 1 those are differences.
            assert!((c3 / exact_c3 - 1.0).abs() < 1e-14, "{x}: {c3} {exact_c3}");
            assert!(((1.0 + x * x * c2) / crate::math::cosh(x) - 1.0).abs() < 1e-15, "{x}");
        }
    }
}
