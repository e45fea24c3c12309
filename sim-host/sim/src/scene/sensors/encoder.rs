//! The table of the encoder.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_with::skip_serializing_none;

use super::super::error::SceneError;
use super::super::schema::KeyOf;
use super::Change;
use super::sampling::{SamplingKeys, change_sampling};
use crate::sensor::Encoder;
use crate::sensor::preset::{self, Preset};

/// `encoder`: a preset and what differs from it.
#[skip_serializing_none]
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct EncoderTable {
    /// Encoder that the other keys change; the suite's without the key.
    #[schemars(example = &"amt102-v", extend("enum" = preset::names(preset::ENCODERS).collect::<Vec<_>>()))]
    pub preset: Option<String>,
    /// Travel per count, such that 32 bits count the rack's travel at θ = 2α; or give `counts_per_revolution` and `pinion_radius_m`.
    #[schemars(range(min = 1e-9, max = 0.01))]
    pub resolution_m: Option<f64>,
    /// Counts a revolution after quadrature, of an encoder on a pinion.
    #[schemars(range(min = 4.0, max = 1e8), example = 4096.0)]
    pub counts_per_revolution: Option<f64>,
    /// Radius of that pinion.
    #[schemars(range(min = 1e-3, max = 10.0))]
    pub pinion_radius_m: Option<f64>,
    /// Probability that a count is missed.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub miss_probability: Option<f64>,
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

impl Change for EncoderTable {
    type Part = Encoder;
    const PRESETS: &'static [Preset<Encoder>] = preset::ENCODERS;

    fn preset(&self) -> Option<&str> {
        self.preset.as_deref()
    }

    fn change(&self, start: Encoder, place: &str, key: &KeyOf<'_>) -> Result<Encoder, SceneError> {
        let of = |name: &str| key(&format!("{place}.{name}"));
        let mut encoder = start;
        let radius = self.pinion_radius_m;
        if let Some(resolution) = self.resolution_m {
            if radius.is_some() || self.counts_per_revolution.is_some() {
                let reason = "counts_per_revolution and pinion_radius_m already say it: give one or the other";
                return Err(of("resolution_m").conflict(reason));
            }
            encoder.resolution = resolution;
        }
        match (self.counts_per_revolution, radius) {
            (Some(counts), Some(radius)) => encoder.resolution = Encoder::rotary_resolution(counts, radius),
            (Some(_), None) => return Err(of("pinion_radius_m").missing("the pinion that the encoder is on")),
            (None, Some(radius)) if start.resolution == preset::AMT102_V.resolution => {
                encoder.resolution *= radius / preset::PINION_RADIUS;
            }
            (None, Some(_)) => return Err(of("counts_per_revolution").missing("the encoder is not one that a pinion turns")),
            (None, None) => {}
        }
        encoder.miss_probability = self.miss_probability.unwrap_or(encoder.miss_probability);
        let &EncoderTable { rate_hz, synchronous, jitter_s, latency_s, .. } = self;
        let keys = SamplingKeys { rate_hz, synchronous, jitter_s, latency_s };
        encoder.sampling = change_sampling(encoder.sampling, &keys, place, key)?;
        Ok(encoder)
    }
}
