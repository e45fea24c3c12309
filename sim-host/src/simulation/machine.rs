//! Runs of devices with a memory, or over ground that moves vertically too.

use sprag_shared::fixed::RungeKutta4;
use sprag_shared::hybrid::Machine;
use sprag_shared::hybrid::exponential::ExponentialMidpoint;
use sprag_shared::hybrid::path::Tracer;
use sprag_shared::hybrid::series::Series;
use sprag_shared::rocking::Phase;
use sprag_shared::scalar::Real;

use super::device_run::{DeviceRun, Found};
use super::run::{Failure, Task};
use crate::batch::case::TERMS;
use crate::scene::accuracy::{MethodName, Precision};

/// Runs the device of `task`.
pub(super) fn run(task: &Task<'_>) -> Result<DeviceRun, Failure> {
    let accuracy = &task.scene.file.accuracy;
    match (accuracy.precision, accuracy.method, task.step()) {
        (Precision::F64, MethodName::RungeKutta4, Some(step)) => with_method(task, &RungeKutta4 { step }),
        (Precision::F64, MethodName::ExponentialMidpoint, Some(step)) => exponential(task, step),
        (Precision::F64, _, Some(step)) => with_method(task, &Series::<f64, TERMS>::fixed(step)),
        (Precision::F64, _, None) => with_method(task, &Series::<f64, TERMS>::adaptive(accuracy.tolerance)),
        (Precision::F32, method, step) => {
            let step = step.unwrap_or(1e-3) as f32;
            match method {
                MethodName::ExponentialMidpoint => exponential(task, step),
                _ => with_method(task, &RungeKutta4 { step }),
            }
        }
    }
}

/// By one method for every device.
fn with_method<S: Real, T: Tracer<S>>(task: &Task<'_>, tracer: &T) -> Result<DeviceRun, Failure> {
    follow(task, &resolve(task)?, tracer)
}

/// By the exponential midpoint method where there is an elastic clutch, and else by Runge-Kutta at the same step.
fn exponential<S: Real>(task: &Task<'_>, step: S) -> Result<DeviceRun, Failure> {
    let machine = resolve(task)?;
    if machine.drive.traits().springs {
        follow(task, &machine, &ExponentialMidpoint { step })
    } else {
        follow(task, &machine, &RungeKutta4 { step })
    }
}

fn resolve<S: Real>(task: &Task<'_>) -> Result<Machine<S>, Failure> {
    Ok(task.device().drivetrain.resolve(&task.scene.structure(task.index), task.ground.vertical.is_some())?)
}

fn follow<S: Real, T: Tracer<S>>(task: &Task<'_>, machine: &Machine<S>, tracer: &T) -> Result<DeviceRun, Failure> {
    let loaded = task.loaded()?;
    let course = task.course(&loaded.block);
    let mut state = match task.released() {
        Some((rotation, velocity)) => machine.released_at(S::of(rotation), S::of(velocity), task.ground_at_start().map(S::of)),
        None => machine.at_rest(),
    };
    let mut watchers = task.watchers::<S>(&loaded)?;
    course.follow_machine(machine, tracer, &mut state, &mut watchers, || !task.interrupt.is_set()).map_err(Failure::Stopped)?;
    if task.interrupt.is_set() {
        return Err(Failure::Interrupted);
    }
    let phase = state.motion.phase;
    if phase != Phase::Overturned {
        watchers.recorder.finish(task.end(), phase == Phase::Rest);
    }
    let peaks = watchers.peaks;
    let mut found = Found::watched(task, watchers);
    found.missed_engagements = state.device.missed;
    Ok(DeviceRun::of(task, &state.motion, &peaks, found))
}
