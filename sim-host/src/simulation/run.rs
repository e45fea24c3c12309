//! `simulate`: every device of a scene under its ground motion.

use serde::Serialize;
use sprag_shared::arc::Method;
use sprag_shared::block::GRAVITY;
use sprag_shared::clutch::Clutch;
use sprag_shared::detected::Switched;
use sprag_shared::equation::Equation;
use sprag_shared::error::ParameterError;
use sprag_shared::fixed::{RungeKutta4, SemiImplicitEuler};
use sprag_shared::observer::Peaks;
use sprag_shared::rocking::{Phase, State, Stopped, System};
use sprag_shared::scalar::Real;
use sprag_shared::structure::WithSystem;
use sprag_shared::taylor::Taylor;

use super::drive::{Course, Overturning};
use super::recorder::Recorder;
use super::step_end::{self, Steps, Trace};
use crate::batch::case::TERMS;
use crate::ground_motion::GroundMotion;
use crate::history::{History, Sample};
use crate::interrupt::Interrupt;
use crate::outcome::Outcome;
use crate::scene::Scene;
use crate::scene::schema::{EventTreatment, MethodName, Precision};

/// Samples of a history when the scene names no interval.
const SAMPLES: f64 = 2000.0;

/// Most samples that a history may have.
const MOST_SAMPLES: f64 = 5e6;

/// Terms of the series in f32: more would only add rounding.
const TERMS_F32: usize = 12;

/// Why a device could not be simulated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RunError {
    /// A parameter that the core refuses.
    #[error("{device}: {error}")]
    Parameter {
        /// Device.
        device: String,
        /// What is wrong.
        error: ParameterError,
    },
    /// The core gave up.
    #[error("{device}: {error}")]
    Stopped {
        /// Device.
        device: String,
        /// Why.
        error: Stopped,
    },
    /// The history would be too long.
    #[error("output.interval_s of {interval} s asks for more than 5 million samples over {duration} s")]
    TooManySamples {
        /// s.
        interval: f64,
        /// s.
        duration: f64,
    },
    /// Ctrl-C.
    #[error("interrupted")]
    Interrupted,
}

/// One device's run. The fields that serialize are the objects in `runs` of `summary.json`; times in s.
#[derive(Clone, Debug, Serialize)]
pub struct DeviceRun {
    /// Its name.
    pub device: String,
    /// Its outcome.
    pub outcome: Outcome,
    /// max |θ|/α; null when overturned.
    pub peak_rotation: Option<f64>,
    /// max |θ̈|/(p²α); null when overturned.
    pub peak_acceleration: Option<f64>,
    /// Impacts.
    pub impacts: u32,
    /// First impact.
    pub first_impact_time_s: Option<f64>,
    /// Rest, overturning or the end of the run.
    pub end_time_s: f64,
    /// Times that the clutch engaged or released.
    pub clutch_switches: u32,
    /// max |F|/(mg) of the inerter's terminals on their support.
    pub peak_force_ratio: f64,
    /// The history, if one was asked for.
    #[serde(skip)]
    pub history: History,
}

/// Runs every device of `scene`.
///
/// # Errors
/// [`RunError`] names the device.
pub fn simulate(scene: &Scene, ground: &GroundMotion, interrupt: &Interrupt) -> Result<Vec<DeviceRun>, RunError> {
    let duration = ground.duration() + scene.free_time_s();
    let interval = scene.file.output.interval_s.unwrap_or((duration / SAMPLES).max(1e-9));
    if duration / interval > MOST_SAMPLES {
        return Err(RunError::TooManySamples { interval, duration });
    }
    (0..scene.devices.len()).map(|index| run_device(scene, ground, index, interval, interrupt)).collect()
}

fn run_device(
    scene: &Scene,
    ground: &GroundMotion,
    index: usize,
    interval: f64,
    interrupt: &Interrupt,
) -> Result<DeviceRun, RunError> {
    let device = scene.devices[index].0.clone();
    let accuracy = &scene.file.accuracy;
    let step = accuracy.step(scene.block.frequency_parameter());
    let run = RunOne { scene, ground, index, interval, interrupt };
    match (accuracy.precision, accuracy.method, step) {
        (Precision::F64, MethodName::RungeKutta4, Some(step)) => run.with_method(&RungeKutta4 { step }),
        (Precision::F64, MethodName::SemiImplicitEuler, Some(step)) => run.with_method(&SemiImplicitEuler { step }),
        (Precision::F64, _, Some(step)) => run.with_method(&Taylor::<f64, TERMS>::fixed(step)),
        (Precision::F64, _, None) => run.with_method(&Taylor::<f64, TERMS>::adaptive(accuracy.tolerance)),
        (Precision::F32, method, step) => {
            let step = step.unwrap_or(1e-3) as f32;
            match method {
                MethodName::RungeKutta4 => run.with_method(&RungeKutta4 { step }),
                MethodName::SemiImplicitEuler => run.with_method(&SemiImplicitEuler { step }),
                MethodName::Taylor => run.with_method(&Taylor::<f32, TERMS_F32>::fixed(step)),
            }
        }
    }
    .map_err(|error| match error {
        Failure::Parameter(error) => RunError::Parameter { device, error },
        Failure::Stopped(error) => RunError::Stopped { device, error },
        Failure::Interrupted => RunError::Interrupted,
    })
}

enum Failure {
    Parameter(ParameterError),
    Stopped(Stopped),
    Interrupted,
}

struct RunOne<'a> {
    scene: &'a Scene,
    ground: &'a GroundMotion,
    index: usize,
    interval: f64,
    interrupt: &'a Interrupt,
}

impl RunOne<'_> {
    fn with_method<S: Real, M: Method<S>>(&self, method: &M) -> Result<DeviceRun, Failure> {
        let structure = self.scene.structure(self.index);
        structure.resolve(Resolved { run: self, method, precision: core::marker::PhantomData }).map_err(Failure::Parameter)?
    }

    #[expect(clippy::too_many_arguments, reason = "the pieces of one result, from two kinds of run")]
    fn result<S: Real>(
        &self,
        state: &State<S>,
        peaks: &Peaks<S>,
        end: f64,
        clutch_switches: u32,
        peak_force_ratio: f64,
        samples: Vec<Sample>,
        impacts_s: Vec<f64>,
    ) -> DeviceRun {
        let device = self.scene.devices[self.index].0.clone();
        let (alpha, p) = (self.scene.block.slenderness(), self.scene.block.frequency_parameter());
        let outcome = Outcome::of(state, peaks);
        let safe = |value: S| (!outcome.overturned()).then_some(value.to_f64());
        DeviceRun {
            device: device.clone(),
            outcome,
            peak_rotation: safe(peaks.rotation).map(|peak| peak / alpha),
            peak_acceleration: safe(peaks.acceleration).map(|peak| peak / (p * p * alpha)),
            impacts: state.impacts,
            first_impact_time_s: peaks.first_impact.map(Real::to_f64),
            end_time_s: peaks.ended.map_or(end, Real::to_f64),
            clutch_switches,
            peak_force_ratio,
            history: History {
                device,
                outcome: outcome.name().to_owned(),
                slenderness_rad: alpha,
                frequency_parameter_1_s: p,
                samples,
                impacts_s,
            },
        }
    }
}

struct Resolved<'a, S, M> {
    run: &'a RunOne<'a>,
    method: &'a M,
    precision: core::marker::PhantomData<S>,
}

impl<S: Real, M: Method<S>> WithSystem<S> for Resolved<'_, S, M> {
    type Output = Result<DeviceRun, Failure>;

    fn with<R: Equation<S>, E: Switched<S>, C: Clutch>(self, system: System<S, R, E, C>) -> Self::Output {
        let RunOne { scene, ground, index, interval, interrupt } = *self.run;
        let device = &scene.devices[index].1;
        let (alpha, p) = (scene.block.slenderness(), scene.block.frequency_parameter());
        let table = &scene.file.block;
        let mut state = State::default();
        let released = table.initial_rotation_ratio != 0.0 || table.initial_velocity_ratio != 0.0;
        if released {
            let at_start = ground.segments().first().map_or(0.0, |segment| segment.shape.acceleration(0.0));
            let (rotation, velocity) = (table.initial_rotation_ratio * alpha, table.initial_velocity_ratio * p * alpha);
            state = system.released_at(S::of(rotation), S::of(velocity), S::of(at_start));
        }
        let course = Course {
            block: &scene.block,
            geometry: scene.geometry(),
            ground,
            free_time: scene.free_time_s(),
            overturning: Overturning::Reached,
        };
        let force_scale = device.mass_ratio * scene.block.size() / GRAVITY;
        let end = ground.duration() + scene.free_time_s();
        let accuracy = &scene.file.accuracy;
        if let (EventTreatment::StepEnd, Some(step)) = (accuracy.events, accuracy.step(p)) {
            let steps = Steps { method: accuracy.method, step, interval, force_scale };
            let trace = step_end::follow(&course, &system, &steps, (state.rotation, state.velocity), || !interrupt.is_set());
            if interrupt.is_set() {
                return Err(Failure::Interrupted);
            }
            let Trace { state, peaks, samples, impacts, switches, peak_force } = trace;
            let peaks = Peaks { rocked: peaks.rocked || released, ..peaks };
            return Ok(self.run.result(&state, &peaks, end, switches, peak_force, samples, impacts));
        }
        let recorder = Recorder::<S, E, C>::new(&system.engaged, force_scale, interval, ground.segments());
        let mut observers = (recorder, Peaks { rocked: released, ..Peaks::default() });
        course.follow(&system, self.method, &mut state, &mut observers, || !interrupt.is_set()).map_err(Failure::Stopped)?;
        if interrupt.is_set() {
            return Err(Failure::Interrupted);
        }
        let (mut recorder, peaks) = observers;
        if state.phase != Phase::Overturned {
            recorder.finish(end, state.phase == Phase::Rest);
        }
        let Recorder { samples, impacts, switches, peak_force, .. } = recorder;
        Ok(self.run.result(&state, &peaks, end, switches, peak_force, samples, impacts))
    }
}
