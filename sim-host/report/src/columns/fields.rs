//! Columns of a table, each with the value that it takes of a row's subject.

use super::column::Column;
use super::error::TableError;
use super::table::RowWriter;
use super::value::Value;

/// The value of a column in the row of a subject.
type Taken<R> = Box<dyn for<'a> Fn(&'a R) -> Value<'a>>;

/// The columns of a table whose rows tell of an `R` each: every column is described once, with its value.
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
    /// Those of `writer`.
    pub fn row(&self, subject: &R, writer: &mut dyn RowWriter) -> Result<(), TableError> {
        let values: Vec<Value<'_>> = self.fields.iter().map(|(_, value)| value(subject)).collect();
        writer.row(&values)
    }
}
