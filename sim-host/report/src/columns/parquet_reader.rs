//! Rows and metadata from Parquet.

use std::fs::File;

use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;

use super::column::Column;
use super::error::TableError;
use super::table::RowWriter;
use super::value::Value;

/// Gives the rows of the Parquet file `file` with these columns to `writer`, one by one; returns how many there are.
///
/// # Errors
/// [`TableError::Titles`] when the file has other columns, [`TableError::Parquet`] for a file that cannot be read, and those of `writer`.
pub fn read_parquet(file: File, columns: &[Column], writer: &mut dyn RowWriter) -> Result<u64, TableError> {
    let reader = SerializedFileReader::new(file)?;
    let titles: Vec<&str> = reader.metadata().file_metadata().schema().get_fields().iter().map(|field| field.name()).collect();
    if !titles.iter().eq(columns.iter().map(|column| &column.name)) {
        let expected = columns.iter().map(|column| column.name.clone()).collect();
        return Err(TableError::Titles { found: titles.into_iter().map(str::to_owned).collect(), expected });
    }
    let mut rows = 0;
    for row in reader.get_row_iter(None)? {
        let row = row?;
        let value = |(_, field)| match field {
            &Field::Double(number) => Value::Number(number),
            &Field::ULong(count) => Value::Count(count),
            Field::Str(text) => Value::Text(text),
            _ => Value::Nothing,
        };
        writer.row(&row.get_column_iter().map(value).collect::<Vec<_>>())?;
        rows += 1;
    }
    Ok(rows)
}

/// The text that the Parquet file `file` has of itself under `name`.
///
/// # Errors
/// [`TableError::Parquet`] for a file that cannot be read.
pub fn parquet_text(file: File, name: &str) -> Result<Option<String>, TableError> {
    let reader = SerializedFileReader::new(file)?;
    let texts = reader.metadata().file_metadata().key_value_metadata();
    Ok(texts.and_then(|texts| texts.iter().find(|text| text.key == name)?.value.clone()))
}
