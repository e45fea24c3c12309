//! Cases of ideal devices over horizontal ground.

use super::{Case, CaseError, Ending, FixedMethod, Initially, RunEnd, Shape, TERMS};
use crate::arc::{Arc, Method};
use crate::clutch::Clutch;
use crate::equation::Equation;
use crate::fixed::{RungeKutta4, SemiImplicitEuler};
use crate::observer::{Event, Observer, Peaks, Stretch};
use crate::rocking::{Limits, Phase, State, Stopped, System};
use crate::structure::WithSystem;
use crate::taylor::Taylor;

/// What the exponential midpoint method runs.
pub(super) const STIFF: &str = "elastic clutches only: nothing else is stiff";

/// Runs a case that is ideal.
pub(super) fn run<O: Observer<f32>>(case: &Case<'_>, observer: &mut O) -> Result<RunEnd, CaseError> {
    case.structure.resolve(Runner { case, observer })?
}

/// The caller's observer, the peaks, and a count of steps.
struct Watch<'o, O> {
    observer: &'o mut O,
    peaks: Peaks<f32>,
    steps: u32,
}

impl<O: Observer<f32>> Observer<f32> for Watch<'_, O> {
    #[inline]
    fn stretch(&mut self, arc: &dyn Arc<f32>, stretch: &Stretch<f32>) {
        self.steps += u32::from(stretch.from == 0.0);
        self.peaks.stretch(arc, stretch);
        self.observer.stretch(arc, stretch);
    }

    #[inline]
    fn event(&mut self, event: Event, time: f32, state: &State<f32>) {
        self.peaks.event(event, time, state);
        self.observer.event(event, time, state);
    }
}

struct Runner<'c, 'w, 'o, O> {
    case: &'c Case<'w>,
    observer: &'o mut O,
}

impl<O: Observer<f32>> WithSystem<f32> for Runner<'_, '_, '_, O> {
    type Output = Result<RunEnd, CaseError>;

    fn with<R: Equation<f32>, E: Equation<f32>, C: Clutch>(self, system: System<f32, R, E, C>) -> Self::Output {
        let step = self.case.step;
        match self.case.method {
            FixedMethod::SemiImplicitEuler => self.run(&system, &SemiImplicitEuler { step }),
            FixedMethod::RungeKutta4 => self.run(&system, &RungeKutta4 { step }),
            FixedMethod::Taylor => self.run(&system, &Taylor::<f32, TERMS>::fixed(step)),
            method @ FixedMethod::ExponentialMidpoint => Err(CaseError::Method { method, runs: STIFF }),
        }
    }
}

impl<O: Observer<f32>> Runner<'_, '_, '_, O> {
    fn run<R: Equation<f32>, E: Equation<f32>, C: Clutch, M: Method<f32>>(
        self,
        system: &System<f32, R, E, C>,
        method: &M,
    ) -> Result<RunEnd, CaseError> {
        let Case { structure, initially, step, ground, free_time, .. } = self.case;
        let mut watch = Watch { observer: self.observer, peaks: Peaks::default(), steps: 0 };
        let mut state = match *initially {
            Initially::Rest => State::default(),
            Initially::Released { rotation, velocity } => system.released_at(rotation, velocity, ground.first()[0]),
        };
        watch.peaks.rocked = state.phase == Phase::Rocking;
        let block = structure.loaded()?.block;
        let no_return = |bound: f32| structure.geometry.point_of_no_return(&block, f64::from(bound)) as f32;
        let overturned = no_return(ground.bound());
        let mut follow = |shape: &Shape, start: f32, duration: f32, overturned: f32| -> Result<(), Stopped> {
            let limits = Limits { overturned, events: most_events(duration, *step) };
            watch.peaks.origin = start;
            system.advance(method, &mut state, shape, duration, &limits, &mut watch)
        };
        ground.try_for_each(|shape, _, start, duration| follow(shape, start, duration, overturned))?;
        follow(&Shape::Quiet, ground.duration(), *free_time, no_return(0.0))?;
        let Watch { peaks, steps, .. } = watch;
        Ok(RunEnd { ending: Ending::of(&state, &peaks), state, peaks, steps, missed: 0 })
    }
}

/// Events that a piece of `duration` (s) may have: every step (s) may meet a few, and dying impacts accumulate before they are
/// summed.
pub(super) fn most_events(duration: f32, step: f32) -> u32 {
    10_000 + (duration / step) as u32 * 8
}
