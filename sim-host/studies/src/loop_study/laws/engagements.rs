//! How often the clutches engage under each law.

use sprag_report::text_table::{TextTable, number};

use super::{EQUATION_10, LAWS, Run};
use crate::loop_study::motion::Family;
use crate::loop_study::report::Report;

/// Mean engagements a run by clutch, pulses and records, and law from Eq. 10 on.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Engagements {
    clutches: Vec<(String, [Vec<f64>; 2])>,
}

impl Engagements {
    /// Those of `runs` with a clutch, by kind, law and motion.
    pub(super) fn add(&mut self, clutch: &str, runs: &[Vec<Vec<Run>>]) {
        let pulses = Family::ALL.len().min(runs.len());
        self.clutches.push((clutch.to_owned(), [mean(&runs[..pulses]), mean(&runs[pulses..])]));
    }

    /// Writes them.
    pub(super) fn report(&self, report: &mut Report) {
        report.paragraph(
            "Mean engagements of the clutches in a run, under the motions under which no law overturns the block, with pulses and with \
             recorded motions.",
        );
        let columns = self.clutches.iter().flat_map(|(clutch, _)| ["pulses", "records"].map(|kind| format!("{clutch}: {kind}")));
        let mut table = TextTable::new(1, std::iter::once("law".to_owned()).chain(columns));
        for (index, law) in LAWS[EQUATION_10..].iter().enumerate() {
            let cell = |means: &Vec<f64>| means.get(index).map_or("-".to_owned(), |&mean| number(mean, 1));
            let cells = self.clutches.iter().flat_map(|(_, kinds)| kinds.iter().map(cell));
            table.row(std::iter::once(law.name().to_owned()).chain(cells).collect());
        }
        report.table("laws-engagements", table);
    }
}

/// Mean engagements by law from Eq. 10 on; none without a motion under which every law keeps the block standing.
fn mean(kinds: &[Vec<Vec<Run>>]) -> Vec<f64> {
    let (mut sums, mut count) = (vec![0_u64; LAWS.len() - EQUATION_10], 0_u64);
    for laws in kinds {
        for motion in 0..laws.first().map_or(0, Vec::len) {
            if laws.iter().all(|runs| !runs[motion].outcome.overturned()) {
                count += 1;
                sums.iter_mut().zip(&laws[EQUATION_10..]).for_each(|(sum, runs)| *sum += u64::from(runs[motion].engagements));
            }
        }
    }
    if count == 0 { Vec::new() } else { sums.into_iter().map(|sum| sum as f64 / count as f64).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprag_shared::observers::outcome::Outcome;

    #[test]
    fn motions_that_overturn_under_any_law_are_left_out() {
        let run = |outcome, engagements| Run { outcome, peak: 0.5, engagements };
        let mut kind = vec![vec![run(Outcome::Safe, 4), run(Outcome::Safe, 100), run(Outcome::Safe, 8)]; LAWS.len()];
        kind[0][1].outcome = Outcome::OverturnedAfterImpact;
        kind[EQUATION_10][0].engagements = 5;
        let means = mean(&[kind.clone()]);
        assert_eq!((means.len(), means[0], means[1]), (LAWS.len() - EQUATION_10, 6.5, 6.0));
        assert!(mean(&[]).is_empty() && mean(&[vec![vec![run(Outcome::OverturnedAfterImpact, 1)]; LAWS.len()]]).is_empty());
    }
}
