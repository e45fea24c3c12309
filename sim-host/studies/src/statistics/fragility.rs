//! Lognormal fragility of overturning by maximum likelihood, and the data that have none.

use std::fmt;

use serde::Serialize;
use sprag_shared::math::exp;

use super::fragility_curve::FragilityCurve;
use super::observation::{Observation, ObservationError, Stripes};
use super::probit::{self, NotConverged};

/// What runs say about P(IM) = Φ((ln IM − μ)/β).
///
/// The likelihood (Thiers-Moggia and Málaga-Chuquitaype 2019, Eq. 26, with binomial factors for several runs at one intensity)
/// is that of a probit regression with intercept −μ/β and slope 1/β. It has a maximum, and only one, if and only if no line
/// separates the runs that overturned from those that stood, not even with some of either on it (Silvapulle 1981; Albert and
/// Anderson 1984); and β > 0 there if and only if the mean of ln IM is larger over the runs that overturned.
/// [`Fragility::reason`] says the rest in words.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "status", rename_all = "kebab-case")]
pub enum Fragility {
    /// The maximum exists.
    Estimated(FragilityCurve),
    /// No run overturned: the likelihood rises to 1 as μ → ∞.
    NeverOverturned {
        /// All runs.
        number: u64,
        /// Highest intensity.
        highest: f64,
    },
    /// Every run overturned: the likelihood rises to 1 as μ → −∞.
    AlwaysOverturned {
        /// All runs.
        number: u64,
        /// Lowest intensity.
        lowest: f64,
    },
    /// Runs of both outcomes, all at one intensity: every μ and β with the right probability there are equally likely.
    SingleIntensity {
        /// The intensity.
        intensity: f64,
        /// All runs.
        number: u64,
        /// Runs that overturned.
        overturned: u64,
    },
    /// Every run that stood was below every one that overturned: the likelihood rises to 1 as β → 0, for any μ between.
    Separated {
        /// Highest intensity that stood.
        highest_stood: f64,
        /// Lowest intensity that overturned.
        lowest_overturned: f64,
    },
    /// Quasi-complete separation: runs of both outcomes at one intensity, below it only runs that stood and above it only runs
    /// that overturned. The likelihood rises as β → 0 and μ → ln of that intensity, where P is the share there, towards a value
    /// less than 1 that no curve attains.
    QuasiSeparated {
        /// The intensity.
        intensity: f64,
        /// Runs there.
        number: u64,
        /// Number of runs that overturned.
        overturned: u64,
    },
    /// Overturning does not become likelier with intensity: the likelihood over β > 0 rises as β → ∞, and a negative β is none.
    /// Also where the slope is so small that e^μ or β is no f64, or the rounding of the logarithms hides its sign.
    SlopeNotPositive {
        /// Mean of ln IM over the runs that stood.
        mean_ln_stood: f64,
        /// Mean of ln IM over the runs that overturned.
        mean_ln_overturned: f64,
    },
}

/// Why runs have neither a fragility nor a reason for having none.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FragilityError {
    /// An observation is outside its range.
    #[error(transparent)]
    Observation(#[from] ObservationError),
    /// The maximum exists and was not reached; not known to happen.
    #[error("the likelihood of {number} runs has a maximum that was not found in {steps} steps of Newton's method")]
    NotConverged {
        /// All runs.
        number: u64,
        /// Steps.
        steps: usize,
    },
}

/// The fragility of `observations`. Neither their order nor how runs at one intensity are grouped changes a bit of it.
/// Intensities that differ by no more than [`SAME_LN_INTENSITY`](super::observation::SAME_LN_INTENSITY) count as one.
///
/// # Errors
///
/// [`FragilityError`] without observations and for one outside its range.
pub fn fragility(observations: &[Observation]) -> Result<Fragility, FragilityError> {
    of_stripes(&Stripes::of(observations)?)
}

pub(super) fn of_stripes(stripes: &Stripes) -> Result<Fragility, FragilityError> {
    if let Some(obstacle) = obstacle(stripes) {
        return Ok(obstacle);
    }
    let (overturned, number) = (stripes.overturned, stripes.number());
    let found = probit::maximum(stripes).map_err(|NotConverged { steps }| FragilityError::NotConverged { number, steps })?;
    let [mu_standard_error, beta_standard_error] = found.standard_errors();
    let curve = FragilityCurve {
        mu: found.mu,
        beta: found.beta,
        median: exp(found.mu),
        mu_standard_error,
        beta_standard_error,
        covariance: found.covariance,
        ln_likelihood: found.ln_likelihood,
        number,
        overturned,
    };
    let numbers = [curve.beta, curve.median, mu_standard_error, beta_standard_error];
    let sound = numbers.iter().all(|value| value.is_finite() && *value > 0.0);
    Ok(if sound { Fragility::Estimated(curve) } else { slope_not_positive(stripes) })
}

/// Why there is no maximum, from the data alone.
fn obstacle(stripes: &Stripes) -> Option<Fragility> {
    let (number, overturned) = (stripes.number(), stripes.overturned);
    let (first, last) = (stripes.all.first()?, stripes.all.last()?);
    // By rising intensity, so these are the highest that stood and the lowest that overturned.
    let Some(lowest_overturned) = stripes.all.iter().find(|stripe| stripe.overturned > 0) else {
        return Some(Fragility::NeverOverturned { number, highest: last.intensity });
    };
    let Some(highest_stood) = stripes.all.iter().rfind(|stripe| stripe.stood > 0) else {
        return Some(Fragility::AlwaysOverturned { number, lowest: first.intensity });
    };
    if stripes.all.len() == 1 {
        return Some(Fragility::SingleIntensity { intensity: first.intensity, number, overturned });
    }
    if highest_stood.ln_intensity < lowest_overturned.ln_intensity {
        let (highest_stood, lowest_overturned) = (highest_stood.intensity, lowest_overturned.intensity);
        return Some(Fragility::Separated { highest_stood, lowest_overturned });
    }
    if highest_stood.ln_intensity == lowest_overturned.ln_intensity {
        let (tie, number) = (lowest_overturned, lowest_overturned.overturned + lowest_overturned.stood);
        return Some(Fragility::QuasiSeparated { intensity: tie.intensity, number, overturned: tie.overturned });
    }
    // The log-likelihood along its best intercepts is concave in the slope, with this sign of its derivative at slope 0.
    let (rise, rounding) = rise(stripes);
    (rise <= rounding).then(|| slope_not_positive(stripes))
}

/// Mean of ln IM over the runs that overturned less that over those that stood, and a bound of its rounding.
fn rise(stripes: &Stripes) -> (f64, f64) {
    let [stood, overturned] = means(stripes);
    let largest = stripes.all.iter().map(|stripe| stripe.ln_intensity.abs()).fold(0.0, f64::max);
    (overturned - stood, stripes.all.len() as f64 * f64::EPSILON * largest)
}

/// Means of ln IM over the runs that stood and over those that overturned.
fn means(stripes: &Stripes) -> [f64; 2] {
    let stood = stripes.all.iter().map(|stripe| stripe.stood as f64 * stripe.ln_intensity).sum::<f64>();
    let overturned = stripes.all.iter().map(|stripe| stripe.overturned as f64 * stripe.ln_intensity).sum::<f64>();
    [stood / stripes.stood as f64, overturned / stripes.overturned as f64]
}

fn slope_not_positive(stripes: &Stripes) -> Fragility {
    let [mean_ln_stood, mean_ln_overturned] = means(stripes);
    Fragility::SlopeNotPositive { mean_ln_stood, mean_ln_overturned }
}

impl Fragility {
    /// The curve, where there is one.
    pub fn curve(&self) -> Option<&FragilityCurve> {
        match self {
            Fragility::Estimated(curve) => Some(curve),
            _ => None,
        }
    }

    /// Why there is no curve, in a sentence; `None` where there is one.
    pub fn reason(&self) -> Option<String> {
        self.curve().is_none().then(|| self.to_string())
    }
}

impl fmt::Display for Fragility {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Fragility::Estimated(curve) => {
                write!(f, "median {}, dispersion {} from {} runs", rounded(curve.median), rounded(curve.beta), curve.number)
            }
            Fragility::NeverOverturned { number, highest } => {
                write!(
                    f,
                    "none of {number} runs overturned, up to an intensity of {}: no fragility can be estimated",
                    rounded(highest)
                )
            }
            Fragility::AlwaysOverturned { number, lowest } => {
                write!(
                    f,
                    "all {number} runs overturned, down to an intensity of {}: no fragility can be estimated",
                    rounded(lowest)
                )
            }
            Fragility::SingleIntensity { intensity, number, overturned } => write!(
                f,
                "all {number} runs, of which {overturned} overturned, are at the intensity {}: median and dispersion \
                 need two",
                rounded(intensity)
            ),
            Fragility::Separated { highest_stood, lowest_overturned } => write!(
                f,
                "every run up to the intensity {} stood and every one from {} overturned: the median \
                 lies between, and the dispersion cannot be distinguished from 0",
                rounded(highest_stood),
                rounded(lowest_overturned)
            ),
            Fragility::QuasiSeparated { intensity, number, overturned } => write!(
                f,
                "every run below the intensity {} stood, every one above overturned, and {overturned} of {number} there did: \
                 the likelihood has no maximum with a dispersion above 0",
                rounded(intensity)
            ),
            Fragility::SlopeNotPositive { mean_ln_stood, mean_ln_overturned } => write!(
                f,
                "overturning does not become likelier with intensity (mean ln IM {} of the runs that \
                 overturned, {} of those that stood): the dispersion has no meaning",
                rounded(mean_ln_overturned),
                rounded(mean_ln_stood)
            ),
        }
    }
}

/// To four digits, as sentences have them.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}
