//! A block followed in time stepping; in a file of its own because tests of another package follow one too.

use sprag_shared::equation::switched::Switched;
use sprag_shared::ground::GroundSegment;
use sprag_shared::math::scalar::Real;
use sprag_shared::motion::step_end::{TimeStepping, TimeSteppingState};

/// Outcome of [`follow`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TimeSteppingPeaks<S> {
    /// Largest |θ| at a step's end, rad.
    pub rotation: S,
    /// Changes of toe.
    pub impacts: u32,
    /// |θ| passed the limit.
    pub overturned: bool,
}

/// Follows `state` over `segment` from its local time 0 to `duration` (s) in Runge-Kutta steps of `h` (s, above 0; the last one may be shorter),
/// until |θ| passes `overturned` (rad). At most 2²⁴ steps.
pub fn follow<S: Real, E: Switched<S>, P: GroundSegment<S>>(
    block: &TimeStepping<S, E>,
    state: &mut TimeSteppingState<S>,
    segment: &P,
    (duration, h): (S, S),
    overturned: S,
) -> TimeSteppingPeaks<S> {
    let mut seen = TimeSteppingPeaks::<S>::default();
    let mut time = S::ZERO;
    let mut push = segment.acceleration(time);
    for tick in 1..=1 << 24 {
        if time >= duration || seen.overturned {
            break;
        }
        let end = (S::count(tick) * h).smaller(duration);
        let push_at_end = segment.acceleration(end);
        let ground = [push, segment.acceleration(S::HALF * (time + end)), push_at_end];
        let before = (state.side, *state != TimeSteppingState::at_rest());
        *state = block.runge_kutta_4(*state, ground, end - time);
        seen.impacts += u32::from(before.1 && before.0 != state.side);
        seen.rotation = seen.rotation.larger(state.rotation.abs());
        seen.overturned = state.rotation.abs() > overturned;
        (time, push) = (end, push_at_end);
    }
    seen
}
