//! The motion of the block at an instant: rotation, angular velocity, angular acceleration.

/// Motion at one instant: θ, θ̇ and θ̈ (rad, rad/s, rad/s²).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<S> {
    /// θ, rad.
    pub rotation: S,
    /// θ̇, rad/s.
    pub velocity: S,
    /// θ̈, rad/s².
    pub acceleration: S,
}
