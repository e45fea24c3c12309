//! The sign test: whether pairs differ one way more often than a fair coin would have them.

use sprag_shared::math::{exp, ln};

/// Probability that of `one + other` pairs that differ, each as likely either way, at least as many go one way: the exact two-sided sign
/// test. Of pairs of single outcomes it is McNemar's exact test (McNemar 1947, Psychometrika 12(2)). 1 where no pair differs.
pub fn sign_test(one: usize, other: usize) -> f64 {
    let number = one + other;
    // ln of the binomial coefficients by their ratios: 2^(−n) itself is no number for n above a thousand.
    let mut term = -(number as f64) * std::f64::consts::LN_2;
    let mut sum = 0.0;
    for few in 0..=one.min(other) {
        sum += exp(term);
        term += ln((number - few) as f64 / (few + 1) as f64);
    }
    (2.0 * sum).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chances_are_those_of_a_fair_coin() {
        assert!((sign_test(0, 5) - 0.0625).abs() < 1e-12 && (sign_test(2, 8) - 112.0 / 1024.0).abs() < 1e-12);
        assert_eq!((sign_test(0, 0), sign_test(4, 4), sign_test(3, 4)), (1.0, 1.0, 1.0));
        assert_eq!(sign_test(9, 1), sign_test(1, 9));
        assert!((0.0..0.05).contains(&sign_test(900, 1100)), "more pairs than 2^(−n) has room for");
    }
}
