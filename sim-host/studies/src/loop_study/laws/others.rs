//! Laws with other blocks and devices than those of the base.

use sprag_report::text_table::TextTable;

use super::verdict::rank;
use super::{AMPLITUDES, Bench, EQUATION_10, FREQUENCIES, Kind, LAWS, PLAIN, THRESHOLDS, families, headings};
use crate::loop_study::bench::StudyError;
use crate::loop_study::law_settings::Setting;
use crate::loop_study::motion::{Family, Records};
use crate::loop_study::report::Report;
use crate::loop_study::tally::{Pairs, Tally};

/// Cells along each axis.
const CELLS: usize = 8;

/// What the laws do with each of some blocks and devices.
pub(super) struct Others {
    /// Of the last setting; the others differ in scale.
    kinds: Vec<Kind>,
    /// Names, and tallies by kind and law.
    settings: Vec<(String, Vec<Vec<Tally>>)>,
}

impl Others {
    /// Runs all laws with each of `settings`, of which `bench` has the rest.
    pub(super) fn of(bench: &Bench<'_>, settings: Vec<Setting>, recorded: &Records<'_>) -> Result<Others, StudyError> {
        let mut others = Others { kinds: Vec::new(), settings: Vec::new() };
        for setting in settings {
            others.kinds = families(|family| family.grid(CELLS, FREQUENCIES, AMPLITUDES));
            let motions = recorded.at_turns(&THRESHOLDS, setting.slenderness_deg.to_radians());
            others.kinds.extend(Kind::of_records(recorded, motions));
            let bench = Bench { setting: &setting, ..*bench };
            let tallies = bench.tallies(&bench.runs(&others.kinds)?);
            others.settings.push((setting.name, tallies));
        }
        Ok(others)
    }

    /// A row a setting and law beyond the plain choices: what `cell` says of a kind's tallies and the law's index among them.
    pub(super) fn table(&self, cell: impl Fn(&[Tally], usize) -> String) -> TextTable {
        let mut table = headings(&["block or device", "law"], &self.kinds);
        for (name, tallies) in &self.settings {
            for (index, law) in LAWS.iter().enumerate().skip(PLAIN) {
                let cells = tallies.iter().map(|tallies| cell(tallies, index));
                table.row([name.clone(), law.name().to_owned()].into_iter().chain(cells).collect());
            }
        }
        table
    }

    /// The laws in their order over all settings, and beside Eq. 10 motion by motion.
    pub(super) fn all_together(&self, report: &mut Report) {
        let tallies: Vec<&[Vec<Tally>]> = self.settings.iter().map(|(_, tallies)| tallies.as_slice()).collect();
        rank(report, "with these blocks and devices", &self.kinds, &tallies);
        let Some((index, kind)) = self.kinds.iter().enumerate().nth(Family::ALL.len()) else { return };
        let beside = |law: usize| {
            let pairs: Vec<_> = tallies.iter().map(|kinds| (&kinds[index][law], &kinds[index][EQUATION_10])).collect();
            format!("{} {}", LAWS[law].name(), Pairs::of(&pairs, kind.different).cell())
        };
        report.paragraph(&format!(
            "Under how many of the {} recorded motions a law overturns less often than {}, under how many more often, with all of them \
             together, and the probability that two equal laws come as far apart: {}.",
            kind.different,
            LAWS[EQUATION_10].name(),
            (PLAIN..LAWS.len()).map(beside).collect::<Vec<_>>().join(", ")
        ));
    }
}
