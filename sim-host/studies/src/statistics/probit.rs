//! The maximum of the likelihood of a lognormal fragility, where there is one.
//!
//! With x = ln IM and z = (x − μ)/β the log-likelihood Σ [k ln Φ(z) + (n − k) ln Φ(−z)] is that of a probit regression: concave
//! in the intercept −μ/β and the slope 1/β, so that Newton's method with steps that are halved until they rise finds its only
//! maximum. Two parameters need no library: about the mean of x under the weights of a step the two equations are independent.

use sprag_shared::math::square_root;

use super::normal::{inverse_mills, ln_cumulative, quantile};
use super::observation::Stripes;

/// Most steps. Ordinary data take some ten; data that a hair's breadth keeps from being separated take a hundred.
const MOST_STEPS: usize = 500;
/// Part of the height and of the slope below which a step is the last: what it leaves is about its square.
const LAST_STEP: f64 = 1e-9;
/// Where a step that is no smaller than the one before is rounding: Newton's steps would be, and on the way up they are larger.
const NEAR_STEP: f64 = 1e-4;
/// Slope over the half range of ln IM below which its steps need not be small as a part of it: their squares are.
const FLAT: f64 = 1e-4;
/// Rounding of a log-likelihood, as a part of it.
const ROUNDING: f64 = 1e-13;

/// Estimates at the maximum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Maximum {
    /// μ, mean of ln IM at overturning.
    pub mu: f64,
    /// β, its standard deviation; negative if overturning becomes less likely with intensity.
    pub beta: f64,
    /// Inverse of the observed information of (μ, β).
    pub covariance: [[f64; 2]; 2],
    /// Σ [k ln Φ(z) + (n − k) ln Φ(−z)].
    pub ln_likelihood: f64,
}

/// The steps did not end at a maximum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NotConverged {
    /// Steps taken.
    pub steps: usize,
}

/// z = `height` + `slope` (u − `pivot`). The pivot moves with the weights, which keeps z exact where all of them are in one
/// place.
#[derive(Clone, Copy)]
struct Line {
    pivot: f64,
    height: f64,
    slope: f64,
}

/// Log-likelihood of a line with its derivatives, about the mean of u under the weights −d²(ln Φ)/dz².
struct Curvature {
    ln_likelihood: f64,
    /// d/d(height), and the sum of the weights.
    height: (f64, f64),
    /// d/d(slope), and the weighted sum of (u − mean)².
    slope: (f64, f64),
    mean: f64,
}

/// The maximum for `stripes` that have one with a slope other than 0: the intensities at which runs overturned and those at
/// which runs stood overlap. Whatever it gives for others means nothing.
///
/// # Errors
///
/// [`NotConverged`] where the steps come to no end.
pub(super) fn maximum(stripes: &Stripes) -> Result<Maximum, NotConverged> {
    let failed = NotConverged { steps: 0 };
    let (Some(first), Some(last)) = (stripes.all.first(), stripes.all.last()) else { return Err(failed) };
    // u from −1 to 1, whatever the unit and the spread of the intensities.
    let (middle, half) = (0.5 * (first.ln_intensity + last.ln_intensity), 0.5 * (last.ln_intensity - first.ln_intensity));
    let u: Vec<f64> = stripes.all.iter().map(|stripe| (stripe.ln_intensity - middle) / half).collect();
    let share = stripes.overturned as f64 / stripes.number() as f64;
    let mut line = Line { pivot: 0.0, height: quantile(share), slope: 0.0 };
    let mut at = curvature(stripes, &u, line);
    let mut previous = f64::INFINITY;
    for steps in 1..=MOST_STEPS {
        let from = Line { pivot: at.mean, height: line.height + line.slope * (at.mean - line.pivot), slope: line.slope };
        let (up, along) = (at.height.0 / at.height.1, at.slope.0 / at.slope.1);
        let decrement = at.height.0 * up + at.slope.0 * along;
        if !decrement.is_finite() {
            return Err(NotConverged { steps });
        }
        let least = at.ln_likelihood - ROUNDING * at.ln_likelihood.abs();
        let mut part = 1.0;
        // Armijo's rule.
        loop {
            line = Line { height: from.height + part * up, slope: from.slope + part * along, ..from };
            at = curvature(stripes, &u, line);
            if at.ln_likelihood >= least + 1e-4 * part * decrement {
                break;
            }
            part *= 0.5;
            if part < 1e-18 {
                return Err(NotConverged { steps });
            }
        }
        let size = (up.abs() / (1.0 + line.height.abs())).max(along.abs() / line.slope.abs().max(FLAT));
        if size <= LAST_STEP || (size <= NEAR_STEP && size >= previous) {
            return Ok(estimates(line, &at, middle, half));
        }
        previous = size;
    }
    Err(NotConverged { steps: MOST_STEPS })
}

fn height_at(line: Line, u: f64) -> f64 {
    line.height + line.slope * (u - line.pivot)
}

fn curvature(stripes: &Stripes, u: &[f64], line: Line) -> Curvature {
    let mut terms = Vec::with_capacity(u.len());
    let (mut ln_likelihood, mut residuals, mut weights, mut moment) = (0.0, 0.0, 0.0, 0.0);
    for (stripe, &u) in stripes.all.iter().zip(u) {
        let z = height_at(line, u);
        let (mut residual, mut weight) = (0.0, 0.0);
        for (count, sign) in [(stripe.overturned, 1.0), (stripe.stood, -1.0)] {
            if count > 0 {
                let mills = inverse_mills(sign * z);
                ln_likelihood += count as f64 * ln_cumulative(sign * z);
                residual += sign * count as f64 * mills.ratio;
                weight += count as f64 * mills.curvature;
            }
        }
        residuals += residual;
        weights += weight;
        moment += weight * (u - line.pivot);
        terms.push((u, residual, weight));
    }
    let mean = line.pivot + moment / weights;
    let (mut slope, mut spread) = (0.0, 0.0);
    for (u, residual, weight) in terms {
        slope += residual * (u - mean);
        spread += weight * (u - mean) * (u - mean);
    }
    Curvature { ln_likelihood, height: (residuals, weights), slope: (slope, spread), mean }
}

/// With μ = u₅₀ and β = 1/slope in units of `half`: dμ = −β (dh + (u₅₀ − m) ds) and dβ = −β² ds, where the height h above the
/// weighted mean m and the slope s are independent with variances 1/W and 1/S.
fn estimates(line: Line, at: &Curvature, middle: f64, half: f64) -> Maximum {
    let (beta, median) = (1.0 / line.slope, line.pivot - line.height / line.slope);
    let away = median - at.mean;
    let scale = half * half * beta * beta;
    let slope_variance = 1.0 / at.slope.1;
    let mixed = scale * beta * away * slope_variance;
    Maximum {
        mu: middle + half * median,
        beta: half * beta,
        covariance: [
            [scale * (1.0 / at.height.1 + away * away * slope_variance), mixed],
            [mixed, scale * beta * beta * slope_variance],
        ],
        ln_likelihood: at.ln_likelihood,
    }
}

impl Maximum {
    /// Standard errors of μ and β.
    pub fn standard_errors(&self) -> [f64; 2] {
        [square_root(self.covariance[0][0]), square_root(self.covariance[1][1])]
    }
}

#[cfg(test)]
mod tests {
    use super::super::observation::Observation;
    use super::*;

    fn stripes(observations: &[(f64, u32, u32)]) -> Stripes {
        let all: Vec<Observation> =
            observations.iter().map(|&(intensity, overturned, of)| Observation { intensity, overturned, of }).collect();
        Stripes::of(&all).unwrap()
    }

    #[test]
    fn two_stripes_are_met_exactly() {
        // As many parameters as stripes: the line passes through both. Shares ¼ at IM = 1 and ¾ at IM = e².
        let e2 = std::f64::consts::E * std::f64::consts::E;
        let found = maximum(&stripes(&[(1.0, 1, 4), (e2, 3, 4)])).unwrap();
        let z = quantile(0.75);
        assert!((found.mu - 1.0).abs() < 1e-14 && (found.beta - 1.0 / z).abs() < 1e-14, "{found:?}");
        let quarter: f64 = 0.25;
        let expected = 2.0 * (sprag_shared::math::ln(quarter) + 3.0 * sprag_shared::math::ln(1.0 - quarter));
        assert!((found.ln_likelihood - expected).abs() < 1e-14);
        // Each stripe has the information n φ²/(p(1 − p)) of its z: with v its inverse, var μ = v β²/2 and var β = β⁴ v/2.
        let density = super::super::normal::density(z);
        let v = 3.0 / 16.0 / (4.0 * density * density);
        let b2 = found.beta * found.beta;
        assert!((found.covariance[0][0] - 0.5 * v * b2).abs() < 1e-13);
        assert!((found.covariance[1][1] - 0.5 * v * b2 * b2).abs() < 1e-12);
        assert!(found.covariance[0][1].abs() < 1e-14);
    }

    #[test]
    fn a_hair_from_separation_there_is_a_maximum_still() {
        for gap in [1e-3, 1e-6, 1e-9] {
            // Runs a hair's breadth beyond one another, in between others that are far.
            let tight = stripes(&[(0.1, 0, 50), (1.0, 1, 1), (1.0 + gap, 0, 1), (10.0, 50, 50)]);
            let found = maximum(&tight).unwrap();
            assert!(found.beta > 0.0 && found.beta < 1.5 && (found.mu / gap - 0.5).abs() < 0.01, "{gap} {found:?}");
            // All that matters within a hair's breadth: β is of its size.
            let cluster = stripes(&[(0.1, 0, 50), (1.0, 0, 3), (1.0 + gap, 2, 3), (1.0 + 2.0 * gap, 1, 3), (10.0, 50, 50)]);
            let found = maximum(&cluster).unwrap();
            assert!(found.beta / gap > 0.5 && found.beta / gap < 10.0, "{gap} {found:?}");
            assert!(found.standard_errors().iter().all(|error| error.is_finite() && *error > 0.0));
        }
    }
}
