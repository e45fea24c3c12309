//! The motion of a block and its device over one step, as a method sees it.

use crate::arc::{Arc, Motion};
use crate::body::Body;
use crate::drivetrain::device::Law;
use crate::drivetrain::drive::{Drive, Moment};
use crate::ground::Piece;
use crate::locate::locate_by_value;
use crate::scalar::{Real, Sign};

/// Horizontal and vertical ground motion over one piece.
#[derive(Clone, Copy, Debug)]
pub struct Shaking<'a, S> {
    /// Horizontal.
    pub horizontal: &'a dyn Piece<S>,
    /// Vertical, for a body that knows of it.
    pub vertical: Option<&'a dyn Piece<S>>,
}

impl<S: Real> Shaking<'_, S> {
    /// Both accelerations in g at the local time `time` (s).
    #[inline(always)]
    pub fn at(&self, time: S) -> [S; 2] {
        let horizontal = self.horizontal.acceleration(time);
        [horizontal, self.vertical.map_or(S::ZERO, |vertical| vertical.acceleration(time))]
    }
}

/// Where a step starts and what governs it.
#[derive(Clone, Copy, Debug)]
pub struct PathStart<'a, S, B, D, const X: usize> {
    /// The block.
    pub body: &'a B,
    /// The device.
    pub drive: &'a D,
    /// Its mode.
    pub law: Law<S>,
    /// The ground motion.
    pub shaking: Shaking<'a, S>,
    /// s.
    pub side: Sign,
    /// θ.
    pub rotation: S,
    /// θ̇.
    pub velocity: S,
    /// The device's unknowns.
    pub extra: [S; X],
    /// Local time in the piece, s.
    pub time: S,
    /// How far the step may reach, s; above 0.
    pub length: S,
    /// The block has just been set free where what moves it passed what held it: θ̈ has the direction of the motion, or is zero.
    pub freed: bool,
    /// Friction holds the block: θ̈ = 0, whatever acts.
    pub held: bool,
    /// Size of a rotation that matters (rad), for tolerances.
    pub scale: S,
    /// Size of an angular velocity that matters, rad/s.
    pub speed: S,
}

impl<S: Real, B: Body<S>, D, const X: usize> PathStart<'_, S, B, D, X> {
    /// Whether friction holds the block; only devices with springs have a path then.
    #[inline(always)]
    pub fn is_held<const G: usize>(&self) -> bool
    where
        D: Drive<S, X, G>,
    {
        D::SPRINGS && self.held
    }

    /// θ̈ at the start, from the equation's `acceleration`: the rounding of a zero must not push a freed block back.
    #[inline(always)]
    pub fn first(&self, acceleration: S) -> S {
        if self.freed && self.law.direction * acceleration < S::ZERO { S::ZERO } else { acceleration }
    }

    /// θ̈ and the rates of the device's unknowns a time `t` after the start.
    #[inline(never)]
    pub fn rates<const G: usize>(&self, t: S, rotation: S, velocity: S, extra: &[S; X]) -> (S, [S; X])
    where
        D: Drive<S, X, G>,
    {
        let (acceleration, rates) = self.drive.flow(&Moment {
            body: self.body,
            law: &self.law,
            posture: self.body.posture(self.side.unit(), rotation),
            velocity,
            extra: *extra,
            ground: self.shaking.at(self.time + t),
            clock: t,
        });
        (if self.is_held::<G>() { S::ZERO } else { acceleration }, rates)
    }

    /// Watched function `index` in the given state.
    #[inline(always)]
    pub fn guard<const G: usize>(&self, index: usize, t: S, motion: &Motion<S>, extra: &[S; X]) -> S
    where
        D: Drive<S, X, G>,
    {
        let moment = Moment {
            body: self.body,
            law: &self.law,
            posture: self.body.posture(self.side.unit(), motion.rotation),
            velocity: motion.velocity,
            extra: *extra,
            ground: self.shaking.at(self.time + t),
            clock: t,
        };
        let acceleration = if self.is_held::<G>() { self.drive.flow(&moment).0 } else { motion.acceleration };
        self.drive.guard(&moment, acceleration, self.law.watch[index])
    }
}

/// The motion from a [`PathStart`] over times from 0 to [`Arc::length`]. Zeros are sought in (0, `to`].
///
/// The defaults see what the ends of the step show; a method with a series overrides them and proves its answers.
pub trait Path<S: Real, const X: usize>: Arc<S> {
    /// The device's unknowns at `time`.
    fn extra(&self, time: S) -> [S; X];

    /// Watched function `index` at `time`.
    fn guard(&self, index: usize, time: S) -> S;

    /// First zero of θ̇, which has the sign `sign` just after the start, and is zero there with `from_zero`.
    fn velocity_zero(&self, to: S, sign: Sign, from_zero: bool) -> Option<S> {
        let _ = from_zero;
        let end = self.at(to).velocity;
        (sign.times(end) < S::ZERO).then(|| locate_by_value(S::ZERO, to, sign, |t| self.at(t).velocity))
    }

    /// First zero of watched function `index`, positive just after the start.
    fn guard_zero(&self, index: usize, to: S, from_zero: bool) -> Option<S> {
        let _ = from_zero;
        let positive = Sign::Positive;
        (self.guard(index, to) < S::ZERO).then(|| locate_by_value(S::ZERO, to, positive, |t| self.guard(index, t)))
    }

    /// First zero of the device's unknown `index`, of sign `sign` just after the start.
    fn extra_zero(&self, index: usize, to: S, sign: Sign, from_zero: bool) -> Option<S> {
        let _ = from_zero;
        let value = |t: S| self.extra(t).get(index).copied().unwrap_or(S::ZERO);
        (sign.times(value(to)) < S::ZERO).then(|| locate_by_value(S::ZERO, to, sign, value))
    }
}

/// A way to integrate a block with a device.
pub trait Tracer<S: Real> {
    /// Its paths.
    type Path<'a, B: Body<S> + 'a, D: Drive<S, X, G> + 'a, const X: usize, const G: usize>: Path<S, X>
    where
        Self: 'a;

    /// The path from `start`.
    fn path<'a, B: Body<S>, D: Drive<S, X, G>, const X: usize, const G: usize>(
        &'a self,
        start: PathStart<'a, S, B, D, X>,
    ) -> Self::Path<'a, B, D, X, G>;

    /// The fixed step (s), if it has one.
    fn step(&self) -> Option<S>;
}
