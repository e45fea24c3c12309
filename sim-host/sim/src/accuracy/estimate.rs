//! The error of a result, from the same motion followed more closely.
//!
//! A motion is followed again with a smaller tolerance. Whatever separates the two, be it truncation or rounding, the impacts and the
//! nearness of a boundary enlarge alike, so their difference says how far the first is from the truth. Where it is as close as rounding
//! allows, two more runs that lay their steps otherwise show how much rounding matters, and the differences are taken larger.

use serde::Serialize;

/// Absolute errors of a result, in its own units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorEstimate {
    /// All runs end alike, with an impact or without, and no closer look changed that.
    pub outcome_certain: bool,
    /// Of the peak rotation, max |θ|/α.
    pub peak_rotation: f64,
    /// Of the peak acceleration, max |θ̈|/(p²α).
    pub peak_acceleration: f64,
    /// Of the time of the first impact, in the unit of the result's times.
    pub first_impact_time: f64,
}

/// What of a result is compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compared<O> {
    /// How it ended.
    pub outcome: O,
    /// max |θ|/α.
    pub peak_rotation: Option<f64>,
    /// max |θ̈|/(p²α).
    pub peak_acceleration: Option<f64>,
    /// First impact.
    pub first_impact_time: Option<f64>,
}

impl<O: PartialEq> Compared<O> {
    /// Its numbers, in the order of [`ErrorEstimate::errors`].
    pub(super) fn numbers(&self) -> [Option<f64>; 3] {
        [self.peak_rotation, self.peak_acceleration, self.first_impact_time]
    }

    /// The same outcome, and an impact in both or in neither.
    fn ends_like(&self, other: &Compared<O>) -> bool {
        self.outcome == other.outcome && self.first_impact_time.is_some() == other.first_impact_time.is_some()
    }

    /// Whether something is equal in both to `within` of it: steps that no tolerance limits make nearly the same run of two tolerances,
    /// which says nothing about the error of either.
    pub fn repeats(&self, other: &Compared<O>, within: f64) -> bool {
        let same = |value: fn(&Compared<O>) -> Option<f64>| {
            value(self).zip(value(other)).is_some_and(|(own, other)| (own - other).abs() <= within * own.abs())
        };
        same(|of| of.peak_rotation) || same(|of| of.peak_acceleration) || same(|of| of.first_impact_time)
    }
}

/// How the checks were followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Checks {
    /// With a tolerance so much smaller that their own errors, some times this tolerance, do not count.
    Closer(f64),
    /// As closely as rounding allows, like the result itself.
    AsClose,
}

impl Checks {
    /// By how much differences are enlarged, and the relative error that no comparison can exclude.
    pub(super) fn margins(self) -> (f64, f64) {
        match self {
            Checks::Closer(tolerance) => (1.5, 1e-14 + 100.0 * tolerance),
            Checks::AsClose => (6.0, 4e-15),
        }
    }
}

impl ErrorEstimate {
    /// Of `found`, from the same motion followed as in `checks`.
    pub fn of<O: PartialEq>(found: &Compared<O>, checks: &[Compared<O>], how: Checks) -> ErrorEstimate {
        let (factor, floor) = how.margins();
        let error = |value: fn(&Compared<O>) -> Option<f64>| {
            let Some(own) = value(found) else { return 0.0 };
            // The checks among themselves too: two of three may agree by chance.
            let all = checks.iter().filter_map(value).chain([own]);
            let (low, high) = all.fold((own, own), |(low, high), other| (low.min(other), high.max(other)));
            factor * (high - low) + floor * own.abs()
        };
        ErrorEstimate {
            outcome_certain: checks.iter().all(|check| found.ends_like(check)),
            peak_rotation: error(|of| of.peak_rotation),
            peak_acceleration: error(|of| of.peak_acceleration),
            first_impact_time: error(|of| of.first_impact_time),
        }
    }

    /// The errors of [`Compared::numbers`].
    pub(super) fn errors(&mut self) -> [&mut f64; 3] {
        [&mut self.peak_rotation, &mut self.peak_acceleration, &mut self.first_impact_time]
    }

    /// Takes the errors `factor` times as large.
    pub fn enlarge(&mut self, factor: f64) {
        for error in self.errors() {
            *error *= factor;
        }
    }

    /// Takes the errors of the numbers that are `apart` so large that they reach from `found` to `other`, which a method of another kind
    /// found.
    pub fn widen<O: PartialEq>(&mut self, found: &Compared<O>, other: &Compared<O>, apart: [bool; 3]) {
        let (factor, _) = Checks::Closer(0.0).margins();
        let pairs = found.numbers().into_iter().zip(other.numbers());
        for ((error, pair), apart) in self.errors().into_iter().zip(pairs).zip(apart) {
            if let (true, (Some(own), Some(other))) = (apart, pair) {
                *error = error.max(factor * (own - other).abs());
            }
        }
        self.outcome_certain &= found.ends_like(other);
    }

    /// What two looks by other methods leave: of each number the closer one's error, and an outcome of which both are certain.
    pub(super) fn closer(self, other: ErrorEstimate) -> ErrorEstimate {
        ErrorEstimate {
            outcome_certain: self.outcome_certain && other.outcome_certain,
            peak_rotation: self.peak_rotation.min(other.peak_rotation),
            peak_acceleration: self.peak_acceleration.min(other.peak_acceleration),
            first_impact_time: self.first_impact_time.min(other.first_impact_time),
        }
    }

    /// The relative error of the peak rotation `peak`; infinite where the outcome itself is in doubt, 0 where no peak has an error.
    pub fn relative(&self, peak: Option<f64>) -> f64 {
        self.of_peak(peak).unwrap_or(0.0)
    }

    /// The same; none of a block that overturns or does not rock.
    pub fn of_peak(&self, peak: Option<f64>) -> Option<f64> {
        if !self.outcome_certain {
            return Some(f64::INFINITY);
        }
        peak.filter(|&peak| peak != 0.0).map(|peak| self.peak_rotation / peak.abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ended(outcome: u8, peak: f64) -> Compared<u8> {
        Compared { outcome, peak_rotation: Some(peak), peak_acceleration: Some(2.0 * peak), first_impact_time: None }
    }

    #[test]
    fn the_largest_difference_counts() {
        let estimate = ErrorEstimate::of(&ended(1, 0.5), &[ended(1, 0.51), ended(1, 0.49)], Checks::Closer(1e-9));
        assert!(estimate.outcome_certain);
        assert!(estimate.peak_rotation >= 0.02 && estimate.peak_rotation < 0.1, "{estimate:?}");
        assert!((estimate.peak_acceleration / estimate.peak_rotation - 2.0).abs() < 1e-6);
        assert_eq!(estimate.first_impact_time, 0.0);
        assert!((estimate.relative(Some(0.5)) - 2.0 * estimate.peak_rotation).abs() < 1e-15);
    }

    #[test]
    fn another_ending_is_no_certainty() {
        let estimate = ErrorEstimate::of(&ended(1, 0.5), &[ended(1, 0.5), ended(2, 0.5)], Checks::Closer(1e-9));
        assert!(!estimate.outcome_certain);
        assert_eq!(estimate.relative(Some(0.5)), f64::INFINITY);
        assert_eq!(estimate.of_peak(None), Some(f64::INFINITY));
    }

    #[test]
    fn a_block_that_overturns_or_does_not_rock_has_no_error() {
        let estimate = ErrorEstimate::of(&ended(1, 0.5), &[ended(1, 0.5)], Checks::AsClose);
        assert!(estimate.of_peak(Some(0.5)).is_some_and(|error| error > 0.0));
        for peak in [None, Some(0.0)] {
            assert_eq!((estimate.of_peak(peak), estimate.relative(peak)), (None, 0.0));
        }
    }

    #[test]
    fn an_impact_that_only_one_run_has_is_no_certainty() {
        let hit = |time| Compared { first_impact_time: time, ..ended(1, 0.5) };
        let estimate = ErrorEstimate::of(&hit(None), &[hit(Some(2.0))], Checks::Closer(1e-9));
        assert!(!estimate.outcome_certain);
        let mut estimate = ErrorEstimate::of(&hit(Some(2.0)), &[hit(Some(2.0))], Checks::AsClose);
        assert!(estimate.outcome_certain);
        estimate.widen(&hit(Some(2.0)), &hit(None), [true; 3]);
        assert!(!estimate.outcome_certain);
    }

    #[test]
    fn runs_that_agree_are_not_exact() {
        let estimate = ErrorEstimate::of(&ended(1, 0.5), &[ended(1, 0.5)], Checks::AsClose);
        assert!(estimate.peak_rotation > 0.0);
    }
}
