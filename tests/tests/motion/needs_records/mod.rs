//! Recorded motions: read, and under blocks.

mod archive;
mod grazes;
mod recorded_motions;
