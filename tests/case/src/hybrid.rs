//! Cases of devices with a memory, and of any device over ground that moves vertically too.

use crate::ideal::{STIFF, Watch, most_events};
use crate::{Case, CaseError, FixedMethod, Initially, RunEnd, Shape};
use sprag_shared::method::fixed::{FixedStep, Scheme};
use sprag_shared::motion::hybrid::HybridSystem;
use sprag_shared::motion::hybrid::mode_output::Shaking;
use sprag_shared::motion::observer::Observer;
use sprag_shared::motion::state::{Limits, Phase, Stopped};
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::observers::peaks::Peaks;

/// |θ| at which a block lies on the ground, rad. A device may bring a block back from beyond the angle from which its weight
/// and the ground alone would not.
const OVERTURNED: f32 = core::f32::consts::FRAC_PI_2;

/// What methods run that are not for these devices.
const IDEAL: &str = "ideal devices over horizontal ground only: loops for all others would not fit the flash of the board";

/// Runs a case that is not ideal.
pub(super) fn run(case: &Case<'_>, observer: &mut dyn Observer<f32>) -> Result<RunEnd, CaseError> {
    let machine = case.drivetrain.resolve(&case.structure, case.ground.is_vertical())?;
    let step = case.step;
    let method = match case.method {
        FixedMethod::RungeKutta4 => FixedStep { scheme: Scheme::RungeKutta4, step },
        FixedMethod::ExponentialMidpoint if machine.transmission.traits().springs => {
            FixedStep { scheme: Scheme::ExponentialMidpoint, step }
        }
        method @ FixedMethod::ExponentialMidpoint => return Err(CaseError::Method { method, runs: STIFF }),
        method => return Err(CaseError::Method { method, runs: IDEAL }),
    };
    follow(case, &machine, &method, observer)
}

fn follow(
    case: &Case<'_>,
    machine: &HybridSystem<f32>,
    integrator: &FixedStep<f32>,
    observer: &mut dyn Observer<f32>,
) -> Result<RunEnd, CaseError> {
    let Case { initially, step, ground, free_time, .. } = case;
    let mut watch = Watch { observer, peaks: Peaks::default(), steps: 0 };
    let mut state = match *initially {
        Initially::Rest => machine.at_rest(),
        Initially::Released { rotation, velocity } => {
            let [horizontal, vertical] = ground.first();
            machine.released_at(rotation, velocity, [horizontal, vertical, 0.0])
        }
    };
    watch.peaks.rocked = state.motion.phase == Phase::Rocking;
    let mut follow = |horizontal: &Shape, vertical: Option<&Shape>, start: f32, duration: f32| -> Result<(), Stopped> {
        let limits = Limits { overturned: OVERTURNED, events: most_events(duration, *step) };
        let shaking = Shaking { horizontal, vertical: vertical.map(|shape| shape as _), support: None };
        watch.peaks.origin = start;
        machine.advance(integrator, &mut state, shaking, duration, &limits, &mut watch)
    };
    ground.try_for_each(&mut follow)?;
    if *free_time > 0.0 {
        follow(&Shape::Quiet, None, ground.duration(), *free_time)?;
    }
    let Watch { peaks, steps, .. } = watch;
    let outcome = Outcome::of(&state.motion, &peaks);
    Ok(RunEnd { outcome, state: state.motion, peaks, steps, missed: state.device.missed })
}
