//! Runs of devices with a memory, or over ground that moves vertically too.

use core::marker::PhantomData;

use sprag_shared::body::Body;
use sprag_shared::drivetrain::drive::Drive;
use sprag_shared::drivetrain::elastic::ElasticPair;
use sprag_shared::fixed::RungeKutta4;
use sprag_shared::hybrid::Machine;
use sprag_shared::hybrid::exponential::ExponentialMidpoint;
use sprag_shared::hybrid::path::Tracer;
use sprag_shared::hybrid::resolve::WithMachine;
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
    resolve(task, Resolved { task, tracer, precision: PhantomData })
}

/// By the exponential midpoint method where there is an elastic clutch, and else by Runge-Kutta at the same step.
fn exponential<S: Real>(task: &Task<'_>, step: S) -> Result<DeviceRun, Failure> {
    let tracer = RungeKutta4 { step };
    resolve(task, Stiff(Resolved { task, tracer: &tracer, precision: PhantomData }))
}

fn resolve<S: Real, W: WithMachine<S, Output = Result<DeviceRun, Failure>>>(
    task: &Task<'_>,
    next: W,
) -> Result<DeviceRun, Failure> {
    task.device().drivetrain.resolve(&task.scene.structure(task.index), task.ground.vertical.is_some(), next)?
}

struct Resolved<'a, S, T> {
    task: &'a Task<'a>,
    tracer: &'a T,
    precision: PhantomData<S>,
}

struct Stiff<'a, S>(Resolved<'a, S, RungeKutta4<S>>);

impl<S: Real, T: Tracer<S>> WithMachine<S> for Resolved<'_, S, T> {
    type Output = Result<DeviceRun, Failure>;

    fn with<B: Body<S>, D: Drive<S, X, G>, const X: usize, const G: usize>(
        self,
        machine: Machine<S, B, D, X, G>,
    ) -> Self::Output {
        follow(self.task, &machine, self.tracer)
    }
}

impl<S: Real> WithMachine<S> for Stiff<'_, S> {
    type Output = Result<DeviceRun, Failure>;

    fn with<B: Body<S>, D: Drive<S, X, G>, const X: usize, const G: usize>(
        self,
        machine: Machine<S, B, D, X, G>,
    ) -> Self::Output {
        self.0.with(machine)
    }

    fn with_elastic<B: Body<S>>(self, machine: Machine<S, B, ElasticPair<S>, 4, 5>) -> Self::Output {
        follow(self.0.task, &machine, &ExponentialMidpoint { step: self.0.tracer.step })
    }
}

fn follow<S: Real, B: Body<S>, D: Drive<S, X, G>, T: Tracer<S>, const X: usize, const G: usize>(
    task: &Task<'_>,
    machine: &Machine<S, B, D, X, G>,
    tracer: &T,
) -> Result<DeviceRun, Failure> {
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
