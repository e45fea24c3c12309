//! Quantiles of a sample.

/// The `share` quantile of `values`, interpolated linearly between order statistics: type 7 of Hyndman and Fan (1996), The
/// American Statistician 50(4), which has x₍₁₎ and x₍ₙ₎ at the shares 0 and 1 and is the default of R and NumPy.
///
/// `share` is 0 to 1. `None` for no values, for a NaN among them, and for a share outside. Infinite values have their place in
/// the order; what lies between a finite value and an infinite one is infinite, and what lies between −∞ and ∞ is `None`.
pub fn quantile(values: &[f64], share: f64) -> Option<f64> {
    quantiles(values, [share]).map(|[value]| value)
}

/// Those of all `shares`, in their order, with one sorting; see [`quantile`]. `None` if one of them has no value.
pub fn quantiles<const N: usize>(values: &[f64], shares: [f64; N]) -> Option<[f64; N]> {
    if values.iter().any(|value| value.is_nan()) {
        return None;
    }
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let mut found = [0.0; N];
    for (found, share) in found.iter_mut().zip(shares) {
        *found = of_sorted(&sorted, share)?;
    }
    Some(found)
}

/// The least of `values` that at least the `share` of them do not exceed: x₍⌈share·n⌉₎, and x₍₁₎ at the share 0. Type 1 of Hyndman and Fan
/// (1996), the inverse of the empirical distribution, which unlike [`quantile`] is one of the values. `None` as for [`quantile`].
pub fn order_statistic(values: &[f64], share: f64) -> Option<f64> {
    if values.iter().any(|value| value.is_nan()) || !(0.0..=1.0).contains(&share) {
        return None;
    }
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    // Shares of so many and not their product with `share`, whose rounding would ask for one more: 0.55 · 100 is above 55.
    (1..=sorted.len()).find(|&held| held as f64 / sorted.len() as f64 >= share).and_then(|held| sorted.get(held - 1).copied())
}

fn of_sorted(sorted: &[f64], share: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    if !(0.0..=1.0).contains(&share) {
        return None;
    }
    let place = share * last as f64;
    let below = (place.floor() as usize).min(last);
    let part = place - below as f64;
    let (low, high) = (sorted[below], sorted[(below + 1).min(last)]);
    // The value itself where nothing is to be interpolated: 0·∞ and ∞ − ∞ are not numbers.
    let value = if part == 0.0 || low == high {
        low
    } else if (high - low).is_finite() {
        low + part * (high - low)
    } else {
        (1.0 - part) * low + part * high
    };
    (!value.is_nan()).then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_interpolate_between_order_statistics() {
        let values = [3.0, 1.0, 2.0, 4.0];
        assert_eq!(quantile(&values, 0.0), Some(1.0));
        assert_eq!(quantile(&values, 0.5), Some(2.5));
        assert_eq!(quantile(&values, 1.0), Some(4.0));
        assert!((quantile(&values, 0.95).unwrap() - 3.85).abs() < 1e-15);
        let hundred: Vec<f64> = (0..=100).rev().map(f64::from).collect();
        assert_eq!(quantiles(&hundred, [0.16, 0.5, 0.84]), Some([16.0, 50.0, 84.0]));
        assert_eq!(quantiles(&[0.3], [0.16, 0.5, 0.84]), Some([0.3; 3]));
        assert_eq!(quantile(&[1.0, 2.0], 0.5), Some(1.5));
    }

    /// The definition itself: the share is kept at the value, and not at a smaller one.
    #[test]
    fn an_order_statistic_holds_for_its_share_of_the_values() {
        for number in 1..=120_usize {
            let values: Vec<f64> = (0..number).map(|index| ((index * 37) % number) as f64).collect();
            for percent in 0..=100_u32 {
                let found = order_statistic(&values, f64::from(percent) / 100.0).unwrap();
                let holds = |limit: f64| values.iter().filter(|value| **value <= limit).count();
                // In whole numbers, which do not round.
                let enough = |count: usize| 100 * count >= percent as usize * number;
                assert!(enough(holds(found)) && values.contains(&found), "{percent} % of {number}: {found}");
                assert!(found == 0.0 || !enough(holds(found - 1.0)), "{percent} % of {number}: {found}");
            }
        }
        assert_eq!(order_statistic(&[1.0, f64::INFINITY], 0.6), Some(f64::INFINITY));
    }

    #[test]
    fn what_has_no_quantile_has_none() {
        assert_eq!([order_statistic(&[], 0.5), order_statistic(&[f64::NAN], 0.5), order_statistic(&[1.0], 1.1)], [None; 3]);
        assert_eq!(quantile(&[], 0.5), None);
        assert_eq!(quantile(&[1.0, f64::NAN], 0.0), None);
        assert_eq!(quantile(&[1.0, 2.0], -0.1), None);
        assert_eq!(quantile(&[1.0, 2.0], 1.1), None);
        assert_eq!(quantile(&[1.0, 2.0], f64::NAN), None);
        assert_eq!(quantiles(&[1.0, 2.0], [0.5, 2.0]), None);
    }

    #[test]
    fn infinite_values_are_in_order_like_others() {
        let values = [f64::INFINITY, 1.0, f64::INFINITY];
        assert_eq!(quantile(&values, 0.0), Some(1.0));
        assert_eq!(quantile(&values, 0.25), Some(f64::INFINITY));
        assert_eq!(quantile(&values, 0.75), Some(f64::INFINITY));
        assert_eq!(quantile(&[f64::NEG_INFINITY, f64::INFINITY], 0.5), None);
        assert_eq!(quantile(&[f64::NEG_INFINITY, 0.0], 0.5), Some(f64::NEG_INFINITY));
    }
}
