//! Readings of the sensors at one tick, in SI units.

use serde::{Deserialize, Serialize};

/// One reading of one sensor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Reading {
    /// In the sensor's unit.
    pub value: f32,
    /// How many readings the sensor has taken so far, wrapping: the same number is the same reading again.
    pub number: u32,
}

/// A reading of an incremental encoder.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Count {
    /// Counts since the start, wrapping; they grow with the terminals' travel, which has the sign of θ.
    pub counts: i32,
    /// Number of the reading, as [`Reading::number`].
    pub number: u32,
}

/// Every sensor, as last read. Axes are those of the block or of the ground: the first along the base, in the direction of positive
/// ground acceleration, the second up along the centre line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// θ̇ of the block, rad/s.
    pub gyroscope: Reading,
    /// Specific force of the block where its accelerometer is ([`Instruments::block_position`](super::instruments::Instruments)), in its own
    /// axes, m/s²: (0, g) at rest.
    pub block_accelerometer: [Reading; 2],
    /// Specific force of the ground, m/s²: (ü_g, g + v̈_g).
    pub ground_accelerometer: [Reading; 2],
    /// Travel of the rack.
    pub encoder: Count,
    /// What each clutch reports of itself: engaged.
    pub engaged: [bool; 2],
}
