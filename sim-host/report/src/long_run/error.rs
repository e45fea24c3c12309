//! Why rows cannot be kept or resumed.

use std::path::{Path, PathBuf};

use super::shard::Shard;

/// Why rows cannot be kept or resumed.
#[derive(Debug, thiserror::Error)]
pub enum LongRunError {
    /// A file that cannot be read or written.
    #[error("{}: {reason}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Reason, in words.
        reason: String,
    },
    /// Rows of an interrupted run that a new one would overwrite.
    #[error("{}: an interrupted run is there; --resume continues it, --restart discards it", path.display())]
    Unfinished {
        /// File with the rows.
        path: PathBuf,
    },
    /// Rows without the page that says what they come from.
    #[error("{}: not there, so that nothing says what the rows in {} come from; give --restart to throw them away, or another --out",
        page.display(), rows.display())]
    NoPage {
        /// Where it should be.
        page: PathBuf,
        /// File with the rows.
        rows: PathBuf,
    },
    /// Rows of another scene, study, version or record.
    #[error("{}: its rows are of another run: {what} differs; give --restart to throw them away, or another --out", path.display())]
    OtherRun {
        /// What says so.
        path: PathBuf,
        /// The first thing that is not the same.
        what: String,
    },
    /// A plan of another scene, study, version or record, or for another number of parts.
    #[error("{}: it plans another run: {what} differs; plan this one in another folder", path.display())]
    OtherPlan {
        /// The plan.
        path: PathBuf,
        /// The first thing that is not the same.
        what: String,
    },
    /// Parts that are not there, damaged, or of another plan.
    #[error("{}: {why}; {missing} of {parts} parts are missing", path.display())]
    Parts {
        /// File of the first one.
        path: PathBuf,
        /// What is wrong with it.
        why: &'static str,
        /// How many are not there.
        missing: usize,
        /// How many there should be.
        parts: u32,
    },
    /// Rows that another program has changed while they were made.
    #[error("{}: it is not as it was written: {reason}; give --restart to make its rows again", path.display())]
    Changed {
        /// Where they are.
        path: PathBuf,
        /// What says so.
        reason: String,
    },
    /// Ctrl-C.
    #[error("{done} of {rows} rows are kept; the same command with --resume continues")]
    Interrupted {
        /// Rows that are there.
        done: usize,
        /// Rows that there should be.
        rows: usize,
    },
    /// Ctrl-C, where it is not known beforehand how many rows there will be.
    #[error("{done} rows are kept; the same command with --resume continues")]
    Stopped {
        /// Rows that are there.
        done: usize,
    },
    /// An option of long runs where no rows are kept.
    #[error("--time-budget tries several accuracies and keeps no rows on the way: {option} cannot go with it")]
    NoRows {
        /// The option.
        option: &'static str,
    },
    /// Rows that are not as they were written.
    #[error("{}: row {row}: {reason}", path.display())]
    BadRow {
        /// The file.
        path: PathBuf,
        /// Which, from 1, without the heading.
        row: usize,
        /// Reason, in words.
        reason: String,
    },
    /// A shard that is not there, or not whole.
    #[error("shard {shard} is not finished: {} has {have} of {rows} rows", path.display())]
    Missing {
        /// Shard that is missing.
        shard: Shard,
        /// Where it should be.
        path: PathBuf,
        /// Rows there.
        have: usize,
        /// Rows that it should have.
        rows: usize,
    },
}

impl LongRunError {
    pub(super) fn file(path: &Path, reason: &impl ToString) -> LongRunError {
        LongRunError::File { path: path.to_owned(), reason: reason.to_string() }
    }

    /// The error without the file that it names.
    pub(super) fn reason(&self) -> String {
        match self {
            LongRunError::File { reason, .. } => reason.clone(),
            LongRunError::BadRow { row, reason, .. } => format!("row {row}: {reason}"),
            LongRunError::OtherRun { what, .. } => format!("{what} differs"),
            other => other.to_string(),
        }
    }
}
