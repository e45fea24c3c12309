//! Tables that cannot be written or read.

use std::io;

use super::column::Kind;
use super::parquet_writer::ParquetError;

/// A table that cannot be written or read.
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    /// A row that is too short or too long.
    #[error("row {row} has {found} values instead of {expected}")]
    WrongLength {
        /// From 1.
        row: u64,
        /// How many values it has.
        found: usize,
        /// How many columns there are.
        expected: usize,
    },
    /// A value that is not of its column.
    #[error("row {row}, column `{column}`: {value} is not {kind}")]
    WrongKind {
        /// From 1.
        row: u64,
        /// Name of the column.
        column: String,
        /// What belongs there.
        kind: Kind,
        /// What was given.
        value: String,
    },
    /// No value where there has to be one.
    #[error("row {row}, column `{column}`: there is no value")]
    Missing {
        /// From 1.
        row: u64,
        /// Name of the column.
        column: String,
    },
    /// Titles of a CSV file that are not the names of the columns.
    #[error("line 1: the columns are {found:?} instead of {expected:?}")]
    Titles {
        /// Those of the file.
        found: Vec<String>,
        /// Those of the table.
        expected: Vec<String>,
    },
    /// A field of a CSV file that does not belong to its column.
    #[error("line {line}, column `{column}`: `{text}` is not {kind}")]
    Field {
        /// From 1, where its row begins.
        line: u64,
        /// Name of the column.
        column: String,
        /// What stands there.
        text: String,
        /// What belongs there.
        kind: Kind,
    },
    /// A row of a CSV file that is longer than any row of numbers.
    #[error("line {line}: a row of more than 1 MiB begins there")]
    LongRow {
        /// From 1, where it begins.
        line: u64,
    },
    /// A Parquet file that is compressed in a way that is not known here.
    #[error("it is compressed by {codec}; zstd, snappy and no compression can be read")]
    Compression {
        /// Its name in Parquet.
        codec: String,
    },
    /// A CSV file that cannot be written or read.
    #[error("{0}")]
    Csv(#[from] csv::Error),
    /// A file that cannot be written.
    #[error("{0}")]
    Output(#[from] io::Error),
    /// What a file should say of itself has no JSON.
    #[error("{0}")]
    Metadata(serde_json::Error),
    /// A Parquet file that cannot be written.
    #[error("{0}")]
    Parquet(#[from] ParquetError),
}

impl From<TableError> for io::Error {
    fn from(error: TableError) -> io::Error {
        match error {
            TableError::Output(error) => error,
            TableError::Csv(error) if error.is_io_error() => error.into(),
            error => io::Error::other(error),
        }
    }
}
