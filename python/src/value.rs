//! Values of Python as those of a scene.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyInt, PyString};
use toml::{Table, Value};

/// Deepest tables in tables.
const DEEPEST: usize = 16;

/// `object` as TOML has it: a bool, a number, a text, a path, a dict or a sequence of these. A key of a dict without a value (None) is left out.
///
/// # Errors
/// `TypeError` for any other object, `OverflowError` for an integer beyond 64 bits.
pub fn value(object: &Bound<'_, PyAny>) -> PyResult<Value> {
    value_within(object, DEEPEST)
}

/// The items of a dict as a table.
///
/// # Errors
/// As [`value`].
pub fn table(dict: &Bound<'_, PyDict>) -> PyResult<Table> {
    table_within(dict, DEEPEST)
}

/// Whether `object` is a bool, or one of NumPy, which is called `bool_` before version 2.
///
/// # Errors
/// Those of the interpreter.
pub fn is_bool(object: &Bound<'_, PyAny>) -> PyResult<bool> {
    let named = |name: &Bound<'_, PyString>| name == "bool" || name == "bool_";
    Ok(object.is_instance_of::<PyBool>() || named(&object.get_type().name()?))
}

fn table_within(dict: &Bound<'_, PyDict>, depth: usize) -> PyResult<Table> {
    let mut table = Table::new();
    for (key, object) in dict.iter().filter(|(_, object)| !object.is_none()) {
        table.insert(key.extract()?, value_within(&object, depth)?);
    }
    Ok(table)
}

fn value_within(object: &Bound<'_, PyAny>, depth: usize) -> PyResult<Value> {
    let Some(depth) = depth.checked_sub(1) else {
        return Err(PyTypeError::new_err("tables of a scene are not that deep"));
    };
    if let Ok(dict) = object.cast::<PyDict>() {
        return table_within(dict, depth).map(Value::Table);
    }
    if is_bool(object)? {
        return object.is_truthy().map(Value::Boolean);
    }
    if object.is_instance_of::<PyInt>() || object.hasattr("__index__")? && !object.hasattr("__len__")? {
        return object.extract().map(Value::Integer);
    }
    if object.is_instance_of::<PyString>() {
        return object.extract().map(Value::String);
    }
    if object.hasattr("__fspath__")? {
        return object.call_method0("__fspath__")?.extract().map(Value::String);
    }
    let is_scalar =
        !object.hasattr("__len__")? || object.getattr("shape").is_ok_and(|shape| shape.len().is_ok_and(|length| length == 0));
    if is_scalar && object.hasattr("__float__")? {
        return object.extract().map(Value::Float);
    }
    let Ok(items) = object.try_iter() else {
        let name = object.get_type().name()?;
        return Err(PyTypeError::new_err(format!(
            "a value of a scene is a bool, a number, a text, a dict or a sequence, and not {name}"
        )));
    };
    items.map(|item| value_within(&item?, depth)).collect::<PyResult<_>>().map(Value::Array)
}
