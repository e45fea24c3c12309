//! What the comparisons of one variant and device have in common over the records.

use serde::Serialize;

use super::answer::Answer;
use super::motion::StudyMotion;
use super::study::{Comparison, Findings, Flip};
use super::variants::VARIANTS;

/// Quantiles of a change over the records.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Quantiles {
    /// 16th percentile.
    pub p16: f64,
    /// Median.
    pub median: f64,
    /// 84th percentile.
    pub p84: f64,
}

/// One variant of one device.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// The effect.
    pub effect: &'static str,
    /// The variant.
    pub variant: &'static str,
    /// Number of the device.
    #[serde(skip)]
    pub device_index: usize,
    /// The device.
    pub device: String,
    /// Records that were run.
    pub records: usize,
    /// Relative changes of the peak rotation under those in which both blocks stand and the one of the scene as it is rocks.
    #[serde(skip)]
    pub changes: Vec<f64>,
    /// How many those are.
    pub rocking: usize,
    /// Their quantiles; null without any.
    pub change: Option<Quantiles>,
    /// Records under which the block overturns and did not.
    pub overturns_instead: usize,
    /// Records under which the block stands and did not.
    pub stands_instead: usize,
    /// Under the scene's own motion; null where that was not run.
    pub own_motion: Option<OwnMotion>,
}

/// Under the scene's own motion.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct OwnMotion {
    /// Relative change of the peak rotation.
    pub change: Option<f64>,
    /// Peak |θ|/α of the scene as it is; null when overturned.
    pub peak_base: Option<f64>,
    /// With the variant; null when overturned.
    pub peak_variant: Option<f64>,
    /// Direction in which the outcome changed.
    #[serde(skip)]
    pub flip: Option<Flip>,
}

/// One for each variant and device with a comparison, in the order of `findings`.
pub fn summaries(findings: &Findings, motions: &[StudyMotion], devices: &[String]) -> Vec<Summary> {
    let same = |one: &Comparison, other: &Comparison| (one.variant, one.device) == (other.variant, other.device);
    findings.comparisons.chunk_by(same).map(|comparisons| summary(comparisons, motions, devices)).collect()
}

fn summary(comparisons: &[Comparison], motions: &[StudyMotion], devices: &[String]) -> Summary {
    let Comparison { variant, device, .. } = comparisons[0];
    let (own, records): (Vec<&Comparison>, Vec<&Comparison>) =
        comparisons.iter().partition(|comparison| motions[comparison.motion].own);
    let changes: Vec<f64> = records.iter().filter_map(|comparison| comparison.change()).collect();
    let flips = |flip: Flip| records.iter().filter(|comparison| comparison.flip() == Some(flip)).count();
    Summary {
        effect: VARIANTS[variant].effect,
        variant: VARIANTS[variant].name,
        device_index: device,
        device: devices[device].clone(),
        records: records.len(),
        rocking: changes.len(),
        change: quantiles(&changes),
        changes,
        overturns_instead: flips(Flip::ToOverturned),
        stands_instead: flips(Flip::ToStanding),
        own_motion: own.first().map(|comparison| {
            let [peak_base, peak_variant] = [comparison.base, comparison.answer].map(|answer: Answer| answer.peak);
            OwnMotion { change: comparison.change(), peak_base, peak_variant, flip: comparison.flip() }
        }),
    }
}

/// Those of `values`; `None` without values.
pub fn quantiles(values: &[f64]) -> Option<Quantiles> {
    crate::statistics::quantiles(values, [0.16, 0.5, 0.84]).map(|[p16, median, p84]| Quantiles { p16, median, p84 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_order_statistics() {
        assert_eq!(quantiles(&[]), None);
        assert_eq!(quantiles(&[0.3]), Some(Quantiles { p16: 0.3, median: 0.3, p84: 0.3 }));
        let hundred: Vec<f64> = (0..=100).rev().map(f64::from).collect();
        assert_eq!(quantiles(&hundred), Some(Quantiles { p16: 16.0, median: 50.0, p84: 84.0 }));
        assert_eq!(quantiles(&[1.0, 2.0]).unwrap().median, 1.5);
    }
}
