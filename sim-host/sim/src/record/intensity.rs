//! Intensity measures of a ground motion.

use std::f64::consts::PI;

use super::{Record, STANDARD_GRAVITY_M_S2};

/// Scalar measures of one record, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Intensity {
    /// Peak ground acceleration, max |a| (m/s²).
    pub pga_m_s2: f64,
    /// Peak ground velocity, max |v| (m/s) of [`velocity_m_s`].
    pub pgv_m_s: f64,
    /// Peak ground displacement, max |d| (m) of [`displacement_m`].
    pub pgd_m: f64,
    /// Arias intensity, see [`arias_intensity_m_s`] (m/s).
    pub arias_m_s: f64,
    /// Significant duration between 5 % and 95 % of the Arias intensity, see [`significant_duration_s`] (s).
    pub d5_95_s: f64,
}

impl Intensity {
    /// The measures of a record. All are finite and at least 0.
    pub fn of(record: &Record) -> Intensity {
        let (acceleration, step) = (&record.acceleration_m_s2, record.time_step_s);
        let velocity = velocity_m_s(acceleration, step);
        Intensity {
            pga_m_s2: peak(acceleration),
            pgv_m_s: peak(&velocity),
            pgd_m: peak(&displacement_m(&velocity, step)),
            arias_m_s: arias_intensity_m_s(acceleration, step),
            d5_95_s: significant_duration_s(acceleration, step, 0.05, 0.95),
        }
    }
}

/// Largest magnitude; 0 for no values.
pub fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |peak, value| peak.max(value.abs()))
}

/// Trapezoidal integral from 0, one value per sample.
pub fn integral(values: &[f64], step_s: f64) -> Vec<f64> {
    let mut sum = 0.0;
    let steps = values.windows(2).map(|pair| {
        sum += 0.5 * (pair[0] + pair[1]) * step_s;
        sum
    });
    std::iter::once(0.0).chain(steps).take(values.len()).collect()
}

/// Ground velocity (m/s): the trapezoidal integral of the acceleration (m/s²) from rest, less its own least-squares
/// straight line c0 + c1 t over the whole record. That is the only baseline treatment; the acceleration is unchanged.
pub fn velocity_m_s(acceleration_m_s2: &[f64], step_s: f64) -> Vec<f64> {
    let mut velocity = integral(acceleration_m_s2, step_s);
    let count = velocity.len() as f64;
    let centre = 0.5 * (count - 1.0);
    let mean = velocity.iter().sum::<f64>() / count;
    let moment: f64 = velocity.iter().enumerate().map(|(index, v)| (index as f64 - centre) * v).sum();
    let spread = count * (count * count - 1.0) / 12.0;
    let slope = if spread > 0.0 { moment / spread } else { 0.0 };
    velocity.iter_mut().enumerate().for_each(|(index, v)| *v -= mean + slope * (index as f64 - centre));
    velocity
}

/// Ground displacement (m): the trapezoidal integral of [`velocity_m_s`] from 0, with nothing subtracted. Records
/// that were not corrected at long periods have a PGD that means little.
pub fn displacement_m(velocity_m_s: &[f64], step_s: f64) -> Vec<f64> {
    integral(velocity_m_s, step_s)
}

/// Arias intensity (m/s), Arias (1970): I_A = π/(2g) ∫ a² dt over the record, with g = 9.80665 m/s².
///
/// The integral is the trapezoidal sum of a² (m²/s⁴), as published values have it; for a band-limited motion that sum is
/// exact, while integrating the square of straight lines between the samples loses up to 14 % in recorded motions.
pub fn arias_intensity_m_s(acceleration_m_s2: &[f64], step_s: f64) -> f64 {
    PI / (2.0 * STANDARD_GRAVITY_M_S2) * squares(acceleration_m_s2).sum::<f64>() * step_s
}

/// Trapezoidal integral of a² over each step, in units of the step.
fn squares(acceleration: &[f64]) -> impl Iterator<Item = f64> + '_ {
    acceleration.windows(2).map(|pair| 0.5 * (pair[0] * pair[0] + pair[1] * pair[1]))
}

/// Significant duration (s), Trifunac and Brady (1975): the time between the instants at which ∫ a² dt reaches the
/// fractions `from` and `to` of its final value, 0 ≤ `from` ≤ `to` ≤ 1. The integral is the one of
/// [`arias_intensity_m_s`]; the instants lie between samples by linear interpolation of the integral. 0 for a record
/// without motion.
pub fn significant_duration_s(acceleration_m_s2: &[f64], step_s: f64, from: f64, to: f64) -> f64 {
    let total: f64 = squares(acceleration_m_s2).sum();
    if total <= 0.0 {
        return 0.0;
    }
    let instant = |fraction: f64| {
        let due = fraction * total;
        let mut sum = 0.0;
        for (index, part) in squares(acceleration_m_s2).enumerate() {
            if sum + part >= due && part > 0.0 {
                return (index as f64 + ((due - sum) / part).clamp(0.0, 1.0)) * step_s;
            }
            sum += part;
        }
        acceleration_m_s2.len().saturating_sub(1) as f64 * step_s
    };
    (instant(to) - instant(from)).max(0.0)
}

/// Cumulative absolute velocity (m/s): CAV = ∫|a| dt of an acceleration (m/s²) that is linear between samples. A line from a₀
/// to a₁ of one sign has the mean (|a₀| + |a₁|)/2; one that changes sign leaves two triangles, of mean (a₀² + a₁²)/(2(|a₀| + |a₁|)).
pub fn cumulative_absolute_velocity_m_s(acceleration_m_s2: &[f64], step_s: f64) -> f64 {
    let mean = |a0: f64, a1: f64| {
        let sum = a0.abs() + a1.abs();
        if (a0 < 0.0) == (a1 < 0.0) || sum == 0.0 { 0.5 * sum } else { 0.5 * (a0 / sum * a0 + a1 / sum * a1) }
    };
    acceleration_m_s2.windows(2).map(|pair| mean(pair[0], pair[1])).sum::<f64>() * step_s
}

/// Uniform duration t_uni (s), the paper's Figure 14: the total time during which |a| exceeds a threshold, there
/// g tan α (9.80665 tan α m/s², the uplift acceleration of a block of slenderness α), so that p t_uni is dimensionless.
///
/// Crossing times are exact for an acceleration (m/s²) that is linear between samples. `threshold_m_s2` ≥ 0.
pub fn uniform_duration_s(acceleration_m_s2: &[f64], step_s: f64, threshold_m_s2: f64) -> f64 {
    acceleration_m_s2
        .windows(2)
        .map(|pair| part_above(pair[0], pair[1], threshold_m_s2) + part_above(-pair[0], -pair[1], threshold_m_s2))
        .sum::<f64>()
        * step_s
}

/// Fraction of a step during which the line from `a0` to `a1` is above the threshold.
fn part_above(a0: f64, a1: f64, threshold: f64) -> f64 {
    match (a0 > threshold, a1 > threshold) {
        (true, true) => 1.0,
        (true, false) => (a0 - threshold) / (a0 - a1),
        (false, true) => (a1 - threshold) / (a1 - a0),
        (false, false) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprag_shared::math;

    const STEP: f64 = 1e-3;

    /// Two cycles of A sin(2πt) from 1 s to 3 s, sampled over 4 s.
    fn sine_burst(amplitude: f64) -> Vec<f64> {
        (0..=4000)
            .map(|i| f64::from(i) * STEP)
            .map(|t| if (1.0..3.0).contains(&t) { amplitude * math::sin(2.0 * PI * t) } else { 0.0 })
            .collect()
    }

    #[test]
    fn sine_burst_matches_closed_forms() {
        let a = sine_burst(3.0);
        assert!((peak(&a) - 3.0).abs() < 1e-5);
        assert!((arias_intensity_m_s(&a, STEP) - PI / (2.0 * 9.80665) * 9.0 * 0.5 * 2.0).abs() < 1e-5);
        // Velocity from rest is A/ω (1 − cos ωt) within the burst: peak 2A/ω.
        assert!((peak(&integral(&a, STEP)) - 2.0 * 3.0 / (2.0 * PI)).abs() < 1e-5);
        // |sin| > 1/2 during two thirds of the time.
        assert!((uniform_duration_s(&a, STEP, 1.5) - 2.0 * 2.0 / 3.0).abs() < 1e-5);
        // Husid: t − sin(2ωt)/(2ω) = 0.05·2 gives t = x and, by symmetry, 2 − x.
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let x = 0.5 * (low + high);
            if x - math::sin(4.0 * PI * x) / (4.0 * PI) < 0.1 { low = x } else { high = x }
        }
        assert!((significant_duration_s(&a, STEP, 0.05, 0.95) - (2.0 - 2.0 * low)).abs() < 1e-5);
    }

    #[test]
    fn rectangles_lines_and_ramps_match_closed_forms() {
        let rectangle = [2.0; 11];
        assert!((arias_intensity_m_s(&rectangle, 0.1) - PI / (2.0 * 9.80665) * 4.0).abs() < 1e-12);
        assert!((significant_duration_s(&rectangle, 0.1, 0.05, 0.95) - 0.9).abs() < 1e-12);
        assert!((uniform_duration_s(&rectangle, 0.1, 1.9) - 1.0).abs() < 1e-12);
        assert_eq!(uniform_duration_s(&rectangle, 0.1, 2.0), 0.0);
        // A line from −1 to 3: above 1 for half of the step, |a| above 0.5 for 1/8 + 5/8 of it.
        assert!((uniform_duration_s(&[-1.0, 3.0], 1.0, 1.0) - 0.5).abs() < 1e-12);
        assert!((uniform_duration_s(&[-1.0, 3.0], 1.0, 0.5) - 0.75).abs() < 1e-12);
        // A ramp to 1 within 1 s: ∫a² = 1/3, and it reaches the fraction f at the cube root of f.
        let ramp: Vec<f64> = (0..=4000).map(|i| f64::from(i) / 4000.0).collect();
        assert!((arias_intensity_m_s(&ramp, 1.0 / 4000.0) - PI / (2.0 * 9.80665) / 3.0).abs() < 1e-7);
        assert!((significant_duration_s(&ramp, 1.0 / 4000.0, 0.125, 1.0) - 0.5).abs() < 1e-6);
        // The mean square of a sine is 1/2 at any number of samples per cycle above two.
        let sine: Vec<f64> = (0..=30).map(|i| math::sin(2.0 * PI * f64::from(i) / 3.0)).collect();
        assert!((arias_intensity_m_s(&sine, 0.1) - PI / (2.0 * 9.80665) * 0.5 * 3.0).abs() < 1e-12);
    }

    /// CAV of a zigzag between ±A is the area of its triangles, A/2 a second; trapezoids of |a| would say A.
    #[test]
    fn the_cumulative_absolute_velocity_is_that_of_straight_lines() {
        let zigzag: Vec<f64> = (0..=10).map(|i| if i % 2 == 0 { 3.0 } else { -3.0 }).collect();
        assert!((cumulative_absolute_velocity_m_s(&zigzag, 0.1) - 1.5).abs() < 1e-12);
        // −1 to 3 crosses zero after a quarter: triangles of 1/8 and 9/8. 3 to 1 is a trapezoid of 2, 1 to 0 a triangle of 1/2.
        let line = |samples: &[f64]| cumulative_absolute_velocity_m_s(samples, 1.0);
        assert!((line(&[-1.0, 3.0, 1.0, 0.0]) - 3.75).abs() < 1e-12);
        assert_eq!((line(&[0.0, 0.0]), line(&[0.0, -2.0]), line(&[-2.0, 0.0]), line(&[-2.0, -4.0])), (0.0, 1.0, 1.0, 3.0));
    }

    /// Of v = 1 + 2t sampled at 0, 1, 2 and 3 s: d = t + t².
    #[test]
    fn a_displacement_begins_at_0_whatever_the_velocity_is() {
        assert_eq!(displacement_m(&[1.0, 3.0, 5.0, 7.0], 1.0), [0.0, 2.0, 6.0, 12.0]);
        assert!(displacement_m(&[], 1.0).is_empty());
    }

    #[test]
    fn a_constant_offset_of_acceleration_leaves_no_velocity() {
        assert!(peak(&velocity_m_s(&[0.3; 500], 0.01)) < 1e-12);
        assert_eq!(peak(&velocity_m_s(&[0.0, 0.0], 0.01)), 0.0);
        assert_eq!(significant_duration_s(&[0.0, 0.0], 0.01, 0.05, 0.95), 0.0);
    }
}
