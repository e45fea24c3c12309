//! Power losses of a device, by cause.

/// Energy losses by cause, or their rates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spent<S> {
    /// Slip and damping of the clutches.
    pub clutch: S,
    /// Brakes of idle flywheels.
    pub brake: S,
    /// Bearings of the flywheels.
    pub bearing: S,
    /// Friction of the rack.
    pub rack: S,
    /// What the paper's kinematics take away without a physical cause (negative: create).
    pub kinematics: S,
}
