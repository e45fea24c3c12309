//! The hard cases of a rocking block, and what they and the tests of the whole workspace share: blocks, ground motions, observers
//! that remember or count, and the way through a motion.
//!
//! Everything is written over [`Precision`], so that each case runs in double and in single precision. Numbers that the tests
//! compare with come from closed forms, never from an earlier run.

mod clutches;
mod counted;
mod dice;
mod energy;
mod follow;
mod log;
mod number;
mod precision;
mod segment;
mod structures;
mod tally;
pub mod target_cases;

pub use clutches::{ElasticEnd, elastic_run};
pub use counted::Counted;
pub use dice::Dice;
pub use energy::Energy;
pub use follow::{Start, Watcher, follow, overturned_without_impact, release, shake, tight};
pub use log::{FullLog, Log, Logged, Sampled, sane};
pub use number::{boundary, relative};
pub use precision::{Outcome, Precision, Stepping};
pub use segment::Segment;
pub use structures::{GEOMETRIES, resized, unit_block};
pub use tally::{Level, Tally};
