//! Columns of a table, each with the value that it takes of a row's subject.

use super::column::Column;
use super::error::TableError;
use super::table::{RowWriter, Table};
use super::value::Value;

/// The value of a column in the row of a subject.
type Taken<R> = Box<dyn for<'a> Fn(&'a R) -> Value<'a>>;

/// The columns of a table whose rows have an `R` each as their subject: every column is described once, with its value.
pub struct Fields<R> {
    fields: Vec<(Column, Taken<R>)>,
}

impl<R> Default for Fields<R> {
    fn default() -> Self {
        Fields { fields: Vec::new() }
    }
}

impl<R> Fields<R> {
    /// Those, and `column` on the right, whose values are `value` of the subjects.
    #[must_use]
    pub fn with(mut self, column: Column, value: impl for<'a> Fn(&'a R) -> Value<'a> + 'static) -> Self {
        self.fields.push((column, Box::new(value)));
        self
    }

    /// The columns, from the left.
    pub fn columns(&self) -> Vec<Column> {
        self.fields.iter().map(|(column, _)| column.clone()).collect()
    }

    /// Gives the row of `subject` to `writer`.
    ///
    /// # Errors
    /// The errors of `writer`.
    pub fn row(&self, subject: &R, writer: &mut dyn RowWriter) -> Result<(), TableError> {
        let values: Vec<Value<'_>> = self.fields.iter().map(|(_, value)| value(subject)).collect();
        writer.row(&values)
    }
}

/// A table of its columns and the subjects of its rows.
pub struct FieldTable<R> {
    /// The columns, each with its value.
    pub fields: Fields<R>,
    /// The subjects.
    pub rows: Vec<R>,
}

impl<R> Table for FieldTable<R> {
    fn columns(&self) -> Vec<Column> {
        self.fields.columns()
    }

    fn rows(&self, writer: &mut dyn RowWriter) -> Result<(), TableError> {
        self.rows.iter().try_for_each(|row| self.fields.row(row, writer))
    }
}
