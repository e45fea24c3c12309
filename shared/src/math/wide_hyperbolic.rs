//! Hyperbolic cosine and sine in double precision without a branch, for SIMD lanes: their series in z = x², truncated below 1e-16.

use super::stumpff::reciprocal_factorials;
use crate::scalar::Scalar;

/// Largest z.
pub const LARGEST: f64 = 4.0;

const COSINE: [f64; 12] = reciprocal_factorials(0);
const SINE: [f64; 12] = reciprocal_factorials(1);

/// Σ c_k z^k, in pairs and fours that shorten the chain of dependent operations.
#[inline(always)]
fn sum<S: Scalar>(c: &[f64; 12], z: S, z2: S, z4: S) -> S {
    let pair = |k: usize| S::of(c[k]) + z * S::of(c[k + 1]);
    let four = |k: usize| pair(k) + z2 * pair(k + 2);
    four(0) + z4 * (four(4) + z4 * four(8))
}

/// cosh √z and sinh √z/√z for 0 ≤ z ≤ [`LARGEST`], each lane to 1e-15 of itself.
#[inline(always)]
pub fn cosh_sinhc<S: Scalar>(z: S) -> (S, S) {
    let z2 = z * z;
    let z4 = z2 * z2;
    (sum(&COSINE, z, z2, z4), sum(&SINE, z, z2, z4))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_libm() {
        assert_eq!(cosh_sinhc(0.0), (1.0, 1.0));
        for k in 1..=100_000_u32 {
            let x = 2.0 * f64::from(k) / 100_000.0;
            let (cosh, sinhc) = cosh_sinhc(x * x);
            let (exact_cosh, exact_sinhc) = (crate::math::cosh(x), crate::math::sinh(x) / x);
            assert!((cosh / exact_cosh - 1.0).abs() < 1e-15, "{x}: {cosh} {exact_cosh}");
            assert!((sinhc / exact_sinhc - 1.0).abs() < 1e-15, "{x}: {sinhc} {exact_sinhc}");
        }
    }
}
