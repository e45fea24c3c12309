//! The sensors that an estimator needs.

use super::sensor::Sensor;

/// Sensors that the estimator needs. The others are watched where they are fitted, but a fault of theirs is only a warning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Required {
    /// θ̇ of the block.
    pub gyroscope: bool,
    /// On the block.
    pub block_accelerometer: bool,
    /// Under it.
    pub ground_accelerometer: bool,
    /// At the rack.
    pub encoder: bool,
}

impl Required {
    /// All sensors.
    pub const ALL: Required = Required { gyroscope: true, block_accelerometer: true, ground_accelerometer: true, encoder: true };
    /// No sensor.
    pub const NONE: Required =
        Required { gyroscope: false, block_accelerometer: false, ground_accelerometer: false, encoder: false };

    /// In the order of [`Sensor::ALL`].
    pub fn flags(&self) -> [bool; 4] {
        [self.gyroscope, self.block_accelerometer, self.ground_accelerometer, self.encoder]
    }

    /// Whether another sensor can take the place of one that is lost, as in the model-aided estimator: its equation of motion continues with
    /// encoder or gyroscope alone, and finds the ground's acceleration from the block's.
    pub fn has_substitutes(&self) -> bool {
        self.flags() == [true, false, true, true]
    }

    /// Whether `sensor` is required.
    pub fn contains(&self, sensor: Sensor) -> bool {
        match sensor {
            Sensor::Gyroscope => self.gyroscope,
            Sensor::BlockAccelerometer => self.block_accelerometer,
            Sensor::GroundAccelerometer => self.ground_accelerometer,
            Sensor::Encoder => self.encoder,
        }
    }
}
