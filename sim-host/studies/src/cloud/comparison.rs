//! Demands of a device beside those of the first one.

use serde::Serialize;
use sprag_shared::math;

use super::demand::{Demand, DemandModel};
use super::runs::Run;
use crate::statistics::quantiles;

/// Demands of a device over those of the first device of the study: 0.7 is a reduction by 30 %.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DemandRatio {
    /// The structure.
    pub structure: String,
    /// The device.
    pub device: String,
    /// The first device.
    pub over: String,
    /// Demand that is compared.
    pub demand: Demand,
    /// Of the medians of both power laws, over the intensities that both were fitted to.
    pub medians: Option<MedianRatio>,
    /// Of both demands under one motion, over the motions in which both blocks rock and stand.
    pub pairs: Option<PairRatio>,
    /// How many motions those are.
    pub number_of_pairs: usize,
}

/// Ratio of the medians D_m of two power laws, exp(ln a − ln a₁) IM^(b − b₁).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MedianRatio {
    /// The intensities common to both.
    pub common_range: [f64; 2],
    /// At their geometric mean, the middle of the range in ln IM; since the logarithm of the ratio is linear in ln IM this is also its
    /// mean over the range, e^(mean of the ln ratio).
    pub middle: f64,
    /// At the lower end.
    pub low: f64,
    /// At the upper end.
    pub high: f64,
}

/// Ratios of two demands under one motion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PairRatio {
    /// 16th percentile.
    pub p16: f64,
    /// Median.
    pub median: f64,
    /// 84th percentile.
    pub p84: f64,
}

impl DemandRatio {
    /// `model` over `first`, the same demand of the same structure with the first device, and the runs of both.
    pub fn of(model: &DemandModel, runs: &[&Run], first: &DemandModel, first_runs: &[&Run]) -> DemandRatio {
        // Every device is run under the same motions, in the same order.
        let pairs = runs.iter().zip(first_runs);
        let ratios: Vec<f64> =
            pairs.filter_map(|(run, first_run)| Some(model.demand.of(run)? / first.demand.of(first_run)?)).collect();
        DemandRatio {
            structure: model.structure.clone(),
            device: model.device.clone(),
            over: first.device.clone(),
            demand: model.demand,
            medians: medians(model, first),
            pairs: quantiles(&ratios, [0.16, 0.5, 0.84]).map(|[p16, median, p84]| PairRatio { p16, median, p84 }),
            number_of_pairs: ratios.len(),
        }
    }
}

fn medians(model: &DemandModel, first: &DemandModel) -> Option<MedianRatio> {
    let (law, first_law) = (model.law?, first.law?);
    let ([low, high], [first_low, first_high]) = (model.intensity_range?, first.intensity_range?);
    let common_range = [low.max(first_low), high.min(first_high)];
    let [low, high] = common_range;
    let ratio = |intensity: f64| law.median(intensity) / first_law.median(intensity);
    (low < high).then(|| MedianRatio {
        common_range,
        middle: ratio(math::square_root(low * high)),
        low: ratio(low),
        high: ratio(high),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::measure::Measure;
    use sprag_shared::observers::outcome::Outcome;

    fn runs(outcomes: &[(f64, Option<f64>)]) -> Vec<Run> {
        let run = |(record, &(intensity, peak)): (usize, &(f64, Option<f64>))| match peak {
            Some(peak) => Run::of(record, intensity, Outcome::Safe, peak),
            None => Run::of(record, intensity, Outcome::OverturnedAfterImpact, 0.0),
        };
        outcomes.iter().enumerate().map(run).collect()
    }

    #[test]
    fn ratios_are_those_of_laws_and_of_pairs() {
        let first = runs(&[(1.0, Some(0.1)), (2.0, Some(0.2)), (4.0, Some(0.4)), (8.0, None)]);
        let other = runs(&[(1.0, Some(0.08)), (2.0, Some(0.12)), (4.0, Some(0.18)), (8.0, Some(0.27))]);
        let fit = |runs: &[Run]| {
            let all: Vec<&Run> = runs.iter().collect();
            DemandModel::fit(&all, (0, "pier"), (0, "device"), Demand::PeakRotation, Measure::Pgv)
        };
        let (first_runs, other_runs): (Vec<&Run>, Vec<&Run>) = (first.iter().collect(), other.iter().collect());
        let ratio = DemandRatio::of(&fit(&other), &other_runs, &fit(&first), &first_runs);
        assert_eq!(ratio.number_of_pairs, 3);
        assert!((ratio.pairs.unwrap().median - 0.6).abs() < 1e-12);
        let medians = ratio.medians.unwrap();
        assert_eq!(medians.common_range, [1.0, 4.0]);
        // The mean over the range in ln IM, taken as a sum, is the value in the middle.
        let ln =
            |intensity: f64| math::ln(fit(&other).law.unwrap().median(intensity) / fit(&first).law.unwrap().median(intensity));
        let mean = (0..=100).map(|k| ln(math::exp(math::ln(4.0) * f64::from(k) / 100.0))).sum::<f64>() / 101.0;
        assert!((math::ln(medians.middle) - mean).abs() < 1e-12);
        assert!(medians.low > medians.middle && medians.middle > medians.high);
    }
}
