//! A controller in closed loop with the plant, its sensors and its clutches.

use std::cell::Cell;

use numpy::{Element, IntoPyArray as _};
use pyo3::exceptions::PyRecursionError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sprag_shared::observers::counted_swing::clutches;
use sprag_shared::structure::block::GRAVITY;
use sprag_sim::accuracy::Closeness;
use sprag_sim::closed_loop::report::LoopReport;
use sprag_sim::closed_loop::run::Tick;
use sprag_sim::closed_loop::{LoopFailure, LoopScene};
use sprag_sim::digest::of_decisions;
use sprag_sim::interrupt::Interrupt;

use crate::errors::{Raise as _, range, refused};
use crate::law::PythonLaw;
use crate::long_call::long_call;
use crate::run::{as_dict, warnings};
use crate::scene::Scene;

/// Runs the loop over device number `device`, the first clutched pair without one, by the law of the scene or a function. A dict: its summary
/// as JSON, an array of each column of its history, the run of the ideal pair without a controller, and warnings.
///
/// # Errors
/// `InputError`, `RunError`, and what the function raises.
#[pyfunction]
#[pyo3(signature = (scene, *, device = None, seed = None, law = None, predicts = true))]
pub fn closed_loop<'py>(
    py: Python<'py>,
    scene: &Scene,
    device: Option<usize>,
    seed: Option<u64>,
    law: Option<Py<PyAny>>,
    predicts: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let LoopOf { desk, index, seed } = LoopOf::new(scene, device, seed)?;
    let report = match law {
        None => long_call(py, |interrupt| run(&desk, index, seed, interrupt, None))?,
        // The function needs the interpreter at every tick.
        Some(function) => {
            let _loop = LoopByFunction::enter()?;
            let interrupt = Interrupt::default();
            let law = PythonLaw::new(function, predicts, &interrupt);
            let report = run(&desk, index, seed, &interrupt, Some(&law));
            if let Some(error) = law.failure() {
                return Err(error);
            }
            report
        }
    };
    dict(py, report.map_err(|failure| failure.raise())?.1, &desk)
}

/// Loops by functions within loops by functions, at most: a function that closes a loop by itself would run out of stack.
const MOST_WITHIN: u32 = 8;

thread_local! {
    /// Loops by functions that this thread is in.
    static WITHIN: Cell<u32> = const { Cell::new(0) };
}

/// A loop by a function, while it lasts.
struct LoopByFunction;

impl LoopByFunction {
    /// # Errors
    /// `RecursionError`.
    fn enter() -> PyResult<LoopByFunction> {
        if WITHIN.get() == MOST_WITHIN {
            return Err(PyRecursionError::new_err("clutch laws close loops within loops by clutch laws, without end"));
        }
        WITHIN.set(WITHIN.get() + 1);
        Ok(LoopByFunction)
    }
}

impl Drop for LoopByFunction {
    fn drop(&mut self) {
        WITHIN.set(WITHIN.get() - 1);
    }
}

/// One loop of a scene.
pub struct LoopOf {
    /// The scene.
    pub desk: LoopScene,
    /// Number of the device.
    pub index: usize,
    /// Of the sensors' errors and noise.
    pub seed: u64,
}

impl LoopOf {
    /// Over device number `device` of `scene`, the first clutched pair without one, with the scene's own seed without one.
    ///
    /// # Errors
    /// `InputError`.
    pub fn new(scene: &Scene, device: Option<usize>, seed: Option<u64>) -> PyResult<LoopOf> {
        let desk = LoopScene::new(scene.scene.clone()).map_err(|error| error.raise())?;
        let index = device.unwrap_or(desk.pairs[0]);
        if !desk.pairs.contains(&index) {
            return Err(range("device", index, &format!("the number of a clutched pair: one of {:?}", desk.pairs)));
        }
        let seed = seed.unwrap_or(desk.controller.sensors.seed());
        Ok(LoopOf { desk, index, seed })
    }
}

/// The loop as `sprag loop` runs it, and how closely that follows the plant.
pub fn run(
    desk: &LoopScene,
    index: usize,
    seed: u64,
    interrupt: &Interrupt,
    law: Option<&PythonLaw>,
) -> Result<(Option<Closeness>, LoopReport), LoopFailure> {
    let task = desk.task(index, seed, interrupt);
    let (task, error, looped) = match law {
        None => task.answered()?,
        Some(law) => task.answered_by(|task| task.driver_by(law.clone()))?,
    };
    let mut report = LoopReport::of_answer(&task, error, looped)?;
    if law.is_some() {
        "python".clone_into(&mut report.summary.law);
    }
    Ok((task.closeness, report))
}

/// A loop of `desk` as Python has it.
///
/// # Errors
/// Those of the interpreter.
pub fn dict<'py>(py: Python<'py>, report: LoopReport, desk: &LoopScene) -> PyResult<Bound<'py, PyDict>> {
    let of_scene = warnings(&desk.scene, &desk.ground.records);
    let of_loop = report.summary.warning(&desk.scene.origin, desk.controller.prelude_s);
    let dict = PyDict::new(py);
    dict.set_item("summary", serde_json::to_string(&report.summary).map_err(refused)?)?;
    dict.set_item("digest", of_decisions(&report.ticks))?;
    let columns = Columns { dict: &dict, ticks: &report.ticks };
    columns.add("t", |tick| tick.plant.time)?;
    columns.add("ground_m_s2", |tick| tick.plant.ground[0] * GRAVITY)?;
    columns.add("rotation_rad", |tick| tick.plant.motion.rotation)?;
    columns.add("velocity_rad_s", |tick| tick.plant.motion.velocity)?;
    columns.add("push_1_s2", |tick| tick.plant.push)?;
    columns.add("rotation_estimated_rad", |tick| tick.decision.estimate.rotation)?;
    columns.add("velocity_estimated_rad_s", |tick| tick.decision.estimate.velocity)?;
    columns.add("push_estimated_1_s2", |tick| tick.decision.estimate.push)?;
    columns.add("standing_estimated", |tick| tick.decision.estimate.standing)?;
    columns.add("gyroscope_rad_s", |tick| tick.sample.gyroscope.value)?;
    columns.add("block_accelerometer_along_m_s2", |tick| tick.sample.block_accelerometer[0].value)?;
    columns.add("block_accelerometer_up_m_s2", |tick| tick.sample.block_accelerometer[1].value)?;
    columns.add("ground_accelerometer_along_m_s2", |tick| tick.sample.ground_accelerometer[0].value)?;
    columns.add("ground_accelerometer_up_m_s2", |tick| tick.sample.ground_accelerometer[1].value)?;
    columns.add("encoder_counts", |tick| tick.sample.encoder.counts)?;
    columns.add("wish", |tick| tick.decision.wish as u8)?;
    columns.add("command", |tick| clutches(tick.decision.command))?;
    columns.add("engaged", |tick| clutches(tick.plant.engaged))?;
    columns.add("ideal", |tick| tick.ideal)?;
    columns.add("state", |tick| tick.decision.phase as u8)?;
    columns.add("fault", |tick| tick.decision.fault.map_or(0, |fault| fault.code()))?;
    dict.set_item("ideal_pair", as_dict(py, report.ideal, &of_scene)?)?;
    dict.set_item("warnings", [of_scene, Vec::from_iter(of_loop)].concat())?;
    Ok(dict)
}

/// A dict whose items are quantities of every tick.
struct Columns<'a, 'py> {
    dict: &'a Bound<'py, PyDict>,
    ticks: &'a [Tick],
}

impl Columns<'_, '_> {
    fn add<T: Element>(&self, name: &str, pick: impl Fn(&Tick) -> T) -> PyResult<()> {
        self.dict.set_item(name, self.ticks.iter().map(pick).collect::<Vec<T>>().into_pyarray(self.dict.py()))
    }
}
