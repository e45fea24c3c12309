//! Limits on crowded events (chattering): detection of a graze, and the error of one that does not end.

use super::{HybridState, HybridSystem};
use crate::drivetrain::clutch_state::Coupling;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::motion::state::{Phase, Stopped};

/// Number of events at once that is taken for a graze: a guard touches zero, and rounding decides in which mode
/// the motion continues, anew each time.
pub(super) const MOST_AT_ONCE: u32 = 16;

/// Number of events at once that no graze has: time stands still.
pub(super) const ENDLESS: u32 = 1000;

/// Largest time between events at once, in 1/p.
const AT_ONCE: f64 = 1e-9;

/// Time for which a graze is followed without guards, in 1/p: their values stay below the square of that.
pub(super) const GRAZE: f64 = 1e-6;

/// Steps without an event for each event of [`crate::motion::state::Limits::events`].
pub(super) const STEPS_PER_EVENT: u32 = 5;

/// Number of steps without a gap in time, after one of `length` (s) that follows `before` of them; `unit` is 1/p (s).
pub(super) fn crowded<S: Real>(before: u32, length: S, unit: S) -> u32 {
    if length > S::of(AT_ONCE) * unit { 0 } else { before + 1 }
}

impl<S: Real> HybridSystem<S> {
    /// Whether a step from `side` ended in an impact that does not end in rest, as it need not below the rest threshold while a support moves:
    /// however short its swings are, they shrink to what is negligible, and it is no event at once.
    pub(super) fn bounces(&self, state: &HybridState<S>, side: Sign) -> bool {
        state.motion.side != side && !self.negligible(state.motion.velocity)
    }

    /// Whether a block that leaves its base at `velocity` rests, whatever holds it.
    pub(super) fn negligible(&self, velocity: S) -> bool {
        velocity.abs() <= self.rest_speed * S::EPSILON
    }
}

/// Error of too many events, with the mode; the last `at_once` of them without a gap in time.
pub(super) fn too_many<S: Real>(state: &HybridState<S>, time: S, at_once: u32) -> Stopped {
    let has = |is: fn(Coupling) -> bool| state.device.wheels.iter().any(|wheel| is(wheel.coupling));
    let mode = if state.motion.phase == Phase::Rest {
        "the block stands"
    } else if state.held {
        "friction holds the block"
    } else if has(|coupling| coupling.slip_sign().is_some()) {
        "a clutch slips"
    } else if has(Coupling::has_twist) {
        "a clutch stretches"
    } else if has(Coupling::is_engaged) {
        "a clutch holds"
    } else {
        "the clutches are open"
    };
    let time = time.to_f64();
    if at_once >= ENDLESS { Stopped::Endless { time, mode } } else { Stopped::TooManyEvents { time, mode } }
}

#[cfg(test)]
mod tests {
    use super::{ENDLESS, too_many};
    use crate::motion::hybrid::{HybridState, Progress};

    /// Many events, with time between them, take place at any step: bounces that hardly lose anything. A fixed step ends only a crowd of them.
    #[test]
    fn a_fixed_step_is_no_remedy_for_many_events() {
        let message = |at_once| std::format!("{}", too_many(&HybridState::<f64>::default(), 1.0, at_once));
        assert!(message(ENDLESS).contains("a fixed step"), "{}", message(ENDLESS));
        let many = message(ENDLESS - 1);
        assert!(!many.contains("fixed step") && many.contains("a restitution below 1"), "{many}");
    }

    /// What others than the core follow without an event ends a crowd of events only where time passes.
    #[test]
    fn steps_of_others_end_a_crowd_only_where_time_passes() {
        let (mut progress, unit) = (Progress { at_once: 7, steps: 9, ..Progress::default() }, 0.5);
        progress.go_on(1e-11, unit);
        assert_eq!((progress.at_once, progress.steps, progress.time), (8, 10, 1e-11));
        progress.go_on(1e-3, unit);
        assert_eq!((progress.at_once, progress.steps, progress.time), (0, 11, 1e-11 + 1e-3));
    }
}
