//! The parameters of an inerter device: kind, mass ratio, mount, kinematics.

use super::mount::Mount;

/// Kind of the device that a block carries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum DeviceKind {
    /// No device.
    #[default]
    None,
    /// One inerter, always engaged.
    Inerter,
    /// Two clutched inerters (Eq. 10).
    ClutchedPair,
}

impl DeviceKind {
    /// Every kind.
    pub const ALL: [DeviceKind; 3] = [DeviceKind::None, DeviceKind::Inerter, DeviceKind::ClutchedPair];
}

/// Which acceleration the inerter's terminals have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum KinematicsKind {
    /// Eq. 11: ℓ R θ̈.
    #[default]
    Paper,
    /// R (ℓ θ̈ + ℓ' θ̇²).
    Consistent,
}

/// A device and how it is mounted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Device {
    /// Kind of the device.
    pub kind: DeviceKind,
    /// σ = inertance / block mass; 0 to 10,000.
    pub mass_ratio: f64,
    /// Mount of the device on the block.
    pub mount: Mount,
    /// Paper or consistent.
    pub kinematics: KinematicsKind,
}

impl Device {
    /// No device.
    pub const NONE: Device =
        Device { kind: DeviceKind::None, mass_ratio: 0.0, mount: Mount::CentreOfMass, kinematics: KinematicsKind::Paper };
}
