//! The sensors of the controller.

use core::fmt;

/// A sensor of [`Sample`](super::sample::Sample).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Sensor {
    /// θ̇ of the block.
    Gyroscope,
    /// On the block.
    BlockAccelerometer,
    /// Under it.
    GroundAccelerometer,
    /// At the rack.
    Encoder,
}

impl Sensor {
    /// Each, in the order in which arrays over sensors hold them.
    pub const ALL: [Sensor; 4] = [Sensor::Gyroscope, Sensor::BlockAccelerometer, Sensor::GroundAccelerometer, Sensor::Encoder];
}

impl fmt::Display for Sensor {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Sensor::Gyroscope => "gyroscope",
            Sensor::BlockAccelerometer => "block accelerometer",
            Sensor::GroundAccelerometer => "ground accelerometer",
            Sensor::Encoder => "encoder",
        })
    }
}
