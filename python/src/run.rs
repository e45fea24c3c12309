//! Responses of a scene's devices.

use numpy::{IntoPyArray as _, PyArrayMethods as _};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sprag_sim::history::Sample;
use sprag_sim::record::{RecordSummary, every_warning};
use sprag_sim::scene::Scene as SimScene;
use sprag_sim::simulation::DeviceRun;
use sprag_sim::simulation::energy::COLUMNS;
use sprag_sim::simulation::simulate as simulated;

use crate::errors::{Raise as _, by_argument, refused};
use crate::long_call::long_call;
use crate::scene::Scene;

/// Runs every device of a scene. A dict of each: its summary as JSON, its history as arrays, and warnings.
///
/// # Errors
/// `InputError` and `RunError`.
#[pyfunction]
pub fn simulate<'py>(py: Python<'py>, scene: &Scene) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let scene = &scene.scene;
    let runs = long_call(py, |interrupt| {
        let ground = scene.ground_motions().map_err(|error| error.raise())?;
        let runs = simulated(scene, &ground, interrupt).map_err(|error| error.raise())?;
        PyResult::Ok((runs, warnings(scene, &ground.records)))
    })?;
    let (runs, warnings) = runs?;
    runs.into_iter().map(|run| as_dict(py, run, &warnings)).collect()
}

/// What looks like a mistake in `scene` and its `records`, a line each.
pub fn warnings(scene: &SimScene, records: &[RecordSummary]) -> Vec<String> {
    scene.warnings().into_iter().chain(every_warning(records).iter().map(|line| by_argument(line))).collect()
}

/// A run as Python has it, with the `warnings` of its scene.
///
/// # Errors
/// Those of the interpreter.
pub fn as_dict<'py>(py: Python<'py>, run: DeviceRun, warnings: &[String]) -> PyResult<Bound<'py, PyDict>> {
    let samples = &run.history.samples;
    let column = |pick: fn(&Sample) -> f64| samples.iter().map(pick).collect::<Vec<f64>>().into_pyarray(py);
    let rows = |first: fn(&Sample) -> f64, second: fn(&Sample) -> f64| {
        let both: Vec<f64> = samples.iter().map(first).chain(samples.iter().map(second)).collect();
        both.into_pyarray(py).reshape([2, samples.len()])
    };
    let dict = PyDict::new(py);
    let energy = run.energy.as_ref().map(|energy| {
        let columns = PyDict::new(py);
        let history = &energy.history;
        columns.set_item("time_s", history.iter().map(|(time, _)| *time).collect::<Vec<f64>>().into_pyarray(py))?;
        for (index, name) in COLUMNS.iter().enumerate() {
            columns
                .set_item(name, history.iter().map(|(_, shares)| shares.row()[index]).collect::<Vec<f64>>().into_pyarray(py))?;
        }
        PyResult::Ok(columns)
    });
    dict.set_item("energy", energy.transpose()?)?;
    dict.set_item("summary", serde_json::to_string(&run).map_err(refused)?)?;
    dict.set_item("warnings", warnings)?;
    dict.set_item("t", column(|sample| sample.time_s))?;
    dict.set_item("y", rows(|sample| sample.rotation_rad, |sample| sample.velocity_rad_s)?)?;
    dict.set_item("acceleration_rad_s2", column(|sample| sample.acceleration_rad_s2))?;
    dict.set_item("ground_m_s2", column(|sample| sample.ground_m_s2))?;
    dict.set_item("force_ratio", rows(|sample| sample.force_ratio[0], |sample| sample.force_ratio[1])?)?;
    dict.set_item("displacement_m", column(|sample| sample.displacement_m))?;
    dict.set_item("engaged", samples.iter().map(|sample| sample.engaged).collect::<Vec<u8>>().into_pyarray(py))?;
    dict.set_item("impacts_s", run.history.impacts_s.into_pyarray(py))?;
    Ok(dict)
}
