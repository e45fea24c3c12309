//! What the study of laws comes to: which law is best for which motions, and which is the default.

use sprag_report::text_table::TextTable;
use sprag_sim::scene::controller::LawName;

use super::{EQUATION_10, Kind, LAWS, best};
use crate::loop_study::law_settings::Setting;
use crate::loop_study::motion::Family;
use crate::loop_study::report::Report;
use crate::loop_study::tally::{Pairs, Tally};

/// A clutch's name, and tallies by kind and law.
pub(super) type Clutch = (String, Vec<Vec<Tally>>);

/// Which law is the default: the others beside Eq. 10, motion by motion, with the `clutches` by name.
pub(super) fn which_default(report: &mut Report, kinds: &[Kind], clutches: &[Clutch]) {
    report.section("Why this default");
    let plain = LAWS[EQUATION_10].name();
    let typical = &clutches[Setting::TYPICAL];
    let names = typical.iter().map(|(name, _)| name.split(',').next().unwrap_or_default()).collect::<Vec<_>>().join(" and ");
    report.paragraph(&format!(
        "Every law beside {plain}, Eq. 10, under the same motions and specimens. A cell has under how many motions the law \
         overturns less often, under how many more often, and in brackets the probability that two equal laws come as far apart (sign test, \
         two-sided; of single runs McNemar's exact test). A motion counts once, with all of its scales and of the clutches of its row."
    ));
    let pairs = |clutches: &[Clutch], law: usize| -> Vec<Pairs> {
        let beside = |kind: usize| {
            clutches.iter().map(|(_, tallies)| (&tallies[kind][law], &tallies[kind][EQUATION_10])).collect::<Vec<_>>()
        };
        kinds.iter().enumerate().map(|(index, kind)| Pairs::of(&beside(index), kind.different)).collect()
    };
    let others = || (1..LAWS.len()).filter(|&law| law != EQUATION_10);
    let pulses = Family::ALL.len();
    let mut headings: Vec<String> = kinds.iter().map(|kind| format!("{} ({})", kind.name, kind.different)).collect();
    headings.insert(pulses, "all pulses".to_owned());
    let mut table = TextTable::new(2, ["clutch", "law"].map(str::to_owned).into_iter().chain(headings));
    let mut rows: Vec<(String, &[Clutch])> =
        clutches.iter().map(|clutch| (clutch.0.clone(), std::slice::from_ref(clutch))).collect();
    rows.push((format!("{names}, typical ones, together"), typical));
    rows.push(("all four together".to_owned(), clutches));
    for (name, clutches) in rows {
        for law in others() {
            let mut pairs = pairs(clutches, law);
            pairs.insert(pulses, pairs[..pulses].iter().fold(Pairs::default(), |sum, &pairs| sum.plus(pairs)));
            table.row([name.clone(), LAWS[law].name().to_owned()].into_iter().chain(pairs.iter().map(Pairs::cell)).collect());
        }
    }
    report.table("laws-paired", table);
    if kinds.len() > pulses {
        let better: Vec<&str> =
            others().filter(|&law| takes_over(&pairs(typical, law), pulses)).map(|law| LAWS[law].name()).collect();
        report.paragraph(&format!(
            "A law is the default in the place of {plain} if, with the typical clutches together, it overturns less often under the recorded motions and \
             more often under no family of pulses, by probabilities below 0.05 each. The recorded motions decide, since how often an earthquake has \
             which of the pulses is not known. By that rule these may be: {}. The default is {}.",
            if better.is_empty() { "none".to_owned() } else { better.join(", ") },
            LawName::default().name()
        ));
    }
}

/// Whether a law with `pairs` by kind, the families of `pulses` first, is better than Eq. 10 for motions that are not known before.
fn takes_over(pairs: &[Pairs], pulses: usize) -> bool {
    pairs[pulses..].iter().any(Pairs::fewer) && !pairs.iter().any(Pairs::greater)
}

/// Which law is best for which motions.
pub(super) fn conclude(report: &mut Report, kinds: &[Kind], winners: &[Clutch]) {
    report.section("Which law for which motions");
    report.paragraph("The law with the fewest overturned blocks, and those that the specimens do not distinguish from it.");
    let headings = std::iter::once("motions".to_owned()).chain(winners.iter().map(|(name, _)| name.clone()));
    let mut table = TextTable::new(1 + winners.len(), headings);
    for (index, kind) in kinds.iter().enumerate() {
        let cells = winners.iter().map(|(_, tallies)| best(&tallies[index]));
        table.row(std::iter::once(kind.name.clone()).chain(cells).collect());
    }
    report.table("laws-best", table);
    let clutches: Vec<&[Vec<Tally>]> = winners[1..].iter().map(|(_, tallies)| tallies.as_slice()).collect();
    rank(report, "with the clutches as they are", kinds, &clutches);
}

/// The laws in the order of the blocks that they overturn in all of `benches` together, each by kind and law, which are `what`.
pub(super) fn rank(report: &mut Report, what: &str, kinds: &[Kind], benches: &[&[Vec<Tally>]]) {
    let pulses = Family::ALL.len();
    for (motions, range) in [("recorded motions", pulses..kinds.len()), ("pulses", 0..pulses)] {
        let runs: usize = kinds[range.clone()].iter().map(|kind| benches.len() * kind.motions.len()).sum();
        if runs == 0 {
            continue;
        }
        let total =
            |law: usize| -> usize { benches.iter().flat_map(|kinds| &kinds[range.clone()]).map(|laws| laws[law].count()).sum() };
        let mut order: Vec<(usize, LawName)> = LAWS.iter().enumerate().map(|(law, &name)| (total(law), name)).collect();
        order.sort_by_key(|(count, _)| *count);
        let order = order.iter().map(|(count, law)| format!("{} {count}", law.name())).collect::<Vec<_>>().join(", ");
        report.paragraph(&format!("Over the {motions} {what}, all together ({runs} runs a law), overturned: {order}."));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_law_takes_over_only_by_records_and_at_no_familys_cost() {
        let (even, fewer, more) = (Pairs { less: 9, more: 9 }, Pairs { less: 20, more: 2 }, Pairs { less: 2, more: 20 });
        assert!(takes_over(&[even, fewer, fewer], 2));
        assert!(!takes_over(&[fewer, fewer, even], 2), "pulses alone");
        assert!(!takes_over(&[fewer, more, fewer], 2), "at a family's cost");
    }
}
