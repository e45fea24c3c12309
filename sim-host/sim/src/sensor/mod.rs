//! Models of the sensors that the controller reads: the truth in, what parts that one can buy make of it out.
//!
//! - [`inertial`]: gyroscope and accelerometers, with [`noise`], [`drift`], a low-pass filter, quantisation and saturation;
//! - [`encoder`]: the incremental encoder on the rack;
//! - [`sampling`]: when they sample and how late they report;
//! - [`preset`]: parts by name.
//!
//! Not modelled: temperature, non-linearity, vibration rectification, a gyroscope's sensitivity to acceleration, saturation ahead of the
//! filter, and an encoder's long-range and cyclic position error.

mod delivery;
pub mod drift;
pub mod encoder;
pub mod inertial;
mod low_pass;
pub mod noise;
pub mod preset;
mod random;
pub mod sampling;
#[cfg(test)]
mod tests;

use sprag_shared::control::sensing::sample::Sample;
use sprag_shared::structure::block::GRAVITY;

pub use delivery::MOST_UNDER_WAY;
pub use drift::Drift;
pub use encoder::Encoder;
pub use inertial::Inertial;
pub use sampling::Sampling;

use encoder::EncoderSensor;
use inertial::InertialSensor;

/// What is true at an instant, in the axes of [`Sample`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Truth {
    /// θ̇ of the block, rad/s.
    pub rate: f64,
    /// Specific force at the block's centre of mass in its own axes, m/s².
    pub block: [f64; 2],
    /// Specific force of the ground, m/s².
    pub ground: [f64; 2],
    /// Travel of the rack, m.
    pub travel: f64,
}

impl Truth {
    /// A block that stands on ground that does not move.
    pub const STILL: Truth = Truth { rate: 0.0, block: [0.0, GRAVITY], ground: [0.0, GRAVITY], travel: 0.0 };
}

/// What the sensors are, in SI units. The valid range of each value stands with it; the scene reader enforces them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Suite {
    /// On the block, about the rocking axis; rad/s.
    pub gyroscope: Inertial,
    /// On the block; m/s².
    pub block_accelerometer: Inertial,
    /// On the ground; m/s².
    pub ground_accelerometer: Inertial,
    /// On the rack.
    pub encoder: Encoder,
}

impl Suite {
    /// Reads the truth at the very instant it is asked.
    pub const IDEAL: Suite = Suite {
        gyroscope: Inertial::IDEAL,
        block_accelerometer: Inertial::IDEAL,
        ground_accelerometer: Inertial::IDEAL,
        encoder: Encoder::IDEAL,
    };
}

/// One specimen of a [`Suite`] at work. Its bias, scale and misalignment are drawn from the seed like its noise, so runs over many seeds
/// are runs with many specimens. Each axis has random numbers of its own: changing one sensor does not touch the others.
#[derive(Clone, Debug)]
pub struct Sensors {
    gyroscope: InertialSensor<1>,
    block_accelerometer: InertialSensor<2>,
    ground_accelerometer: InertialSensor<2>,
    encoder: EncoderSensor,
}

impl Sensors {
    /// Sensors that have been looking at `first` for long when time 0 comes. A first reading of it can be read from then on.
    pub fn new(suite: &Suite, seed: u64, first: &Truth) -> Sensors {
        Sensors {
            gyroscope: InertialSensor::new(&suite.gyroscope, seed, 0, &[first.rate]),
            block_accelerometer: InertialSensor::new(&suite.block_accelerometer, seed, 1, &first.block),
            ground_accelerometer: InertialSensor::new(&suite.ground_accelerometer, seed, 3, &first.ground),
            encoder: EncoderSensor::new(&suite.encoder, seed, 5, first.travel),
        }
    }

    /// The truth at `time` (s, finite), which must not decrease (an earlier time counts as the last one again). Between two calls the
    /// truth is taken as a straight line; a second call at the same time is a jump.
    pub fn advance(&mut self, time: f64, truth: &Truth) {
        self.gyroscope.advance(time, &[truth.rate]);
        self.block_accelerometer.advance(time, &truth.block);
        self.ground_accelerometer.advance(time, &truth.ground);
        self.encoder.advance(time, truth.travel);
    }

    /// Everything readable at the time last advanced to. `engaged` is left at its default.
    pub fn sample(&self) -> Sample {
        let [gyroscope] = self.gyroscope.readings();
        Sample {
            gyroscope,
            block_accelerometer: self.block_accelerometer.readings(),
            ground_accelerometer: self.ground_accelerometer.readings(),
            encoder: self.encoder.readable(),
            ..Sample::default()
        }
    }
}
