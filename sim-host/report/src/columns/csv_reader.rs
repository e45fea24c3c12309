//! Rows from CSV.

use std::io::{Read, Write};

use super::column::Column;
use super::error::TableError;
use super::metadata::Metadata;
use super::parquet_writer::ParquetWriter;
use super::table::RowWriter;
use super::value::Value;

/// Gives the rows of the CSV file `csv` with these columns to `writer`, one by one; returns how many there are.
///
/// # Errors
/// [`TableError::Titles`] when the file has other columns, [`TableError::Field`] for a field that does not belong to its column,
/// [`TableError::Csv`] for rows that are too short or too long and a file that cannot be read, and those of `writer`.
pub fn read_csv(csv: impl Read, columns: &[Column], writer: &mut dyn RowWriter) -> Result<u64, TableError> {
    let mut table = csv::Reader::from_reader(csv);
    let titles = table.headers()?;
    if !titles.iter().eq(columns.iter().map(|column| column.name.as_str())) {
        let expected = columns.iter().map(|column| column.name.clone()).collect();
        return Err(TableError::Titles { found: titles.iter().map(str::to_owned).collect(), expected });
    }
    let mut record = csv::StringRecord::new();
    let mut rows = 0;
    while table.read_record(&mut record)? {
        let values = columns.iter().zip(&record).map(|(column, text)| {
            column.parsed(text).ok_or_else(|| TableError::Field {
                line: record.position().map_or(0, csv::Position::line),
                column: column.name.clone(),
                text: text.to_owned(),
                kind: column.kind,
            })
        });
        let values: Vec<Value<'_>> = values.collect::<Result<_, _>>()?;
        writer.row(&values)?;
        rows += 1;
    }
    Ok(rows)
}

/// Makes a Parquet file of the CSV file `csv` with these columns, in a stream; returns how many rows there are.
///
/// The bytes are those that the rows themselves give to a [`ParquetWriter`].
///
/// # Errors
/// Those of [`read_csv`], and [`TableError::Parquet`] when `out` does not take the bytes.
pub fn parquet_of_csv(
    csv: impl Read,
    columns: &[Column],
    metadata: &Metadata,
    out: impl Write + Send,
) -> Result<u64, TableError> {
    let mut writer = ParquetWriter::new(columns.to_vec(), metadata, out)?;
    let rows = read_csv(csv, columns, &mut writer)?;
    writer.finish()?;
    Ok(rows)
}
