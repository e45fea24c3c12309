//! Bands of a fragility by resampling its runs.

use rayon::prelude::*;
use serde::Serialize;
use sprag_report::band::Band;
use sprag_sim::interrupt::Interrupt;

use super::fragility::{Fragility, FragilityError, of_stripes};
use super::fragility_curve::FragilityCurve;
use super::level::Level;
use super::observation::{Observation, ObservationError, Stripes};
use super::quantile::quantiles;
use super::resample::Cases;

/// Most resamples: all of their estimates are held at once.
pub const MOST_RESAMPLES: u32 = 1_000_000;

/// How to resample.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Bootstrap {
    /// Resamples, 1 to [`MOST_RESAMPLES`]; a thousand or more for bands at 95 %.
    pub resamples: u32,
    /// Seed of the random numbers. Every resample has a stream of its own, so that the first of more are those of fewer.
    pub seed: u64,
    /// Level of the bands.
    pub level: Level,
}

/// Percentile bands of the bootstrap (Efron and Tibshirani 1993, Chapter 13): between the quantiles (1 ∓ level)/2 over the
/// resamples that have an estimate. What they leave out is counted; where that is more than a few percent, the bands are too
/// narrow.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FragilityBands {
    /// How it was resampled.
    #[serde(flatten)]
    pub bootstrap: Bootstrap,
    /// Resamples with an estimate.
    pub estimated: u32,
    /// Resamples without one, by reason.
    pub without_estimate: NoEstimateCounts,
    /// Their share, 0 to 1.
    pub share_without_estimate: f64,
    /// Of μ; `None` if no resample has an estimate.
    pub mu: Option<Band>,
    /// Of β; `None` if no resample has an estimate.
    pub beta: Option<Band>,
    /// Of the probability of overturning, in the order of the intensities asked for; empty if no resample has an estimate.
    pub curve: Vec<CurveBand>,
}

/// Resamples without an estimate: see the variants of [`Fragility`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct NoEstimateCounts {
    /// No run overturned.
    pub never_overturned: u32,
    /// Every run overturned.
    pub always_overturned: u32,
    /// One intensity.
    pub single_intensity: u32,
    /// Completely separated.
    pub separated: u32,
    /// Separated but for one intensity.
    pub quasi_separated: u32,
    /// No rise with intensity.
    pub slope_not_positive: u32,
}

/// The probability of overturning at one intensity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CurveBand {
    /// The intensity.
    pub intensity: f64,
    /// Median over the resamples.
    pub median: f64,
    /// Its band.
    #[serde(flatten)]
    pub band: Band,
}

/// Reasons why runs have no bands.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BootstrapError {
    /// Too few or too many resamples.
    #[error("{value} resamples: allowed are 1 to {MOST_RESAMPLES}")]
    Resamples {
        /// Resamples asked for.
        value: u32,
    },
    /// The curve has no place at an intensity.
    #[error("intensity {value}, number {index} of the curve: allowed is more than 0 and finite")]
    Intensity {
        /// Its number, from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// An observation is outside its range.
    #[error(transparent)]
    Observation(#[from] ObservationError),
    /// A resample has a fragility that was not found.
    #[error("resample {index}: {error}")]
    Resample {
        /// Its number, from 0.
        index: u32,
        /// Error of the fragility curve.
        error: FragilityError,
    },
    /// Ctrl-C.
    #[error("interrupted")]
    Interrupted,
}

/// Bands of the fragility of `observations` and of its curve at `intensities`, on rayon's threads.
///
/// A case is a single run: as many are drawn as there are, with replacement, from all runs of all observations. Neither the
/// number of threads nor the order and grouping of the observations changes a bit. Runs that share a record at several
/// intensities are not independent; their bands are too narrow.
///
/// # Errors
///
/// [`BootstrapError`] for a number of resamples, an intensity or an observation outside its range, and once `interrupt` is set.
pub fn fragility_bands(
    observations: &[Observation],
    intensities: &[f64],
    bootstrap: Bootstrap,
    interrupt: &Interrupt,
) -> Result<FragilityBands, BootstrapError> {
    if !(1..=MOST_RESAMPLES).contains(&bootstrap.resamples) {
        return Err(BootstrapError::Resamples { value: bootstrap.resamples });
    }
    if let Some((index, value)) = intensities.iter().copied().enumerate().find(|(_, im)| !(*im > 0.0 && im.is_finite())) {
        return Err(BootstrapError::Intensity { index, value });
    }
    let cases = Cases::of(Stripes::of(observations)?);
    let resample = |index| match interrupt.is_set() {
        true => Err(BootstrapError::Interrupted),
        false => of_stripes(&cases.resample(bootstrap.seed, index)).map_err(|error| BootstrapError::Resample { index, error }),
    };
    // The first error by number, not by time.
    let found: Vec<Result<Fragility, BootstrapError>> = (0..bootstrap.resamples).into_par_iter().map(resample).collect();
    let mut curves = Vec::with_capacity(found.len());
    let mut without_estimate = NoEstimateCounts::default();
    for found in found {
        let counts = &mut without_estimate;
        let count = match found? {
            Fragility::Estimated(curve) => {
                curves.push(curve);
                continue;
            }
            Fragility::NeverOverturned { .. } => &mut counts.never_overturned,
            Fragility::AlwaysOverturned { .. } => &mut counts.always_overturned,
            Fragility::SingleIntensity { .. } => &mut counts.single_intensity,
            Fragility::Separated { .. } => &mut counts.separated,
            Fragility::QuasiSeparated { .. } => &mut counts.quasi_separated,
            Fragility::SlopeNotPositive { .. } => &mut counts.slope_not_positive,
        };
        *count += 1;
    }
    let estimated = curves.len() as u32;
    let [low, high] = bootstrap.level.shares();
    let shares = [low, 0.5, high];
    let band = |of: fn(&FragilityCurve) -> f64| {
        let values: Vec<f64> = curves.iter().map(of).collect();
        quantiles(&values, bootstrap.level.shares()).map(|[low, high]| Band { low, high })
    };
    let at = |intensity: &f64| {
        let probabilities: Vec<f64> = curves.iter().map(|curve| curve.probability(*intensity)).collect();
        let [low, median, high] = quantiles(&probabilities, shares)?;
        Some(CurveBand { intensity: *intensity, median, band: Band { low, high } })
    };
    let curve: Vec<Option<CurveBand>> = intensities.par_iter().map(at).collect();
    Ok(FragilityBands {
        bootstrap,
        estimated,
        without_estimate,
        share_without_estimate: f64::from(bootstrap.resamples - estimated) / f64::from(bootstrap.resamples),
        mu: band(|curve| curve.mu),
        beta: band(|curve| curve.beta),
        curve: curve.into_iter().flatten().collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOOTSTRAP: Bootstrap = Bootstrap { resamples: 400, seed: 7, level: Level::COMMON };

    fn stripes(counts: &[(f64, u32, u32)]) -> Vec<Observation> {
        counts.iter().map(|&(intensity, overturned, of)| Observation { intensity, overturned, of }).collect()
    }

    fn ordinary() -> Vec<Observation> {
        stripes(&[(0.5, 1, 20), (0.8, 4, 20), (1.1, 9, 20), (1.5, 15, 20), (2.0, 19, 20)])
    }

    #[test]
    fn threads_order_and_grouping_change_no_bit() {
        let bands = fragility_bands(&ordinary(), &[0.7, 1.4], BOOTSTRAP, &Interrupt::default()).unwrap();
        let mut cloud: Vec<Observation> = Vec::new();
        for stripe in ordinary().iter().rev() {
            let one = |index| Observation { overturned: u32::from(index >= stripe.of - stripe.overturned), of: 1, ..*stripe };
            cloud.extend((0..stripe.of).map(one));
        }
        for threads in [1, 2, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            assert_eq!(pool.install(|| fragility_bands(&cloud, &[0.7, 1.4], BOOTSTRAP, &Interrupt::default())).unwrap(), bands);
        }
        let other = fragility_bands(&ordinary(), &[0.7, 1.4], Bootstrap { seed: 8, ..BOOTSTRAP }, &Interrupt::default()).unwrap();
        assert_ne!(other.mu, bands.mu);
    }

    #[test]
    fn bands_are_about_those_of_large_samples() {
        let wanted = Bootstrap { resamples: 4000, ..BOOTSTRAP };
        let bands = fragility_bands(&ordinary(), &[0.7, 1.1], wanted, &Interrupt::default()).unwrap();
        let Fragility::Estimated(curve) = super::super::fragility(&ordinary()).unwrap() else { panic!() };
        assert_eq!(bands.estimated + bands.without_estimate.separated, 4000);
        let half = |band: Option<Band>| 0.5 * (band.unwrap().high - band.unwrap().low) / Level::COMMON.normal();
        assert!((half(bands.mu) / curve.mu_standard_error - 1.0).abs() < 0.15);
        assert!((half(bands.beta) / curve.beta_standard_error - 1.0).abs() < 0.2);
        for at in bands.curve {
            let delta = curve.band(at.intensity, Level::COMMON);
            assert!(at.band.low < at.median && at.median < at.band.high);
            assert!((at.band.low - delta.low).abs() < 0.03 && (at.band.high - delta.high).abs() < 0.03, "{at:?} {delta:?}");
        }
    }

    #[test]
    fn resamples_without_an_estimate_are_counted() {
        // Four runs: each outcome of drawing four of them is as likely as any other, 4⁴ in all.
        let few = stripes(&[(1.0, 0, 1), (2.0, 1, 1), (3.0, 0, 1), (4.0, 1, 1)]);
        let bands = fragility_bands(&few, &[2.5], Bootstrap { resamples: 20_000, ..BOOTSTRAP }, &Interrupt::default()).unwrap();
        let counts = bands.without_estimate;
        let share = |count: u32| f64::from(count) / 20_000.0;
        // Only runs 1 and 3, or only 2 and 4: 16 of 256 each. An estimate needs 2 and 3 (overlap), and one beyond: see below.
        let near = |found: f64, expected: f64| assert!((found - expected).abs() < 0.01, "{found} {expected}");
        near(share(counts.never_overturned), 16.0 / 256.0);
        near(share(counts.always_overturned), 16.0 / 256.0);
        assert_eq!((counts.single_intensity, counts.quasi_separated), (0, 0));
        // All draws, counted one by one.
        let (mut separated, mut falling, mut estimated) = (0, 0, 0);
        for draw in 0..256_u32 {
            let mut drawn = few.clone();
            drawn.iter_mut().for_each(|observation| (observation.overturned, observation.of) = (0, 0));
            for place in 0..4 {
                let case = (draw >> (2 * place) & 3) as usize;
                drawn[case].of += 1;
                drawn[case].overturned += few[case].overturned;
            }
            drawn.retain(|observation| observation.of > 0);
            match super::super::fragility(&drawn).unwrap() {
                Fragility::Estimated(_) => estimated += 1,
                Fragility::Separated { .. } => separated += 1,
                Fragility::SlopeNotPositive { .. } => falling += 1,
                _ => {}
            }
        }
        assert_eq!(separated + falling + estimated, 256 - 32);
        near(share(counts.separated), f64::from(separated) / 256.0);
        near(share(counts.slope_not_positive), f64::from(falling) / 256.0);
        near(1.0 - bands.share_without_estimate, f64::from(estimated) / 256.0);
    }

    #[test]
    fn nothing_estimated_gives_no_bands() {
        let bands = fragility_bands(&stripes(&[(1.0, 0, 5), (2.0, 0, 5)]), &[1.0], BOOTSTRAP, &Interrupt::default()).unwrap();
        assert_eq!((bands.estimated, bands.without_estimate.never_overturned, bands.share_without_estimate), (0, 400, 1.0));
        assert_eq!((bands.mu, bands.beta, bands.curve.len()), (None, None, 0));
        assert!(serde_json::to_string(&bands).unwrap().contains("\"resamples\":400"));
    }

    #[test]
    fn what_is_outside_its_range_is_named() {
        let error = |observations: &[Observation], intensities: &[f64], resamples| {
            fragility_bands(observations, intensities, Bootstrap { resamples, ..BOOTSTRAP }, &Interrupt::default()).unwrap_err()
        };
        assert_eq!(error(&ordinary(), &[], 0).to_string(), "0 resamples: allowed are 1 to 1000000");
        assert_eq!(error(&ordinary(), &[1.0, 0.0], 10), BootstrapError::Intensity { index: 1, value: 0.0 });
        assert_eq!(error(&[], &[], 10), BootstrapError::Observation(ObservationError::None));
    }

    #[test]
    fn it_can_be_interrupted() {
        let interrupt = Interrupt::default();
        interrupt.set();
        let bands = fragility_bands(&ordinary(), &[0.7], Bootstrap { resamples: MOST_RESAMPLES, ..BOOTSTRAP }, &interrupt);
        assert_eq!(bands.unwrap_err(), BootstrapError::Interrupted);
    }
}
