//! Equations of a block on a compliant foundation.
//!
//! With s = sgn θ, a = |θ|, δ = α − a, lengths over R, and n engaged flywheels at the height of the centre of mass, the feet under the toe about which the block turns (1)
//! and under the other one (2) are compressed by
//!
//! c₁ = cos δ − cos α − y,  c₂ = c₁ − 2 sin α sin a,
//!
//! press with φᵢ = (k cᵢ + c ċᵢ)/m, and by Lagrange's equations
//!
//! ÿ = φ₁ + φ₂ − (g + v̈_g)/R,
//! (λ − 1 + (1 + nσ) cos²δ) ä + (1 + nσ) sin δ cos δ ȧ² = −s ü_g cos δ/R − φ₁ sin δ − φ₂ (sin δ − 2 sin α cos a).
//!
//! The paper's kinematics leave nσ out of the ȧ² term. With rigid feet φ₁ = ÿ + g/R, c₁ = 0 and φ₂ = 0, which is the equation of rocking.

use super::{CompliantState, CompliantSystem, Foot};
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::motion::state::BlockState;

/// Accelerations in the present mode.
#[derive(Clone, Copy, Debug)]
pub(super) struct Balance<S> {
    /// θ̈, rad/s².
    pub acceleration: S,
    /// ÿ/R, 1/s².
    pub lift: S,
    /// Of the sign of the terminals' acceleration, engaged or not; 1/s².
    pub push: S,
    /// Power of the dashpots, over mR²; 1/s³.
    pub loss: S,
}

impl<S: Real> CompliantSystem<S> {
    /// g/R, 1/s².
    pub(super) fn gravity(&self) -> S {
        self.inertia * self.frequency_squared
    }

    /// sin δ and cos δ.
    pub(super) fn delta(&self, side: Sign, rotation: S) -> (S, S) {
        (self.slenderness - side.times(rotation)).sin_cos()
    }

    /// y/R at which the feet under the toe of `side` and under the other one just touch the ground.
    pub(super) fn sinking(&self, side: Sign, rotation: S) -> [S; 2] {
        let toe = self.delta(side, rotation).1 - self.cos_slenderness;
        [toe, toe - S::of(2.0) * self.sin_slenderness * side.times(rotation).sin_cos().0]
    }

    /// Compression over R of the foot with this number and the force that it would have, over mR; 1/s².
    pub(super) fn foot(&self, state: &CompliantState<S>, foot: usize) -> (S, S) {
        let (compression, speed, _) = self.compression(state, foot);
        (compression, self.stiffness * compression + self.damping * speed)
    }

    /// Compression of a foot over R, its speed, and its slope over a = |θ|.
    fn compression(&self, state: &CompliantState<S>, foot: usize) -> (S, S, S) {
        let BlockState { side, rotation, velocity, .. } = state.motion;
        let (away, speed) = (side.times(rotation), side.times(velocity));
        let (sin_delta, cos_delta) = self.delta(side, rotation);
        let (mut compression, mut slope) = (cos_delta - self.cos_slenderness - state.height, sin_delta);
        if foot != usize::from(side == Sign::Positive) {
            let (sine, cosine) = away.sin_cos();
            let base = S::of(2.0) * self.sin_slenderness;
            (compression, slope) = (compression - base * sine, slope - base * cosine);
        }
        (compression, slope * speed - state.rise, slope)
    }

    /// Accelerations in the mode of `state`; `ground` is ü_g/g and the weight 1 + v̈_g/g.
    pub(super) fn balance(&self, state: &CompliantState<S>, ground: [S; 2]) -> Balance<S> {
        let BlockState { side, rotation, velocity, .. } = state.motion;
        let (sin_delta, cos_delta) = self.delta(side, rotation);
        let gravity = self.gravity();
        let (mut moment, mut lift, mut loss) = (-side.times(ground[0]) * gravity * cos_delta, -gravity * ground[1], S::ZERO);
        for foot in [0, 1] {
            if state.feet[foot] != Foot::Presses {
                continue;
            }
            let (compression, speed, slope) = self.compression(state, foot);
            let force = self.stiffness * compression + self.damping * speed;
            (moment, lift) = (moment - force * slope, lift + force);
            loss = loss + self.damping * speed * speed;
        }
        let square = velocity * velocity;
        let swing = sin_delta * cos_delta * square;
        let centre = self.inertia - S::ONE + cos_delta * cos_delta;
        let (mut mass, mut held) = (centre, moment - swing);
        let mut push = held;
        if self.consistent {
            push = push + centre * sin_delta / cos_delta * square;
        }
        if state.engaged {
            mass = mass + self.mass_ratio * cos_delta * cos_delta;
            if self.consistent {
                held = held - self.mass_ratio * swing;
            }
        }
        Balance { acceleration: side.times(held / mass), lift, push: side.times(push), loss }
    }
}
