//! Rows as CSV.

use std::fmt::Write as _;
use std::io::Write;

use super::column::Column;
use super::error::TableError;
use super::table::RowWriter;
use super::value::Value;

/// Writes rows as CSV: titles first, numbers that read back to the same f64, an empty field for no value.
pub struct CsvWriter<W: Write> {
    columns: Vec<Column>,
    table: csv::Writer<W>,
    rows: u64,
    /// A field in the making.
    field: String,
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
        CsvWriter { columns, table: csv::Writer::from_writer(out), rows: 0, field: String::new() }
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

/// Writes `number` into `text` as `{:?}` does: as short as it reads back to the same f64.
pub(super) fn write_number(text: &mut String, number: f64) -> std::fmt::Result {
    // Where `{:?}` has no exponent.
    if (1e-4..1e16).contains(&number.abs()) {
        text.write_str(zmij::Buffer::new().format_finite(number))
    } else {
        write!(text, "{number:?}")
    }
}

impl<W: Write> RowWriter for CsvWriter<W> {
    fn row(&mut self, values: &[Value<'_>]) -> Result<(), TableError> {
        self.rows += 1;
        if values.len() != self.columns.len() {
            return Err(TableError::WrongLength { row: self.rows, found: values.len(), expected: self.columns.len() });
        }
        for (column, value) in self.columns.iter().zip(values) {
            self.field.clear();
            // Writing into a string does not fail.
            let _ = match column.taken(*value, self.rows)? {
                Value::Number(number) => write_number(&mut self.field, number),
                Value::Count(count) => write!(self.field, "{count}"),
                Value::Text(text) => self.field.write_str(text),
                Value::Nothing => Ok(()),
            };
            self.table.write_field(&self.field)?;
        }
        // Ends the row.
        Ok(self.table.write_record(None::<&[u8]>)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_the_texts_of_the_standard_library() {
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            state
        };
        let edges = [0.0, -0.0, 1.0, 1e-4, 1e16, 1e15, 0.1 + 0.2, f64::MIN_POSITIVE, f64::MAX, f64::NAN, f64::INFINITY, 5e-324];
        let near = edges.iter().flat_map(|edge| [edge.next_down(), *edge, edge.next_up(), -*edge]);
        let any: Vec<f64> = (0..200_000).map(|_| f64::from_bits(random())).collect();
        let usual: Vec<f64> = (0..200_000).map(|_| (random() >> 11) as f64 / (1_u64 << (random() % 60)) as f64).collect();
        let mut text = String::new();
        for number in near.chain(any).chain(usual) {
            text.clear();
            write_number(&mut text, number).unwrap();
            assert_eq!(text, format!("{number:?}"));
        }
    }
}
