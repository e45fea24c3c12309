//! Runs at an intensity that overturned or stood, and all of them gathered by intensity.

use sprag_shared::math::ln;

/// Difference of ln IM up to which intensities are one: what rounding leaves of a stripe that was scaled record by record. A
/// fragility or a power law between them would be one of rounding.
pub const SAME_LN_INTENSITY: f64 = 1e-10;

/// Runs at one intensity: `of` 1 for a record of a cloud analysis, more for a stripe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// Intensity measure, positive and finite, in any unit.
    pub intensity: f64,
    /// Runs that overturned, 0 to `of`.
    pub overturned: u32,
    /// All runs, 1 or more.
    pub of: u32,
}

/// An observation outside its range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ObservationError {
    /// There is none.
    #[error("0 observations: a fragility needs 1 or more")]
    None,
    /// An intensity has no logarithm.
    #[error("intensity {value} of observation {index}: allowed is more than 0 and finite")]
    Intensity {
        /// Number of the observation, from 0.
        index: usize,
        /// Its intensity.
        value: f64,
    },
    /// An observation of no run.
    #[error("0 runs in observation {index}: allowed are 1 or more")]
    NoRuns {
        /// Number of the observation, from 0.
        index: usize,
    },
    /// More runs overturned than there are.
    #[error("{overturned} overturned runs in observation {index}: allowed are 0 to its {of} runs")]
    Overturned {
        /// Number of the observation, from 0.
        index: usize,
        /// Runs that overturned.
        overturned: u32,
        /// All runs.
        of: u32,
    },
}

/// All runs at one intensity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stripe {
    /// The intensity; the lowest of those that are one.
    pub intensity: f64,
    /// Logarithm of the intensity.
    pub ln_intensity: f64,
    /// Runs that overturned.
    pub overturned: u64,
    /// Runs that stood.
    pub stood: u64,
}

/// Observations in one form, whatever their order and grouping: by rising intensity, one stripe for each. So results have the
/// same bits for both.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stripes {
    /// By rising intensity, each with a run.
    pub all: Vec<Stripe>,
    /// Runs that overturned.
    pub overturned: u64,
    /// Runs that stood.
    pub stood: u64,
}

impl Stripes {
    /// Those of `observations`.
    ///
    /// # Errors
    ///
    /// [`ObservationError`] for the first observation outside its range.
    pub fn of(observations: &[Observation]) -> Result<Stripes, ObservationError> {
        let mut all = Vec::with_capacity(observations.len());
        for (index, &Observation { intensity, overturned, of }) in observations.iter().enumerate() {
            if !(intensity > 0.0 && intensity.is_finite()) {
                return Err(ObservationError::Intensity { index, value: intensity });
            }
            if of == 0 {
                return Err(ObservationError::NoRuns { index });
            }
            let stood = of.checked_sub(overturned).ok_or(ObservationError::Overturned { index, overturned, of })?;
            let ln_intensity = ln(intensity);
            all.push(Stripe { intensity, ln_intensity, overturned: overturned.into(), stood: stood.into() });
        }
        if all.is_empty() {
            return Err(ObservationError::None);
        }
        all.sort_by(|one, other| one.intensity.total_cmp(&other.intensity));
        all.dedup_by(|next, first| {
            let same = next.ln_intensity - first.ln_intensity <= SAME_LN_INTENSITY;
            if same {
                first.overturned += next.overturned;
                first.stood += next.stood;
            }
            same
        });
        Ok(Stripes::gathered(all))
    }

    /// Of stripes that are in order; those without runs are left out.
    pub fn gathered(mut all: Vec<Stripe>) -> Stripes {
        all.retain(|stripe| stripe.overturned + stripe.stood > 0);
        let overturned = all.iter().map(|stripe| stripe.overturned).sum();
        let stood = all.iter().map(|stripe| stripe.stood).sum();
        Stripes { all, overturned, stood }
    }

    /// All runs.
    pub fn number(&self) -> u64 {
        self.overturned + self.stood
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn observation(intensity: f64, overturned: u32, of: u32) -> Observation {
        Observation { intensity, overturned, of }
    }

    #[test]
    fn order_and_grouping_are_forgotten() {
        let cloud = [observation(2.0, 1, 1), observation(1.0, 0, 1), observation(2.0, 0, 1), observation(2.0, 1, 1)];
        let stripes = Stripes::of(&[observation(1.0, 0, 1), observation(2.0, 2, 3)]).unwrap();
        assert_eq!(Stripes::of(&cloud).unwrap(), stripes);
        assert_eq!((stripes.overturned, stripes.stood, stripes.number()), (2, 2, 4));
    }

    #[test]
    fn intensities_that_differ_by_rounding_are_one() {
        // 0.1 + 0.2 is not 0.3.
        let stripes = Stripes::of(&[observation(0.1 + 0.2, 1, 1), observation(0.3, 0, 1)]).unwrap();
        assert_eq!(stripes.all.len(), 1);
        assert_eq!((stripes.all[0].intensity, stripes.all[0].overturned, stripes.all[0].stood), (0.3, 1, 1));
        assert_eq!(Stripes::of(&[observation(1.0, 1, 1), observation(1.0 + 2e-10, 0, 1)]).unwrap().all.len(), 2);
    }

    #[test]
    fn observations_outside_their_range_are_named() {
        let error = |wrong: Observation| Stripes::of(&[observation(1.0, 0, 1), wrong]).unwrap_err();
        for value in [0.0, -1.0, f64::INFINITY] {
            assert_eq!(error(observation(value, 0, 1)), ObservationError::Intensity { index: 1, value });
        }
        assert!(matches!(error(observation(f64::NAN, 0, 1)), ObservationError::Intensity { index: 1, .. }));
        assert_eq!(error(observation(1.0, 0, 0)), ObservationError::NoRuns { index: 1 });
        let many = error(observation(1.0, 3, 2));
        assert_eq!(many.to_string(), "3 overturned runs in observation 1: allowed are 0 to its 2 runs");
        assert_eq!(Stripes::of(&[]).unwrap_err(), ObservationError::None);
    }
}
