//! Fragilities: the probability of overturning of each structure and device.

use serde::Serialize;
use sprag_sim::interrupt::Interrupt;

use super::measure::Measure;
use super::runs::Run;
use crate::statistics::{
    Bootstrap, BootstrapError, Fragility, FragilityBands, FragilityError, Observation, fragility, fragility_bands,
};

/// Equal steps of the intensity at whose ends a curve and its band are drawn.
const CURVE_POINTS: u32 = 120;

/// Equal steps of the probability, beside those, where a curve rises from the first to the last within fewer steps of the intensity.
const RISE_POINTS: u32 = 20;

/// Where to draw `fragility` and its band up to `highest`.
fn drawn_at(fragility: &Fragility, highest: f64) -> Vec<f64> {
    let step = highest / f64::from(CURVE_POINTS);
    let mut all: Vec<f64> = (1..=CURVE_POINTS).map(|k| highest * f64::from(k) / f64::from(CURVE_POINTS)).collect();
    if let Some(curve) = fragility.curve() {
        let rise: Vec<f64> = (1..RISE_POINTS).map(|k| curve.intensity(f64::from(k) / f64::from(RISE_POINTS))).collect();
        if rise[rise.len() - 1] - rise[0] < f64::from(RISE_POINTS) * step {
            all.extend(rise.into_iter().filter(|intensity| *intensity < highest));
            all.sort_by(f64::total_cmp);
        }
    }
    all
}

/// The fragility of one structure and device (Eq. 26).
#[derive(Clone, Debug, Serialize)]
pub struct DeviceFragility {
    /// Number of the structure.
    #[serde(skip)]
    pub structure_index: usize,
    /// The structure.
    pub structure: String,
    /// Number of the device.
    #[serde(skip)]
    pub device_index: usize,
    /// The device.
    pub device: String,
    /// IM.
    pub measure: Measure,
    /// Runs in it.
    pub runs: usize,
    /// Number of runs that overturned.
    pub overturned: usize,
    /// Runs that failed, and are not in it.
    pub failed: usize,
    /// Runs without a value of the measure, and not in it.
    pub zero: usize,
    /// The curve, or what the runs say instead.
    pub fragility: Fragility,
    /// Why there is no curve, in words.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Its bands; null without a curve.
    pub bands: Option<FragilityBands>,
    /// Probability of overturning at the intensities at which it is 0.1 and 0.5 with the first device; null for that one.
    pub at_first: Option<[f64; 2]>,
    /// Its median over that of the first device; null for that one.
    pub median_ratio: Option<f64>,
    /// What it was fitted to.
    #[serde(skip)]
    pub observations: Vec<Observation>,
}

/// Why there is neither a curve nor a reason for having none.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OverturningError {
    /// The fit.
    #[error("fragility of {structure}, {device}: {error}")]
    Fit {
        /// Structure.
        structure: String,
        /// Device.
        device: String,
        /// Reason why there is no fragility.
        error: Box<FragilityError>,
    },
    /// Confidence bands that cannot be made.
    #[error("fragility of {structure}, {device}: {error}")]
    Bands {
        /// Structure.
        structure: String,
        /// Device.
        device: String,
        /// Reason why there are no bands.
        error: Box<BootstrapError>,
    },
}

impl DeviceFragility {
    /// That of `runs`, which are all those of structure and device number `structure.0` and `device.0`; `None` if none of them
    /// has a value of the measure. `highest` is where its band ends.
    ///
    /// # Errors
    /// [`OverturningError`] once `interrupt` is set; another is not known to happen.
    pub fn fit(
        runs: &[&Run],
        structure: (usize, &str),
        device: (usize, &str),
        measure: Measure,
        bootstrap: Bootstrap,
        highest: f64,
        interrupt: &Interrupt,
    ) -> Result<Option<DeviceFragility>, OverturningError> {
        let (mut failed, mut zero) = (0, 0);
        let mut observations = Vec::new();
        for run in runs {
            let intensity = run.measure(measure);
            match &run.answer {
                Err(_) => failed += 1,
                Ok(answer) if intensity > 0.0 => {
                    observations.push(Observation { intensity, overturned: answer.outcome.overturned().into(), of: 1 });
                }
                Ok(_) => zero += 1,
            }
        }
        if observations.is_empty() {
            return Ok(None);
        }
        let names = || (structure.1.to_owned(), device.1.to_owned());
        let fragility = fragility(&observations).map_err(|error| {
            let (structure, device) = names();
            OverturningError::Fit { structure, device, error: Box::new(error) }
        })?;
        let bands = match fragility {
            Fragility::Estimated(_) => {
                let intensities = drawn_at(&fragility, highest);
                Some(fragility_bands(&observations, &intensities, bootstrap, interrupt).map_err(|error| {
                    let (structure, device) = names();
                    OverturningError::Bands { structure, device, error: Box::new(error) }
                })?)
            }
            _ => None,
        };
        Ok(Some(DeviceFragility {
            structure_index: structure.0,
            structure: structure.1.to_owned(),
            device_index: device.0,
            device: device.1.to_owned(),
            measure,
            runs: observations.len(),
            overturned: observations.iter().map(|observation| observation.overturned as usize).sum(),
            failed,
            zero,
            reason: fragility.reason(),
            fragility,
            bands,
            at_first: None,
            median_ratio: None,
            observations,
        }))
    }

    /// Intensity and share of overturned runs of each stripe; `None` where most intensities have a single run, as in a cloud.
    pub fn shares(&self) -> Option<Vec<(f64, f64)>> {
        let mut all = self.observations.clone();
        all.sort_by(|one, other| one.intensity.total_cmp(&other.intensity));
        // A level is met to within rounding.
        let stripes = all.chunk_by(|one, other| other.intensity <= one.intensity * (1.0 + 1e-9));
        let share = |stripe: &[Observation]| {
            let overturned: u32 = stripe.iter().map(|observation| observation.overturned).sum();
            (stripe[0].intensity, f64::from(overturned) / stripe.len() as f64)
        };
        let shares: Vec<(f64, f64)> = stripes.map(share).collect();
        (all.len() >= 2 * shares.len()).then_some(shares)
    }

    /// Puts it beside `first`, the fragility of the same structure with the first device.
    pub fn compare(&mut self, first: &DeviceFragility) {
        if let (Some(curve), Some(first)) = (self.fragility.curve(), first.fragility.curve()) {
            self.at_first = Some([0.1, 0.5].map(|probability| curve.probability(first.intensity(probability))));
            self.median_ratio = Some(curve.median / first.median);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Level;
    use sprag_shared::observers::outcome::Outcome;

    fn runs(outcomes: &[(f64, bool)]) -> Vec<Run> {
        let run = |(record, &(intensity, overturned)): (usize, &(f64, bool))| {
            Run::of(record, intensity, if overturned { Outcome::OverturnedAfterImpact } else { Outcome::NoRocking }, 0.0)
        };
        outcomes.iter().enumerate().map(run).collect()
    }

    fn fit_unless(interrupt: &Interrupt, runs: &[Run]) -> Result<Option<DeviceFragility>, OverturningError> {
        let all: Vec<&Run> = runs.iter().collect();
        let bootstrap = Bootstrap { resamples: 50, seed: 1, level: Level::COMMON };
        DeviceFragility::fit(&all, (0, "pier"), (0, "none"), Measure::Pgv, bootstrap, 4.0, interrupt)
    }

    fn fit(runs: &[Run]) -> Option<DeviceFragility> {
        fit_unless(&Interrupt::default(), runs).unwrap()
    }

    /// Intensities, and whether the block overturns: neither separated nor falling.
    const ROCKING: [(f64, bool); 6] = [(0.5, false), (1.0, false), (1.5, true), (2.0, false), (2.5, true), (3.0, true)];

    #[test]
    fn blocks_that_do_not_rock_count_as_standing() {
        let mut all = runs(&ROCKING);
        all.push(Run { answer: Err("it failed".to_owned()), ..all[0].clone() });
        all.push(Run { measures: [0.0; Measure::COUNT], ..all[0].clone() });
        let mut found = fit(&all).unwrap();
        assert_eq!((found.runs, found.overturned, found.failed, found.zero), (6, 3, 1, 1));
        assert_eq!(found.bands.as_ref().unwrap().curve.len(), CURVE_POINTS as usize);
        found.compare(&found.clone());
        assert_eq!(found.median_ratio, Some(1.0));
        let [tenth, half] = found.at_first.unwrap();
        assert!((tenth - 0.1).abs() < 1e-12 && (half - 0.5).abs() < 1e-12);
    }

    /// Intensities from 0.005 to 60, of which a curve takes the first: it is no polygon of a few lines.
    #[test]
    fn a_curve_that_rises_within_a_few_steps_is_drawn_as_a_curve() {
        let found = fit(&runs(&ROCKING.map(|(intensity, overturned)| (0.01 * intensity, overturned)))).unwrap();
        let (curve, drawn) = (found.fragility.curve().unwrap(), drawn_at(&found.fragility, 60.0));
        let probabilities: Vec<f64> = std::iter::once(0.0).chain(drawn.iter().map(|at| curve.probability(*at))).collect();
        assert!(probabilities.windows(2).all(|ends| (0.0..0.051).contains(&(ends[1] - ends[0]))), "{probabilities:?}");
        assert!((drawn[drawn.len() - 1] - 60.0).abs() < 1e-12);
    }

    #[test]
    fn bands_are_not_made_once_the_user_asks_to_stop() {
        let interrupt = Interrupt::default();
        interrupt.set();
        let stopped = fit_unless(&interrupt, &runs(&ROCKING)).unwrap_err();
        assert!(matches!(stopped, OverturningError::Bands { error, .. } if *error == BootstrapError::Interrupted));
    }

    #[test]
    fn stripes_have_shares_and_clouds_none() {
        let found = fit(&runs(&[(2.0, true), (1.0, false), (2.0, false), (1.0, false), (2.0, true), (3.0, true)])).unwrap();
        assert_eq!(found.shares(), Some(vec![(1.0, 0.0), (2.0, 2.0 / 3.0), (3.0, 1.0)]));
        assert_eq!(fit(&runs(&[(1.0, false), (2.0, true), (3.0, false)])).unwrap().shares(), None);
    }

    #[test]
    fn a_block_that_never_overturns_has_a_reason_and_no_curve() {
        let found = fit(&runs(&[(0.5, false), (1.0, false)])).unwrap();
        assert!(found.bands.is_none() && found.reason.unwrap().starts_with("none of 2 runs overturned"));
        assert!(fit(&[]).is_none());
    }
}
