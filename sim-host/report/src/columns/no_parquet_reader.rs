//! In a program without Parquet there is no reader of it.

use std::fs::File;

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

/// Refuses to read a file.
///
/// # Errors
/// [`TableError::Parquet`].
pub fn parquet_text(_file: File, _name: &str) -> Result<Option<String>, TableError> {
    Err(Missing(Part::PARQUET).into())
}
