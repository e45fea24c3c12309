//! Time stepping without event location, as in most simulations and the paper: fixed steps at whose ends the clutch is "re-evaluated according
//! to Equation 10" and impacts are noticed. Nothing is located, so every event comes late by up to a step: an error of
//! order one, whatever the method between events. The event-driven counterpart is [`crate::motion::ideal`].
//!
//! There is no branch in a step, only selection, so the same lines run in f32 on the target, in f64, and in SIMD lanes.
//! That makes it the yardstick for what the equations cost.

use crate::equation::switched::Switched;
use crate::math::scalar::Scalar;
use crate::method::fixed::runge_kutta_4;

/// State of the block in time stepping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeSteppingState<S> {
    /// θ, rad.
    pub rotation: S,
    /// θ̇, rad/s.
    pub velocity: S,
    /// s = ±1, the toe.
    pub side: S,
}

impl<S: Scalar> TimeSteppingState<S> {
    /// A block that stands on both toes.
    pub fn at_rest() -> TimeSteppingState<S> {
        TimeSteppingState { rotation: S::of(0.0), velocity: S::of(0.0), side: S::of(1.0) }
    }
}

/// A block with a clutched pair whose clutch and impacts are looked at once a step. With `released` equal to `engaged` it
/// is the block with a single inerter, or with none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeStepping<S, E> {
    /// Equation of motion with the inerter released.
    pub released: E,
    /// Equation of motion with the inerter engaged.
    pub engaged: E,
    /// η, 0 to 1.
    pub restitution: S,
    /// Ground acceleration (in g) above which a block at rest uplifts.
    pub uplift: S,
}

impl<S: Scalar, E: Switched<S>> TimeStepping<S, E> {
    /// One step of length `h` (s) with the classical Runge-Kutta method; `ground` is ü_g/g at its start, middle and end.
    #[inline(always)]
    pub fn runge_kutta_4(&self, state: TimeSteppingState<S>, ground: [S; 3], h: S) -> TimeSteppingState<S> {
        let (side, h) = self.awake(&state, ground[0], h);
        let equation = self.engagement(&state, side, ground[0]);
        let first = equation.acceleration(side, state.rotation, state.velocity, ground[0]);
        let (rotation, velocity) = runge_kutta_4(&equation, side, (state.rotation, state.velocity), first, ground, h);
        self.impact(TimeSteppingState { rotation, velocity, side })
    }

    /// One step of length `h` (s) with the semi-implicit Euler method; `ground` is ü_g/g at its start.
    #[inline(always)]
    pub fn semi_implicit_euler(&self, state: TimeSteppingState<S>, ground: S, h: S) -> TimeSteppingState<S> {
        let (side, h) = self.awake(&state, ground, h);
        let equation = self.engagement(&state, side, ground);
        let velocity = state.velocity + h * equation.acceleration(side, state.rotation, state.velocity, ground);
        self.impact(TimeSteppingState { rotation: state.rotation + h * velocity, velocity, side })
    }

    /// A block at rest stays there while the ground acceleration is below the threshold, which is a step of no length; above it the block
    /// uplifts to the side opposite to the ground acceleration.
    #[inline(always)]
    fn awake(&self, state: &TimeSteppingState<S>, ground: S, h: S) -> (S, S) {
        let (zero, one) = (S::of(0.0), S::of(1.0));
        let motion = state.rotation.abs() + state.velocity.abs();
        let moving = motion.exceeds(zero);
        let opposite = S::select(ground.exceeds(zero), -one, one);
        let uplifts = ground.abs().exceeds(self.uplift);
        (S::select(moving, state.side, opposite), S::select(moving, h, S::select(uplifts, h, zero)))
    }

    /// Eq. 10 at an instant: engaged where acceleration and velocity of the terminals have one sign.
    #[inline(always)]
    pub fn engages(&self, state: &TimeSteppingState<S>, side: S, ground: S) -> S::Mask {
        let drive = self.released.switching(side, state.rotation, state.velocity, ground);
        (drive * state.velocity).exceeds(S::of(0.0))
    }

    /// The equation in force at an instant.
    #[inline(always)]
    pub fn engagement(&self, state: &TimeSteppingState<S>, side: S, ground: S) -> E {
        E::switched(self.engages(state, side, ground), &self.engaged, &self.released)
    }

    /// Where θ has changed its sign: θ̇⁺ = η θ̇⁻ and the other toe. θ stays where the step left it.
    #[inline(always)]
    fn impact(&self, end: TimeSteppingState<S>) -> TimeSteppingState<S> {
        let hit = S::of(0.0).exceeds(end.rotation * end.side);
        TimeSteppingState {
            rotation: end.rotation,
            velocity: S::select(hit, end.velocity * self.restitution, end.velocity),
            side: S::select(hit, -end.side, end.side),
        }
    }
}

#[cfg(test)]
mod tests;
