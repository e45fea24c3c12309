//! Cases of ideal devices over horizontal ground.

use crate::{Case, CaseError, FixedMethod, Initially, RunEnd, Shape, TERMS};
use sprag_shared::method::dense_output::{DenseOutput, Integrator};
use sprag_shared::method::fixed::{FixedStep, Scheme};
use sprag_shared::method::taylor::Taylor;
use sprag_shared::motion::device_snapshot::DeviceOutput;
use sprag_shared::motion::ideal::IdealSystem;
use sprag_shared::motion::observer::{Event, MonotoneInterval, Observer};
use sprag_shared::motion::state::{BlockState, Limits, Phase, Stopped};
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::observers::peaks::Peaks;

/// What the exponential midpoint method runs.
pub(super) const STIFF: &str = "elastic clutches only: nothing else is stiff";

/// Runs a case that is ideal.
pub(super) fn run(case: &Case<'_>, observer: &mut dyn Observer<f32>) -> Result<RunEnd, CaseError> {
    let system = case.structure.resolve()?;
    let step = case.step;
    match case.method {
        method @ FixedMethod::ExponentialMidpoint => Err(CaseError::Method { method, runs: STIFF }),
        FixedMethod::Taylor => follow(case, &system, &Taylor::<f32, TERMS>::fixed(step), observer),
        FixedMethod::SemiImplicitEuler => follow(case, &system, &FixedStep { scheme: Scheme::SemiImplicitEuler, step }, observer),
        FixedMethod::RungeKutta4 => follow(case, &system, &FixedStep { scheme: Scheme::RungeKutta4, step }, observer),
    }
}

/// The caller's observer, the peaks, and a count of steps. It wants every swing on quiet ground too: digests and the count of steps are of
/// the whole motion, and swings that are summed have no steps.
pub(super) struct Watch<'o> {
    pub observer: &'o mut dyn Observer<f32>,
    pub peaks: Peaks<f32>,
    pub steps: u32,
}

impl Observer<f32> for Watch<'_> {
    fn interval(&mut self, output: &dyn DenseOutput<f32>, interval: &MonotoneInterval<f32>) {
        self.steps += u32::from(interval.from == 0.0);
        self.peaks.interval(output, interval);
        self.observer.interval(output, interval);
    }

    fn device_interval(&mut self, output: &dyn DeviceOutput<f32>, interval: &MonotoneInterval<f32>) {
        self.steps += u32::from(interval.from == 0.0);
        self.peaks.interval(output.motion(), interval);
        self.observer.device_interval(output, interval);
    }

    fn event(&mut self, event: Event, time: f32, state: &BlockState<f32>) {
        self.peaks.event(event, time, state);
        self.observer.event(event, time, state);
    }
}

fn follow<M: Integrator<f32>>(
    case: &Case<'_>,
    system: &IdealSystem<f32>,
    method: &M,
    observer: &mut dyn Observer<f32>,
) -> Result<RunEnd, CaseError> {
    let Case { structure, initially, step, ground, free_time, .. } = case;
    let mut watch = Watch { observer, peaks: Peaks::default(), steps: 0 };
    let mut state = match *initially {
        Initially::Rest => BlockState::default(),
        Initially::Released { rotation, velocity } => system.released_at(rotation, velocity, ground.first()[0]),
    };
    watch.peaks.rocked = state.phase == Phase::Rocking;
    let block = structure.loaded()?.block;
    let no_return = |bound: f32| structure.geometry.point_of_no_return(block.slenderness(), f64::from(bound)) as f32;
    let overturned = no_return(ground.bound());
    let mut follow = |shape: &Shape, start: f32, duration: f32, overturned: f32| -> Result<(), Stopped> {
        let limits = Limits { overturned, events: most_events(duration, *step) };
        watch.peaks.origin = start;
        system.advance(method, &mut state, shape, duration, &limits, &mut watch)
    };
    ground.try_for_each(|shape, _, start, duration| follow(shape, start, duration, overturned))?;
    follow(&Shape::Quiet, ground.duration(), *free_time, no_return(0.0))?;
    let Watch { peaks, steps, .. } = watch;
    Ok(RunEnd { outcome: Outcome::of(&state, &peaks), state, peaks, steps, missed: 0 })
}

/// Events that a piece of `duration` (s) may have: every step (s) may meet a few, and dying impacts accumulate before they are
/// summed.
pub(super) fn most_events(duration: f32, step: f32) -> u32 {
    10_000 + (duration / step) as u32 * 8
}
