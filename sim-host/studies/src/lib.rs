//! Many runs, and what they say.
//!
//! - [`map`]: outcomes over two keys of a scene; [`cloud`]: demands and fragilities over many records; [`optimise`]: the device that
//!   overturns least.
//! - [`design`]: the parts of a device, from what many motions ask for.
//! - [`sensitivity`]: what each effect changes; [`similarity`]: motions that are one motion in other units.
//! - [`accuracy_study`]: what methods, steps and precisions cost; [`loop_study`]: the controller's studies.
//! - [`statistics`]: quantiles, bands, regressions and probabilities.

#[cfg(feature = "effects")]
pub mod accuracy_study;
pub mod cloud;
#[cfg(feature = "effects")]
pub mod design;
#[cfg(feature = "effects")]
pub mod loop_study;
pub mod map;
pub mod optimise;
pub mod sensitivity;
pub mod similarity;
pub mod statistics;
