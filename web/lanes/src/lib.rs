//! The lanes of a map in a browser: a module of its own, because it is built twice, with SIMD and without.

#[cfg(target_family = "wasm")]
pub mod pulses;
