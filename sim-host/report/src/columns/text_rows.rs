//! Rows of a table, one by one, as texts.

use std::fs::File;
use std::io::{Read, Take};

use csv::{Position, StringRecord};

use super::error::TableError;
use super::parquet_reader::ParquetTexts;

/// Most bytes of a row of CSV: a quote that nothing closes does not take all memory.
const LONGEST_ROW: u64 = 1 << 20;

/// Rows of a CSV or Parquet file, read one by one, each value as the text that CSV has for it. Memory is that of a row, or of pages of Parquet.
pub enum TextRows {
    /// Of CSV.
    Csv(Box<csv::Reader<Take<Box<dyn Read + Send>>>>),
    /// Of Parquet.
    Parquet(Box<ParquetTexts>),
}

impl TextRows {
    /// Those of the CSV file `csv`.
    pub fn of_csv(csv: impl Read + Send + 'static) -> TextRows {
        let source: Box<dyn Read + Send> = Box::new(csv);
        TextRows::Csv(Box::new(csv::ReaderBuilder::new().buffer_capacity(1 << 16).from_reader(source.take(LONGEST_ROW))))
    }

    /// Those of the Parquet file `file`.
    ///
    /// # Errors
    /// [`TableError::Parquet`] for a file that cannot be read, [`TableError::Compression`].
    pub fn of_parquet(file: File) -> Result<TextRows, TableError> {
        Ok(TextRows::Parquet(Box::new(ParquetTexts::new(file)?)))
    }

    /// The names of the columns.
    ///
    /// # Errors
    /// Those of [`TextRows::read`].
    pub fn titles(&mut self) -> Result<StringRecord, TableError> {
        match self {
            TextRows::Csv(reader) => {
                let titles = reader.headers().cloned();
                whole(reader, 1)?;
                Ok(titles?)
            }
            TextRows::Parquet(rows) => Ok(rows.titles.clone()),
        }
    }

    /// Reads the next row, if there is one. Its position has its line, or in Parquet its number, from 1.
    ///
    /// # Errors
    /// [`TableError::Csv`] for rows that are too short or too long and a file that cannot be read, [`TableError::LongRow`] and
    /// [`TableError::Parquet`].
    pub fn read(&mut self, row: &mut StringRecord) -> Result<bool, TableError> {
        match self {
            TextRows::Csv(reader) => {
                reader.get_mut().set_limit(LONGEST_ROW);
                let line = reader.position().line();
                let read = reader.read_record(row);
                whole(reader, line)?;
                Ok(read?)
            }
            TextRows::Parquet(rows) => {
                if !rows.read(row)? {
                    return Ok(false);
                }
                let mut position = Position::new();
                position.set_line(rows.read);
                row.set_position(Some(position));
                Ok(true)
            }
        }
    }

    /// How far they are read: bytes of CSV, rows of Parquet.
    pub fn done(&self) -> u64 {
        match self {
            TextRows::Csv(reader) => reader.position().byte(),
            TextRows::Parquet(rows) => rows.read,
        }
    }
}

fn whole(reader: &csv::Reader<Take<Box<dyn Read + Send>>>, line: u64) -> Result<(), TableError> {
    if reader.get_ref().limit() == 0 { Err(TableError::LongRow { line }) } else { Ok(()) }
}
