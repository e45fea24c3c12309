//! Tables for programs: columns with types, and rows that go to CSV or to Parquet one by one, so that a table of any length takes the
//! memory of one group of rows.
//!
//! Both formats hold the same values to the last bit, and the same rows are the same bytes on every machine: a Parquet file made from
//! the finished CSV file ([`parquet_of_csv`]) is the one that the rows themselves give.

mod column;
mod csv_reader;
mod csv_writer;
mod error;
mod fields;
mod metadata;
mod number_text;
#[cfg_attr(not(feature = "parquet"), path = "no_parquet_reader.rs")]
mod parquet_reader;
#[cfg_attr(not(feature = "parquet"), path = "no_parquet_writer.rs")]
mod parquet_writer;
mod table;
#[cfg(all(test, feature = "parquet"))]
mod tests;
mod text_rows;
mod value;

pub use column::{Column, Kind, Shown};
pub use csv_reader::{parquet_of_csv, read_csv};
pub use csv_writer::CsvWriter;
pub use error::TableError;
pub use fields::{FieldTable, Fields};
pub use metadata::{Metadata, metadata_of};
pub use number_text::NumberText;
pub use parquet_reader::{ParquetTexts, parquet_text, read_parquet};
pub use parquet_writer::ParquetWriter;
pub use table::{RowWriter, Table, write_csv, write_parquet};
pub use text_rows::TextRows;
pub use value::Value;
