//! The clairvoyant bound: what a clutch law could do that knew the whole ground motion beforehand.
//!
//! No causal law overturns fewer blocks, so what a law is worth is the share of the way from the plain devices to this bound. It is a
//! problem of optimal control: among all schedules of the clutches, one that lets the block stand, and of these the one with the smallest
//! peak rotation. [`search()`] solves it by forward dynamic programming; [`rocker`] has the equations of motion that it steps; [`played`]
//! plays a schedule to the plant of the closed loop, whose events are located, so that what the search found is proved by another program.
//! [`full_state`] is what lies between: a law that sees all there is now, and nothing of what will come.

pub mod full_state;
pub mod played;
pub mod rocker;
pub mod search;
pub mod shaking;

#[cfg(test)]
mod tests;

pub use full_state::{Followed, FullState};
pub use rocker::Rocker;
pub use search::{Found, Grid, search};
pub use shaking::Shaking;
