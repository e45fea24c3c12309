//! The state of a rocking block, the bounds of its integration, and why an integration stops.

use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::motion::observer::{Event, Observer};

/// Phase of the motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Phase {
    /// Rest: the block stands on both toes.
    #[default]
    Rest,
    /// Rocking: it turns about one toe.
    Rocking,
    /// Overturned: it cannot return.
    Overturned,
}

/// The state of a rocking block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BlockState<S> {
    /// θ, rad.
    pub rotation: S,
    /// θ̇, rad/s.
    pub velocity: S,
    /// Rest, rocking or overturned.
    pub phase: Phase,
    /// Sign of θ, or at θ = 0 the side that it moves to.
    pub side: Sign,
    /// Sign of θ̇, or at θ̇ = 0 the one it is about to take.
    pub direction: Sign,
    /// Sign of θ̈, or at θ̈ = 0 the one it is about to take.
    pub acceleration_sign: Sign,
    /// Sign of the acceleration of the inerter's terminals; with the paper's kinematics that of θ̈.
    pub terminal_acceleration_sign: Sign,
    /// θ̈ is zero here, by an event just handled.
    pub acceleration_is_zero: bool,
    /// Impacts so far that came in with more than [`IdealSystem::counted_speed`](super::ideal::IdealSystem::counted_speed).
    pub impacts: u32,
}

/// Relative distance from an angle within which a motion is there, but for rounding.
const NEARLY_THERE: f64 = 1e-9;

/// The angle from which on a motion has reached `angle` (rad, above 0), but for rounding: where a clutch switches there, rounding would decide
/// whether it does so just before.
pub(crate) fn as_good_as<S: Real>(angle: S) -> S {
    angle * (S::ONE - S::of(NEARLY_THERE).larger(S::of(16.0) * S::EPSILON))
}

impl<S: Real> BlockState<S> {
    /// Level that θ passes on its way to `rotation`, and the sign of θ less it before: 0 at an impact, or the limit of overturning.
    #[inline]
    pub(super) fn passes(&self, rotation: S, limits: &Limits<S>) -> Option<(S, Sign)> {
        let outward = self.side.times(rotation);
        if outward < S::ZERO {
            Some((S::ZERO, self.side))
        } else if self.side == self.direction && outward > limits.overturned {
            Some((self.side.times(limits.overturned), self.side.opposite()))
        } else {
            None
        }
    }

    /// The block on its base at its uplift to `side`, which all its signs take.
    pub(super) fn uplifted(&self, side: Sign) -> BlockState<S> {
        BlockState {
            phase: Phase::Rocking,
            side,
            direction: side,
            acceleration_sign: side,
            terminal_acceleration_sign: side,
            impacts: self.impacts,
            ..BlockState::default()
        }
    }

    /// Moves outward at |θ| of `angle` (rad) or beyond.
    pub(super) fn is_outward_at(&self, angle: S) -> bool {
        self.side == self.direction && self.side.times(self.rotation) >= angle
    }

    /// Whether this motion has ended as it reaches θ = `rotation` (rad), but for rounding.
    pub(super) fn ends_at(&self, rotation: S, limits: &Limits<S>) -> bool {
        self.side == self.direction && self.side.times(rotation) >= as_good_as(limits.overturned)
    }

    /// Ends a motion at `time` (s), on ground that has come to rest: a block that moves outward at `no_return` (rad,
    /// [`crate::structure::block::Geometry::point_of_no_return`]) or beyond has overturned, although it may not lie on the ground yet.
    pub fn end(&mut self, no_return: S, time: S, observer: &mut (impl Observer<S> + ?Sized)) {
        if self.phase == Phase::Rocking && self.is_outward_at(no_return) {
            self.phase = Phase::Overturned;
            observer.event(Event::Overturned, time, self);
        }
    }

    /// The block at rest after `impacts`.
    pub(super) fn rested(&self, impacts: u32) -> BlockState<S> {
        BlockState { impacts, side: self.side, direction: self.direction, ..BlockState::default() }
    }
}

/// Error that ends the integration of a ground segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stopped {
    /// More events than [`Limits::events`] in one ground segment.
    TooManyEvents {
        /// Time in the ground segment, s.
        time: f64,
        /// The mode of block and clutches then.
        mode: &'static str,
    },
    /// Events between which time stands still.
    Endless {
        /// Time in the ground segment, s.
        time: f64,
        /// The mode of block and clutches then.
        mode: &'static str,
    },
    /// More steps without an event than fit one ground segment.
    TooManySteps {
        /// Time in the ground segment, s.
        time: f64,
    },
    /// A state that is not finite.
    NotFinite {
        /// Time in the ground segment, s.
        time: f64,
    },
}

impl Stopped {
    /// The same, with times from the start of a motion in which the segment begins at `start` (s).
    pub fn after(self, start: f64) -> Stopped {
        match self {
            Stopped::TooManyEvents { time, mode } => Stopped::TooManyEvents { time: start + time, mode },
            Stopped::Endless { time, mode } => Stopped::Endless { time: start + time, mode },
            Stopped::TooManySteps { time } => Stopped::TooManySteps { time: start + time },
            Stopped::NotFinite { time } => Stopped::NotFinite { time: start + time },
        }
    }
}

impl core::fmt::Display for Stopped {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Stopped::TooManyEvents { time, mode } => write!(
                formatter,
                "at {time:.6} s, while {mode}, there have been too many events; a restitution below 1, a larger rest speed or a dwell of \
                 the clutches leaves fewer"
            ),
            Stopped::Endless { time, mode } => write!(
                formatter,
                "at {time:.6} s, while {mode}, events follow one another without end; a dwell of the clutches, or a fixed step (beside \
                 springs that of exponential-midpoint), goes past them"
            ),
            Stopped::TooManySteps { time } => write!(
                formatter,
                "at {time:.6} s there have been too many steps: viscous forces or springs move too fast for so long a motion; beside \
                 springs exponential-midpoint needs fewer"
            ),
            Stopped::NotFinite { time } => write!(formatter, "at {time:.6} s the motion is no longer finite"),
        }
    }
}

impl core::error::Error for Stopped {}

/// Bounds of one call of [`IdealSystem::advance`](super::ideal::IdealSystem::advance).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits<S> {
    /// |θ| (rad) at which an outward motion counts as overturned
    /// ([`crate::structure::block::Geometry::point_of_no_return`], or π/2).
    pub overturned: S,
    /// Events that one call may follow.
    pub events: u32,
}
