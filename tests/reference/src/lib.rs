//! A second program: a rocking block with inerters and clutches, event by event, by a derivation of its own.
//!
//! It shares no code with Sprag and is written to be read: small fixed steps of Runge-Kutta, guards looked at after each step,
//! bisection by stepping anew. What the modes are, what ends them and what follows is the table of `docs/modes.md`; the code
//! follows it file by file. Sprag and this program must give the same histories for the same scene ([`compare`]).
//!
//! Units: m, s, rad; forces and stiffnesses are divided by the mass of the block with what rides on it, energies by
//! that mass and R².

pub mod actuation;
pub mod block;
pub mod chain;
pub mod compare;
pub mod consistent;
pub mod device;
pub mod effort;
pub mod equation;
pub mod event;
pub mod foundation;
pub mod generate;
pub mod ground;
pub mod guard;
pub mod ledger;
pub mod method;
pub mod mode;
pub mod pulse;
pub mod random;
pub mod record;
mod runner;
pub mod scatter;
pub mod scene;
pub mod simulate;
pub mod sliding;
pub mod step;
pub mod support;
pub mod tally;
pub mod terminals;
