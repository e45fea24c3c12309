//! Studies that are divided into parts.

use std::path::PathBuf;

use pyo3::prelude::*;
use sprag_report::long_run::division::Division;

use crate::errors::refused;

fn division(folder: &std::path::Path) -> PyResult<Division> {
    Division::read(folder).map_err(refused)
}

/// The plan in a folder: its key, the number of parts, the number of rows, and the folder that its command is given in.
///
/// # Errors
/// `InputError` where there is none.
#[pyfunction]
pub fn plan(folder: PathBuf) -> PyResult<(String, u32, usize, PathBuf)> {
    let Division { key, parts, origin, working_folder, .. } = division(&folder)?;
    Ok((key, parts, origin.rows, working_folder))
}

/// Numbers of the parts of the plan in a folder that are not there.
///
/// # Errors
/// `InputError` where there is no plan.
#[pyfunction]
pub fn missing_parts(py: Python<'_>, folder: PathBuf) -> PyResult<Vec<u32>> {
    let division = division(&folder)?;
    Ok(py.detach(|| division.missing(&folder)))
}
