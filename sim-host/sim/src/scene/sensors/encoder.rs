//! The table of the encoder.

use serde::{Deserialize, Serialize};

use super::super::error::SceneError;
use super::super::schema::KeyOf;
use super::Change;
use super::sampling::{SamplingKeys, change_sampling};
use crate::sensor::{Encoder, preset};

/// `encoder`: a preset and what differs from it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct EncoderTable {
    /// What the other keys change: the suite's encoder if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub preset: Option<String>,
    /// Travel per count, m; 1e-9 to 0.01.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub resolution_m: Option<f64>,
    /// After quadrature, of an encoder on a pinion; 4 to 1e8.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub counts_per_revolution: Option<f64>,
    /// Of that pinion, m; 0.001 to 10.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pinion_radius_m: Option<f64>,
    /// That a count is missed; 0 to 0.5.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub miss_probability: Option<f64>,
    /// How often it is read, Hz; 0 (continuously), or 1 to 100,000.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rate_hz: Option<f64>,
    /// Is read at whole periods instead of on a clock of its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub synchronous: Option<bool>,
    /// Of the instant at which it is read, s; up to a tenth of the period.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub jitter_s: Option<f64>,
    /// From then until the count is known, s; up to 0.1, and to 32 periods.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub latency_s: Option<f64>,
}

impl Change<Encoder> for EncoderTable {
    fn preset(&self) -> Option<&str> {
        self.preset.as_deref()
    }

    fn change(&self, start: Encoder, place: &str, key: &KeyOf<'_>) -> Result<Encoder, SceneError> {
        let of = |name: &str| key(&format!("{place}.{name}"));
        let mut encoder = start;
        let radius = self.pinion_radius_m;
        if let Some(radius) = radius {
            of("pinion_radius_m").require(radius, (1e-3..=10.0).contains(&radius), "from 0.001 to 10")?;
        }
        if let Some(counts) = self.counts_per_revolution {
            of("counts_per_revolution").require(counts, (4.0..=1e8).contains(&counts), "from 4 to 100000000")?;
        }
        if let Some(resolution) = self.resolution_m {
            if radius.is_some() || self.counts_per_revolution.is_some() {
                let reason = "counts_per_revolution and pinion_radius_m already say it: give one or the other";
                return Err(of("resolution_m").conflict(reason));
            }
            let allowed = (1e-9..=0.01).contains(&resolution);
            encoder.resolution = of("resolution_m").require(resolution, allowed, "from 0.000000001 to 0.01")?;
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
        if let Some(probability) = self.miss_probability {
            let allowed = (0.0..=0.5).contains(&probability);
            encoder.miss_probability = of("miss_probability").require(probability, allowed, "from 0 to 0.5")?;
        }
        let &EncoderTable { rate_hz, synchronous, jitter_s, latency_s, .. } = self;
        let keys = SamplingKeys { rate_hz, synchronous, jitter_s, latency_s };
        encoder.sampling = change_sampling(encoder.sampling, &keys, place, key)?;
        Ok(encoder)
    }
}
