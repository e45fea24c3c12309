//! Rows as CSV.

use std::io::Write;

use csv::StringRecord;

use super::column::Column;
use super::error::TableError;
use super::number_text::NumberText;
use super::table::RowWriter;
use super::value::Value;

/// Writes rows as CSV: titles first, numbers that read back to the same f64, an empty field for no value.
pub struct CsvWriter<W: Write> {
    columns: Vec<Column>,
    table: csv::Writer<W>,
    rows: u64,
    /// A row in the making: whole ones take half as long as fields.
    row: StringRecord,
    number: NumberText,
}

impl<W: Write> CsvWriter<W> {
    /// Writes the titles of `columns` to `out`.
    ///
    /// # Errors
    /// When `out` does not take them.
    pub fn new(columns: Vec<Column>, out: W) -> Result<CsvWriter<W>, TableError> {
        let mut writer = CsvWriter::resumed(columns, out);
        writer.table.write_record(writer.columns.iter().map(|column| &column.name))?;
        Ok(writer)
    }

    /// Continues `out`, which holds the titles and any number of rows.
    pub fn resumed(columns: Vec<Column>, out: W) -> CsvWriter<W> {
        CsvWriter {
            columns,
            table: csv::Writer::from_writer(out),
            rows: 0,
            row: StringRecord::new(),
            number: NumberText::default(),
        }
    }

    /// Hands all rows so far to the writer.
    ///
    /// # Errors
    /// When it does not take them.
    pub fn flush(&mut self) -> Result<(), TableError> {
        Ok(self.table.flush()?)
    }

    /// Writes what is left, and gives the writer back.
    ///
    /// # Errors
    /// When it does not take the rows.
    pub fn finish(mut self) -> Result<W, TableError> {
        self.table.flush()?;
        self.table.into_inner().map_err(|error| error.into_error().into())
    }
}

impl<W: Write> RowWriter for CsvWriter<W> {
    fn row(&mut self, values: &[Value<'_>]) -> Result<(), TableError> {
        self.rows += 1;
        if values.len() != self.columns.len() {
            return Err(TableError::WrongLength { row: self.rows, found: values.len(), expected: self.columns.len() });
        }
        self.row.clear();
        for (column, value) in self.columns.iter().zip(values) {
            let field = match column.taken(*value, self.rows)? {
                Value::Number(number) => self.number.of(number),
                Value::Count(count) => self.number.of_count(count),
                Value::Text(text) => text,
                Value::Nothing => "",
            };
            self.row.push_field(field);
        }
        Ok(self.table.write_byte_record(self.row.as_byte_record())?)
    }
}
