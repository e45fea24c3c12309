//! Values of Python as those of a scene.

use std::fmt::Display;

use pyo3::exceptions::{PyOverflowError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyInt, PyString};
use toml::{Table, Value};

use crate::errors::range;

/// What NumPy calls the kinds of its bools, whole numbers, real numbers and objects of Python.
const REAL_KINDS: &str = "biufO";

/// Deepest tables in tables.
const DEEPEST: usize = 16;

/// `object` as TOML has it: a bool, a number, a text, a path, a dict or a sequence of these. An integer beyond 64 bits is a floating-point number,
/// which no key of whole numbers takes. A key of a dict without a value (None) is left out.
///
/// # Errors
/// `TypeError` for any other object.
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

/// A whole number, the value of `key`, which must be `allowed`.
///
/// # Errors
/// `InputError` for one beyond 64 bits, `TypeError` for what is none.
pub fn whole(object: &Bound<'_, PyAny>, key: &str, allowed: &str) -> PyResult<i64> {
    object.extract().map_err(|error: PyErr| match error.is_instance_of::<PyOverflowError>(object.py()) {
        true => range(key, object, allowed),
        false => error,
    })
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
    if object.is_instance_of::<PyString>() {
        return object.extract().map(Value::String);
    }
    let is_one = object.getattr("shape").is_ok_and(|shape| shape.len().is_ok_and(|length| length == 0));
    if is_one && let Ok(dtype) = object.getattr("dtype") {
        // A complex number would be taken by its real part, a time by the number in it.
        if dtype.getattr("kind").and_then(|kind| kind.extract::<String>()).is_ok_and(|kind| !REAL_KINDS.contains(&kind)) {
            return Err(of_another_kind(&dtype));
        }
        // An array of one value.
        if object.hasattr("__len__")? {
            return value_within(&object.call_method0("item")?, depth);
        }
    }
    if object.is_instance_of::<PyInt>() || object.hasattr("__index__")? && !object.hasattr("__len__")? {
        let beyond = |_| {
            let infinity = if object.lt(0)? { f64::NEG_INFINITY } else { f64::INFINITY };
            Ok(Value::Float(object.extract().unwrap_or(infinity)))
        };
        return object.extract().map(Value::Integer).or_else(beyond);
    }
    if object.hasattr("__fspath__")? {
        return object.call_method0("__fspath__")?.extract().map(Value::String);
    }
    if !object.hasattr("__len__")? && object.hasattr("__float__")? {
        return object.extract().map(Value::Float);
    }
    let Ok(items) = object.try_iter() else {
        return Err(of_another_kind(object.get_type().name()?));
    };
    items.map(|item| value_within(&item?, depth)).collect::<PyResult<_>>().map(Value::Array)
}

fn of_another_kind(kind: impl Display) -> PyErr {
    PyTypeError::new_err(format!("a value of a scene is a bool, a number, a text, a dict or a sequence, and not {kind}"))
}
