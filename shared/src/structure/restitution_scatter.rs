//! Scatter of the restitution from impact to impact.
//!
//! No two impacts of a block are alike: grains, dust and edges decide how much of the velocity each leaves, and repeated tests of one specimen
//! under one motion differ while their statistics do not (Bachmann et al. 2018, Is rocking motion predictable?, Earthquake Engng Struct. Dyn. 47).
//! Each impact has an η of its own here, from a normal distribution about the one of the structure, that of an error of many small causes,
//! truncated to 0 < η ≤ 1: no impact reverses the motion, and none adds energy.

use super::error::{ParameterError, require};
use crate::math;
use crate::math::split_mix;

/// Pairs of words that one impact may take; half of all normal deviates or more are within the range, so that none takes as many.
const MOST_TRIES: u64 = 128;

/// Scatter of η from impact to impact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RestitutionScatter {
    /// Standard deviation of η before it is truncated, 0 to 0.5; 0 turns the scatter off.
    pub deviation: f64,
    /// Of the draws.
    pub seed: u64,
}

impl RestitutionScatter {
    /// Every impact alike.
    pub const NONE: RestitutionScatter = RestitutionScatter { deviation: 0.0, seed: 0 };

    /// Whether impacts differ.
    pub fn is_on(&self) -> bool {
        self.deviation > 0.0
    }

    /// Checks the range.
    ///
    /// # Errors
    /// [`ParameterError`] for a deviation outside 0 to 0.5.
    pub fn check(&self) -> Result<(), ParameterError> {
        let deviation = self.deviation;
        require("restitution_scatter", deviation, (0.0..=0.5).contains(&deviation), "from 0 to 0.5").map(|_| ())
    }

    /// η of impact number `impact`, counted from 1, about `mean`, 0 to 1:
    ///
    /// η = mean + deviation √(−2 ln(1 − u)) cos 2πv, the first such value with 0 < η ≤ 1 (Box and Muller 1958; rejection),
    ///
    /// with u and v from words 256·impact + 2j and the next of SplitMix64, j = 0, 1, …. Its seed is the first word of the scatter's own, so that
    /// missed engagements of the same seed are independent. Neither steps nor times are asked, so that the k-th impact is the same by
    /// every method and on every machine. A mean at an end of the range has half of the distribution, one near it a mean that is shifted inwards.
    pub fn draw(&self, impact: u32, mean: f64) -> f64 {
        let stream = split_mix::word(self.seed, 1);
        let uniform = |number: u64| (split_mix::word(stream, number) >> 11) as f64 / (1_u64 << 53) as f64;
        let of = |try_number: u64| {
            let number = 256 * u64::from(impact) + 2 * try_number;
            let radius = math::square_root(-2.0 * math::ln(1.0 - uniform(number)));
            mean + self.deviation * radius * math::cos(core::f64::consts::TAU * uniform(number + 1))
        };
        (0..MOST_TRIES).map(of).find(|eta| *eta > 0.0 && *eta <= 1.0).unwrap_or(mean)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean and standard deviation of a normal distribution truncated to 0 to 1, by its density.
    fn truncated(mean: f64, deviation: f64) -> (f64, f64) {
        let count = 200_000;
        let (mut mass, mut first, mut second) = (0.0, 0.0, 0.0);
        for i in 0..count {
            let x = (f64::from(i) + 0.5) / f64::from(count);
            let density = math::exp(-0.5 * ((x - mean) / deviation) * ((x - mean) / deviation));
            (mass, first, second) = (mass + density, first + density * x, second + density * x * x);
        }
        let centre = first / mass;
        (centre, (second / mass - centre * centre).sqrt())
    }

    #[test]
    fn draws_have_the_mean_and_spread_of_the_truncated_normal_distribution() {
        let count = 200_000;
        for (mean, deviation) in [(0.85, 0.02), (0.85, 0.1), (0.955, 0.05), (1.0, 0.1), (0.0, 0.2), (0.5, 0.5)] {
            let scatter = RestitutionScatter { deviation, seed: 11 };
            let (mut sum, mut squares) = (0.0, 0.0);
            for impact in 1..=count {
                let eta = scatter.draw(impact, mean);
                assert!(eta > 0.0 && eta <= 1.0, "{eta}");
                (sum, squares) = (sum + eta, squares + eta * eta);
            }
            let found = sum / f64::from(count);
            let spread = (squares / f64::from(count) - found * found).sqrt();
            let (expected, width) = truncated(mean, deviation);
            let error = width / f64::from(count).sqrt();
            assert!((found - expected).abs() < 4.0 * error, "{mean} {deviation}: {found} and {expected}");
            assert!((spread - width).abs() < 4.0 * error, "{mean} {deviation}: {spread} and {width}");
        }
    }

    /// The share beyond one and two standard deviations, and neighbours that know nothing of one another, of impacts and of seeds.
    #[test]
    fn draws_are_normal_and_independent() {
        let count = 100_000_u32;
        let of = |seed: u64, impact: u32| (RestitutionScatter { deviation: 0.05, seed }.draw(impact, 0.6) - 0.6) / 0.05;
        let beyond = |limit: f64| {
            let number = (1..=count).filter(|impact| of(3, *impact).abs() > limit).count();
            number as f64 / f64::from(count)
        };
        for limit in [1.0, 2.0, 3.0] {
            let expected = math::erfc(limit / core::f64::consts::SQRT_2);
            let error = (expected * (1.0 - expected) / f64::from(count)).sqrt();
            assert!((beyond(limit) - expected).abs() < 4.0 * error, "{limit}: {} and {expected}", beyond(limit));
        }
        let next = (1..=count).map(|impact| of(3, impact) * of(3, impact + 1)).sum::<f64>() / f64::from(count);
        let seeds = (0..count).map(|seed| of(u64::from(seed), 7) * of(u64::from(seed) + 1, 7)).sum::<f64>() / f64::from(count);
        assert!(next.abs() < 4.0 / f64::from(count).sqrt() && seeds.abs() < 4.0 / f64::from(count).sqrt(), "{next} {seeds}");
    }

    #[test]
    fn a_deviation_out_of_its_range_is_refused() {
        for deviation in [-0.01, 0.51, f64::NAN, f64::INFINITY] {
            let error = RestitutionScatter { deviation, seed: 0 }.check().unwrap_err();
            assert_eq!((error.parameter, error.range), ("restitution_scatter", "from 0 to 0.5"));
        }
        assert!(RestitutionScatter { deviation: 0.5, seed: u64::MAX }.check().is_ok());
    }
}
