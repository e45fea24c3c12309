//! How a file of rows begins.

/// How a file of rows begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// Empty; refused where an interrupted run has left rows.
    New,
    /// Empty, whatever is there.
    Restart,
    /// With the rows that are there, if any.
    Resume,
    /// With the rows of so many shards.
    Merge(u32),
}
