//! The end of free rocking: the accumulation of impacts, the decay of free rocking summed in closed form, its outcome and its times by the
//! energy integral.
//!
//! The room imports `math` and `equation`.

pub mod free_course;
pub mod free_decay;
pub mod free_motion;
pub mod impact_accumulation;
pub mod leg_time;
