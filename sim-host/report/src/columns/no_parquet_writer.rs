//! In a program without Parquet there is no writer of it.

use std::convert::Infallible;
use std::io::Write;
use std::marker::PhantomData;

use super::column::Column;
use super::error::TableError;
use super::metadata::Metadata;
use super::table::RowWriter;
use super::value::Value;
pub use crate::part::Missing as ParquetError;
use crate::part::Part;

/// Writes rows as Parquet: there is none.
pub struct ParquetWriter<W>(Infallible, PhantomData<W>);

impl<W: Write + Send> ParquetWriter<W> {
    /// Refuses to begin a file.
    ///
    /// # Errors
    /// [`TableError::Parquet`].
    pub fn new(_columns: Vec<Column>, _metadata: &Metadata, _out: W) -> Result<ParquetWriter<W>, TableError> {
        Err(ParquetError(Part::PARQUET).into())
    }

    /// Never called.
    ///
    /// # Errors
    /// None.
    pub fn finish(self) -> Result<W, TableError> {
        match self.0 {}
    }
}

impl<W> RowWriter for ParquetWriter<W> {
    fn row(&mut self, _values: &[Value<'_>]) -> Result<(), TableError> {
        match self.0 {}
    }
}
