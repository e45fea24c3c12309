//! Equation of motion in parts: moment of weight and ground D, and lever ℓ of the inerter's terminals.
//!
//! With δ = αs − θ and everything divided by I_O = λmR², the moment of weight and ground is
//!
//! D = −p² [ (1 + v̈_g/g) sin δ + (ü_g/g) cos δ ],
//!
//! where the vertical ground acceleration v̈_g is there only if the scene has one. [`crate::equation`] holds the closed equations of
//! ideal devices; here the same parts stand apart, so that a device with a memory can put its own forces between them.

use super::FullBlock;
use super::lever::{Lever, TyingPoint};
use crate::math::scalar::Scalar;
use crate::math::value::Value;

/// Block and lever: the terms of the equation of motion at a configuration.
pub trait Body<S: Scalar>: Copy {
    /// Quantities that θ alone decides: sin δ, cos δ, ℓ, ℓ'.
    type Configuration<V: Value<S>>: Copy;

    /// Configuration at θ (rad) on side s = ±1.
    fn configuration<V: Value<S>>(&self, side: S, rotation: V) -> Self::Configuration<V>;

    /// D for the ground acceleration in g, horizontal and vertical (the vertical one is not read by a body without it).
    fn driving_moment<V: Value<S>>(&self, configuration: &Self::Configuration<V>, ground: [V; 2]) -> V;

    /// ℓ x.
    fn to_terminal<V: Value<S>>(&self, configuration: &Self::Configuration<V>, x: V) -> V;

    /// Acceleration of the terminals per R: ℓθ̈, plus ℓ'θ̇² in the consistent kinematics.
    fn terminal_acceleration<V: Value<S>>(&self, configuration: &Self::Configuration<V>, velocity: V, acceleration: V) -> V;

    /// θ̈ from (1 + k ℓ²) θ̈ + k ℓ ℓ' θ̇² = `moment` (the θ̇² term in the consistent kinematics only).
    fn solve_acceleration<V: Value<S>>(&self, configuration: &Self::Configuration<V>, moment: V, coupling: S, velocity: V) -> V;

    /// A quantity with the sign of the terminals' acceleration under D alone, whatever is engaged (Eq. 10): D in the paper's kinematics,
    /// ℓ (ℓ D + ℓ' θ̇²) in the consistent ones.
    fn switching<V: Value<S>>(&self, configuration: &Self::Configuration<V>, velocity: V, driving_moment: V) -> V;

    /// Power that the paper's kinematics take from an engaged flywheel without a cause: −k ℓ ℓ' θ̇³ per λmR²; 0 where
    /// energy is conserved.
    fn paper_power(&self, side: S, configuration: &Self::Configuration<S>, velocity: S, coupling: S) -> S;

    /// Lever ℓ.
    fn arm(&self, configuration: &Self::Configuration<S>) -> S;

    /// The terminals' travel per R, ∫ ℓ dθ, up to a constant of each side.
    fn travel(&self, side: S, configuration: &Self::Configuration<S>) -> S;

    /// Factors of ü_g/g and of 1 + v̈_g/g in D at the configuration: −p² cos δ and −p² sin δ.
    fn factors(&self, configuration: &Self::Configuration<S>) -> (S, S);
}

/// The slender block (Eq. 17-18): sin δ → δ, cos δ → 1, ℓ constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlenderBody<S> {
    /// p², 1/s².
    pub frequency_squared: S,
    /// α, rad.
    pub slenderness: S,
    /// ℓ.
    pub lever: S,
    /// The ground moves vertically too.
    pub vertical: bool,
}

impl<S: Scalar> Body<S> for SlenderBody<S> {
    type Configuration<V: Value<S>> = V;

    #[inline(always)]
    fn configuration<V: Value<S>>(&self, side: S, rotation: V) -> V {
        (-rotation).offset(side * self.slenderness)
    }

    #[inline(always)]
    fn driving_moment<V: Value<S>>(&self, delta: &V, ground: [V; 2]) -> V {
        let weight = if self.vertical { *delta * ground[1].offset(S::of(1.0)) } else { *delta };
        (weight + ground[0]).scale(-self.frequency_squared)
    }

    #[inline(always)]
    fn to_terminal<V: Value<S>>(&self, _delta: &V, x: V) -> V {
        x.scale(self.lever)
    }

    #[inline(always)]
    fn terminal_acceleration<V: Value<S>>(&self, _delta: &V, _velocity: V, acceleration: V) -> V {
        acceleration.scale(self.lever)
    }

    #[inline(always)]
    fn solve_acceleration<V: Value<S>>(&self, _delta: &V, moment: V, coupling: S, _velocity: V) -> V {
        moment.scale(S::of(1.0) / (S::of(1.0) + coupling * self.lever * self.lever))
    }

    #[inline(always)]
    fn switching<V: Value<S>>(&self, _delta: &V, _velocity: V, driving_moment: V) -> V {
        driving_moment
    }

    #[inline(always)]
    fn paper_power(&self, _side: S, _delta: &S, _velocity: S, _coupling: S) -> S {
        S::of(0.0)
    }

    #[inline(always)]
    fn arm(&self, _delta: &S) -> S {
        self.lever
    }

    #[inline(always)]
    fn travel(&self, _side: S, delta: &S) -> S {
        -(self.lever * *delta)
    }

    #[inline(always)]
    fn factors(&self, delta: &S) -> (S, S) {
        (-self.frequency_squared, -self.frequency_squared * *delta)
    }
}

/// Configuration of the exact block: sin δ, cos δ, ℓ and, in the consistent kinematics, ℓ'; with δ = αs − θ.
#[derive(Clone, Copy, Debug)]
pub struct FullConfiguration<V> {
    /// sin δ.
    pub sin: V,
    /// cos δ.
    pub cos: V,
    /// ℓ.
    pub arm: V,
    /// ℓ' = dℓ/dθ, in the consistent kinematics only.
    pub rate: Option<V>,
}

/// The exact block (Eq. 13-16) with any mount.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FullBody<S, L = TyingPoint<S>> {
    /// The block.
    pub block: FullBlock<S>,
    /// ℓ(θ).
    pub lever: L,
    /// Consistent kinematics, with the θ̇² term; else the paper's (Eq. 11).
    pub consistent: bool,
    /// The ground moves vertically too.
    pub vertical: bool,
}

impl<S: Scalar, L: Lever<S>> Body<S> for FullBody<S, L> {
    type Configuration<V: Value<S>> = FullConfiguration<V>;

    #[inline(always)]
    fn configuration<V: Value<S>>(&self, side: S, rotation: V) -> FullConfiguration<V> {
        let (sin, cos) = self.block.delta(side, rotation).sin_cos();
        let rate = if self.consistent { Some(self.lever.arm_rate(side, sin, cos)) } else { None };
        FullConfiguration { sin, cos, arm: self.lever.arm(side, sin, cos), rate }
    }

    #[inline(always)]
    fn driving_moment<V: Value<S>>(&self, at: &FullConfiguration<V>, ground: [V; 2]) -> V {
        let weight = if self.vertical { at.sin * ground[1].offset(S::of(1.0)) } else { at.sin };
        self.block.driving_moment(weight, at.cos, ground[0])
    }

    #[inline(always)]
    fn to_terminal<V: Value<S>>(&self, at: &FullConfiguration<V>, x: V) -> V {
        at.arm * x
    }

    #[inline(always)]
    fn terminal_acceleration<V: Value<S>>(&self, at: &FullConfiguration<V>, velocity: V, acceleration: V) -> V {
        let tangential = at.arm * acceleration;
        match at.rate {
            Some(rate) => tangential + rate * velocity.square(),
            None => tangential,
        }
    }

    #[inline(always)]
    fn solve_acceleration<V: Value<S>>(&self, at: &FullConfiguration<V>, moment: V, coupling: S, velocity: V) -> V {
        let moment = match at.rate {
            Some(rate) => moment - (at.arm * rate * velocity.square()).scale(coupling),
            None => moment,
        };
        moment / at.arm.square().scale(coupling).offset(S::of(1.0))
    }

    #[inline(always)]
    fn switching<V: Value<S>>(&self, at: &FullConfiguration<V>, velocity: V, driving_moment: V) -> V {
        match at.rate {
            Some(rate) => at.arm * (at.arm * driving_moment + rate * velocity.square()),
            None => driving_moment,
        }
    }

    #[inline(always)]
    fn paper_power(&self, side: S, at: &FullConfiguration<S>, velocity: S, coupling: S) -> S {
        if at.rate.is_some() {
            return S::of(0.0);
        }
        let rate = self.lever.arm_rate(side, at.sin, at.cos);
        -(coupling * at.arm * rate * (velocity * velocity * velocity))
    }

    #[inline(always)]
    fn arm(&self, at: &FullConfiguration<S>) -> S {
        at.arm
    }

    #[inline(always)]
    fn travel(&self, side: S, at: &FullConfiguration<S>) -> S {
        // ℓ is a sum of a sine and a cosine: its integral is −ℓ'.
        -self.lever.arm_rate(side, at.sin, at.cos)
    }

    #[inline(always)]
    fn factors(&self, at: &FullConfiguration<S>) -> (S, S) {
        (-self.block.frequency_squared * at.cos, -self.block.frequency_squared * at.sin)
    }
}
