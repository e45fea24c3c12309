//! Tables as columns of NumPy arrays.

use numpy::IntoPyArray as _;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use sprag_report::columns::{Column, Kind, RowWriter, Table, TableError, Value};

use crate::errors::failed;

/// A column that grows.
enum Growing {
    Number(Vec<f64>),
    Count(Vec<u64>),
    Text(Vec<Option<String>>),
}

/// Columns that grow row by row.
struct Rows {
    columns: Vec<(Column, Growing)>,
}

impl RowWriter for Rows {
    fn row(&mut self, values: &[Value<'_>]) -> Result<(), TableError> {
        for ((_, column), value) in self.columns.iter_mut().zip(values) {
            match (column, value) {
                (Growing::Number(numbers), Value::Number(number)) => numbers.push(*number),
                (Growing::Number(numbers), Value::Count(count)) => numbers.push(*count as f64),
                (Growing::Number(numbers), _) => numbers.push(f64::NAN),
                (Growing::Count(counts), Value::Count(count)) => counts.push(*count),
                (Growing::Count(counts), _) => counts.push(0),
                (Growing::Text(texts), Value::Text(text)) => texts.push((!text.is_empty()).then(|| (*text).to_owned())),
                (Growing::Text(texts), _) => texts.push(None),
            }
        }
        Ok(())
    }
}

/// A dict of tables by their names.
///
/// # Errors
/// `RunError` for a table that contradicts its columns.
pub fn tables<'py, const N: usize>(
    py: Python<'py>,
    tables: [(&str, Result<Columns, TableError>); N],
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (name, table) in tables {
        dict.set_item(name, table.map_err(failed)?.dict(py)?)?;
    }
    Ok(dict)
}

/// A table that Python has not got yet, so that it can be made without the interpreter's lock.
pub struct Columns(Vec<(Column, Growing)>);

impl Columns {
    /// Of `table`. Numbers that are not there are NaN, and whole numbers of which some are not there are floating-point numbers.
    ///
    /// # Errors
    /// [`TableError`] of a table that contradicts its columns.
    pub fn of(table: &dyn Table) -> Result<Columns, TableError> {
        let growing = |column: &Column| match (column.kind, column.nullable) {
            (Kind::Text, _) => Growing::Text(Vec::new()),
            (Kind::Count, false) => Growing::Count(Vec::new()),
            (Kind::Number, _) | (Kind::Count, true) => Growing::Number(Vec::new()),
        };
        let columns =
            table.columns().into_iter().map(|column| (growing(&column), column)).map(|(growing, column)| (column, growing));
        let mut rows = Rows { columns: columns.collect() };
        table.rows(&mut rows)?;
        Ok(Columns(rows.columns))
    }

    /// As a dict of arrays by the columns' names; texts are lists.
    ///
    /// # Errors
    /// Those of the interpreter.
    pub fn dict(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let dict = PyDict::new(py);
        for (column, growing) in self.0 {
            match growing {
                Growing::Number(numbers) => dict.set_item(column.name, numbers.into_pyarray(py))?,
                Growing::Count(counts) => dict.set_item(column.name, counts.into_pyarray(py))?,
                Growing::Text(texts) => dict.set_item(column.name, PyList::new(py, texts)?)?,
            }
        }
        Ok(dict)
    }
}
