//! Beyond Eq. 10: which law overturns fewest blocks, under which motions, in the ideal model and with clutches and sensors as they are.

use sprag_report::long_run::in_order::all_in_order;
use sprag_report::plot::{Cell, CellMap, CellMaps, Class, Scale, cell_map_figure};
use sprag_report::progress::Progress;
use sprag_report::text_table::TextTable;
use sprag_shared::observers::outcome::Outcome;
use sprag_sim::scene::controller::LawName;

use super::bench::{Conditions, StudyError, Variant, run_ideal, run_loop};
use super::law_settings::{IDEAL, SLENDERNESS_DEG, Setting};
use super::motion::{Family, Motion, Records, and_records};
use super::report::Report;
use super::tally::{Tally, fewest};
use engagements::Engagements;
use others::Others;

mod engagements;
mod others;
mod verdict;

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
/// Cells along each axis of the base.
const CELLS: usize = 16;
/// Specimens of the sensors.
const SPECIMENS: usize = 32;
/// Pulses of each family and specimen.
const PULSES: usize = 4;
/// From sample to clutch, of the clutches of other blocks and devices, ms.
const DELAY_MS: f64 = 20.0;

/// Eq. 10 among [`LAWS`].
pub(super) const EQUATION_10: usize = PLAIN - 1;

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

/// What one run came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Run {
    pub(super) outcome: Outcome,
    /// max |θ|/α.
    pub(super) peak: f64,
    /// Engagements of the clutches; none where there is no loop.
    pub(super) engagements: u32,
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

    pub(super) fn run(&self, law: LawName, motion: &Motion, specimen: usize) -> Result<Run, StudyError> {
        let kind = match law {
            LawName::Passive => Some("none"),
            LawName::AlwaysEngaged => Some("inerter"),
            LawName::ResistingPredicted => Some("clutched-pair"),
            _ => None,
        };
        if let Some(kind) = kind.filter(|_| self.ideal) {
            let none = if kind == "none" { "device.0={kind=\"none\"}".to_owned() } else { format!("device.0.kind=\"{kind}\"") };
            let (outcome, peak) = run_ideal(motion, &self.setting.variant().with(&none), self.conditions)?;
            return Ok(Run { outcome, peak, engagements: 0 });
        }
        let mut variant = self.variant().with(&format!("controller.law=\"{}\"", law.name()));
        variant.seed = 1 + specimen as u64;
        let result = run_loop(motion, &variant, self.conditions)?;
        Ok(Run { outcome: result.outcome, peak: result.peak, engagements: result.ending.engagements })
    }

    /// Runs by kind, law and motion; motion i is shaken by specimen i mod their number.
    fn runs(&self, kinds: &[Kind]) -> Result<Vec<Vec<Vec<Run>>>, StudyError> {
        let jobs: Vec<(LawName, &Motion, usize)> = kinds
            .iter()
            .flat_map(|kind| LAWS.iter().map(move |&law| (law, kind)))
            .flat_map(|(law, kind)| kind.motions.iter().enumerate().map(move |(index, motion)| (law, motion, index)))
            .collect();
        let work = |&(law, motion, index): &(LawName, &Motion, usize)| self.run(law, motion, index % self.specimens);
        let mut runs = all_in_order(&jobs, self.progress, work)?.into_iter();
        let mut of = |kind: &Kind| runs.by_ref().take(kind.motions.len()).collect::<Vec<Run>>();
        Ok(kinds.iter().map(|kind| LAWS.iter().map(|_| of(kind)).collect()).collect())
    }

    fn tallies(&self, runs: &[Vec<Vec<Run>>]) -> Vec<Vec<Tally>> {
        let tally = |runs: &Vec<Run>| Tally {
            overturned: runs.iter().map(|run| run.outcome.overturned()).collect(),
            specimens: self.specimens,
        };
        runs.iter().map(|laws| laws.iter().map(tally).collect()).collect()
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

/// The pulses, of so many `families`, and `records` that laws are compared under.
pub(super) fn motions_in_words(families: &str, records: &[Motion]) -> String {
    let (number, records) = (Family::ALL.len(), records.len());
    let ((slowest, fastest), (least, most)) = (FREQUENCIES, AMPLITUDES);
    let thresholds = THRESHOLDS.map(|threshold| threshold.to_string()).join(", ");
    let records = and_records(records, &format!(" scaled to peaks of {thresholds} thresholds"));
    format!(
        "Motions: pulses of {number} {families} with ω/p {slowest} to {fastest} and peaks of {least} to {most} uplift thresholds g tan α{records}."
    )
}

/// Runs the study over pulses and `records`.
pub fn laws(records: &[Motion], progress: &Progress, conditions: &Conditions<'_>) -> Result<Report, StudyError> {
    let recorded = Records::new(records)?;
    let base = Setting::base();
    let alpha = |setting: &Setting| setting.slenderness_deg.to_radians();
    let mut report = Report::new("laws", "Beyond Eq. 10: clutch laws");
    let motions = motions_in_words("families (M-P: Mavroeidis-Papageorgiou)", records);
    report.paragraph(&format!("{motions} A heading has the number of runs in brackets."));
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
    let runs = bench.runs(&kinds)?;
    let tallies = bench.tallies(&runs);
    report.table("laws-ideal", by_law(&kinds, &tallies, |tallies, law| tallies[law].count().to_string()));
    report.figure("laws-ideal", "maps of overturned cells, ideal model", maps(&kinds[..Family::ALL.len()], &runs)?);
    winners.push(("ideal model".to_owned(), tallies));

    report.section("Ideal model, other blocks and devices");
    let others = Others::of(&bench, Setting::others(), &recorded)?;
    report.paragraph("Change of the number of overturned blocks, in percent, from the best of bare block, inerter and Eq. 10.");
    report.table("laws-others", others.table(change));

    report.section("Clutches as they are");
    report.paragraph(&format!(
        "Consistent kinematics, a clutch with a jolt, flywheels that keep spinning (braked: at 2 m/s² once released), the sensors of an \
         ADIS16470, 1 kHz. {SPECIMENS} specimens of the sensors, each under motions of its own, the same for all laws. Overturned, in \
         percent, and difference to Eq. 10 in percentage points, with 95 % bands over the specimens."
    ));
    let mut kinds = families(|family| family.spread(SPECIMENS * PULSES, FREQUENCIES, AMPLITUDES));
    kinds.extend(Kind::of_records(&recorded, recorded.at_each(&THRESHOLDS, alpha(&base))));
    let mut engagements = Engagements::default();
    for (number, setting) in Setting::clutches().iter().enumerate() {
        let bench = Bench { setting, ideal: false, specimens: SPECIMENS, progress, conditions };
        let runs = bench.runs(&kinds)?;
        engagements.add(&setting.name, &runs);
        let tallies = bench.tallies(&runs);
        report.paragraph(&format!("**{}.**", setting.name));
        let table = by_law(&kinds, &tallies, |tallies, law| {
            let share = tallies[law].share().percent(false);
            if law == EQUATION_10 {
                share
            } else {
                format!("{share} ({})", tallies[law].beyond(&tallies[EQUATION_10]).percent(true))
            }
        });
        report.table(&format!("laws-clutch-{}", number + 1), table);
        winners.push((setting.name.clone(), tallies));
    }

    engagements.report(&mut report);

    report.section(&format!("A clutch of {DELAY_MS} ms, other blocks and devices"));
    let settings = Setting::others().into_iter().map(|setting| setting.with_clutch(DELAY_MS, true)).collect();
    let others =
        Others::of(&Bench { setting: &base, ideal: false, specimens: SPECIMENS, progress, conditions }, settings, &recorded)?;
    report.paragraph(
        "Change of the number of overturned blocks, in percent, from the best of bare block, inerter and Eq. 10, and in brackets that \
         number. Nothing was trained with these blocks and devices.",
    );
    report
        .table("laws-others-clutch", others.table(|tallies, law| format!("{} ({})", change(tallies, law), tallies[law].count())));
    others.all_together(&mut report);

    verdict::conclude(&mut report, &kinds, &winners);
    verdict::which_default(&mut report, &kinds, &winners[1..]);
    Ok(report)
}

fn maps(kinds: &[Kind], runs: &[Vec<Vec<Run>>]) -> Result<String, StudyError> {
    let map = |kind: &Kind, law: &LawName, runs: &[Run]| {
        let note = format!("{} of {}", runs.iter().filter(|run| run.outcome.overturned()).count(), runs.len());
        let cells: Vec<usize> = runs.iter().map(|run| Cell::from(run.outcome).class()).collect();
        (format!("{}, {}", law.name(), kind.name), note, cells)
    };
    let pairs = kinds.iter().zip(runs);
    let maps = pairs.flat_map(|(kind, laws)| LAWS.iter().zip(laws).map(move |(law, runs)| map(kind, law, runs)));
    maps_of_pulses("Overturning by clutch law, ideal model", Class::outcomes(), maps, (CELLS, LAWS.len()))
}

/// Maps of pulses over ω/p and amplitude, each with title, note and classes of its cells, which are `side` by `side`.
pub(super) fn maps_of_pulses(
    title: &str,
    classes: Vec<Class>,
    maps: impl Iterator<Item = (String, String, Vec<usize>)>,
    (side, columns): (usize, usize),
) -> Result<String, StudyError> {
    let map =
        |(title, note, cells)| CellMap { title, note, columns: side, rows: side, to_the_edges: false, cells, curves: Vec::new() };
    Ok(cell_map_figure(&CellMaps {
        title: title.into(),
        classes,
        scales: (Scale::Linear, Scale::Linear),
        x_title: "ω_g/*p*".to_owned(),
        x: FREQUENCIES,
        y_title: "*a*_g/(*g* tan α)".to_owned(),
        y: AMPLITUDES,
        maps: maps.map(map).collect(),
        curves: Vec::new(),
        columns,
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
}
