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
use crate::sensor::{Inertial, Sampling, Suite};

/// Noise peaks over its standard deviation, once in some 1e9 readings.
const PEAK: f64 = 6.0;

/// Readings missed before a sensor is stale, the next one due.
const MISSED: f64 = 3.0;

/// Time between readings that [`stuck_time`] counts as independent behind a low-pass, over 1/bandwidth. One follows the other with a
/// correlation of 0.44 there; those in between are closer, but all of them have to be equal.
const INDEPENDENT: f64 = 0.25;

/// Delays of a second-order low-pass in which a shock goes through it: what comes out, e^(−t/delay) sin(t/delay), is back at zero.
const RINGING: f64 = std::f64::consts::PI;

/// Longest time for which a monitor may wait, s.
const LONGEST_WAIT: f32 = 10.0;

/// Largest allowance of a monitor for late readings, and its longest window, s.
const LATEST: f64 = 1.0;

/// Time between readings of `sensor` that its noise makes independent, s; new ones are `between` (s) apart.
fn independent(sensor: &Inertial, between: f64) -> f64 {
    if sensor.bandwidth > 0.0 { between.max(INDEPENDENT / sensor.bandwidth) } else { between }
}

/// Time between new readings at ticks of `period` (s), s.
fn between_readings(sampling: &Sampling, period: f64) -> f64 {
    if sampling.rate > 0.0 { (1.0 / sampling.rate).max(period) } else { period }
}

/// Without a new reading for this long a sensor misses some, s.
fn missing(sampling: &Sampling, period: f64) -> f64 {
    MISSED * between_readings(sampling, period) + sampling.latency
}

/// Time that a clutch is given to move, s, where it takes `actuation` (s) at ticks of `period` (s), …
fn actuator_time(actuation: f64, period: f64) -> f64 {
    2.0 * actuation + 4.0 * period
}

/// … where its earlier moves may keep it as it is for `held` (s) before, …
fn actuator_time_held(actuation: f64, held: f64, period: f64) -> f64 {
    let free = actuator_time(actuation, period);
    free.max((free + held).min(LONGEST_WAIT.into()))
}

/// … and the longest `actuation` for which a monitor waits, s.
pub fn longest_actuation(period: f64) -> f64 {
    0.5 * (f64::from(LONGEST_WAIT) - 4.0 * period)
}

/// Supervision of sensors and clutches; `actuation` (s) is the time from a command to a clutch that has moved, and its earlier moves may keep
/// it as it is for `held` (s) before.
pub fn supervision(
    structure: &Structure,
    suite: &Suite,
    design: &SensorDesign,
    table: &ControllerTable,
    (actuation, held): (f64, f64),
) -> Parameters {
    let Suite { gyroscope, block_accelerometer, ground_accelerometer, encoder } = suite;
    let defaults = Parameters::default();
    let monitor = MonitorParameters::default();
    let period = 1.0 / table.rate_hz;
    let noise = |sensor: &Inertial| {
        let rate = if sensor.sampling.rate > 0.0 { sensor.sampling.rate } else { table.rate_hz };
        output_deviation(sensor.noise_density, sensor.bandwidth, rate)
    };
    let larger = |default: f32, value: f64| f64::from(default).max(value) as f32;
    let shaken = 1.5 * table.shock_s + 2.0 * period;
    let limits = |sensor: &Inertial, default: SensorLimits| {
        let between = independent(sensor, between_readings(&sensor.sampling, period));
        let stuck = if sensor.resolution > 0.0 {
            stuck_time((noise(sensor) / sensor.resolution) as f32, between as f32).min(LONGEST_WAIT)
        } else {
            0.0
        };
        SensorLimits {
            stale_time: larger(default.stale_time, missing(&sensor.sampling, period)),
            stuck_time: stuck,
            // Where noise does not move a reading by a step, or there is none, equal readings say nothing: a block that has just stopped
            // counts as moving for a while, as one does whose gyroscope has a bias.
            stuck_time_moving: if sensor.resolution > 0.0 || noise(sensor) == 0.0 { stuck } else { default.stuck_time_moving },
            full_scale: if sensor.full_scale > 0.0 { (0.98 * sensor.full_scale) as f32 } else { 1e6 },
            saturation_time: larger(default.saturation_time, shaken),
        }
    };
    let block = &structure.block;
    let lever = structure.device.mount.lever_at(block, structure.geometry, 0.5 * block.slenderness()).unwrap_or(0.0);
    let counts = lever * block.size() / encoder.resolution;
    let [ringing, ..] = block_accelerometer.sampling.delays(block_accelerometer.bandwidth);
    // A reading is held for as long, whoever keeps the clock.
    let mean_age = |bandwidth: f64, sampling: &Sampling| delay(bandwidth, &Sampling { synchronous: false, ..*sampling });
    let gyroscope_delay = mean_age(gyroscope.bandwidth, &gyroscope.sampling);
    // At its oldest; 0 of one that is read at once.
    let encoder_delay = 2.0 * mean_age(0.0, &encoder.sampling);
    // At either end of a window a count may be as old as that.
    let sensor_delay = (2.0 * gyroscope_delay + 2.0 * period + 2.0 * encoder_delay).min(LATEST);
    // So long that a window has seen how fast that moved which a reading brings.
    let window = gyroscope_delay.max(between_readings(&gyroscope.sampling, period)).max(encoder_delay).min(LATEST);
    // When a block is stopped at once, at some 2pα, its last counts may come so long after the last rate, too late for `sensor_delay` to
    // allow for them. Of a slower encoder no more: that would hide one that is stuck.
    let [settling, _, gyroscope_latency] = gyroscope.sampling.delays(gyroscope.bandwidth);
    let trailing =
        (period + encoder_delay - RINGING * settling - gyroscope_latency).clamp(0.0, monitor.contradiction_time.into());
    let trailing_counts = counts * 2.0 * block.frequency_parameter() * block.slenderness() * trailing;
    let settled = |sensor: &Inertial| {
        let [ringing, _, latency] = sensor.sampling.delays(sensor.bandwidth);
        RINGING * ringing + between_readings(&sensor.sampling, period) + latency
    };
    Parameters {
        period: period as f32,
        monitor: MonitorParameters {
            gyroscope: limits(gyroscope, monitor.gyroscope),
            block_accelerometer: SensorLimits {
                saturation_time: larger(monitor.block_accelerometer.saturation_time, shaken + RINGING * ringing),
                ..limits(block_accelerometer, monitor.block_accelerometer)
            },
            ground_accelerometer: SensorLimits {
                stuck_time_moving: limits(ground_accelerometer, monitor.ground_accelerometer).stuck_time,
                ..limits(ground_accelerometer, monitor.ground_accelerometer)
            },
            encoder: EncoderLimits {
                stale_time: larger(monitor.encoder.stale_time, missing(&encoder.sampling, period)),
                counts_per_radian: counts as f32,
                travel: 0,
            },
            contradiction_time: larger(monitor.contradiction_time, window.max(8.0 * period)),
            // Several times what is allowed for late readings, or nothing would be found.
            slow_contradiction_time: larger(
                monitor.slow_contradiction_time,
                (64.0 * period).max((4.0 * sensor_delay).min(LATEST)),
            ),
            // For so long one accelerometer may show what the other does not yet, or no longer.
            rest_contradiction_time: larger(
                monitor.rest_contradiction_time,
                settled(block_accelerometer) + settled(ground_accelerometer),
            ),
            rest_tolerance: larger(monitor.rest_tolerance, PEAK * noise(block_accelerometer).max(noise(ground_accelerometer))),
            count_tolerance: (f64::from(monitor.count_tolerance) + trailing_counts) as f32,
            rate_tolerance: larger(monitor.rate_tolerance, PEAK * noise(gyroscope)),
            sensor_delay: larger(monitor.sensor_delay, sensor_delay),
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
        actuator_time: larger(defaults.actuator_time, actuator_time_held(actuation, held, period)),
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

#[cfg(test)]
mod tests;
