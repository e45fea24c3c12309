//! Runs of a block whose base may slide, by the loop that knows how.

use sprag_shared::math::scalar::Real;
use sprag_shared::motion::sliding::{SlidingState, SlidingSystem};
use sprag_shared::motion::state::Phase;

use super::device_run::{DeviceRun, Found};
use super::run::{Failure, Task};
use super::sliding_report::{SlidingOutcome, SlidingReport};
use crate::scene::accuracy::Precision;
use crate::scene::sliding::step;

/// Runs the block of `task`.
pub(super) fn run(task: &Task<'_>) -> Result<DeviceRun, Failure> {
    match task.scene.file.accuracy.precision {
        Precision::F64 => follow::<f64>(task),
        Precision::F32 => follow::<f32>(task),
    }
}

fn follow<S: Real>(task: &Task<'_>) -> Result<DeviceRun, Failure> {
    let system: SlidingSystem<S> = task.scene.structure(task.index).resolve_sliding()?;
    let loaded = task.loaded()?;
    let course = task.course(&loaded.block);
    let mut state = match task.released() {
        Some((rotation, velocity)) => {
            let [along, up, _] = task.ground_at_start().map(S::of);
            system.released_at(S::of(rotation), S::of(velocity), [along, up])
        }
        None => SlidingState::default(),
    };
    let mut watchers = task.watchers::<S>(&loaded)?;
    // Their impulses are those of a toe that sticks.
    watchers.checks = None;
    watchers.recorder = watchers.recorder.sliding();
    let step = S::of(step(&task.scene.file, &task.scene.block));
    // No reaction within the cone of friction turns a block back from beyond α + arctan μ, whatever the ground does.
    let limits = course.limits(system.friction.to_f64());
    // When the toe left the ground, s.
    let mut lifted_off = None;
    let ended = course.in_pairs(
        &mut watchers,
        || !task.interrupt.is_set(),
        |pair, [start, duration], watchers| {
            system.advance(step, &mut state, pair, S::of(duration), &limits, watchers)?;
            lifted_off = state.lifted_off.map(|time| start + time.to_f64());
            Ok(state.has_ended())
        },
    );
    task.ended(ended)?;
    if !state.has_ended() {
        watchers.recorder.finish(task.end(), state.stands());
    } else if lifted_off.is_some() {
        watchers.recorder.finish(task.end(), false);
    }
    let (mut peaks, first_slip) = (watchers.peaks, watchers.recorder.first_slip);
    peaks.ended = lifted_off.map(S::of).or(peaks.ended);
    let stands = state.motion.phase != Phase::Overturned && lifted_off.is_none();
    let size = loaded.block.size();
    let meters = |value: S| stands.then_some(size * value.to_f64());
    let weight = loaded.block.inertia_ratio() * loaded.block.frequency_parameter_squared();
    let barrier = weight * (1.0 - sprag_shared::math::cos(loaded.block.slenderness()));
    let report = SlidingReport {
        outcome: if first_slip.is_some() { SlidingOutcome::Slides } else { SlidingOutcome::Sticks },
        first_slip_time_s: first_slip,
        peak_slide_m: meters(state.farthest),
        residual_displacement_m: meters(state.displacement),
        friction_energy_ratio: stands.then_some(state.spent.to_f64() / barrier),
        lifted_off_time_s: lifted_off,
    };
    let found = Found { sliding: Some(report), peak_force_ratio: Some(0.0), ..Found::watched(task, watchers) };
    Ok(DeviceRun::of(task, &state.motion, &peaks, found))
}
