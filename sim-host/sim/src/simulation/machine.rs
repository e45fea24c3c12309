//! Runs of devices with a memory, or over ground that moves vertically too.

use sprag_loops::{HybridLoop, Method, hybrid, hybrid_f32};
use sprag_shared::math::scalar::Real;
use sprag_shared::method::fixed::{FixedStep, Scheme};
use sprag_shared::motion::hybrid::HybridSystem;
use sprag_shared::motion::state::Phase;

use super::device_run::{DeviceRun, Found};
use super::run::{Failure, Task};
use super::stable_step::stable_step_of;
use crate::scene::accuracy::Precision;

/// Runs the device of `task`.
pub(super) fn run(task: &Task<'_>) -> Result<DeviceRun, Failure> {
    let accuracy = &task.scene.file.accuracy;
    match (accuracy.precision, task.step()) {
        (Precision::F64, None) => follow(task, |_| hybrid(Method::Adaptive(accuracy.tolerance))),
        (Precision::F64, Some(step)) => {
            follow(task, |machine| hybrid(accuracy.method.in_steps(stable_step_of(machine, accuracy.method, step))))
        }
        (Precision::F32, step) => follow(task, |machine| {
            let step = stable_step_of(machine, accuracy.method, step.unwrap_or(1e-3)) as f32;
            hybrid_f32(accuracy.method.fixed(step).unwrap_or(FixedStep { scheme: Scheme::RungeKutta4, step }))
        }),
    }
}

/// Runs the device of `task` by the method for its equations.
fn follow<S: Real>(
    task: &Task<'_>,
    method: impl FnOnce(&HybridSystem<S>) -> Box<dyn HybridLoop<S>>,
) -> Result<DeviceRun, Failure> {
    let structure = task.scene.structure(task.index);
    let machine: HybridSystem<S> = task.device().drivetrain.resolve(&structure, task.ground.vertical.is_some())?;
    let method = method(&machine);
    let loaded = task.loaded()?;
    let course = task.course(&loaded.block);
    let mut state = match task.released() {
        Some((rotation, velocity)) => machine.released_at(S::of(rotation), S::of(velocity), task.ground_at_start().map(S::of)),
        None => machine.at_rest(),
    };
    let mut watchers = task.watchers::<S>(&loaded)?;
    task.ended(course.follow_machine(&machine, &*method, &mut state, &mut watchers, || !task.interrupt.is_set()))?;
    let phase = state.motion.phase;
    if phase != Phase::Overturned {
        watchers.recorder.finish(task.end(), phase == Phase::Rest);
    }
    let peaks = watchers.peaks;
    let mut found = Found::watched(task, watchers);
    found.missed_engagements = state.device.missed;
    Ok(DeviceRun::of(task, &state.motion, &peaks, found))
}
