//! Keys of sampling.

use super::super::error::SceneError;
use super::super::schema::KeyOf;
use crate::sensor::{MOST_UNDER_WAY, Sampling};

/// Keys of sampling, the same for every sensor.
pub(super) struct SamplingKeys {
    pub(super) rate_hz: Option<f64>,
    pub(super) synchronous: Option<bool>,
    pub(super) jitter_s: Option<f64>,
    pub(super) latency_s: Option<f64>,
}

/// `start` with `keys`, those of the table at `place`.
///
/// # Errors
/// [`SceneError`] names the key.
pub(super) fn change_sampling(
    start: Sampling,
    keys: &SamplingKeys,
    place: &str,
    key: &KeyOf<'_>,
) -> Result<Sampling, SceneError> {
    let key = |name: &str| key(&format!("{place}.{name}"));
    let mut sampling = start;
    if let Some(rate) = keys.rate_hz {
        sampling.rate = key("rate_hz").require(rate, rate == 0.0 || rate >= 1.0, "0 (continuous), or from 1 to 100000")?;
        if rate == 0.0 && keys.jitter_s.is_none() {
            sampling.jitter = 0.0;
        }
    }
    sampling.synchronous = keys.synchronous.unwrap_or(sampling.synchronous);
    sampling.jitter = keys.jitter_s.unwrap_or(sampling.jitter);
    sampling.latency = keys.latency_s.unwrap_or(sampling.latency);
    if sampling.jitter > 0.0 && sampling.rate == 0.0 {
        return Err(key("jitter_s").conflict("a sensor that is read continuously has no instants to move: give rate_hz"));
    }
    if sampling.jitter * sampling.rate > 0.1 * (1.0 + 1e-12) {
        return Err(
            key("jitter_s").range(sampling.jitter, &format!("from 0 to a tenth of the period, {} s", 0.1 / sampling.rate))
        );
    }
    let most = MOST_UNDER_WAY as f64;
    if sampling.latency * sampling.rate > most {
        let range = format!("at most {most} periods, {} s", most / sampling.rate);
        return Err(key("latency_s").range(sampling.latency, &range));
    }
    Ok(sampling)
}
