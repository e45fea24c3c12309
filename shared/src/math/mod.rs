//! Numerical mathematics: scalars and SIMD lanes, transcendental functions, truncated power series, polynomials, roots, quadrature and hashes.
//! It imports no other room.
//!
//! - [`scalar`]: what an equation is written over; [`lanes`]: several numbers in one SIMD register; [`value`]: either, or a power series;
//!   [`sign`]: a sign as a state.
//! - [`power_series`]: automatic differentiation by truncated power series; [`polynomial`], [`root`]: first zeros, bracketed.
//!
//! Every transcendental function of the project is here:
//!
//! - f64: libm, pinned and without architecture-specific paths, so that a host gives the same bits as any other.
//! - f32: [`sine32`], an own polynomial in single precision. libm's `sinf` computes in double, which on a Cortex-M4F
//!   (single-precision FPU) takes some 1,200 instructions.
//! - lanes: [`wide_sine`] and [`wide_hyperbolic`], branch-free f64 polynomials that fill SIMD registers.
//! - [`tier`], [`tiered`]: any of these and others in the place of a number's own sine, to compare them; [`stumpff`]: what is left of
//!   sines and cosines in short steps.
//!
//! `clippy.toml` forbids the methods of `std`: which implementation they use depends on the platform and on cargo's
//! feature unification.

pub mod fnv;
pub mod lanes;
pub mod polynomial;
pub mod power_series;
pub(crate) mod quadrature;
pub mod root;
pub mod scalar;
pub mod sign;
pub mod sine32;
pub mod split_mix;
pub mod stumpff;
pub mod tier;
pub mod tiered;
pub mod value;
pub mod wide_hyperbolic;
pub mod wide_sine;

pub use libm::{
    acos, acosh, asin, atan, atan2, atanh, cos, cosh, erf, erfc, exp, expf as exp32, expm1, hypot, log as ln, log1p, log10, pow,
    sin, sincos as sin_cos, sinh, sqrt as square_root, sqrtf as square_root32, tan, tanh,
};

/// 1/k for k = 1 to 63; entry 0 is 0.
pub const RECIPROCALS: [f64; 64] = {
    let mut table = [0.0; 64];
    let mut k = 1;
    while k < 64 {
        table[k] = 1.0 / k as f64;
        k += 1;
    }
    table
};
