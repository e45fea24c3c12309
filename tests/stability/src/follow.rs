//! A structure, followed through a ground motion.

use sprag_shared::ground::GroundSegment;
use sprag_shared::math::scalar::Real;
use sprag_shared::method::dense_output::Integrator;
use sprag_shared::method::taylor::Taylor;
use sprag_shared::motion::observer::Observer;
use sprag_shared::motion::state::{BlockState, Limits, Phase, Stopped};
use sprag_shared::structure::Structure;

use crate::log::FullLog;
use crate::segment::Segment;

/// How a motion starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start<S> {
    /// Standing still.
    Rest,
    /// At θ (rad) with θ̇ (rad/s).
    Released(S, S),
}

/// The Taylor method as tight as f64 allows.
pub fn tight() -> Taylor<f64, 20> {
    Taylor::adaptive(1e-17)
}

/// An observer of a motion over several segments.
pub trait Watcher<S: Real>: Observer<S> {
    /// A segment of `duration` (s) is over; the times of the next one start anew.
    fn passed(&mut self, duration: S);
}

/// Follows `structure` from `start` over all `segments`, or until it overturns.
///
/// # Errors
/// [`Stopped`] when the motion takes more than a million arcs in one segment, or is no longer finite.
pub fn follow<S: Real, M: Integrator<S>, W: Watcher<S>>(
    structure: &Structure,
    method: &M,
    start: Start<S>,
    segments: &[Segment<S>],
    watcher: &mut W,
) -> Result<BlockState<S>, Stopped> {
    let system = structure.resolve().expect("parameters within range");
    let mut state = match start {
        Start::Rest => BlockState::default(),
        Start::Released(rotation, velocity) => {
            let ground = segments.first().map_or(S::ZERO, |segment| segment.ground.acceleration(S::ZERO));
            system.released_at(rotation, velocity, ground)
        }
    };
    for (index, segment) in segments.iter().enumerate() {
        // The ground may yet push back as hard as its strongest segment still to come.
        let bound = segments[index..].iter().fold(S::ZERO, |bound, later| bound.larger(later.bound()));
        let limit = structure.geometry.point_of_no_return(structure.block.slenderness(), bound.to_f64());
        let limits = Limits { overturned: S::of(limit), events: 1_000_000 };
        system.advance(method, &mut state, &segment.ground, segment.duration, &limits, watcher)?;
        watcher.passed(segment.duration);
    }
    Ok(state)
}

/// [`follow`] from rest by the tight Taylor method, with every swing integrated.
pub fn shake(structure: &Structure, segments: &[Segment<f64>]) -> (BlockState<f64>, FullLog) {
    let mut log = FullLog::default();
    let state = follow(structure, &tight(), Start::Rest, segments, &mut log).expect("a motion that can be followed");
    (state, log)
}

/// [`follow`] on quiet ground by the tight Taylor method, with every swing integrated.
pub fn release(structure: &Structure, rotation: f64, velocity: f64, duration: f64, log: &mut FullLog) -> BlockState<f64> {
    follow(structure, &tight(), Start::Released(rotation, velocity), &[Segment::quiet(duration)], log)
        .expect("a motion that can be followed")
}

/// The block has overturned, and before that no impact.
pub fn overturned_without_impact(state: &BlockState<f64>) -> bool {
    state.phase == Phase::Overturned && state.impacts == 0
}
