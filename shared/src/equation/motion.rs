//! The motion of the block at an instant: rotation, angular velocity, angular acceleration.

/// θ, θ̇ and θ̈ at one instant (rad, rad/s, rad/s²).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<S> {
    /// θ.
    pub rotation: S,
    /// θ̇.
    pub velocity: S,
    /// θ̈.
    pub acceleration: S,
}
