//! Runs of a block on a compliant foundation, by the loop that knows how.

use sprag_shared::math::scalar::Real;
use sprag_shared::motion::compliant::{CompliantState, CompliantSystem};
use sprag_shared::motion::ground_pair::GroundPair;
use sprag_shared::motion::observer::Observer;
use sprag_shared::motion::state::{Phase, Stopped};
use sprag_shared::observers::checks::Checks;

use super::demand::Impulses;
use super::device_run::{DeviceRun, Found};
use super::drive::{Course, Segmented};
use super::run::{Failure, Task};
use crate::ground_motion::{GroundMotion, SumSegment};
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
    along(&course, &system, step, &mut state, &mut watchers, || !task.interrupt.is_set()).map_err(Failure::Stopped)?;
    if task.interrupt.is_set() {
        return Err(Failure::Interrupted);
    }
    if state.motion.phase != Phase::Overturned {
        watchers.recorder.finish(task.end(), false);
    }
    let peaks = watchers.peaks;
    let found = Found { impulses: Impulses::default(), ..Found::watched(task, watchers) };
    Ok(DeviceRun::of(task, &state.motion, &peaks, found))
}

/// Follows `state` to the end; `continues` is asked before every segment.
fn along<S: Real, O: Observer<S> + Segmented>(
    course: &Course<'_>,
    system: &CompliantSystem<S>,
    step: S,
    state: &mut CompliantState<S>,
    observer: &mut O,
    continues: impl Fn() -> bool,
) -> Result<(), Stopped> {
    // A foot that gives may bring a block back from where rigid ground does not: only on its side it lies.
    let limits = course.limits(f64::INFINITY);
    let vertical = course.vertical.map(GroundMotion::segments);
    for (index, segment) in course.ground.segments().iter().enumerate() {
        if state.motion.phase == Phase::Overturned || !continues() {
            return Ok(());
        }
        observer.segment(segment.start, Some(segment));
        let horizontal: SumSegment<S> = segment.shape.to();
        let up: Option<SumSegment<S>> = vertical.and_then(|segments| segments.get(index)).map(|segment| segment.shape.to());
        let pair = GroundPair { horizontal: &horizontal, vertical: up.as_ref().map(|piece| piece as _) };
        let ended = system.advance(step, state, pair, S::of(segment.duration), &limits, observer);
        ended.map_err(|end| end.after(segment.start))?;
    }
    if state.motion.phase == Phase::Overturned || !continues() {
        return Ok(());
    }
    observer.segment(course.ground.duration(), None);
    let pair = GroundPair { horizontal: &SumSegment::QUIET, vertical: None };
    let ended = system.advance(step, state, pair, S::of(course.free_time), &limits, observer);
    ended.map_err(|end| end.after(course.ground.duration()))
}
