//! Linear resampling, only on request.

use super::error::RecordError;
use super::warning::Warning;
use super::{MAXIMUM_SAMPLES, Record, check_time_step};

/// Slack when counting whole steps, so that rounding of the times does not lose the last sample.
const COUNT_SLACK: f64 = 1e-9;

/// Values at start + i·step of the piecewise linear function through `(times_s, values)`, up to the last time.
///
/// The times must increase. What remains after the last whole step is dropped.
pub(super) fn linear(name: &str, times_s: &[f64], values: &[f64], step_s: f64) -> Result<Vec<f64>, RecordError> {
    check_time_step(name, step_s)?;
    let (Some(first), Some(last)) = (times_s.first(), times_s.last()) else { return Ok(Vec::new()) };
    let samples = ((last - first) / step_s * (1.0 + COUNT_SLACK)).floor() + 1.0;
    if samples > MAXIMUM_SAMPLES as f64 {
        return Err(RecordError::TooManySamples { file: name.to_owned(), time_step_s: step_s, samples, limit: MAXIMUM_SAMPLES });
    }
    let mut interval = 0;
    Ok((0..samples as usize)
        .map(|index| {
            let time = (first + index as f64 * step_s).min(*last);
            while interval + 2 < times_s.len() && times_s[interval + 1] <= time {
                interval += 1;
            }
            let (Some(t0), Some(t1)) = (times_s.get(interval), times_s.get(interval + 1)) else { return values[0] };
            let weight = ((time - t0) / (t1 - t0)).clamp(0.0, 1.0);
            values[interval] * (1.0 - weight) + values[interval + 1] * weight
        })
        .collect())
}

impl Record {
    /// The record at another time step, by linear interpolation between its samples.
    ///
    /// A finer step leaves the motion as it is. A coarser one drops peaks and folds high frequencies back, since
    /// nothing is filtered; [`Warning::Resampled`] is added to the warnings.
    ///
    /// # Errors
    ///
    /// [`RecordError::TimeStepRange`] and [`RecordError::TooManySamples`]; [`RecordError::TooFewSamples`] if the
    /// step is longer than the record.
    pub fn resample(&self, time_step_s: f64) -> Result<Record, RecordError> {
        let times: Vec<f64> = (0..self.acceleration_m_s2.len()).map(|index| index as f64 * self.time_step_s).collect();
        let acceleration_m_s2 = linear(&self.name, &times, &self.acceleration_m_s2, time_step_s)?;
        if acceleration_m_s2.len() < 2 {
            return Err(RecordError::TooFewSamples { file: self.name.clone(), samples: acceleration_m_s2.len() });
        }
        let mut record = Record { time_step_s, acceleration_m_s2, ..self.clone() };
        record.warnings.push(Warning::Resampled { from_s: self.time_step_s, to_s: time_step_s });
        Ok(record)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::{ReadOptions, Units};

    #[test]
    fn a_finer_step_keeps_the_samples_and_halves_between() {
        let options =
            ReadOptions { units: Some(Units::MetrePerSecondSquared), time_step_s: Some(0.02), ..ReadOptions::default() };
        let record = Record::parse("r", b"0\n1\n-1\n0.5\n", &options).unwrap();
        let fine = record.resample(0.01).unwrap();
        let expected = [0.0, 0.5, 1.0, 0.0, -1.0, -0.25, 0.5];
        assert_eq!(fine.acceleration_m_s2.len(), expected.len());
        for (found, expected) in fine.acceleration_m_s2.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
        assert!(fine.warnings.contains(&Warning::Resampled { from_s: 0.02, to_s: 0.01 }));
        assert!(matches!(record.resample(0.5), Err(RecordError::TooFewSamples { .. })));
        assert!(matches!(record.resample(f64::NAN), Err(RecordError::TimeStepRange { .. })));
    }
}
