//! Rows and metadata from Parquet.

use std::fs::File;

use csv::StringRecord;
use parquet::basic::Compression;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use parquet::record::reader::RowIter;

use super::column::Column;
use super::error::TableError;
use super::number_text::NumberText;
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

/// Rows of a Parquet file of any columns, read one by one as texts.
pub struct ParquetTexts {
    pub(super) titles: StringRecord,
    rows: RowIter<'static>,
    number: NumberText,
    /// Rows of the file.
    pub length: u64,
    /// Rows that are read.
    pub(super) read: u64,
}

impl ParquetTexts {
    pub(super) fn new(file: File) -> Result<ParquetTexts, TableError> {
        let reader = SerializedFileReader::new(file)?;
        let mut chunks = reader.metadata().row_groups().iter().flat_map(|group| group.columns());
        let known = |codec| matches!(codec, Compression::UNCOMPRESSED | Compression::SNAPPY | Compression::ZSTD(_));
        if let Some(codec) = chunks.find_map(|chunk| Some(chunk.compression()).filter(|codec| !known(*codec))) {
            return Err(TableError::Compression { codec: codec.to_string() });
        }
        let file = reader.metadata().file_metadata();
        let titles = file.schema().get_fields().iter().map(|field| field.name()).collect::<Vec<_>>().into();
        let length = u64::try_from(file.num_rows()).unwrap_or(0);
        Ok(ParquetTexts {
            titles,
            rows: RowIter::from_file_into(Box::new(reader)),
            number: NumberText::default(),
            length,
            read: 0,
        })
    }

    /// Reads the next row, if there is one; numbers are written so that they read back to the same value.
    pub(super) fn read(&mut self, texts: &mut StringRecord) -> Result<bool, TableError> {
        let Some(row) = self.rows.next() else { return Ok(false) };
        texts.clear();
        for (_, field) in row?.get_column_iter() {
            match field {
                Field::Null => texts.push_field(""),
                Field::Str(text) => texts.push_field(text),
                Field::Double(number) => texts.push_field(self.number.of(*number)),
                Field::Float(number) => texts.push_field(self.number.of(f64::from(*number))),
                other => texts.push_field(&other.to_string()),
            }
        }
        self.read += 1;
        Ok(true)
    }
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
