//! Tables of gyroscopes and accelerometers.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_with::skip_serializing_none;
use sprag_shared::structure::block::GRAVITY;

use super::super::error::SceneError;
use super::super::schema::KeyOf;
use super::Change;
use super::sampling::{SamplingKeys, change_sampling};
use crate::sensor::Inertial;
use crate::sensor::preset::{self, DEGREE, MILLI_G, Preset};

/// `gyroscope`: a preset and what differs from it. Bias, scale error and misalignment are standard deviations over specimens.
#[skip_serializing_none]
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GyroscopeTable {
    /// Gyroscope that the other keys change; the suite's without the key.
    #[schemars(example = &"icm-42688-p", extend("enum" = preset::names(preset::GYROSCOPES).collect::<Vec<_>>()))]
    pub preset: Option<String>,
    /// Noise density, one-sided.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub noise_density_deg_s_rthz: Option<f64>,
    /// Bias at turn-on, standard deviation over specimens.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub bias_deg_s: Option<f64>,
    /// Bias instability as a Gauss-Markov process.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub drift_deg_s: Option<f64>,
    /// Correlation time of the bias instability.
    #[schemars(range(min = 1e-3, max = 1e6))]
    pub drift_correlation_time_s: Option<f64>,
    /// Random walk of the bias.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub random_walk_deg_s_rts: Option<f64>,
    /// Scale error as a fraction, standard deviation over specimens.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub scale_error_ratio: Option<f64>,
    /// Misalignment of an axis, standard deviation over specimens.
    #[schemars(range(min = 0.0, max = 45.0))]
    pub misalignment_deg: Option<f64>,
    /// −3 dB corner; 0 (none), or from 0.1.
    #[schemars(range(min = 0.0, max = 1e5), example = 500.0)]
    pub bandwidth_hz: Option<f64>,
    /// Reading per count.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub resolution_deg_s: Option<f64>,
    /// Full scale either way; 0 (no limit).
    #[schemars(range(min = 0.0, max = 1e5))]
    pub full_scale_deg_s: Option<f64>,
    /// How often it is read; 0 (continuously), or from 5.
    #[schemars(range(min = 0.0, max = 1e5), example = 2000.0)]
    pub rate_hz: Option<f64>,
    /// Whether it is read at whole periods instead of on a clock of its own.
    pub synchronous: Option<bool>,
    /// Jitter of the instant at which it is read; up to a tenth of the period.
    #[schemars(range(min = 0.0, max = 0.1))]
    pub jitter_s: Option<f64>,
    /// Time until a reading is known; up to 32 periods, or substeps of a tick where it is read continuously.
    #[schemars(range(min = 0.0, max = 0.1), example = 0.001)]
    pub latency_s: Option<f64>,
}

/// `block_accelerometer` and `ground_accelerometer`, as [`GyroscopeTable`].
#[skip_serializing_none]
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct AccelerometerTable {
    /// Accelerometer that the other keys change; the suite's without the key.
    #[schemars(example = &"icm-42688-p", extend("enum" = preset::names(preset::ACCELEROMETERS).collect::<Vec<_>>()))]
    pub preset: Option<String>,
    /// Noise density, one-sided.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub noise_density_ug_rthz: Option<f64>,
    /// Bias at turn-on, standard deviation over specimens.
    #[schemars(range(min = 0.0, max = 1e3))]
    pub bias_mg: Option<f64>,
    /// Bias instability as a Gauss-Markov process.
    #[schemars(range(min = 0.0, max = 1e3))]
    pub drift_mg: Option<f64>,
    /// Correlation time of the bias instability.
    #[schemars(range(min = 1e-3, max = 1e6))]
    pub drift_correlation_time_s: Option<f64>,
    /// Random walk of the bias.
    #[schemars(range(min = 0.0, max = 1e3))]
    pub random_walk_mg_rts: Option<f64>,
    /// Scale error as a fraction, standard deviation over specimens.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub scale_error_ratio: Option<f64>,
    /// Misalignment of an axis, standard deviation over specimens.
    #[schemars(range(min = 0.0, max = 45.0))]
    pub misalignment_deg: Option<f64>,
    /// −3 dB corner; 0 (none), or from 0.1.
    #[schemars(range(min = 0.0, max = 1e5), example = 500.0)]
    pub bandwidth_hz: Option<f64>,
    /// Reading per count.
    #[schemars(range(min = 0.0, max = 1e3))]
    pub resolution_mg: Option<f64>,
    /// Full scale either way; 0 (no limit).
    #[schemars(range(min = 0.0, max = 1e4))]
    pub full_scale_g: Option<f64>,
    /// How often it is read; 0 (continuously), or from 1.
    #[schemars(range(min = 0.0, max = 1e5))]
    pub rate_hz: Option<f64>,
    /// Whether it is read at whole periods instead of on a clock of its own.
    pub synchronous: Option<bool>,
    /// Jitter of the instant at which it is read; up to a tenth of the period.
    #[schemars(range(min = 0.0, max = 0.1))]
    pub jitter_s: Option<f64>,
    /// Time until a reading is known; up to 32 periods, or substeps of a tick where it is read continuously.
    #[schemars(range(min = 0.0, max = 0.1), example = 0.001)]
    pub latency_s: Option<f64>,
}

/// A number of a table: its key, its value, its unit in SI, where it goes.
type Number = (&'static str, Option<f64>, f64, fn(&mut Inertial) -> &mut f64);

/// What both kinds of inertial sensor have in common, once units are known.
fn change_inertial(
    mut sensor: Inertial,
    numbers: &[Number],
    sampling: &SamplingKeys,
    place: &str,
    key: &KeyOf<'_>,
) -> Result<Inertial, SceneError> {
    for &(name, value, unit, field) in numbers {
        if let Some(value) = value {
            let allowed = name != "bandwidth_hz" || value == 0.0 || value >= 0.1;
            let value = key(&format!("{place}.{name}")).require(value, allowed, "0 (none), or from 0.1 to 100000")?;
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

impl Change for GyroscopeTable {
    type Part = Inertial;
    const PRESETS: &'static [Preset<Inertial>] = preset::GYROSCOPES;

    fn preset(&self) -> Option<&str> {
        self.preset.as_deref()
    }

    fn change(&self, start: Inertial, place: &str, key: &KeyOf<'_>) -> Result<Inertial, SceneError> {
        let numbers: [Number; 10] = [
            ("noise_density_deg_s_rthz", self.noise_density_deg_s_rthz, DEGREE, |s| &mut s.noise_density),
            ("bias_deg_s", self.bias_deg_s, DEGREE, |s| &mut s.bias),
            ("drift_deg_s", self.drift_deg_s, DEGREE, |s| &mut s.drift.deviation),
            correlation_time(self.drift_correlation_time_s),
            ("random_walk_deg_s_rts", self.random_walk_deg_s_rts, DEGREE, |s| &mut s.drift.random_walk),
            scale_error(self.scale_error_ratio),
            misalignment(self.misalignment_deg),
            bandwidth(self.bandwidth_hz),
            ("resolution_deg_s", self.resolution_deg_s, DEGREE, |s| &mut s.resolution),
            ("full_scale_deg_s", self.full_scale_deg_s, DEGREE, |s| &mut s.full_scale),
        ];
        let &GyroscopeTable { rate_hz, synchronous, jitter_s, latency_s, .. } = self;
        change_inertial(start, &numbers, &SamplingKeys { rate_hz, synchronous, jitter_s, latency_s }, place, key)
    }
}

impl Change for AccelerometerTable {
    type Part = Inertial;
    const PRESETS: &'static [Preset<Inertial>] = preset::ACCELEROMETERS;

    fn preset(&self) -> Option<&str> {
        self.preset.as_deref()
    }

    fn change(&self, start: Inertial, place: &str, key: &KeyOf<'_>) -> Result<Inertial, SceneError> {
        let micro_g = 1e-3 * MILLI_G;
        let numbers: [Number; 10] = [
            ("noise_density_ug_rthz", self.noise_density_ug_rthz, micro_g, |s| &mut s.noise_density),
            ("bias_mg", self.bias_mg, MILLI_G, |s| &mut s.bias),
            ("drift_mg", self.drift_mg, MILLI_G, |s| &mut s.drift.deviation),
            correlation_time(self.drift_correlation_time_s),
            ("random_walk_mg_rts", self.random_walk_mg_rts, MILLI_G, |s| &mut s.drift.random_walk),
            scale_error(self.scale_error_ratio),
            misalignment(self.misalignment_deg),
            bandwidth(self.bandwidth_hz),
            ("resolution_mg", self.resolution_mg, MILLI_G, |s| &mut s.resolution),
            ("full_scale_g", self.full_scale_g, GRAVITY, |s| &mut s.full_scale),
        ];
        let &AccelerometerTable { rate_hz, synchronous, jitter_s, latency_s, .. } = self;
        change_inertial(start, &numbers, &SamplingKeys { rate_hz, synchronous, jitter_s, latency_s }, place, key)
    }
}

fn correlation_time(value: Option<f64>) -> Number {
    ("drift_correlation_time_s", value, 1.0, |s| &mut s.drift.correlation_time)
}

fn scale_error(value: Option<f64>) -> Number {
    ("scale_error_ratio", value, 1.0, |s| &mut s.scale_error)
}

fn misalignment(value: Option<f64>) -> Number {
    ("misalignment_deg", value, DEGREE, |s| &mut s.misalignment)
}

fn bandwidth(value: Option<f64>) -> Number {
    ("bandwidth_hz", value, 1.0, |s| &mut s.bandwidth)
}
