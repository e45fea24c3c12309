//! The second program by itself: known answers and random scenes.

#[expect(clippy::disallowed_methods, reason = "as the second program, its answers are by the standard library")]
mod answers;
mod generated;
