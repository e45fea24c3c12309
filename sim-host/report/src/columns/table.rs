//! A table that is written in any format.

use std::io::Write;

use super::column::Column;
use super::csv_writer::CsvWriter;
use super::error::TableError;
use super::metadata::Metadata;
use super::parquet_writer::ParquetWriter;
use super::value::Value;

/// What takes the rows of a table in their order.
pub trait RowWriter {
    /// Takes a row: a value a column.
    ///
    /// # Errors
    /// [`TableError`] when the values are not those of the columns, or cannot be written.
    fn row(&mut self, values: &[Value<'_>]) -> Result<(), TableError>;
}

/// A table: its columns, and a walk over its rows, the same every time.
pub trait Table {
    /// The columns, from the left.
    fn columns(&self) -> Vec<Column>;

    /// Gives every row to `writer`.
    ///
    /// # Errors
    /// The errors of `writer`.
    fn rows(&self, writer: &mut dyn RowWriter) -> Result<(), TableError>;
}

/// Writes `table` to `out` as CSV.
pub fn write_csv(table: &dyn Table, out: impl Write) -> Result<(), TableError> {
    let mut writer = CsvWriter::new(table.columns(), out)?;
    table.rows(&mut writer)?;
    writer.finish().map(drop)
}

/// Writes `table` to `out` as Parquet that carries `metadata`.
pub fn write_parquet(table: &dyn Table, metadata: &Metadata, out: impl Write + Send) -> Result<(), TableError> {
    let mut writer = ParquetWriter::new(table.columns(), metadata, out)?;
    table.rows(&mut writer)?;
    writer.finish().map(drop)
}
