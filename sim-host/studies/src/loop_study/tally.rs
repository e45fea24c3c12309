//! Overturned runs counted by specimen of the sensors, and how sure their mean is.

use sprag_report::text_table::number;
use sprag_shared::math::square_root;

use crate::statistics::{Level, sign_test};

/// A mean over specimens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mean {
    /// The mean, …
    pub value: f64,
    /// … and the half-width of its 95 % band by Student's t; 0 where there is but one specimen.
    pub half: f64,
}

impl Mean {
    /// Mean of `values`, one a specimen.
    pub fn of(values: &[f64]) -> Mean {
        let count = values.len() as f64;
        let value = values.iter().sum::<f64>() / count;
        let square = values.iter().map(|each| (each - value) * (each - value)).sum::<f64>();
        let freedom = values.len().saturating_sub(1);
        let error = square_root(square / (freedom.max(1) as f64 * count));
        Mean { value, half: if freedom > 0 { Level::COMMON.student(freedom as u32) * error } else { 0.0 } }
    }

    /// 0 lies outside of the band.
    pub fn differs(&self) -> bool {
        self.value.abs() > self.half
    }

    /// In percent, with its half-width where there is one.
    pub fn percent(&self, sign: bool) -> String {
        let value = number(100.0 * self.value, 1);
        let value = if sign && self.value > 0.0 { format!("+{value}") } else { value };
        if self.half > 0.0 { format!("{value} ± {}", number(100.0 * self.half, 1)) } else { value }
    }
}

/// Which of the runs of one law overturned; run i is one of specimen i mod the number of specimens.
#[derive(Clone, Debug, PartialEq)]
pub struct Tally {
    /// By run.
    pub overturned: Vec<bool>,
    /// Specimens.
    pub specimens: usize,
}

impl Tally {
    /// How many.
    pub fn count(&self) -> usize {
        self.overturned.iter().filter(|&&overturned| overturned).count()
    }

    /// The share of each specimen that has a run.
    fn shares(&self) -> Vec<f64> {
        let of = |specimen: usize| self.overturned.iter().skip(specimen).step_by(self.specimens);
        let count = |specimen: usize| of(specimen).filter(|&&overturned| overturned).count();
        let with_runs = 0..self.specimens.min(self.overturned.len());
        with_runs.map(|specimen| count(specimen) as f64 / of(specimen).count() as f64).collect()
    }

    /// The mean share.
    pub fn share(&self) -> Mean {
        Mean::of(&self.shares())
    }

    /// How much larger the share is than that of `other` under the same motions and specimens.
    pub fn beyond(&self, other: &Tally) -> Mean {
        Mean::of(&self.shares().iter().zip(other.shares()).map(|(own, other)| own - other).collect::<Vec<f64>>())
    }
}

/// Under how many motions one law overturns less or more often than another.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pairs {
    /// Less often.
    pub less: usize,
    /// More often.
    pub more: usize,
}

impl Pairs {
    /// Of a law's tallies beside another's, of which run i is shaken by motion i mod `different`. What one motion does at several
    /// scales, or in several tallies, counts once: as less or more often in all.
    pub fn of(beside: &[(&Tally, &Tally)], different: usize) -> Pairs {
        let mut net = vec![0_i32; different];
        for (law, other) in beside {
            for (index, (&own, &other)) in law.overturned.iter().zip(&other.overturned).enumerate() {
                net[index % different] += i32::from(own) - i32::from(other);
            }
        }
        let count = |sign: i32| net.iter().filter(|net| net.signum() == sign).count();
        Pairs { less: count(-1), more: count(1) }
    }

    /// Sum of both tallies.
    #[must_use]
    pub fn plus(self, other: Pairs) -> Pairs {
        Pairs { less: self.less + other.less, more: self.more + other.more }
    }

    /// Probability that two equal laws are at least as far apart: two-sided sign test, which of single runs is McNemar's exact one.
    pub fn chance(&self) -> f64 {
        sign_test(self.less, self.more)
    }

    /// Less often, and equal laws come as far apart with a probability below 0.05.
    pub fn fewer(&self) -> bool {
        self.less > self.more && self.chance() < 0.05
    }

    /// More often, likewise.
    pub fn greater(&self) -> bool {
        Pairs { less: self.more, more: self.less }.fewer()
    }

    /// Cell of a table.
    pub fn cell(&self) -> String {
        let chance = self.chance();
        let chance = if chance < 0.001 { "< 0.001".to_owned() } else { number(chance, 3) };
        format!("{} : {} ({chance})", self.less, self.more)
    }
}

/// The tallies with the fewest overturned runs: first the least, then those that specimens do not distinguish from it.
pub fn fewest(tallies: &[Tally]) -> Vec<usize> {
    let Some(least) = (0..tallies.len()).min_by_key(|&index| tallies[index].count()) else { return Vec::new() };
    let alike = |&index: &usize| index != least && !tallies[index].beyond(&tallies[least]).differs();
    std::iter::once(least).chain((0..tallies.len()).filter(alike)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_are_those_of_student() {
        // 1 to 5: standard error √(2.5/5), t(4) = 2.776.
        let mean = Mean::of(&[1.0, 2.0, 3.0, 4.0, 5.0]);
        assert!((mean.value - 3.0).abs() < 1e-12 && (mean.half - 2.776_445 * 0.5_f64.sqrt()).abs() < 1e-5);
        assert_eq!(Mean::of(&[0.25]), Mean { value: 0.25, half: 0.0 });
        assert_eq!((Mean::of(&[0.25]).percent(true), mean.percent(false)), ("+25.0".to_owned(), "300.0 ± 196.3".to_owned()));
    }

    #[test]
    fn runs_belong_to_specimens_and_are_compared_in_pairs() {
        let tally = |bits: [u8; 8]| Tally { overturned: bits.iter().map(|&bit| bit == 1).collect(), specimens: 4 };
        let (one, other) = (tally([1, 0, 1, 0, 1, 0, 0, 0]), tally([1, 1, 1, 1, 1, 1, 0, 0]));
        assert_eq!((one.count(), one.shares()), (3, vec![1.0, 0.0, 0.5, 0.0]));
        assert!((one.beyond(&other).value + 0.375).abs() < 1e-12);
        assert_eq!(fewest(&[other, one]), [1, 0], "four specimens are few");
        let none = tally([0; 8]);
        assert_eq!(fewest(&[none.clone(), none, tally([1; 8])]), [0, 1], "every specimen distinguishes them");
    }

    /// One record at three scales under 32 specimens: nobody ran under the other 29.
    #[test]
    fn a_specimen_without_a_run_has_no_share() {
        let tally = |bits: [bool; 3]| Tally { overturned: bits.to_vec(), specimens: 32 };
        let (all, none) = (tally([true; 3]), tally([false; 3]));
        assert_eq!(all.share(), Mean { value: 1.0, half: 0.0 });
        assert_eq!(all.beyond(&none).percent(true), "+100.0");
        let some = tally([true, false, false]);
        assert_eq!(some.share(), Mean::of(&[1.0, 0.0, 0.0]));
    }

    #[test]
    fn what_one_motion_does_counts_once() {
        let tally = |bits: &[u8]| Tally { overturned: bits.iter().map(|&bit| bit == 1).collect(), specimens: 1 };
        // Three motions at two scales: the first is saved at both, the second at one and lost at the other, the third is lost at one.
        let (law, default) = (tally(&[0, 0, 1, 0, 1, 0]), tally(&[1, 1, 0, 1, 0, 0]));
        assert_eq!(Pairs::of(&[(&law, &default)], 3), Pairs { less: 1, more: 1 });
        assert_eq!(Pairs::of(&[(&law, &default)], 6), Pairs { less: 3, more: 2 });
        assert_eq!(Pairs::of(&[(&law, &default), (&default, &law)], 3), Pairs::default());
    }

    #[test]
    fn a_law_overturns_less_often_where_a_fair_coin_hardly_does() {
        assert!(
            Pairs { less: 6, more: 0 }.fewer() && !Pairs { less: 5, more: 0 }.fewer() && Pairs { less: 0, more: 6 }.greater()
        );
    }
}
