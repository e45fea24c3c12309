//! Sprag in a browser: what a page calls, and what it gets.
//!
//! - [`scene`], [`about`]: a scene with its records, and what it says before it is run.
//! - [`run`], [`map`], [`closed_loop`]: responses, overturning maps, the controller in closed loop.
//! - [`examples`], [`digests`]: the shipped scenes, and the bits that they come to everywhere.
//! - [`columns`], and in WebAssembly `object` and `page`: how results reach JavaScript.

pub mod about;
pub mod closed_loop;
pub mod columns;
pub mod digests;
pub mod examples;
pub mod map;
#[cfg(target_family = "wasm")]
pub mod object;
#[cfg(target_family = "wasm")]
pub mod page;
pub mod run;
pub mod scene;
