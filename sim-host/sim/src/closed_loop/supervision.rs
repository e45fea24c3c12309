//! From data sheets to what the supervisor allows the sensors.

use sprag_shared::control::monitor::fault::Wheel;
use sprag_shared::control::monitor::{EncoderLimits, MonitorParameters, SensorLimits, stuck_time};
use sprag_shared::control::sensing::calibration::Plausible;
use sprag_shared::control::supervisor::{Parameters, SafeState};
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::GRAVITY;

use super::design::{SensorDesign, delay};
use crate::scene::controller::{ControllerTable, SafeStateName};
use crate::sensor::noise::output_deviation;
use crate::sensor::{Inertial, Suite};

/// Noise peaks over its standard deviation, once in some 1e9 readings.
const PEAK: f64 = 6.0;

/// Readings missed before a sensor is stale, the next one due.
const MISSED: f64 = 3.0;

/// Supervision of sensors and clutches; `actuation` (s) is the time from a command to a clutch that has moved.
pub fn supervision(
    structure: &Structure,
    suite: &Suite,
    design: &SensorDesign,
    table: &ControllerTable,
    actuation: f64,
) -> Parameters {
    let Suite { gyroscope, block_accelerometer, ground_accelerometer, encoder } = suite;
    let defaults = Parameters::default();
    let monitor = MonitorParameters::default();
    let period = 1.0 / table.rate_hz;
    let noise = |sensor: &Inertial| {
        let rate = if sensor.sampling.rate > 0.0 { sensor.sampling.rate } else { table.rate_hz };
        output_deviation(sensor.noise_density, sensor.bandwidth, rate)
    };
    let limits = |sensor: &Inertial, default: SensorLimits| {
        let between = if sensor.sampling.rate > 0.0 { (1.0 / sensor.sampling.rate).max(period) } else { period };
        let stuck =
            if sensor.resolution > 0.0 { stuck_time((noise(sensor) / sensor.resolution) as f32, between as f32) } else { 0.0 };
        SensorLimits {
            stale_time: f64::from(default.stale_time).max(MISSED * between + sensor.sampling.latency) as f32,
            stuck_time: stuck,
            // Where noise does not move a reading by a step, equal readings say nothing.
            stuck_time_moving: if sensor.resolution > 0.0 { stuck } else { default.stuck_time_moving },
            full_scale: if sensor.full_scale > 0.0 { (0.98 * sensor.full_scale) as f32 } else { 1e6 },
            saturation_time: f64::from(default.saturation_time).max(1.5 * table.shock_s + 2.0 * period) as f32,
        }
    };
    // The rack's travel per radian varies with θ; the mean over ±α serves.
    let block = &structure.block;
    let lever = structure.device.mount.lever_at(block, structure.geometry, 0.5 * block.slenderness()).unwrap_or(0.0);
    let counts = lever * block.size() / encoder.resolution;
    let larger = |default: f32, value: f64| f64::from(default).max(value) as f32;
    let gyroscope_delay = delay(gyroscope.bandwidth, &gyroscope.sampling);
    Parameters {
        period: period as f32,
        monitor: MonitorParameters {
            gyroscope: limits(gyroscope, monitor.gyroscope),
            block_accelerometer: limits(block_accelerometer, monitor.block_accelerometer),
            ground_accelerometer: SensorLimits {
                stuck_time_moving: limits(ground_accelerometer, monitor.ground_accelerometer).stuck_time,
                ..limits(ground_accelerometer, monitor.ground_accelerometer)
            },
            encoder: EncoderLimits {
                stale_time: larger(monitor.encoder.stale_time, MISSED * period),
                counts_per_radian: if counts <= 1e9 { counts as f32 } else { 0.0 },
                travel: 0,
            },
            contradiction_time: larger(monitor.contradiction_time, 8.0 * period),
            slow_contradiction_time: larger(monitor.slow_contradiction_time, 64.0 * period),
            rest_tolerance: larger(monitor.rest_tolerance, PEAK * noise(block_accelerometer).max(noise(ground_accelerometer))),
            rate_tolerance: larger(monitor.rate_tolerance, PEAK * noise(gyroscope)),
            sensor_delay: larger(monitor.sensor_delay, 2.0 * gyroscope_delay + 2.0 * period),
            moving_rate: larger(monitor.moving_rate, PEAK * noise(gyroscope)),
            gravity: GRAVITY as f32,
            ..monitor
        },
        required: design.estimator.required(),
        safe_state: match table.safe_state {
            SafeStateName::Released => SafeState::Released,
            SafeStateName::Engaged => SafeState::Engaged(Wheel::First),
        },
        both_allowed: false,
        feedback_time: larger(defaults.feedback_time, 2.0 * period),
        actuator_time: larger(defaults.actuator_time, 2.0 * actuation + 4.0 * period),
        plausible: Plausible {
            gyroscope: larger(defaults.plausible.gyroscope, 5.0 * gyroscope.bias),
            accelerometer: larger(
                defaults.plausible.accelerometer,
                5.0 * block_accelerometer.bias.max(ground_accelerometer.bias)
                    + 5.0 * GRAVITY * block_accelerometer.misalignment.max(ground_accelerometer.misalignment),
            ),
        },
        shaking: larger(defaults.shaking, PEAK * noise(ground_accelerometer)),
        moving_counts: (10e-6 / encoder.resolution).clamp(2.0, 1e6) as i32,
        ..defaults
    }
}
