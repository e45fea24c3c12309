//! Tables of a command.

use std::path::Path;

use super::{Formats, OutputError, Results};
use crate::columns::{Column, Metadata, Table, parquet_of_csv, write_csv, write_parquet};

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

    /// Writes the finished table at `csv`, which has these columns, as Parquet beside it, as [`Results::add_table`] would have.
    ///
    /// # Errors
    /// The errors of [`Results::add`].
    pub fn add_parquet_of(&mut self, csv: &Path, columns: &[Column], metadata: &Metadata) -> Result<(), OutputError> {
        let rows = std::fs::File::open(csv).map_err(|error| OutputError { path: csv.to_owned(), reason: error.to_string() })?;
        self.add(&csv.with_extension("parquet"), |file| {
            parquet_of_csv(rows, columns, metadata, file).map(drop).map_err(Into::into)
        })
    }
}
