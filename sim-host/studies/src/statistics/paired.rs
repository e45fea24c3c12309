//! Paired differences: how much two designs differ under the same motions, and how sure that is.

use rayon::prelude::*;
use serde::Serialize;

use super::bootstrap::Bootstrap;
use super::resample::draws;
use super::sign_test::sign_test;
use super::{Band, Level, quantiles};

/// Pairs of which those of one group depend on each other, and groups do not: motions of one earthquake, one record at several scales.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Groups {
    /// The group of each pair.
    of: Vec<usize>,
    number: usize,
}

/// What paired differences say together.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Paired {
    /// Pairs.
    pub pairs: usize,
    /// Mean difference over the pairs.
    pub difference: f64,
    /// Its band: percentiles of the bootstrap over groups (Efron and Tibshirani 1993, Chapter 13). `None` where only one group has pairs,
    /// which says nothing of how groups scatter.
    pub band: Option<Band>,
    /// Groups whose differences sum up to more than 0.
    pub groups_above: usize,
    /// Groups whose differences sum up to less than 0.
    pub groups_below: usize,
    /// Probability that groups without a difference are at least as far apart: [`sign_test`] of the two counts.
    pub chance: f64,
}

impl Groups {
    /// Groups by `names`, one a pair: those of one name belong together.
    pub fn of<N: AsRef<str>>(names: &[N]) -> Groups {
        let mut known = std::collections::HashMap::new();
        let of: Vec<usize> = names
            .iter()
            .map(|name| {
                let next = known.len();
                *known.entry(name.as_ref()).or_insert(next)
            })
            .collect();
        let number = known.len();
        Groups { of, number }
    }

    /// How many groups there are.
    pub fn number(&self) -> usize {
        self.number
    }

    /// The group of each pair.
    pub fn of_pairs(&self) -> &[usize] {
        &self.of
    }

    /// How often each group is drawn by resample `index`: as many groups as there are, with replacement. The resamples of one seed are the
    /// same for all that is compared over these groups.
    pub fn weights(&self, seed: u64, index: u32) -> Vec<u32> {
        let mut weights = vec![0; self.number];
        draws(seed, index, self.number as u64).take(self.number).for_each(|group| weights[group as usize] += 1);
        weights
    }

    /// What pairs say that were tried once or several times, each under specimens of its own: the sum of the differences of each, and of how
    /// many, in the order of the groups' names; a pair without one is left out. `None` without any. Sums of whole numbers are exact, so that
    /// differences that cancel are none.
    ///
    /// Neither the number of threads nor what else is compared changes a bit.
    pub fn paired_repeatedly(&self, sums_of_pairs: &[Option<(f64, u32)>], bootstrap: Bootstrap) -> Option<Paired> {
        let mut sums = vec![(0.0, 0_u32); self.number];
        for (group, (sum, count)) in self.of.iter().zip(sums_of_pairs).filter_map(|(group, found)| Some((*group, (*found)?))) {
            sums[group].0 += sum;
            sums[group].1 += count;
        }
        let mean = |weights: &mut dyn Iterator<Item = u32>| {
            let mut total = (0.0, 0.0);
            for (weight, (sum, count)) in weights.zip(&sums) {
                total.0 += f64::from(weight) * sum;
                total.1 += f64::from(weight) * f64::from(*count);
            }
            (total.1 > 0.0).then(|| total.0 / total.1)
        };
        let difference = mean(&mut std::iter::repeat(1))?;
        let band = || {
            // A resample of groups that have no pair has no mean.
            let means: Vec<f64> = (0..bootstrap.resamples)
                .into_par_iter()
                .filter_map(|index| mean(&mut self.weights(bootstrap.seed, index).into_iter()))
                .collect();
            let [low, high] = quantiles(&means, bootstrap.level.shares())?;
            Some(Band { low, high })
        };
        let several = sums.iter().filter(|(_, count)| *count > 0).count() > 1;
        let count = |of: fn(f64) -> bool| sums.iter().filter(|(sum, _)| of(*sum)).count();
        let (groups_above, groups_below) = (count(|sum| sum > 0.0), count(|sum| sum < 0.0));
        Some(Paired {
            pairs: sums_of_pairs.iter().flatten().count(),
            difference,
            band: if several { Some(band()?) } else { None },
            groups_above,
            groups_below,
            chance: sign_test(groups_above, groups_below),
        })
    }
}

impl Paired {
    /// Whether the difference is above 0 (or below) for sure at `level`: 0 lies outside of the band, and groups without a difference would
    /// not come as far apart. The band alone is too narrow where few groups differ: four that all go one way leave 0 outside of it.
    pub fn is_sure(&self, level: Level) -> bool {
        self.band.is_some_and(|band| band.low > 0.0 || band.high < 0.0) && self.chance <= 1.0 - level.value()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    const BOOTSTRAP: Bootstrap = Bootstrap { resamples: 400, seed: 3, level: Level::COMMON };

    impl Groups {
        /// Of pairs that were tried once.
        fn paired(&self, differences: &[Option<f64>], bootstrap: Bootstrap) -> Option<Paired> {
            let once: Vec<Option<(f64, u32)>> = differences.iter().map(|difference| Some(((*difference)?, 1))).collect();
            self.paired_repeatedly(&once, bootstrap)
        }
    }

    fn each_alone(number: usize) -> Groups {
        Groups::of(&(0..number).map(|index| index.to_string()).collect::<Vec<_>>())
    }

    #[test]
    fn what_does_not_differ_has_no_band() {
        let same = each_alone(30).paired(&[Some(0.0); 30], BOOTSTRAP).unwrap();
        assert_eq!((same.difference, same.band, same.chance), (0.0, Some(Band { low: 0.0, high: 0.0 }), 1.0));
        assert!(!same.is_sure(Level::COMMON));
        assert_eq!(each_alone(3).paired(&[None; 3], BOOTSTRAP), None);
    }

    #[test]
    fn one_group_has_a_difference_and_no_band() {
        let one = Groups::of(&["a"; 8]).paired(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0].map(Some), BOOTSTRAP).unwrap();
        assert_eq!((one.pairs, one.difference, one.band, one.groups_above), (8, 0.25, None, 1));
        assert!(!one.is_sure(Level::new(0.01).unwrap()));
        // Groups without a pair are none.
        assert_eq!(each_alone(3).paired(&[None, Some(1.0), None], BOOTSTRAP).unwrap().band, None);
        assert!(each_alone(3).paired(&[None, Some(1.0), Some(0.0)], BOOTSTRAP).unwrap().band.is_some());
    }

    #[test]
    fn a_group_counts_once_however_often_it_is_repeated() {
        let names: Vec<&str> = ["a", "b", "c", "d", "e", "f", "g"].into_iter().flat_map(|name| [name; 10]).collect();
        let groups = Groups::of(&names);
        assert_eq!((groups.number(), groups.of_pairs()[69]), (7, 6));
        // One group of seven differs, in all of its ten pairs.
        let differences: Vec<Option<f64>> = (0..70).map(|index| Some(f64::from(u8::from(index < 10)))).collect();
        let found = groups.paired(&differences, BOOTSTRAP).unwrap();
        assert!((found.difference - 1.0 / 7.0).abs() < 1e-12 && found.band.unwrap().low == 0.0 && !found.is_sure(Level::COMMON));
        assert_eq!((found.groups_above, found.groups_below, found.pairs), (1, 0, 70));
        // Taken as independent, they would be sure.
        assert!(each_alone(70).paired(&differences, BOOTSTRAP).unwrap().is_sure(Level::COMMON));
    }

    /// Four motions of an earthquake under ten specimens, one of them better by as many as the others are worse together.
    #[test]
    fn differences_that_cancel_are_none() {
        let groups = Groups::of(&["a", "a", "a", "a", "b"]);
        let sums = [1.0, 1.0, 1.0, -3.0, 0.0].map(|sum| Some((sum, 10)));
        let found = groups.paired_repeatedly(&sums, BOOTSTRAP).unwrap();
        assert_eq!((found.pairs, found.difference, found.groups_above, found.groups_below), (5, 0.0, 0, 0));
        assert_eq!(found.band, Some(Band { low: 0.0, high: 0.0 }));
        // Their means do not cancel.
        let means = sums.map(|pair| pair.map(|(sum, count)| sum / f64::from(count)));
        assert_eq!(groups.paired(&means, BOOTSTRAP).unwrap().groups_above, 1);
    }

    #[test]
    fn the_other_way_round_is_the_same_below_zero() {
        let differences: Vec<f64> = (0..40).map(|index| f64::from((index * 7) % 5) - 1.0).collect();
        let [one, other] = [1.0, -1.0].map(|sign| {
            let signed: Vec<Option<f64>> = differences.iter().map(|value| Some(sign * value)).collect();
            each_alone(40).paired(&signed, BOOTSTRAP).unwrap()
        });
        assert_eq!((one.difference, one.groups_above, one.chance), (-other.difference, other.groups_below, other.chance));
        let [low, high] = [one.band.unwrap().low, other.band.unwrap().high];
        assert!((low + high).abs() < 1e-12 && one.is_sure(Level::COMMON) == other.is_sure(Level::COMMON));
    }

    /// Two designs of which one overturns with a probability of 0.3 and the other of 0.15, over groups of one to four motions that share
    /// a part of their luck; what the band says of the difference, over and over.
    #[test]
    fn bands_hold_the_difference_as_often_as_their_level_says() {
        let mut words = ChaCha8Rng::seed_from_u64(11);
        let mut uniform = || (words.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        let (studies, level) = (400, 0.9);
        let bootstrap = Bootstrap { level: Level::new(level).unwrap(), resamples: 300, seed: 5 };
        let (mut held, mut sure_of_nothing) = (0, 0);
        for _ in 0..studies {
            let (mut names, mut differences, mut nothing) = (Vec::new(), Vec::new(), Vec::new());
            for group in 0..60 {
                let shared = uniform();
                for _ in 0..1 + group % 4 {
                    // Half of the motions do what their group does: shares stay those of the uniform numbers.
                    let mut luck = || if uniform() < 0.5 { shared } else { uniform() };
                    let (one, other, third) = (luck(), luck(), luck());
                    let of = |luck: f64, probability: f64| f64::from(u8::from(luck < probability));
                    names.push(group.to_string());
                    differences.push(Some(of(one, 0.3) - of(other, 0.15)));
                    nothing.push(Some(of(one, 0.3) - of(third, 0.3)));
                }
            }
            let groups = Groups::of(&names);
            let found = groups.paired(&differences, bootstrap).unwrap();
            held += usize::from(found.band.is_some_and(|band| band.low <= 0.15 && 0.15 <= band.high));
            sure_of_nothing += usize::from(groups.paired(&nothing, bootstrap).unwrap().is_sure(bootstrap.level));
        }
        // Three standard deviations of a share of 0.9 in 400 are 0.045.
        let share = held as f64 / f64::from(studies);
        assert!((share - level).abs() < 0.045, "{share}");
        assert!(sure_of_nothing as f64 / f64::from(studies) <= 0.1 + 0.045, "{sure_of_nothing}");
    }
}
