//! The class of sensors that a controller of the clutches needs, and the parts among those that Sprag knows that have it.

use std::f64::consts::{PI, SQRT_2};

use serde::Serialize;
use sprag_shared::structure::block::GRAVITY;
use sprag_sim::sensor::preset::{DEGREE, SUITES};
use sprag_sim::sensor::{Inertial, Suite};

use super::standard::{ACCELEROMETER_RANGES_G, GYROSCOPE_RANGES_DEG_S, smallest};

/// Share of the delay allowed that sensors may take: the rest is the clutch's and the controller's.
pub const SHARE: f64 = 0.2;

/// What sensors have to be. Ranges are null where no usual one is enough, times where sensors were in the runs, or no delay is allowed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SensorClass {
    /// Full scale of the gyroscope, degrees per second.
    pub gyroscope_range_deg_s: Option<f64>,
    /// Full scale of the accelerometers on block and ground, g.
    pub accelerometer_range_g: Option<f64>,
    /// Delay that filter, sampling and reading may take together, s.
    pub delay_s: Option<f64>,
    /// −3 dB corner of a Butterworth filter of second order that takes half of that, √2/(2π f) at low frequency, Hz.
    pub bandwidth_hz: Option<f64>,
    /// Rate of samples whose period is half of it, Hz.
    pub rate_hz: Option<f64>,
    /// Suites of sensors that suffice, as `controller.sensors.suite` names them.
    pub suites: Vec<&'static str>,
}

/// For a rotation rate of `rate_rad_s` and an acceleration of `acceleration_m_s2`, margins included, and clutches that may be later by
/// `allowed_s`, of which sensors get their share; without it any sensors are quick enough.
pub fn sensor_class(rate_rad_s: f64, acceleration_m_s2: f64, allowed_s: Option<f64>) -> SensorClass {
    let delay_s = allowed_s.map(|allowed| SHARE * allowed);
    let half = delay_s.map(|delay| 0.5 * delay).filter(|half| *half > 0.0);
    let suffices = |suite: &Suite| {
        let reaches = |sensor: &Inertial, least: f64| sensor.full_scale == 0.0 || sensor.full_scale >= least;
        let parts = [&suite.gyroscope, &suite.block_accelerometer, &suite.ground_accelerometer];
        reaches(&suite.gyroscope, rate_rad_s)
            && parts[1..].iter().all(|sensor| reaches(sensor, acceleration_m_s2))
            && parts.iter().all(|sensor| delay_s.is_none_or(|delay| delay_of(sensor) <= delay))
    };
    let real = SUITES.iter().filter(|preset| preset.name != "ideal");
    SensorClass {
        gyroscope_range_deg_s: smallest(&GYROSCOPE_RANGES_DEG_S, rate_rad_s / DEGREE),
        accelerometer_range_g: smallest(&ACCELEROMETER_RANGES_G, acceleration_m_s2 / GRAVITY),
        delay_s,
        bandwidth_hz: half.map(|half| SQRT_2 / (2.0 * PI) / half),
        rate_hz: half.map(|half| 1.0 / half),
        suites: real.filter(|preset| suffices(&preset.part)).map(|preset| preset.name).collect(),
    }
}

/// From a motion to its reading at the latest, s: the filter's delay at low frequency, a period and the latency.
fn delay_of(sensor: &Inertial) -> f64 {
    let filter = if sensor.bandwidth > 0.0 { SQRT_2 / (2.0 * PI * sensor.bandwidth) } else { 0.0 };
    let period = if sensor.sampling.rate > 0.0 { 1.0 / sensor.sampling.rate } else { 0.0 };
    filter + period + sensor.sampling.latency
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_and_rates_are_the_next_that_are_enough() {
        let class = sensor_class(130.0 * DEGREE, 2.1 * GRAVITY, Some(0.01));
        assert_eq!((class.gyroscope_range_deg_s, class.accelerometer_range_g), (Some(250.0), Some(4.0)));
        // 2 ms: 1 ms of a filter is 225 Hz, 1 ms a period of 1 kHz.
        assert!((class.bandwidth_hz.unwrap() - 225.08).abs() < 0.01 && (class.rate_hz.unwrap() - 1000.0).abs() < 1e-9);
        // ADIS16470: 0.41 + 0.5 + 0.2 ms. MPU-6050: 2.3 + 1 + 0.9 ms.
        assert!(class.suites.contains(&"adis16470") && !class.suites.contains(&"mpu-6050"), "{:?}", class.suites);
    }

    #[test]
    fn sensors_that_are_too_small_or_too_slow_do_not_suffice() {
        assert_eq!(sensor_class(0.1, 10.0, Some(0.0005)).suites, [""; 0]);
        assert_eq!(sensor_class(0.1, 10.0, Some(0.0)).bandwidth_hz, None);
        // 10 g: the ICM-42688-P is set to 8 g here, the BMI088 to 12 g.
        assert_eq!(sensor_class(0.1, 10.0 * GRAVITY, Some(0.02)).suites, ["bmi088", "adis16470"]);
        // However slow, where sensors were in the runs.
        assert!(sensor_class(0.1, 10.0, None).suites.contains(&"mpu-6050"));
        let beyond = sensor_class(2001.0 * DEGREE, 17.0 * GRAVITY, Some(0.02));
        assert_eq!((beyond.gyroscope_range_deg_s, beyond.accelerometer_range_g, beyond.suites.len()), (None, None, 0));
    }
}
