//! Tables of a command.

use std::path::Path;

use super::{Formats, OutputError, Results};
use crate::columns::{
    Column, CsvWriter, Metadata, RowWriter, Table, TableError, Value, parquet_of_csv, write_csv, write_parquet,
};

/// What takes the rows of a table one by one: values of its columns.
pub type RowTaker<'a> = dyn FnMut(&[Value<'_>]) -> Result<(), OutputError> + Send + 'a;

impl Results {
    /// Writes `table` to `folder` as NAME.csv and, if `formats` say so, as NAME.parquet, which carries `metadata`.
    ///
    /// # Errors
    /// The errors of [`Results::add`].
    pub fn add_table(
        &mut self,
        folder: &Path,
        name: &str,
        table: &dyn Table,
        metadata: &Metadata,
        formats: Formats,
    ) -> Result<(), OutputError> {
        self.add(&folder.join(format!("{name}.csv")), |file| Ok(write_csv(table, file)?))?;
        if formats.parquet {
            self.add(&folder.join(format!("{name}.parquet")), |file| Ok(write_parquet(table, metadata, file)?))?;
        }
        Ok(())
    }

    /// Writes a table with these columns to `csv` as its rows come from `fill`.
    ///
    /// # Errors
    /// Those of `fill` and of [`Results::add`].
    pub fn add_rows<E: From<OutputError>>(
        &mut self,
        csv: &Path,
        columns: &[Column],
        fill: impl FnOnce(&mut RowTaker<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        let failed = |error: TableError| OutputError::new(csv, &error.into());
        self.add_by(csv, |file| {
            let mut writer = CsvWriter::new(columns.to_vec(), file).map_err(failed)?;
            fill(&mut |values| writer.row(values).map_err(failed))?;
            writer.finish().map_err(failed)?;
            Ok(())
        })
    }

    /// Writes the table at `csv`, which has these columns, to `path` as Parquet, as [`Results::add_table`] would have.
    ///
    /// # Errors
    /// The errors of [`Results::add`].
    pub fn add_parquet_of(
        &mut self,
        csv: &Path,
        path: &Path,
        columns: &[Column],
        metadata: &Metadata,
    ) -> Result<(), OutputError> {
        let rows = std::fs::File::open(csv).map_err(|error| OutputError { path: csv.to_owned(), reason: error.to_string() })?;
        self.add(path, |file| parquet_of_csv(rows, columns, metadata, file).map(drop).map_err(Into::into))
    }
}
