//! In a program without Parquet there is no reader of it.

use std::convert::Infallible;
use std::fs::File;

use csv::StringRecord;

use super::column::Column;
use super::error::TableError;
use super::table::RowWriter;
use crate::part::{Missing, Part};

/// Refuses to read a file.
///
/// # Errors
/// [`TableError::Parquet`].
pub fn read_parquet(_file: File, _columns: &[Column], _writer: &mut dyn RowWriter) -> Result<u64, TableError> {
    Err(Missing(Part::PARQUET).into())
}

/// Rows of a Parquet file: there are none.
pub struct ParquetTexts {
    pub(super) titles: StringRecord,
    /// Rows of the file.
    pub length: u64,
    pub(super) read: u64,
    never: Infallible,
}

impl ParquetTexts {
    pub(super) fn new(_file: File) -> Result<ParquetTexts, TableError> {
        Err(Missing(Part::PARQUET).into())
    }

    pub(super) fn read(&mut self, _texts: &mut StringRecord) -> Result<bool, TableError> {
        match self.never {}
    }
}

/// Refuses to read a file.
///
/// # Errors
/// [`TableError::Parquet`].
pub fn parquet_text(_file: File, _name: &str) -> Result<Option<String>, TableError> {
    Err(Missing(Part::PARQUET).into())
}
