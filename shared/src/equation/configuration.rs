//! Configuration of the exact block: what of Eq. 13-16 the rotation alone decides, and the equation on it.

use super::lever::Lever;
use crate::math::scalar::Scalar;
use crate::math::value::Value;

/// sin δ, cos δ, ℓ and, in the consistent kinematics, ℓ'; with δ = αs − θ.
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

impl<V> FullConfiguration<V> {
    /// Configuration at δ on side s = ±1.
    #[inline(always)]
    pub fn new<S: Scalar, L: Lever<S>>(lever: &L, consistent: bool, side: S, delta: V) -> Self
    where
        V: Value<S>,
    {
        let (sin, cos) = delta.sin_cos();
        let rate = if consistent { Some(lever.arm_rate(side, sin, cos)) } else { None };
        FullConfiguration { sin, cos, arm: lever.arm(side, sin, cos), rate }
    }

    /// (1 + κ k ℓ²) for `coupling` κ k: inertia about the toe over that of the bare block.
    #[inline(always)]
    pub fn inertia<S: Scalar>(&self, coupling: S) -> V
    where
        V: Value<S>,
    {
        self.arm.square().scale(coupling).offset(S::of(1.0))
    }

    /// θ̈ from (1 + κ k ℓ²) θ̈ + κ k ℓ ℓ' θ̇² = `moment` (the θ̇² term in the consistent kinematics only).
    #[inline(always)]
    pub fn solve_acceleration<S: Scalar>(&self, moment: V, coupling: S, velocity: V) -> V
    where
        V: Value<S>,
    {
        let moment = match self.rate {
            Some(rate) => moment - (self.arm * rate * velocity.square()).scale(coupling),
            None => moment,
        };
        moment / self.inertia(coupling)
    }

    /// Acceleration of the terminals per R: ℓθ̈, plus ℓ'θ̇² in the consistent kinematics.
    #[inline(always)]
    pub fn terminal_acceleration<S: Scalar>(&self, velocity: V, acceleration: V) -> V
    where
        V: Value<S>,
    {
        let tangential = self.arm * acceleration;
        match self.rate {
            Some(rate) => tangential + rate * velocity.square(),
            None => tangential,
        }
    }

    /// Quantity with the sign of the terminals' acceleration under the driving moment D (`moment`) alone, from which κ has dropped out:
    /// D in the paper's kinematics, ℓ (ℓ D + ℓ' θ̇²) in the consistent ones.
    #[inline(always)]
    pub fn switching<S: Scalar>(&self, velocity: V, moment: V) -> V
    where
        V: Value<S>,
    {
        match self.rate {
            Some(rate) => self.arm * (self.arm * moment + rate * velocity.square()),
            None => moment,
        }
    }
}

impl<S: Scalar> FullConfiguration<S> {
    /// Power that the paper's kinematics take from an engaged flywheel without a cause: −κ k ℓ ℓ' θ̇³ per λmR², with ℓ' of the `lever`
    /// on side s = ±1; 0 in the consistent ones.
    #[inline(always)]
    pub fn paper_power<L: Lever<S>>(&self, lever: &L, side: S, velocity: S, coupling: S) -> S
    where
        S: Value<S>,
    {
        if self.rate.is_some() {
            return S::of(0.0);
        }
        let rate = lever.arm_rate(side, self.sin, self.cos);
        -(coupling * self.arm * rate * (velocity * velocity * velocity))
    }
}
