//! Whole-workspace tests of Sprag.
