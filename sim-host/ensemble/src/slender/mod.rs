//! Slender blocks under a sine, in closed form: steps as long as a half-cycle of the ground, exact to rounding.
//!
//! In units of 1/p, with the inertia I = 1 + κ k and ü_g/g = G sin ψ, ψ = ωt + φ, in a block's mirror, Eq. 17-18 are
//!
//! I θ̈ = θ − α − G sin ψ,  θ = α + y + s,  s = R sin ψ,  R = G/(1 + Iω²),
//!
//! and y, what is left, moves by itself: ÿ = y/I. Every derivative of θ is a sum of these two ([`Motion`]). [`zero`] finds where one of
//! them vanishes, [`crest`] the largest |θ̈|, and [`step`] puts them together. Where a step ends and why nothing is missed in it rests on three facts:
//!
//! - y has at most one zero, and so has ẏ: one sign at both ends of a step is its sign throughout;
//! - s has one sign over a half-cycle, and no step is longer;
//! - where the two parts of θ̈ have opposite signs, θ̈ bends one way only, because its second derivative then has parts of one sign;
//!   where they have the same sign, θ̈ has it too.

pub mod crest;
mod motion;
mod pending;
pub mod step;
pub mod zero;

pub use motion::{Motion, Place};

#[cfg(test)]
mod tests;
