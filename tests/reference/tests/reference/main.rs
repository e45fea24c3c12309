//! The second program by itself: known answers and random scenes.

mod answers;
mod generated;
