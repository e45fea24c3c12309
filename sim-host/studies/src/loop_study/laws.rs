//! Beyond Eq. 10: which law overturns fewest blocks, under which motions, in the ideal model and with clutches and sensors as they are.

use sprag_report::plot::{Cell, CellMap, CellMaps, Class, Scale, cell_map_figure};
use sprag_report::progress::Progress;
use sprag_report::text_table::TextTable;
use sprag_shared::observers::outcome::Outcome;
use sprag_sim::scene::controller::LawName;

use super::bench::{Conditions, StudyError, Variant, all, run_ideal, run_loop};
use super::law_settings::{IDEAL, SLENDERNESS_DEG, Setting};
use super::motion::{Family, Motion, Records, and_records};
use super::report::Report;
use super::tally::{Pairs, Tally, fewest};

/// Laws in the order of the tables: without decisions, Eq. 10, and beyond.
pub(super) const LAWS: [LawName; 7] = [
    LawName::Passive,
    LawName::AlwaysEngaged,
    LawName::ResistingPredicted,
    LawName::SignTable,
    LawName::GatedTable,
    LawName::LookAhead,
    LawName::Costate,
];
/// Of these, the plain choices.
pub(super) const PLAIN: usize = 3;
/// ω/p.
pub(super) const FREQUENCIES: (f64, f64) = (0.2, 8.0);
/// a/(g tan α).
pub(super) const AMPLITUDES: (f64, f64) = (1.0, 10.0);
/// Peaks of records over g tan α.
pub(super) const THRESHOLDS: [f64; 3] = [2.0, 3.0, 4.5];
/// Cells along each axis, of the base …
const CELLS: usize = 16;
/// … and of other blocks and devices.
const FEW_CELLS: usize = 8;
/// Specimens of the sensors.
const SPECIMENS: usize = 32;
/// Pulses of each family and specimen.
const PULSES: usize = 4;

/// The default among [`LAWS`].
const DEFAULT: usize = PLAIN - 1;

/// Motions of one kind.
pub(super) struct Kind {
    pub(super) name: String,
    pub(super) motions: Vec<Motion>,
    /// Of how many the others are the same at another scale: motion i is one of motion i mod this number.
    pub(super) different: usize,
}

impl Kind {
    /// `recorded` motions at some scales, if there are any.
    pub(super) fn of_records(recorded: &Records<'_>, motions: Vec<Motion>) -> Option<Kind> {
        (!motions.is_empty()).then(|| Kind { name: "records".to_owned(), motions, different: recorded.count() })
    }
}

pub(super) fn families(motions: impl Fn(Family) -> Vec<Motion>) -> Vec<Kind> {
    let of = |&family: &Family| {
        let motions = motions(family);
        Kind { name: family.name(), different: motions.len(), motions }
    };
    Family::ALL.iter().map(of).collect()
}

/// Under what the runs of a setting are made.
pub(super) struct Bench<'a> {
    pub(super) setting: &'a Setting,
    /// The ideal model: what no law decides needs no loop.
    pub(super) ideal: bool,
    pub(super) specimens: usize,
    pub(super) progress: &'a Progress,
    pub(super) conditions: &'a Conditions<'a>,
}

impl Bench<'_> {
    /// Block, device and, in the ideal model, what makes it that.
    pub(super) fn variant(&self) -> Variant {
        let mut variant = self.setting.variant();
        if self.ideal {
            variant.overrides.extend(IDEAL.map(str::to_owned));
        }
        variant
    }

    /// Outcome and peak |θ|/α of one run.
    pub(super) fn result(&self, law: LawName, motion: &Motion, specimen: usize) -> Result<(Outcome, f64), StudyError> {
        let kind = match law {
            LawName::Passive => Some("none"),
            LawName::AlwaysEngaged => Some("inerter"),
            LawName::ResistingPredicted => Some("clutched-pair"),
            _ => None,
        };
        if let Some(kind) = kind.filter(|_| self.ideal) {
            let none = if kind == "none" { "device.0={kind=\"none\"}".to_owned() } else { format!("device.0.kind=\"{kind}\"") };
            return run_ideal(motion, &self.setting.variant().with(&none), self.conditions);
        }
        let mut variant = self.variant().with(&format!("controller.law=\"{}\"", law.name()));
        variant.seed = 1 + specimen as u64;
        let result = run_loop(motion, &variant, self.conditions)?;
        Ok((result.outcome, result.peak))
    }

    /// Outcomes by kind, law and motion; motion i is shaken by specimen i mod their number.
    fn outcomes(&self, kinds: &[Kind]) -> Result<Vec<Vec<Vec<Outcome>>>, StudyError> {
        let jobs: Vec<(LawName, &Motion, usize)> = kinds
            .iter()
            .flat_map(|kind| LAWS.iter().map(move |&law| (law, kind)))
            .flat_map(|(law, kind)| kind.motions.iter().enumerate().map(move |(index, motion)| (law, motion, index)))
            .collect();
        let work = |&(law, motion, index): &(LawName, &Motion, usize)| Ok(self.result(law, motion, index % self.specimens)?.0);
        let mut outcomes = all(&jobs, self.progress, work)?.into_iter();
        let mut of = |kind: &Kind| outcomes.by_ref().take(kind.motions.len()).collect::<Vec<Outcome>>();
        Ok(kinds.iter().map(|kind| LAWS.iter().map(|_| of(kind)).collect()).collect())
    }

    fn tallies(&self, outcomes: &[Vec<Vec<Outcome>>]) -> Vec<Vec<Tally>> {
        let tally = |outcomes: &Vec<Outcome>| Tally {
            overturned: outcomes.iter().map(|outcome| outcome.overturned()).collect(),
            specimens: self.specimens,
        };
        outcomes.iter().map(|laws| laws.iter().map(tally).collect()).collect()
    }
}

fn headings(first: &[&str], kinds: &[Kind]) -> TextTable {
    let of_kind = |kind: &Kind| format!("{} ({})", kind.name, kind.motions.len());
    TextTable::new(first.len(), first.iter().map(|&text| text.to_owned()).chain(kinds.iter().map(of_kind)))
}

/// A row a law: what `cell` says of each kind's tallies and the law's index among them.
fn by_law(kinds: &[Kind], tallies: &[Vec<Tally>], cell: impl Fn(&[Tally], usize) -> String) -> TextTable {
    let mut table = headings(&["law"], kinds);
    for (index, law) in LAWS.iter().enumerate() {
        table.row(std::iter::once(law.name().to_owned()).chain(tallies.iter().map(|laws| cell(laws, index))).collect());
    }
    table
}

/// Change of overturned runs, in percent, from the best plain choice.
fn change(tallies: &[Tally], law: usize) -> String {
    let best = tallies[..PLAIN].iter().map(Tally::count).min().unwrap_or_default();
    if best == 0 { "-".to_owned() } else { format!("{:+.0}", 100.0 * (tallies[law].count() as f64 / best as f64 - 1.0)) }
}

/// Names of the laws with the fewest overturned runs.
fn best(tallies: &[Tally]) -> String {
    fewest(tallies).into_iter().map(|index| LAWS[index].name()).collect::<Vec<_>>().join(", ")
}

/// Runs the study over pulses and `records`.
///
/// # Errors
/// [`StudyError`].
pub fn laws(records: &[Motion], progress: &Progress, conditions: &Conditions<'_>) -> Result<Report, StudyError> {
    let recorded = Records::new(records)?;
    let base = Setting::base();
    let alpha = |setting: &Setting| setting.slenderness_deg.to_radians();
    let thresholds = THRESHOLDS.map(|threshold| threshold.to_string()).join(", ");
    let mut report = Report::new("laws", "Beyond Eq. 10: clutch laws");
    report.paragraph(&format!(
        "Motions: pulses of {} families (M-P: Mavroeidis-Papageorgiou) with ω/p {} to {} and peaks of {} to {} uplift thresholds \
         g tan α{}. A heading has the number of runs in brackets.",
        Family::ALL.len(),
        FREQUENCIES.0,
        FREQUENCIES.1,
        AMPLITUDES.0,
        AMPLITUDES.1,
        and_records(records.len(), &format!(" scaled to peaks of {thresholds} thresholds")),
    ));
    report.paragraph(&format!(
        "R = 2 m, α = {SLENDERNESS_DEG}°, σ = 0.5, η = 0.85 but where a table says otherwise. Counted are overturned blocks: {} is the \
         bare block, {} one inerter, {} Eq. 10.",
        LAWS[0].name(),
        LAWS[1].name(),
        LAWS[2].name()
    ));
    let mut winners = Vec::new();

    report.section("Ideal model");
    report.paragraph(
        "Ideal sensors, no delay, a clutch that engages a stopped flywheel without a jolt. Nothing is left to chance, so every motion is \
         run once.",
    );
    let bench = Bench { setting: &base, ideal: true, specimens: 1, progress, conditions };
    let mut kinds = families(|family| family.grid(CELLS, FREQUENCIES, AMPLITUDES));
    kinds.extend(Kind::of_records(&recorded, recorded.at_each(&THRESHOLDS, alpha(&base))));
    let outcomes = bench.outcomes(&kinds)?;
    let tallies = bench.tallies(&outcomes);
    report.table("laws-ideal", by_law(&kinds, &tallies, |tallies, law| tallies[law].count().to_string()));
    report.figure("laws-ideal", "maps of overturned cells, ideal model", maps(&kinds[..Family::ALL.len()], &outcomes)?);
    winners.push(("ideal model".to_owned(), tallies));

    report.section("Ideal model, other blocks and devices");
    report.paragraph("Change of the number of overturned blocks, in percent, from the best of bare block, inerter and Eq. 10.");
    let few = |setting: &Setting| {
        let mut kinds = families(|family| family.grid(FEW_CELLS, FREQUENCIES, AMPLITUDES));
        kinds.extend(Kind::of_records(&recorded, recorded.at_turns(&THRESHOLDS, alpha(setting))));
        kinds
    };
    let mut table = headings(&["block or device", "law"], &few(&base));
    for setting in &Setting::others() {
        let (bench, kinds) = (Bench { setting, ..bench }, few(setting));
        let tallies = bench.tallies(&bench.outcomes(&kinds)?);
        for (index, law) in LAWS.iter().enumerate().skip(PLAIN) {
            let cells = tallies.iter().map(|tallies| change(tallies, index));
            table.row([setting.name.clone(), law.name().to_owned()].into_iter().chain(cells).collect());
        }
    }
    report.table("laws-others", table);

    report.section("Clutches as they are");
    report.paragraph(&format!(
        "Consistent kinematics, a clutch with a jolt, flywheels that keep spinning (braked: at 2 m/s² once released), the sensors of an \
         ADIS16470, 1 kHz. {SPECIMENS} specimens of the sensors, each under motions of its own, the same for all laws. Overturned, in \
         percent, and difference to Eq. 10 in percentage points, with 95 % bands over the specimens."
    ));
    let mut kinds = families(|family| family.spread(SPECIMENS * PULSES, FREQUENCIES, AMPLITUDES));
    kinds.extend(Kind::of_records(&recorded, recorded.at_each(&THRESHOLDS, alpha(&base))));
    for (number, setting) in Setting::clutches().iter().enumerate() {
        let bench = Bench { setting, ideal: false, specimens: SPECIMENS, progress, conditions };
        let tallies = bench.tallies(&bench.outcomes(&kinds)?);
        report.paragraph(&format!("**{}.**", setting.name));
        let table = by_law(&kinds, &tallies, |tallies, law| {
            let share = tallies[law].share().percent(false);
            if law == DEFAULT { share } else { format!("{share} ({})", tallies[law].beyond(&tallies[DEFAULT]).percent(true)) }
        });
        report.table(&format!("laws-clutch-{}", number + 1), table);
        winners.push((setting.name.clone(), tallies));
    }
    conclude(&mut report, &kinds, &winners);
    why(&mut report, &kinds, &winners[1..]);
    Ok(report)
}

/// A clutch's name, and tallies by kind and law.
type Clutch = (String, Vec<Vec<Tally>>);

/// Why the default law is the one that it is: the others beside it, motion by motion, with the `clutches` by name.
fn why(report: &mut Report, kinds: &[Kind], clutches: &[Clutch]) {
    report.section("Why this default");
    let default = LAWS[DEFAULT].name();
    let typical = &clutches[Setting::TYPICAL];
    let names = typical.iter().map(|(name, _)| name.split(',').next().unwrap_or_default()).collect::<Vec<_>>().join(" and ");
    report.paragraph(&format!(
        "Every law beside {default}, the default, under the same motions and specimens. A cell has under how many motions the law \
         overturns less often, under how many more often, and in brackets the probability that two equal laws come as far apart (sign test, \
         two-sided; of single runs McNemar's exact test). A motion counts once, with all of its scales and of the clutches of its row."
    ));
    let pairs = |clutches: &[Clutch], law: usize| -> Vec<Pairs> {
        let beside =
            |kind: usize| clutches.iter().map(|(_, tallies)| (&tallies[kind][law], &tallies[kind][DEFAULT])).collect::<Vec<_>>();
        kinds.iter().enumerate().map(|(index, kind)| Pairs::of(&beside(index), kind.different)).collect()
    };
    let others = || (1..LAWS.len()).filter(|&law| law != DEFAULT);
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
            "A law takes the default's place if, with the typical clutches together, it overturns less often under the recorded motions and more \
             often under no family of pulses, by probabilities below 0.05 each. The recorded motions decide, since how often an earthquake has \
             which of the pulses is not known. By that rule {}.",
            if better.is_empty() { format!("{default} stays the default") } else { format!("these do: {}", better.join(", ")) }
        ));
    }
}

/// Whether a law with `pairs` by kind, the families of `pulses` first, is better than the default for motions that are not known before.
fn takes_over(pairs: &[Pairs], pulses: usize) -> bool {
    pairs[pulses..].iter().any(Pairs::fewer) && !pairs.iter().any(Pairs::greater)
}

/// Which law is best for which motions.
fn conclude(report: &mut Report, kinds: &[Kind], winners: &[Clutch]) {
    report.section("Which law for which motions");
    report.paragraph("The law with the fewest overturned blocks, and those that the specimens do not distinguish from it.");
    let headings = std::iter::once("motions".to_owned()).chain(winners.iter().map(|(name, _)| name.clone()));
    let mut table = TextTable::new(1 + winners.len(), headings);
    for (index, kind) in kinds.iter().enumerate() {
        let cells = winners.iter().map(|(_, tallies)| best(&tallies[index]));
        table.row(std::iter::once(kind.name.clone()).chain(cells).collect());
    }
    report.table("laws-best", table);
    let clutches = &winners[1..];
    let total = |pick: &dyn Fn(usize) -> bool, law: usize| -> usize {
        let counts = |tallies: &Vec<Vec<Tally>>| -> usize {
            tallies.iter().enumerate().filter(|(kind, _)| pick(*kind)).map(|(_, laws)| laws[law].count()).sum()
        };
        clutches.iter().map(|(_, tallies)| counts(tallies)).sum()
    };
    let ranking = |pick: &dyn Fn(usize) -> bool| {
        let mut order: Vec<(usize, LawName)> = LAWS.iter().enumerate().map(|(law, &name)| (total(pick, law), name)).collect();
        order.sort_by_key(|(count, _)| *count);
        order.iter().map(|(count, law)| format!("{} {count}", law.name())).collect::<Vec<_>>().join(", ")
    };
    let pulses = Family::ALL.len();
    if kinds.len() > pulses {
        report.paragraph(&format!(
            "Over the recorded motions with the clutches as they are, all together ({} runs a law), overturned: {}.",
            clutches.len() * kinds[pulses].motions.len(),
            ranking(&|kind| kind >= pulses)
        ));
    }
    report.paragraph(&format!("Over the pulses with them, all together, overturned: {}.", ranking(&|kind| kind < pulses)));
}

fn maps(kinds: &[Kind], outcomes: &[Vec<Vec<Outcome>>]) -> Result<String, StudyError> {
    let map = |kind: &Kind, law: &LawName, outcomes: &[Outcome]| CellMap {
        title: format!("{}, {}", law.name(), kind.name),
        note: format!("{} of {}", outcomes.iter().filter(|outcome| outcome.overturned()).count(), outcomes.len()),
        columns: CELLS,
        rows: CELLS,
        to_the_edges: false,
        cells: outcomes.iter().map(|&outcome| Cell::from(outcome).class()).collect(),
        curves: Vec::new(),
    };
    let maps = kinds
        .iter()
        .zip(outcomes)
        .flat_map(|(kind, laws)| LAWS.iter().zip(laws).map(move |(law, outcomes)| map(kind, law, outcomes)))
        .collect();
    Ok(cell_map_figure(&CellMaps {
        title: "Overturning by clutch law, ideal model".into(),
        classes: Class::outcomes(),
        scales: (Scale::Linear, Scale::Linear),
        x_title: "ω_g/*p*".to_owned(),
        x: FREQUENCIES,
        y_title: "*a*_g/(*g* tan α)".to_owned(),
        y: AMPLITUDES,
        maps,
        curves: Vec::new(),
        columns: LAWS.len(),
    })?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_are_from_the_best_plain_choice() {
        let tally = |count: usize| Tally { overturned: (0..10).map(|run| run < count).collect(), specimens: 1 };
        let tallies = [8, 5, 6, 4, 5, 10].map(tally);
        assert_eq!([change(&tallies, 3), change(&tallies, 4), change(&tallies, 5)], ["-20", "+0", "+100"]);
        assert_eq!(best(&tallies), "sign-table");
        assert_eq!(change(&[tally(0), tally(0), tally(0), tally(1)], 3), "-");
    }

    #[test]
    fn a_law_takes_over_only_by_records_and_at_no_familys_cost() {
        let (even, fewer, more) = (Pairs { less: 9, more: 9 }, Pairs { less: 20, more: 2 }, Pairs { less: 2, more: 20 });
        assert!(takes_over(&[even, fewer, fewer], 2));
        assert!(!takes_over(&[fewer, fewer, even], 2), "pulses alone");
        assert!(!takes_over(&[fewer, more, fewer], 2), "at a family's cost");
    }
}
