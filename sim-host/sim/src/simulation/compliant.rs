//! Runs of a block on a compliant foundation, by the loop that knows how.

use sprag_shared::math::scalar::Real;
use sprag_shared::motion::compliant::CompliantSystem;
use sprag_shared::motion::state::Phase;
use sprag_shared::observers::checks::Checks;

use super::demand::Impulses;
use super::device_run::{DeviceRun, Found};
use super::run::{Failure, Task};
use crate::scene::accuracy::Precision;

/// Runs the device of `task`.
pub(super) fn run(task: &Task<'_>) -> Result<DeviceRun, Failure> {
    match task.scene.file.accuracy.precision {
        Precision::F64 => follow::<f64>(task),
        Precision::F32 => follow::<f32>(task),
    }
}

fn follow<S: Real>(task: &Task<'_>) -> Result<DeviceRun, Failure> {
    let (system, longest): (CompliantSystem<S>, f64) = task.scene.structure(task.index).resolve_compliant()?;
    let loaded = task.loaded()?;
    let course = task.course(&loaded.block);
    let mut state = match task.released() {
        Some((rotation, velocity)) => {
            let [along, up, _] = task.ground_at_start().map(S::of);
            system.released_at(S::of(rotation), S::of(velocity), [along, up])
        }
        None => system.at_rest(),
    };
    let mut watchers = task.watchers::<S>(&loaded)?;
    // The toe's reactions are those of rigid ground.
    watchers.checks = watchers.checks.map(Checks::of_device);
    let step = S::of(task.step().map_or(longest, |step| step.min(longest)));
    // A foot that gives may bring a block back from where rigid ground does not: only on its side it lies.
    let limits = course.limits(f64::INFINITY);
    let ended = course.in_pairs(
        &mut watchers,
        || !task.interrupt.is_set(),
        |pair, [_, duration], watchers| {
            system.advance(step, &mut state, pair, S::of(duration), &limits, watchers)?;
            Ok(state.motion.phase == Phase::Overturned)
        },
    );
    task.ended(ended)?;
    if state.motion.phase != Phase::Overturned {
        watchers.recorder.finish(task.end(), false);
    }
    let peaks = watchers.peaks;
    let found = Found { impulses: Impulses::default(), ..Found::watched(task, watchers) };
    Ok(DeviceRun::of(task, &state.motion, &peaks, found))
}
