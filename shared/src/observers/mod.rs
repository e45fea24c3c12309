//! Observers of a motion: peaks, energy ledger, checks of forces and friction, use of coils, digests of every bit.
//!
//! The room imports `math`, `structure`, `method` and `motion`.

pub mod checks;
pub mod coil_use;
pub mod counted_swing;
pub mod digest;
pub mod fall;
pub mod ledger;
pub mod outcome;
pub mod peaks;
