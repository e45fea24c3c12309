//! Tables of gyroscopes and accelerometers.

use serde::{Deserialize, Serialize};
use sprag_shared::structure::block::GRAVITY;

use super::super::error::SceneError;
use super::super::schema::KeyOf;
use super::Change;
use super::sampling::{SamplingKeys, change_sampling};
use crate::sensor::Inertial;
use crate::sensor::preset::{DEGREE, MILLI_G};

/// `gyroscope`: a preset and what differs from it. Bias, scale error and misalignment are standard deviations over specimens.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct GyroscopeTable {
    /// What the other keys change: the suite's gyroscope if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub preset: Option<String>,
    /// One-sided, °/s/√Hz; up to 10.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub noise_density_deg_s_rthz: Option<f64>,
    /// At turn-on, °/s; up to 100.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bias_deg_s: Option<f64>,
    /// Bias instability as a Gauss-Markov process, °/s; up to 100.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drift_deg_s: Option<f64>,
    /// Of the bias instability, s; 0.001 to 1e6.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drift_correlation_time_s: Option<f64>,
    /// Rate random walk, °/s/√s; up to 10.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub random_walk_deg_s_rts: Option<f64>,
    /// Fraction; up to 0.5.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale_error_ratio: Option<f64>,
    /// Degrees; up to 45.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub misalignment_deg: Option<f64>,
    /// −3 dB corner, Hz; 0 (none), or 0.1 to 100,000.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bandwidth_hz: Option<f64>,
    /// Per count, °/s; up to 100.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub resolution_deg_s: Option<f64>,
    /// Either way, °/s; 0 (no limit) up to 100,000.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub full_scale_deg_s: Option<f64>,
    /// Output data rate, Hz; 0 (continuous), or 1 to 100,000.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rate_hz: Option<f64>,
    /// Samples at whole periods instead of on a clock of its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub synchronous: Option<bool>,
    /// Of the instant of sampling, s; up to a tenth of the period.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub jitter_s: Option<f64>,
    /// From sampling to reading, s; up to 0.1, and to 32 periods.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub latency_s: Option<f64>,
}

/// `block_accelerometer` and `ground_accelerometer`, as [`GyroscopeTable`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AccelerometerTable {
    /// What the other keys change: the suite's accelerometer if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub preset: Option<String>,
    /// One-sided, µg/√Hz; up to 1e6.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub noise_density_ug_rthz: Option<f64>,
    /// At turn-on, mg; up to 1000.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bias_mg: Option<f64>,
    /// Bias instability as a Gauss-Markov process, mg; up to 1000.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drift_mg: Option<f64>,
    /// Of the bias instability, s; 0.001 to 1e6.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drift_correlation_time_s: Option<f64>,
    /// Acceleration random walk, mg/√s; up to 1000.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub random_walk_mg_rts: Option<f64>,
    /// Fraction; up to 0.5.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale_error_ratio: Option<f64>,
    /// Of each axis, degrees; up to 45.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub misalignment_deg: Option<f64>,
    /// −3 dB corner, Hz; 0 (none), or 0.1 to 100,000.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bandwidth_hz: Option<f64>,
    /// Per count, mg; up to 1000.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub resolution_mg: Option<f64>,
    /// Either way, g; 0 (no limit) up to 10,000.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub full_scale_g: Option<f64>,
    /// Output data rate, Hz; 0 (continuous), or 1 to 100,000.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rate_hz: Option<f64>,
    /// Samples at whole periods instead of on a clock of its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub synchronous: Option<bool>,
    /// Of the instant of sampling, s; up to a tenth of the period.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub jitter_s: Option<f64>,
    /// From sampling to reading, s; up to 0.1, and to 32 periods.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub latency_s: Option<f64>,
}

/// A number of a table: its key, its value, its unit in SI, the largest allowed and the range in words, where it goes.
type Number = (&'static str, Option<f64>, f64, f64, &'static str, fn(&mut Inertial) -> &mut f64);

/// What both kinds of inertial sensor have in common, once units are known.
fn change_inertial(
    mut sensor: Inertial,
    numbers: &[Number],
    sampling: &SamplingKeys,
    place: &str,
    key: &KeyOf<'_>,
) -> Result<Inertial, SceneError> {
    for &(name, value, unit, highest, range, field) in numbers {
        if let Some(value) = value {
            // A correlation time or a bandwidth cannot be as small as one likes.
            let lowest = match name {
                "drift_correlation_time_s" => 1e-3,
                "bandwidth_hz" if value != 0.0 => 0.1,
                _ => 0.0,
            };
            let value = key(&format!("{place}.{name}")).require(value, (lowest..=highest).contains(&value), range)?;
            *field(&mut sensor) = value * unit;
        }
    }
    sensor.sampling = change_sampling(sensor.sampling, sampling, place, key)?;
    let named = |start: &str| numbers.iter().map(|number| number.0).find(|name| name.starts_with(start)).unwrap_or_default();
    if sensor.noise_density > 0.0 && sensor.bandwidth == 0.0 && sensor.sampling.rate == 0.0 {
        let reason = "white noise needs a band: give bandwidth_hz or rate_hz";
        return Err(key(&format!("{place}.{}", named("noise"))).conflict(reason));
    }
    if sensor.drift.deviation > 0.0 && sensor.drift.correlation_time == 0.0 {
        let needed = format!("the correlation time of {}", named("drift"));
        return Err(key(&format!("{place}.drift_correlation_time_s")).missing(&needed));
    }
    if sensor.full_scale > 0.0 && sensor.resolution > sensor.full_scale {
        return Err(key(&format!("{place}.{}", named("resolution"))).conflict("one step is more than the full scale"));
    }
    Ok(sensor)
}

impl Change<Inertial> for GyroscopeTable {
    fn preset(&self) -> Option<&str> {
        self.preset.as_deref()
    }

    fn change(&self, start: Inertial, place: &str, key: &KeyOf<'_>) -> Result<Inertial, SceneError> {
        let numbers: [Number; 10] = [
            ("noise_density_deg_s_rthz", self.noise_density_deg_s_rthz, DEGREE, 10.0, "from 0 to 10", |s| &mut s.noise_density),
            ("bias_deg_s", self.bias_deg_s, DEGREE, 100.0, "from 0 to 100", |s| &mut s.bias),
            ("drift_deg_s", self.drift_deg_s, DEGREE, 100.0, "from 0 to 100", |s| &mut s.drift.deviation),
            correlation_time(self.drift_correlation_time_s),
            ("random_walk_deg_s_rts", self.random_walk_deg_s_rts, DEGREE, 10.0, "from 0 to 10", |s| &mut s.drift.random_walk),
            scale_error(self.scale_error_ratio),
            misalignment(self.misalignment_deg),
            bandwidth(self.bandwidth_hz),
            ("resolution_deg_s", self.resolution_deg_s, DEGREE, 100.0, "from 0 to 100", |s| &mut s.resolution),
            ("full_scale_deg_s", self.full_scale_deg_s, DEGREE, 1e5, "0 (no limit) to 100000", |s| &mut s.full_scale),
        ];
        let &GyroscopeTable { rate_hz, synchronous, jitter_s, latency_s, .. } = self;
        change_inertial(start, &numbers, &SamplingKeys { rate_hz, synchronous, jitter_s, latency_s }, place, key)
    }
}

impl Change<Inertial> for AccelerometerTable {
    fn preset(&self) -> Option<&str> {
        self.preset.as_deref()
    }

    fn change(&self, start: Inertial, place: &str, key: &KeyOf<'_>) -> Result<Inertial, SceneError> {
        let micro_g = 1e-3 * MILLI_G;
        let numbers: [Number; 10] = [
            ("noise_density_ug_rthz", self.noise_density_ug_rthz, micro_g, 1e6, "from 0 to 1000000", |s| &mut s.noise_density),
            ("bias_mg", self.bias_mg, MILLI_G, 1e3, "from 0 to 1000", |s| &mut s.bias),
            ("drift_mg", self.drift_mg, MILLI_G, 1e3, "from 0 to 1000", |s| &mut s.drift.deviation),
            correlation_time(self.drift_correlation_time_s),
            ("random_walk_mg_rts", self.random_walk_mg_rts, MILLI_G, 1e3, "from 0 to 1000", |s| &mut s.drift.random_walk),
            scale_error(self.scale_error_ratio),
            misalignment(self.misalignment_deg),
            bandwidth(self.bandwidth_hz),
            ("resolution_mg", self.resolution_mg, MILLI_G, 1e3, "from 0 to 1000", |s| &mut s.resolution),
            ("full_scale_g", self.full_scale_g, GRAVITY, 1e4, "0 (no limit) to 10000", |s| &mut s.full_scale),
        ];
        let &AccelerometerTable { rate_hz, synchronous, jitter_s, latency_s, .. } = self;
        change_inertial(start, &numbers, &SamplingKeys { rate_hz, synchronous, jitter_s, latency_s }, place, key)
    }
}

fn correlation_time(value: Option<f64>) -> Number {
    ("drift_correlation_time_s", value, 1.0, 1e6, "from 0.001 to 1000000", |s| &mut s.drift.correlation_time)
}

fn scale_error(value: Option<f64>) -> Number {
    ("scale_error_ratio", value, 1.0, 0.5, "from 0 to 0.5", |s| &mut s.scale_error)
}

fn misalignment(value: Option<f64>) -> Number {
    ("misalignment_deg", value, DEGREE, 45.0, "from 0 to 45", |s| &mut s.misalignment)
}

fn bandwidth(value: Option<f64>) -> Number {
    ("bandwidth_hz", value, 1.0, 1e5, "0 (none), or from 0.1 to 100000", |s| &mut s.bandwidth)
}
