//! Balance of forces and moments of a block whose toe sticks or slides.
//!
//! With the toe at u_g + x, the centre of mass at (−R sin δ, R cos δ) from it, δ = αs − θ, and a = g/R, horizontal and vertical reaction H and V
//! over mR are
//!
//! h = a ü_g/g + ẍ/R + cos δ θ̈ + sin δ θ̇²,  v = a w + sin δ θ̈ − cos δ θ̇²,  w = 1 + v̈_g/g,
//!
//! and moments about the centre of mass give (λ − 1) θ̈ = −sin δ v − cos δ h.

use super::SlidingSystem;
use crate::math::scalar::Real;
use crate::math::sign::Sign;

/// Accelerations, and reactions of the ground over mR; 1/s².
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Balance<S> {
    /// θ̈, rad/s².
    pub acceleration: S,
    /// ẍ/R.
    pub slide: S,
    /// h.
    pub along: S,
    /// v.
    pub normal: S,
}

impl<S: Real> SlidingSystem<S> {
    /// a = g/R = λp².
    fn weight(&self) -> S {
        self.inertia * self.frequency_squared
    }

    fn direction(&self, side: Sign, rotation: S) -> (S, S) {
        (side.times(self.slenderness) - rotation).sin_cos()
    }

    /// Of a block that rocks about a toe that sticks: ẍ = 0, so that λθ̈ = −a (w sin δ + ü_g/g cos δ). `ground` is ü_g/g and w.
    pub(super) fn stuck(&self, side: Sign, rotation: S, velocity: S, [push, weight]: [S; 2]) -> Balance<S> {
        let (sin, cos) = self.direction(side, rotation);
        let acceleration = -self.frequency_squared * (weight * sin + push * cos);
        let pull = velocity * velocity;
        Balance {
            acceleration,
            slide: S::ZERO,
            along: self.weight() * push + cos * acceleration + sin * pull,
            normal: self.weight() * weight + sin * acceleration - cos * pull,
        }
    }

    /// Of a block that rocks about a toe that slides in `direction` d: h = −μ d v, so that θ̈ = −q n₀/(λ − 1 + q sin δ) with
    /// q = sin δ − μ d cos δ and n₀ = a w − cos δ θ̇². The divisor is above 0 for every δ while μ² < 4λ(λ − 1).
    pub(super) fn sliding(&self, side: Sign, direction: Sign, rotation: S, velocity: S, [push, weight]: [S; 2]) -> Balance<S> {
        let (sin, cos) = self.direction(side, rotation);
        let pull = velocity * velocity;
        let inertia = self.inertia - S::ONE;
        let lever = sin - direction.times(self.friction * cos);
        let unhindered = self.weight() * weight - cos * pull;
        let divisor = inertia + sin * lever;
        let acceleration = -lever * unhindered / divisor;
        let normal = unhindered * inertia / divisor;
        let along = -direction.times(self.friction * normal);
        let slide = along - self.weight() * push - cos * acceleration - sin * pull;
        Balance { acceleration, slide, along, normal }
    }

    /// Of a block that slides on its whole base in `direction`: ẍ = −μ d (g + v̈_g) − ü_g.
    pub(super) fn flat(&self, direction: Sign, [push, weight]: [S; 2]) -> Balance<S> {
        let normal = self.weight() * weight;
        let along = -direction.times(self.friction * normal);
        Balance { acceleration: S::ZERO, slide: along - self.weight() * push, along, normal }
    }

    /// Of a block that stands.
    pub(super) fn still(&self, [push, weight]: [S; 2]) -> Balance<S> {
        let scale = self.weight();
        Balance { acceleration: S::ZERO, slide: S::ZERO, along: scale * push, normal: scale * weight }
    }
}
