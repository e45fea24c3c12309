//! A lognormal fragility curve, and how far it can be trusted.

use serde::Serialize;
use sprag_report::band::Band;
use sprag_shared::math::{exp, ln, square_root};

use super::level::Level;
use super::normal::{cumulative, quantile};

/// Probability of overturning P(IM) = Φ((ln IM − μ)/β), with the μ and β that maximise its likelihood (Thiers-Moggia and
/// Málaga-Chuquitaype 2019, Eq. 26). The errors are those of large samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FragilityCurve {
    /// μ, the mean of ln IM at overturning.
    pub mu: f64,
    /// β > 0, its standard deviation.
    pub beta: f64,
    /// The intensity e^μ at which half of the blocks overturn, in the unit of the intensities.
    pub median: f64,
    /// Standard error of μ.
    pub mu_standard_error: f64,
    /// Standard error of β.
    pub beta_standard_error: f64,
    /// Covariance of (μ, β): the inverse of the observed information, the second derivatives of the log-likelihood at its
    /// maximum with their sign changed.
    pub covariance: [[f64; 2]; 2],
    /// Log-likelihood: the logarithm of Eq. 26, one factor for each run and no binomial coefficients.
    pub ln_likelihood: f64,
    /// All runs.
    pub number: u64,
    /// Runs that overturned.
    pub overturned: u64,
}

impl FragilityCurve {
    /// Probability of overturning at `intensity`: 0 at 0, 1 at ∞, NaN below 0. Its relative error is that of z²: below 1e-12
    /// down to 1e-300.
    pub fn probability(&self, intensity: f64) -> f64 {
        cumulative(self.deviate(intensity))
    }

    /// Intensity at which the probability of overturning is `probability`, 0 to 1: 0 at 0, ∞ at 1, NaN outside.
    pub fn intensity(&self, probability: f64) -> f64 {
        exp(self.mu + self.beta * quantile(probability))
    }

    /// Where the probability of overturning at `intensity` (> 0, finite; NaN otherwise) lies with the probability `level`, by
    /// the delta method: Φ(z ∓ q s) with the normal quantile q and s² = (V_μμ + 2 z V_μβ + z² V_ββ)/β². On the scale of z the
    /// band stays within 0 to 1.
    pub fn band(&self, intensity: f64, level: Level) -> Band {
        let z = self.deviate(intensity);
        let [[mu, mixed], [_, beta]] = self.covariance;
        let half = level.normal() * square_root((mu + 2.0 * z * mixed + z * z * beta).max(0.0)) / self.beta;
        Band { low: cumulative(z - half), high: cumulative(z + half) }
    }

    /// z = (ln IM − μ)/β.
    fn deviate(&self, intensity: f64) -> f64 {
        (ln(intensity) - self.mu) / self.beta
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CURVE: FragilityCurve = FragilityCurve {
        mu: 0.5,
        beta: 0.25,
        median: 1.6487212707001282,
        mu_standard_error: 0.05,
        beta_standard_error: 0.04,
        covariance: [[0.0025, 0.0006], [0.0006, 0.0016]],
        ln_likelihood: -12.0,
        number: 40,
        overturned: 12,
    };

    #[test]
    fn probabilities_and_intensities_undo_each_other() {
        assert!((CURVE.probability(CURVE.median) - 0.5).abs() < 1e-15);
        // One deviation above: Φ(1).
        assert!((CURVE.probability(exp(0.75)) - 0.8413447460685429).abs() < 1e-15);
        for probability in [1e-12, 0.1, 0.5, 0.9, 0.999] {
            assert!((CURVE.probability(CURVE.intensity(probability)) / probability - 1.0).abs() < 1e-12);
        }
        assert_eq!((CURVE.probability(0.0), CURVE.probability(f64::INFINITY)), (0.0, 1.0));
        assert_eq!((CURVE.intensity(0.0), CURVE.intensity(1.0)), (0.0, f64::INFINITY));
        assert!(CURVE.probability(-1.0).is_nan() && CURVE.intensity(1.5).is_nan());
    }

    #[test]
    fn the_band_is_that_of_the_delta_method() {
        // At z = 1: s² = (0.0025 + 0.0012 + 0.0016)/0.0625.
        let band = CURVE.band(exp(0.75), Level::COMMON);
        let half = 1.959963984540054 * square_root(0.0053 / 0.0625);
        assert!((quantile(band.low) - (1.0 - half)).abs() < 1e-12);
        assert!((quantile(band.high) - (1.0 + half)).abs() < 1e-12);
        let far = CURVE.band(1e-6, Level::COMMON);
        assert!(far.low >= 0.0 && far.high < 1e-3 && far.low <= far.high);
    }
}
