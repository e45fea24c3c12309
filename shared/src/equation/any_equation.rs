//! Run-time choice of the equation of motion of an ideal device.
//!
//! Only the steps of a method, which evaluate the equation many times, are compiled for each type ([`AnyEquation::known`]); the event loop
//! is compiled once.

use super::lever::{CentreOfMass, Lever, TyingPoint};
use super::switched::Switched;
use super::{Equation, FullBlock, FullInerter, SlenderBlock};
use crate::math::scalar::Real;
use crate::math::value::Value;

/// One of the equations of motion (Eq. 2, 13-16 and 17-18).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnyEquation<S> {
    /// Slender block, with or without an engaged inerter.
    Slender(SlenderBlock<S>),
    /// Full block, alone or with its inerter released.
    Block(FullBlock<S>),
    /// Inerter at the centre of mass.
    Centre(FullInerter<S, CentreOfMass>),
    /// Inerter at any point of the block.
    Point(FullInerter<S, TyingPoint<S>>),
}

/// Continuation that receives the equation in its own type.
pub trait WithEquation<S: Real> {
    /// The result.
    type Output;

    /// Continues with `equation`.
    fn with<E: Switched<S>>(self, equation: &E) -> Self::Output;
}

macro_rules! known {
    ($any:expr, $equation:ident => $then:expr) => {
        match $any {
            AnyEquation::Slender($equation) => $then,
            AnyEquation::Block($equation) => $then,
            AnyEquation::Centre($equation) => $then,
            AnyEquation::Point($equation) => $then,
        }
    };
}

impl<S: Real> AnyEquation<S> {
    /// Continues with the equation in its own type and kinematics: one choice for all that `next` evaluates.
    #[inline(always)]
    pub fn known<W: WithEquation<S>>(&self, next: W) -> W::Output {
        match self {
            AnyEquation::Slender(equation) => next.with(equation),
            AnyEquation::Block(equation) => next.with(equation),
            AnyEquation::Centre(equation) => equation.known(next),
            AnyEquation::Point(equation) => equation.known(next),
        }
    }
}

impl<S: Real, L: Lever<S>> FullInerter<S, L> {
    #[inline(always)]
    fn known<W: WithEquation<S>>(&self, next: W) -> W::Output {
        if self.body.consistent { next.with(&self.with_kinematics(true)) } else { next.with(&self.with_kinematics(false)) }
    }
}

impl<S: Real> Equation<S> for AnyEquation<S> {
    #[inline]
    fn switches_with_acceleration(&self) -> bool {
        known!(self, equation => equation.switches_with_acceleration())
    }

    #[inline]
    fn acceleration<V: Value<S>>(&self, side: S, rotation: V, velocity: V, ground: V) -> V {
        known!(self, equation => equation.acceleration(side, rotation, velocity, ground))
    }

    #[inline]
    fn switching<V: Value<S>>(&self, side: S, rotation: V, velocity: V, ground: V) -> V {
        known!(self, equation => equation.switching(side, rotation, velocity, ground))
    }

    #[inline]
    fn terminal_acceleration(&self, side: S, rotation: S, velocity: S, acceleration: S) -> S {
        known!(self, equation => equation.terminal_acceleration(side, rotation, velocity, acceleration))
    }

    #[inline]
    fn slender(&self) -> Option<&SlenderBlock<S>> {
        known!(self, equation => equation.slender())
    }

    #[inline]
    fn paper_power(&self, side: S, rotation: S, velocity: S) -> S {
        known!(self, equation => equation.paper_power(side, rotation, velocity))
    }
}
