//! Studies of the controller: what it is worth against the ideal pair, and where it breaks.

pub mod bench;
pub mod bound;
pub mod decisions;
pub mod faults;
pub mod ideal_limit;
pub mod law_settings;
pub mod laws;
pub mod losses;
pub mod motion;
pub mod practice;
pub mod report;
pub mod robustness;
pub mod tally;
pub mod train;
