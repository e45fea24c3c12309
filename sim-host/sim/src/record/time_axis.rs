//! Is a time column made of equal steps?

use super::contents::StatedStep;

/// Steps may differ from their mean by this fraction: it covers single precision sums, not real jitter.
const RELATIVE_TOLERANCE: f64 = 0.01;

/// Never more than this fraction, however coarse the print: a quarter covers 0.0025 s printed with three decimals.
const LARGEST_TOLERANCE: f64 = 0.25;

/// Equal steps found in a column.
#[derive(Debug, PartialEq)]
pub(super) struct EqualSteps {
    pub start_s: f64,
    pub step: StatedStep,
}

/// Where and how a column fails to advance by equal steps.
#[derive(Debug, PartialEq)]
pub(super) struct UnequalSteps {
    /// Index of the row that comes too early or too late.
    pub row: usize,
    /// Step to that row (s).
    pub found_s: f64,
    /// Mean step (s).
    pub mean_s: f64,
}

/// Checks the times of at least two rows, printed with a last digit worth `resolution_s`.
///
/// Each time may differ from start + index·mean step by the last digit or by 1 % of the step, whichever is more, but
/// never by more than a quarter of a step. The mean is returned with no more decimals than the rounding of the ends warrants.
pub(super) fn equal_steps(times_s: &[f64], resolution_s: f64) -> Result<EqualSteps, UnequalSteps> {
    let (Some(first), Some(last)) = (times_s.first(), times_s.last()) else {
        return Err(UnequalSteps { row: 0, found_s: 0.0, mean_s: 0.0 });
    };
    let count = times_s.len().saturating_sub(1).max(1) as f64;
    let mean_s = (last - first) / count;
    let tolerance = (resolution_s * (1.0 + 1e-6)).max(RELATIVE_TOLERANCE * mean_s).min(LARGEST_TOLERANCE * mean_s);
    for (row, pair) in times_s.windows(2).enumerate() {
        let due = first + (row + 1) as f64 * mean_s;
        let found_s = pair[1] - pair[0];
        if !((pair[1] - due).abs() <= tolerance && found_s > 0.0) {
            return Err(largest_deviation(times_s, mean_s));
        }
    }
    let uncertainty = resolution_s / count;
    Ok(EqualSteps {
        start_s: *first,
        step: StatedStep {
            value_s: shortest_decimal(mean_s, uncertainty.min(RELATIVE_TOLERANCE * mean_s)),
            resolution_s: 2.0 * uncertainty,
        },
    })
}

/// The row whose own step is farthest from the usual one, which is where a person should look.
fn largest_deviation(times_s: &[f64], mean_s: f64) -> UnequalSteps {
    let mut steps: Vec<f64> = times_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    let usual = steps.get(steps.len() / 2).copied().unwrap_or(mean_s);
    let mut worst = UnequalSteps { row: 0, found_s: 0.0, mean_s };
    let mut largest = -1.0;
    for (row, pair) in times_s.windows(2).enumerate() {
        let found_s = pair[1] - pair[0];
        if (found_s - usual).abs() > largest {
            largest = (found_s - usual).abs();
            worst = UnequalSteps { row: row + 1, found_s, mean_s };
        }
    }
    worst
}

/// The value with the fewest decimals within `uncertainty` of `value`.
fn shortest_decimal(value: f64, uncertainty: f64) -> f64 {
    (0..=12)
        .filter_map(|decimals| format!("{value:.decimals$}").parse::<f64>().ok())
        .find(|rounded| *rounded > 0.0 && (rounded - value).abs() <= uncertainty.max(1e-12 * value))
        .unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounded_columns_give_the_true_step() {
        let times: Vec<f64> = (0..4000).map(|row| (f64::from(row) * 0.00244 * 1e4).round() / 1e4).collect();
        let equal = equal_steps(&times, 1e-4).unwrap();
        assert_eq!(equal.step.value_s, 0.00244);
        let times: Vec<f64> = (0..7500).map(|row| 3.0 + f64::from(row) * 0.02).collect();
        let equal = equal_steps(&times, 1e-4).unwrap();
        assert_eq!((equal.start_s, equal.step.value_s), (3.0, 0.02));
    }

    #[test]
    fn gaps_jitter_and_repeats_are_found() {
        let mut times: Vec<f64> = (0..100).map(|row| f64::from(row) * 0.01).collect();
        times.iter_mut().skip(40).for_each(|time| *time += 0.01);
        assert_eq!(equal_steps(&times, 1e-4).unwrap_err().row, 40);
        assert!(equal_steps(&[0.0, 0.01, 0.01, 0.03], 0.01).is_err());
        assert!(equal_steps(&[0.0, 0.0], 0.01).is_err());
        assert!(equal_steps(&[0.0, 0.012, 0.02, 0.03], 1e-3).is_err());
    }
}
