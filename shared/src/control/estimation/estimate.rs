//! What the controller believes of the motion, whichever estimator found it.

use crate::math::sign::Sign;
use serde::{Deserialize, Serialize};

/// The motion at the instant of a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// θ, rad.
    pub rotation: f32,
    /// θ̇, rad/s.
    pub velocity: f32,
    /// The sign of θ, or at θ = 0 the side that it moves to.
    pub side: Sign,
    /// Quantity with the sign of the terminals' acceleration, 1/s² ([`crate::control::model::Model::push`]).
    pub push: f32,
    /// Acceleration of the ground in g, horizontal and vertical.
    pub ground: [f32; 2],
    /// Growth of the horizontal one, 1/s.
    pub ground_rate: f32,
    /// The block stands on both toes.
    pub standing: bool,
    /// How far off each may be.
    pub deviation: Deviation,
}

/// Standard deviation of θ, in α, beyond which nobody knows where the block is.
const LOST: f32 = 0.2;

impl Estimate {
    /// It says where a block of this `slenderness` (rad) is, and which way: not so after power-on in motion, until an impact has shown where
    /// θ = 0 is.
    #[inline]
    pub fn located(&self, slenderness: f32) -> bool {
        self.deviation.rotation <= LOST * slenderness
    }
}

/// Standard deviations of an estimate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Deviation {
    /// rad.
    pub rotation: f32,
    /// rad/s.
    pub velocity: f32,
    /// 1/s².
    pub push: f32,
    /// g.
    pub ground: f32,
}

impl Deviation {
    /// All of them `factor` times as large.
    #[inline]
    #[must_use]
    pub fn scaled(self, factor: f32) -> Deviation {
        Deviation {
            rotation: factor * self.rotation,
            velocity: factor * self.velocity,
            push: factor * self.push,
            ground: factor * self.ground,
        }
    }
}

/// Largest |θ| that an estimator keeps, rad: a block that lies on the ground has π/2.
const MOST_ROTATION: f32 = 2.0;

/// Largest |θ̇|, rad/s, and |θ̈|, rad/s²: no block reaches them.
const MOST_RATE: f32 = 100.0;
const MOST_ACCELERATION: f32 = 1e4;

/// θ, θ̇ and θ̈ within what can be, so that no estimator runs away from finite readings.
#[inline]
pub(super) fn bounded(rotation: f32, velocity: f32, acceleration: f32) -> (f32, f32, f32) {
    let within = |x: f32, most: f32| x.clamp(-most, most);
    (within(rotation, MOST_ROTATION), within(velocity, MOST_RATE), within(acceleration, MOST_ACCELERATION))
}
