//! What a sensor is allowed, in SI units.

use super::Monitor;
use super::agreement::{AgreementLimits, SLOTS};
use super::watch::WatchLimits;
use crate::control::ticks::{ticks, ticks_or_never};
use crate::structure::error::{ParameterError, require};

/// Ticks that a window in which gyroscope and encoder are compared cannot be shorter than: one for each part that it moves on by.
pub const FEWEST_WINDOW_TICKS: u32 = SLOTS;

/// What a gyroscope or accelerometer is allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorLimits {
    /// Without a new reading for this long it is stale, s; above 0, up to 10.
    pub stale_time: f32,
    /// Bit-identical readings (of every axis, three times at least) for this long are stuck, s; 0 to 10, 0 to switch this off.
    /// See [`stuck_time`].
    pub stuck_time: f32,
    /// The same while the block moves, so that a sensor without noise may be constant at rest.
    pub stuck_time_moving: f32,
    /// At or beyond this a reading is saturated, rad/s or m/s²; above 0. Just inside of what the sensor can say.
    pub full_scale: f32,
    /// Saturation for this long is a fault, s; 0 to 10.
    pub saturation_time: f32,
}

/// What the encoder is allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EncoderLimits {
    /// Longest time without a reading, s, as of the other sensors.
    pub stale_time: f32,
    /// Counts per rad of the block at |θ| = α/2: its lever there, ℓ R, times counts per metre of the rack. At any other θ the geometry says how
    /// many. 0 where it is not to be compared with the gyroscope. Magnitude up to 1e12.
    pub counts_per_radian: f32,
    /// Largest distance of a count from θ = 0; at least 0, 0 where there is none.
    pub travel: i32,
}

/// What all are allowed. The defaults find what a sensor reading once a millisecond can show within 5 ms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MonitorParameters {
    /// Default: stale after 3 ms, which is two readings missed and the third due. Stuck is off at rest, where a sensor without
    /// noise is constant, and after 4 ms in motion, where none with fine steps is (for coarse ones,
    /// [`stuck_time`]). Full scale 8.7 rad/s (500°/s); saturated after 2 ms, since a velocity has no spikes,
    /// so that one bad reading passes and two do not.
    pub gyroscope: SensorLimits,
    /// Default: as the gyroscope, but full scale 78 m/s² (just below 8 g) and saturated after 4 ms: impacts last 1 ms to 2 ms, and with 1 ms to the
    /// first reading it is known after 5 ms.
    pub block_accelerometer: SensorLimits,
    /// Default: as the block's, but never stuck: the ground may well be still while the block rocks.
    pub ground_accelerometer: SensorLimits,
    /// Default: stale after 3 ms; no comparison, no end of travel, until they are known.
    pub encoder: EncoderLimits,
    /// Window in which gyroscope and encoder are compared, s; above 0, up to 1, no less than eight ticks. Default 4 ms: what is wrong by
    /// more than `sensor_delay` explains is seen when the window is full of it, after 4 ms and up to 1 ms of a reading's age.
    pub contradiction_time: f32,
    /// A second window for what is too slow for the first, s; as that, and no shorter. Default 64 ms: noise and counts weigh a sixteenth,
    /// which is the least in which a block that starts to rock turns by a few counts.
    pub slow_contradiction_time: f32,
    /// How long an accelerometer must contradict gravity at rest, s; above 0, up to 10. Default 100 ms: a block that starts to rock shows
    /// it in its accelerometer before its rate is noticed, and a distant ground sensor hears of a wave earlier; at rest nothing is urgent.
    pub rest_contradiction_time: f32,
    /// By how much an accelerometer at rest may be off gravity, m/s², noise included; above 0. Default 0.5: 0.05 rad of tilt.
    pub rest_tolerance: f32,
    /// Counts by which gyroscope and encoder may differ in a window: quantisation, twice, and backlash; at least 1. Default 4.
    pub count_tolerance: f32,
    /// Mean error of the calibrated gyroscope over a window, rad/s; at least 0. Default 0.02.
    pub rate_tolerance: f32,
    /// Share of the movement by which they may differ, because the lever is not known exactly; 0 to 0.9. Default 0.25.
    pub lever_tolerance: f32,
    /// By how much later than the other either may be, reading period and filters together, s; 0 to 1. Default 2 ms.
    pub sensor_delay: f32,
    /// The block moves when |rate| exceeds this, rad/s; above 0. Default 0.02, above the peaks of a gyroscope's noise.
    pub moving_rate: f32,
    /// g, m/s²; above 0.
    pub gravity: f32,
}

/// The stuck time of a sensor with noise of `noise_in_steps` (standard deviation over resolution) and a reading every `reading_period` s.
/// Two readings in a row are equal with a chance of 0.28 over the noise in steps, and each further one with up to 0.4 over it; the time is
/// that of as many as happen by chance once in 1e9 readings (11 days at 1 kHz), up to a correlation of 0.44 from one to the next. 5 ms at
/// 1 kHz takes a noise of 30 steps; below half a step nothing can be said, and the check is off.
pub fn stuck_time(noise_in_steps: f32, reading_period: f32) -> f32 {
    let repeats = match noise_in_steps {
        steps if steps >= 100.0 => 4.0,
        steps if steps >= 30.0 => 5.0,
        steps if steps >= 13.0 => 6.0,
        steps if steps >= 4.2 => 9.0,
        steps if steps >= 3.0 => 11.0,
        steps if steps >= 1.4 => 17.0,
        steps if steps >= 0.8 => 32.0,
        steps if steps >= 0.5 => 63.0,
        _ => 0.0,
    };
    repeats * reading_period
}

impl Default for MonitorParameters {
    fn default() -> MonitorParameters {
        let gyroscope = SensorLimits {
            stale_time: 0.003,
            stuck_time: 0.0,
            stuck_time_moving: 0.004,
            full_scale: 8.7,
            saturation_time: 0.002,
        };
        let block_accelerometer = SensorLimits { full_scale: 78.0, saturation_time: 0.004, ..gyroscope };
        MonitorParameters {
            gyroscope,
            block_accelerometer,
            ground_accelerometer: SensorLimits { stuck_time_moving: 0.0, ..block_accelerometer },
            encoder: EncoderLimits { stale_time: 0.003, counts_per_radian: 0.0, travel: 0 },
            contradiction_time: 0.004,
            slow_contradiction_time: 0.064,
            rest_contradiction_time: 0.1,
            rest_tolerance: 0.5,
            count_tolerance: 4.0,
            rate_tolerance: 0.02,
            lever_tolerance: 0.25,
            sensor_delay: 0.002,
            moving_rate: 0.02,
            gravity: 9.81,
        }
    }
}

impl MonitorParameters {
    /// Whether all is within its range, for a controller with a tick every `period` s.
    pub(in crate::control) fn check(&self, period: f32) -> Result<(), ParameterError> {
        self.gyroscope.check(GYROSCOPE)?;
        self.block_accelerometer.check(BLOCK_ACCELEROMETER)?;
        self.ground_accelerometer.check(GROUND_ACCELEROMETER)?;
        duration("encoder.stale_time", self.encoder.stale_time, 10.0)?;
        let scale = self.encoder.counts_per_radian;
        require("encoder.counts_per_radian", scale.into(), scale.abs() <= 1e12, "from -1e12 to 1e12")?;
        require("encoder.travel", self.encoder.travel.into(), self.encoder.travel >= 0, "at least 0")?;
        duration("contradiction_time", self.contradiction_time, 1.0)?;
        duration("slow_contradiction_time", self.slow_contradiction_time, 1.0)?;
        let (fast, slow) = (self.contradiction_time, self.slow_contradiction_time);
        require("contradiction_time", fast.into(), ticks(fast, period) >= FEWEST_WINDOW_TICKS, "at least eight ticks")?;
        require("slow_contradiction_time", slow.into(), slow >= fast, "at least contradiction_time")?;
        duration("rest_contradiction_time", self.rest_contradiction_time, 10.0)?;
        positive("rest_tolerance", self.rest_tolerance)?;
        require("count_tolerance", self.count_tolerance.into(), self.count_tolerance >= 1.0, "at least 1")?;
        require("rate_tolerance", self.rate_tolerance.into(), self.rate_tolerance >= 0.0, "at least 0")?;
        require("lever_tolerance", self.lever_tolerance.into(), (0.0..=0.9).contains(&self.lever_tolerance), "from 0 to 0.9")?;
        require("sensor_delay", self.sensor_delay.into(), (0.0..=1.0).contains(&self.sensor_delay), "from 0 s to 1 s")?;
        positive("moving_rate", self.moving_rate)?;
        positive("gravity", self.gravity)?;
        Ok(())
    }

    /// The monitor of a controller with a tick every `period` s, above 0; a gyroscope that has not been calibrated may be off by
    /// `gyroscope_bias` rad/s.
    pub(in crate::control) fn resolve(&self, period: f32, gyroscope_bias: f32) -> Monitor {
        // While nothing is known of its bias, it may be anything that a calibration would accept.
        let rate_tolerances = [self.rate_tolerance + gyroscope_bias, self.rate_tolerance];
        let slots = [self.contradiction_time, self.slow_contradiction_time].map(|time| ticks(time / SLOTS as f32, period).max(1));
        Monitor {
            gyroscope: self.gyroscope.resolve(period),
            accelerometers: [self.block_accelerometer.resolve(period), self.ground_accelerometer.resolve(period)],
            encoder_stale: ticks(self.encoder.stale_time, period).max(1),
            travel: if self.encoder.travel == 0 { u32::MAX } else { self.encoder.travel.unsigned_abs() },
            agreement: AgreementLimits {
                period,
                slots,
                counts: self.count_tolerance,
                share: self.lever_tolerance,
                delay: self.sensor_delay,
            },
            counts_per_radian: self.encoder.counts_per_radian,
            quiet_ticks: slots[0].saturating_mul(SLOTS),
            rest_ticks: ticks(self.rest_contradiction_time, period),
            rest_tolerance: self.rest_tolerance,
            rate_tolerances,
            moving_rate: self.moving_rate,
            gravity: self.gravity,
        }
    }
}

/// The fields of a sensor's limits, by their full names.
type Names = [&'static str; 5];

const GYROSCOPE: Names = [
    "gyroscope.stale_time",
    "gyroscope.stuck_time",
    "gyroscope.stuck_time_moving",
    "gyroscope.full_scale",
    "gyroscope.saturation_time",
];
const BLOCK_ACCELEROMETER: Names = [
    "block_accelerometer.stale_time",
    "block_accelerometer.stuck_time",
    "block_accelerometer.stuck_time_moving",
    "block_accelerometer.full_scale",
    "block_accelerometer.saturation_time",
];
const GROUND_ACCELEROMETER: Names = [
    "ground_accelerometer.stale_time",
    "ground_accelerometer.stuck_time",
    "ground_accelerometer.stuck_time_moving",
    "ground_accelerometer.full_scale",
    "ground_accelerometer.saturation_time",
];

impl SensorLimits {
    fn check(&self, [stale, stuck, stuck_moving, full_scale, saturation]: Names) -> Result<(), ParameterError> {
        duration(stale, self.stale_time, 10.0)?;
        for (name, time) in [(stuck, self.stuck_time), (stuck_moving, self.stuck_time_moving), (saturation, self.saturation_time)]
        {
            require(name, time.into(), (0.0..=10.0).contains(&time), "from 0 s to 10 s")?;
        }
        positive(full_scale, self.full_scale)?;
        Ok(())
    }

    fn resolve(&self, period: f32) -> WatchLimits {
        WatchLimits {
            stale: ticks(self.stale_time, period).max(1),
            stuck: ticks_or_never(self.stuck_time, period),
            stuck_moving: ticks_or_never(self.stuck_time_moving, period),
            full_scale: self.full_scale,
            saturation: ticks(self.saturation_time, period),
        }
    }
}

fn positive(name: &'static str, value: f32) -> Result<f64, ParameterError> {
    require(name, value.into(), value > 0.0, "above 0")
}

/// A time above 0 and up to `most`, 1 s, 10 s or 3600 s.
pub(in crate::control) fn duration(name: &'static str, value: f32, most: f32) -> Result<f64, ParameterError> {
    let range = match most {
        1.0 => "above 0 s, up to 1 s",
        10.0 => "above 0 s, up to 10 s",
        _ => "above 0 s, up to 3600 s",
    };
    require(name, value.into(), value > 0.0 && value <= most, range)
}
