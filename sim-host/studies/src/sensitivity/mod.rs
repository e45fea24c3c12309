//! Does it matter? Each effect alone, and all of a realistic device together, against the scene as it is.

pub mod answer;
pub mod motion;
pub mod report;
pub mod statistics;
pub mod study;
pub mod variants;
