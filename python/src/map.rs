//! Overturning maps.

use numpy::{IntoPyArray as _, PyArrayMethods as _};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sprag_sim::map::grid::Grid;
use sprag_studies::map::study::study_rows;

use crate::errors::Raise as _;
use crate::long_call::long_call;
use crate::run::warnings;
use crate::scene::Scene;
use crate::threads;

/// Outcomes and peaks of every device of a scene, and of clutched pairs by every law of its `[map]`, over the axes there: a dict of the
/// names of these maps, axes, arrays by map, y and x, and warnings.
///
/// # Errors
/// `InputError` and `RunError`.
#[pyfunction]
#[pyo3(signature = (scene, *, threads = None))]
pub fn overturning_map<'py>(py: Python<'py>, scene: &Scene, threads: Option<&Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyDict>> {
    let pool = self::threads(threads)?;
    let made = long_call(py, |interrupt| {
        let grid = Grid::new(scene.scene.clone(), scene.table.clone()).map_err(|error| error.raise())?;
        let rows = grid.table_rows();
        let mut outcomes = Vec::with_capacity(rows);
        let [mut rotations, mut accelerations] = [Vec::with_capacity(rows), Vec::with_capacity(rows)];
        let made = pool.install(|| {
            study_rows(&grid, interrupt, |_, result| {
                outcomes.push(result.outcome as u8);
                rotations.push(result.peak_rotation);
                accelerations.push(result.peak_acceleration);
            })
        });
        made.map_err(|error| error.raise())?;
        // The scene itself may lack what its axes set.
        let first = grid.scene_of(0, 0).map_err(|error| error.raise())?;
        let warnings = warnings(&grid.scene, &first.records().map_err(|error| error.raise())?);
        PyResult::Ok((grid, outcomes, rotations, accelerations, warnings))
    })?;
    let (grid, outcomes, rotations, accelerations, warnings) = made?;
    let shape = [grid.mapped().len(), grid.rows(), grid.columns()];
    let dict = PyDict::new(py);
    dict.set_item("devices", grid.mapped().iter().map(|mapped| mapped.name.as_str()).collect::<Vec<_>>())?;
    dict.set_item("warnings", warnings)?;
    dict.set_item("x_key", &grid.map.x.key)?;
    dict.set_item("x", (0..grid.columns()).map(|cell| grid.map.x.value(cell)).collect::<Vec<f64>>().into_pyarray(py))?;
    if let Some(y) = &grid.map.y {
        dict.set_item("y_key", &y.key)?;
        dict.set_item("y", (0..y.cells).map(|cell| y.value(cell)).collect::<Vec<f64>>().into_pyarray(py))?;
    }
    dict.set_item("outcome", outcomes.into_pyarray(py).reshape(shape)?)?;
    dict.set_item("peak_rotation", rotations.into_pyarray(py).reshape(shape)?)?;
    dict.set_item("peak_acceleration", accelerations.into_pyarray(py).reshape(shape)?)?;
    Ok(dict)
}
