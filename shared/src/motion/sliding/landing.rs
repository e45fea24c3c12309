//! Impact of a block whose toe may slide.
//!
//! The old toe leaves with the velocity that it gets, the new one stays on the ground. With P_x and P_y the impulses along and normal to the
//! ground over mR, and the resultant at κ R sin α from the middle of the base,
//!
//! P_x = Δẋ/R + cos α Δθ̇,  P_y = −s sin α (θ̇⁺ + θ̇⁻),  (λ − 1) Δθ̇ = s κ sin α P_y − cos α P_x,
//!
//! s the side before. The new toe sticks, ẋ⁺ = 0, if |P_x| ≤ μ P_y; else it slides by P_x = −μ d P_y, d = sgn ẋ⁺. κ = 1 is an impulse at the new toe
//! (Shenton and Jones 1991); any η at or below that one's, 1 − 2 sin²α/λ, of an impact without sliding before and after is had by
//! κ = (λ − sin²α)(1 − η)/((1 + η) sin²α), from 1 up. No such impact adds energy.
//!
//! Where the block would not turn on, both toes hit the ground and θ̇⁺ = 0.

use super::SlidingSystem;
use crate::math::scalar::Real;
use crate::math::sign::Sign;

/// What an impact leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Landing<S> {
    /// θ̇⁺, rad/s; 0 where the block lands on both toes.
    pub velocity: S,
    /// ẋ⁺/R, 1/s; 0 where the base sticks.
    pub slip: S,
}

impl<S: Real> SlidingSystem<S> {
    /// Impact on `side` s with θ̇⁻ = `velocity` (rad/s) and ẋ⁻/R = `slip` (1/s).
    pub(super) fn land(&self, side: Sign, velocity: S, slip: S) -> Landing<S> {
        let (sin, cos, eccentricity) = (self.sin_slenderness, self.cos_slenderness, self.eccentricity);
        let squared = sin * sin;
        let turns_on = |after: S| side.times(after) < S::ZERO;
        // P_x without a change of ẋ, and P_y.
        let along = |after: S| cos * (after - velocity);
        let normal = |after: S| -side.times(sin * (after + velocity));
        let sticks = |after: S| (along(after) - slip).abs() <= self.friction * normal(after);

        let stuck = self.restitution * velocity + cos * slip / (self.inertia - squared + eccentricity * squared);
        let velocity_after = if sticks(stuck) {
            if turns_on(stuck) {
                return Landing { velocity: stuck, slip: S::ZERO };
            }
            S::ZERO
        } else {
            let direction = Sign::of(along(stuck) - slip, Sign::Positive).opposite();
            let lever = sin * (eccentricity * sin + (direction.times(side.times(self.friction * cos))));
            let inertia = self.inertia - S::ONE;
            let after = velocity * (inertia - lever) / (inertia + lever);
            if turns_on(after) {
                let friction = direction.times(self.friction * normal(after));
                return Landing { velocity: after, slip: slip - along(after) - friction };
            }
            S::ZERO
        };
        if sticks(velocity_after) {
            return Landing { velocity: S::ZERO, slip: S::ZERO };
        }
        let free = slip - along(S::ZERO);
        let friction = Sign::of(free, Sign::Positive).times(self.friction * normal(S::ZERO));
        Landing { velocity: S::ZERO, slip: free - friction }
    }
}
