//! The seismic demand model: median demand as a power of an intensity measure.

use serde::Serialize;
use sprag_report::band::Band;
use sprag_shared::math::{exp, ln, square_root};

use super::level::Level;
use super::observation::SAME_LN_INTENSITY;

/// Fewest points: with two the line passes through both, and nothing is left to find the scatter from.
pub const FEWEST_POINTS: usize = 3;

/// Intensity and demand of one run, in any units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DemandPoint {
    /// Intensity measure IM, positive and finite.
    pub intensity: f64,
    /// Demand D, positive and finite. Runs that overturned have none and are left out.
    pub demand: f64,
}

/// Median demand D_m = a IM^b, fitted by least squares to ln D = ln a + b ln IM (Thiers-Moggia and Málaga-Chuquitaype 2019,
/// Eq. 24 and 25; Cornell et al. 2002). The scatter is taken for normal in ln D and the same at every intensity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PowerLaw {
    /// a, the median demand at IM = 1, in the unit of the demand; 0 or ∞ where only its logarithm is an f64.
    pub a: f64,
    /// ln a.
    pub ln_a: f64,
    /// Exponent b.
    pub b: f64,
    /// Standard error of ln a.
    pub ln_a_standard_error: f64,
    /// Standard error of b.
    pub b_standard_error: f64,
    /// R², the part of the variance of ln D that the law explains, 0 to 1; `None` if all demands are equal.
    pub r_squared: Option<f64>,
    /// β_D|IM, the standard deviation of ln D about the law with n − 2 degrees of freedom.
    pub dispersion: f64,
    /// n, the points.
    pub number: u32,
    /// Mean of ln IM.
    pub mean_ln_intensity: f64,
    /// Sum of the squared deviations of ln IM from its mean.
    pub spread_ln_intensity: f64,
}

/// Reasons why points have no power law.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PowerLawError {
    /// Too few of them, or more than can be counted.
    #[error("{found} points: a power law and its dispersion need at least {FEWEST_POINTS}")]
    Number {
        /// The points.
        found: usize,
    },
    /// An intensity has no logarithm.
    #[error("intensity {value} of point {index}: allowed is more than 0 and finite")]
    Intensity {
        /// Number of the point, from 0.
        index: usize,
        /// Its intensity.
        value: f64,
    },
    /// A demand has no logarithm.
    #[error("demand {value} of point {index}: allowed is more than 0 and finite")]
    Demand {
        /// Number of the point, from 0.
        index: usize,
        /// Its demand.
        value: f64,
    },
    /// One intensity says nothing about an exponent.
    #[error("all {number} intensities are {value}: an exponent needs two that differ")]
    EqualIntensities {
        /// The intensity.
        value: f64,
        /// The points.
        number: usize,
    },
}

impl PowerLaw {
    /// The law of `points`, whose order changes the last digits at most.
    ///
    /// # Errors
    ///
    /// [`PowerLawError`] for fewer than three points, a value that is not positive and finite, and intensities that are all
    /// equal, or differ by no more than [`SAME_LN_INTENSITY`].
    pub fn fit(points: &[DemandPoint]) -> Result<PowerLaw, PowerLawError> {
        let wrong = PowerLawError::Number { found: points.len() };
        let Some(number) = u32::try_from(points.len()).ok().filter(|_| points.len() >= FEWEST_POINTS) else { return Err(wrong) };
        for (index, DemandPoint { intensity, demand }) in points.iter().copied().enumerate() {
            if !(intensity > 0.0 && intensity.is_finite()) {
                return Err(PowerLawError::Intensity { index, value: intensity });
            }
            if !(demand > 0.0 && demand.is_finite()) {
                return Err(PowerLawError::Demand { index, value: demand });
            }
        }
        let x: Vec<f64> = points.iter().map(|point| ln(point.intensity)).collect();
        let y: Vec<f64> = points.iter().map(|point| ln(point.demand)).collect();
        let ends = x.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [x.min(low), x.max(high)]);
        if ends[1] - ends[0] <= SAME_LN_INTENSITY {
            return Err(PowerLawError::EqualIntensities { value: points[0].intensity, number: points.len() });
        }
        let (x_mean, y_mean) = (mean(&x), mean(&y));
        let pairs = || x.iter().map(|x| x - x_mean).zip(y.iter().map(|y| y - y_mean));
        let spread: f64 = pairs().map(|(x, _)| x * x).sum();
        let b = pairs().map(|(x, y)| x * y).sum::<f64>() / spread;
        // From the residuals themselves: the difference of two sums would lose a small scatter.
        let unexplained: f64 = pairs().map(|(x, y)| (y - b * x) * (y - b * x)).sum();
        let total: f64 = pairs().map(|(_, y)| y * y).sum();
        let count = f64::from(number);
        let dispersion = square_root(unexplained / (count - 2.0));
        let ln_a = y_mean - b * x_mean;
        Ok(PowerLaw {
            a: exp(ln_a),
            ln_a,
            b,
            ln_a_standard_error: dispersion * square_root(1.0 / count + x_mean * x_mean / spread),
            b_standard_error: dispersion / square_root(spread),
            r_squared: (total > 0.0).then(|| (1.0 - unexplained / total).max(0.0)),
            dispersion,
            number,
            mean_ln_intensity: x_mean,
            spread_ln_intensity: spread,
        })
    }

    /// Median demand at `intensity` (> 0), in the units of the points.
    pub fn median(&self, intensity: f64) -> f64 {
        exp(self.ln_a + self.b * ln(intensity))
    }

    /// Where the median demand at `intensity` (> 0) lies with the probability `level`: D_m exp(∓t s √(1/n + (ln IM − m)²/S)),
    /// with the dispersion s, mean m and spread S of the logarithms of the intensities, and Student's t for n − 2 degrees of
    /// freedom.
    pub fn median_band(&self, intensity: f64, level: Level) -> Band {
        self.band(intensity, level, 0.0)
    }

    /// Where the demand of one more run at `intensity` (> 0) lies with the probability `level`: as [`PowerLaw::median_band`],
    /// with 1 + 1/n for 1/n.
    pub fn prediction_band(&self, intensity: f64, level: Level) -> Band {
        self.band(intensity, level, 1.0)
    }

    fn band(&self, intensity: f64, level: Level, own: f64) -> Band {
        let away = ln(intensity) - self.mean_ln_intensity;
        let variance = own + 1.0 / f64::from(self.number) + away * away / self.spread_ln_intensity;
        let half = level.student(self.number.saturating_sub(2)) * self.dispersion * square_root(variance);
        let middle = self.ln_a + self.b * ln(intensity);
        Band { low: exp(middle - half), high: exp(middle + half) }
    }
}

/// Exact where all values are equal.
fn mean(values: &[f64]) -> f64 {
    let first = values[0];
    first + values.iter().map(|value| value - first).sum::<f64>() / values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(pairs: &[(f64, f64)]) -> Vec<DemandPoint> {
        pairs.iter().map(|&(intensity, demand)| DemandPoint { intensity, demand }).collect()
    }

    /// ln IM = 0, 1, 2, 3 and ln D = 1, 2, 2, 4: b = 0.9, ln a = 0.9, residuals 0.1, 0.2, −0.7, 0.4.
    fn by_hand() -> PowerLaw {
        let e = |x: f64| exp(x);
        PowerLaw::fit(&points(&[(e(0.0), e(1.0)), (e(1.0), e(2.0)), (e(2.0), e(2.0)), (e(3.0), e(4.0))])).unwrap()
    }

    #[test]
    fn a_fit_by_hand_is_found() {
        let law = by_hand();
        let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        close(law.b, 0.9);
        close(law.ln_a, 0.9);
        close(law.a, exp(0.9));
        close(law.dispersion, square_root(0.7 / 2.0));
        close(law.b_standard_error, square_root(0.35 / 5.0));
        close(law.ln_a_standard_error, square_root(0.35 * (0.25 + 2.25 / 5.0)));
        close(law.r_squared.unwrap(), 1.0 - 0.7 / 4.75);
        assert_eq!(law.number, 4);
        // Two degrees of freedom at 95 %: t = 0.95 √2/√(1 − 0.95²). At ln IM = 1.5 nothing is due to the slope.
        let t = 0.95 * square_root(2.0 / (1.0 - 0.95 * 0.95));
        let median = law.median_band(exp(1.5), Level::COMMON);
        close(ln(median.high / law.median(exp(1.5))), t * square_root(0.35 / 4.0));
        close(ln(median.low * median.high), 2.0 * (0.9 + 0.9 * 1.5));
        let prediction = law.prediction_band(exp(2.5), Level::COMMON);
        close(0.5 * ln(prediction.high / prediction.low), t * square_root(0.35 * (1.25 + 1.0 / 5.0)));
    }

    #[test]
    fn points_on_a_law_give_it_without_scatter() {
        let exact: Vec<DemandPoint> =
            (1..=20).map(|i| f64::from(i) * 0.1).map(|x| DemandPoint { intensity: x, demand: 3.0 / (x * x) }).collect();
        let law = PowerLaw::fit(&exact).unwrap();
        assert!((law.b + 2.0).abs() < 1e-14 && (law.a - 3.0).abs() < 1e-14 && law.dispersion < 1e-14);
        assert!((law.r_squared.unwrap() - 1.0).abs() < 1e-15);
        assert!((law.median(5.0) - 0.12).abs() < 1e-14);
    }

    #[test]
    fn units_change_only_a() {
        let law = by_hand();
        let scaled: Vec<DemandPoint> = [(0.0, 1.0), (1.0, 2.0), (2.0, 2.0), (3.0, 4.0)]
            .map(|(x, y)| DemandPoint { intensity: 9.81 * exp(x), demand: 57.3 * exp(y) })
            .to_vec();
        let other = PowerLaw::fit(&scaled).unwrap();
        assert!((other.b - law.b).abs() < 1e-13 && (other.dispersion - law.dispersion).abs() < 1e-13);
        assert!((other.b_standard_error - law.b_standard_error).abs() < 1e-13);
        assert!((other.median(9.81 * 2.0) / law.median(2.0) / 57.3 - 1.0).abs() < 1e-13);
    }

    #[test]
    fn equal_demands_have_no_scatter_to_explain() {
        let law = PowerLaw::fit(&points(&[(1.0, 0.1), (2.0, 0.1), (3.0, 0.1)])).unwrap();
        assert_eq!((law.b, law.dispersion, law.r_squared), (0.0, 0.0, None));
    }

    #[test]
    fn what_has_no_law_is_named() {
        let error = |pairs: &[(f64, f64)]| PowerLaw::fit(&points(pairs)).unwrap_err();
        assert_eq!(error(&[]), PowerLawError::Number { found: 0 });
        assert_eq!(error(&[(1.0, 1.0), (2.0, 2.0)]).to_string(), "2 points: a power law and its dispersion need at least 3");
        assert_eq!(error(&[(1.0, 1.0), (0.0, 2.0), (3.0, 1.0)]), PowerLawError::Intensity { index: 1, value: 0.0 });
        assert_eq!(error(&[(1.0, 1.0), (2.0, 2.0), (3.0, -1.0)]), PowerLawError::Demand { index: 2, value: -1.0 });
        let infinite = error(&[(1.0, f64::INFINITY), (2.0, 2.0), (3.0, 1.0)]);
        assert_eq!(infinite.to_string(), "demand inf of point 0: allowed is more than 0 and finite");
        assert!(matches!(error(&[(f64::NAN, 1.0), (2.0, 2.0), (3.0, 1.0)]), PowerLawError::Intensity { index: 0, .. }));
        let equal = PowerLawError::EqualIntensities { value: 0.1, number: 3 };
        assert_eq!(error(&[(0.1, 1.0), (0.1, 2.0), (0.1, 3.0)]), equal);
        // What scaling to one level leaves of it.
        let rounded = 0.1 + f64::EPSILON * 0.1;
        assert!(rounded > 0.1);
        assert_eq!(error(&[(0.1, 1.0), (rounded, 2.0), (0.1, 3.0)]), equal);
        assert!(PowerLaw::fit(&points(&[(0.1, 1.0), (0.1 * (1.0 + 1e-9), 2.0), (0.1, 3.0)])).is_ok());
    }
}
