//! Runs of ideal devices, by the loop that knows nothing else.

use sprag_loops::Method;
use sprag_shared::motion::ideal::IdealSystem;
use sprag_shared::motion::ideal::device_view::Watched;
use sprag_shared::motion::state::{BlockState, Phase};
use sprag_shared::observers::peaks::Peaks;

use super::device_run::{DeviceRun, Found};
use super::run::{Failure, Task};
use super::step_end::{self, Steps};
use crate::ground_motion::SumSegment;
use crate::scene::accuracy::{EventTreatment, Precision};

/// Runs the device of `task`.
pub(super) fn run(task: &Task<'_>) -> Result<DeviceRun, Failure> {
    let accuracy = &task.scene.file.accuracy;
    match (accuracy.precision, task.step()) {
        (Precision::F64, None) => with_method(task, Method::Adaptive(accuracy.tolerance)),
        (Precision::F64, Some(step)) => with_method(task, accuracy.method.in_steps(step)),
        (Precision::F32, step) => with_method(task, accuracy.method.in_steps(step.unwrap_or(1e-3) as f32)),
    }
}

fn with_method<S: sprag_loops::Precision>(task: &Task<'_>, method: Method<S>) -> Result<DeviceRun, Failure> {
    let system: IdealSystem<S> = task.scene.structure(task.index).resolve()?;
    let loaded = task.loaded()?;
    let course = task.course(&loaded.block);
    let mut state = BlockState::default();
    if let Some((rotation, velocity)) = task.released() {
        let [ground, ..] = task.ground_at_start();
        state = system.released_at(S::of(rotation), S::of(velocity), S::of(ground));
    }
    let mut continues = || !task.interrupt.is_set();
    let accuracy = &task.scene.file.accuracy;
    if let (EventTreatment::StepEnd, Some(step)) = (accuracy.events, task.step()) {
        // Per R the terminals' acceleration; σ of the loaded block weighs on the bare one.
        let coupling = loaded.device.mass_ratio / loaded.block.inertia_ratio();
        let force_scale = coupling * task.force_scale(&loaded);
        let steps = Steps { method: accuracy.method, step, interval: task.interval, force_scale };
        let trace = step_end::follow(&course, &system, &steps, (state.rotation, state.velocity), &mut continues);
        task.ended(Ok(()))?;
        let peaks = Peaks { rocked: trace.peaks.rocked || task.released().is_some(), ..trace.peaks };
        let state = trace.state;
        return Ok(DeviceRun::of(task, &state, &peaks, trace.into()));
    }
    let coupling = S::of(loaded.device.mass_ratio / loaded.block.inertia_ratio());
    let mut watchers = task.watchers::<S>(&loaded)?;
    let still = SumSegment::QUIET;
    let mut watched =
        Watched { engaged: system.engaged, clutch: system.clutch, coupling, segment: still, observer: &mut watchers };
    task.ended(course.follow(&system, &*S::ideal(method), &mut state, &mut watched, continues))?;
    if state.phase != Phase::Overturned {
        watchers.recorder.finish(task.end(), state.phase == Phase::Rest);
    }
    let peaks = watchers.peaks;
    Ok(DeviceRun::of(task, &state, &peaks, Found::watched(task, watchers)))
}
