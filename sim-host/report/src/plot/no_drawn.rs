//! In a program without PNG nothing lays figures out.

/// Passes.
pub fn assert_drawn(_svg: &str) {}
