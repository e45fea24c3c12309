//! How much of what is possible each clutch law does: the laws between the plain devices and a law that knew the ground motion beforehand.

use sprag_report::long_run::in_order::all_in_order;
use sprag_report::plot::Class;
use sprag_report::progress::Progress;
use sprag_report::text_table::{TextTable, number};
use sprag_sim::clairvoyant::Grid;

use super::bench::{Conditions, StudyError, with_loop};
use super::law_settings::{SLENDERNESS_DEG, Setting};
use super::laws::{
    AMPLITUDES, Bench, FREQUENCIES, Kind, LAWS, PLAIN, Run, THRESHOLDS, families, maps_of_pulses, motions_in_words,
};
use super::motion::{Family, Motion, Records};
use super::report::Report;
use crate::statistics::quantile;

/// Cells along each axis, of the ideal model …
const CELLS: usize = 10;
/// … and pulses of each family with clutches as they are, one for each specimen of the sensors.
const PULSES: usize = 24;

/// A peak beyond all: that of a block that overturns.
const OVERTURNED: f64 = f64::INFINITY;

/// What became of one motion: peaks |θ|/α by law, and of the clairvoyant schedule as it was found and as it was played.
#[derive(Clone, Debug, PartialEq)]
struct Fate {
    laws: Vec<f64>,
    found: f64,
    played: f64,
}

/// The smallest of the peaks of some laws.
fn best(laws: &[f64]) -> f64 {
    laws.iter().copied().fold(OVERTURNED, f64::min)
}

impl Fate {
    /// Place in the legend of the map: the plainest that keeps the block standing.
    fn class(&self) -> usize {
        let stands = [best(&self.laws[..PLAIN]), best(&self.laws[PLAIN..]), self.played.min(self.found)];
        stands.iter().position(|peak| peak.is_finite()).unwrap_or(stands.len())
    }
}

/// Fates by kind. A delay does not move the bound, so that of other clutches with the same wheels, `known`, is taken where there is one.
fn fates(bench: &Bench<'_>, kinds: &[Kind], known: Option<&[Vec<Fate>]>) -> Result<Vec<Vec<Fate>>, StudyError> {
    let known: Option<Vec<&Fate>> = known.map(|known| known.iter().flatten().collect());
    let in_kinds = kinds.iter().flat_map(|kind| kind.motions.iter().enumerate());
    let jobs: Vec<(usize, usize, &Motion)> = in_kinds.enumerate().map(|(job, (index, motion))| (job, index, motion)).collect();
    let work = |&(job, index, motion): &(usize, usize, &Motion)| -> Result<Fate, StudyError> {
        let laws = LAWS.iter().map(|&law| {
            let Run { outcome, peak, .. } = bench.run(law, motion, index % bench.specimens)?;
            Ok(if outcome.overturned() { OVERTURNED } else { peak })
        });
        let laws = laws.collect::<Result<Vec<f64>, StudyError>>()?;
        if let Some(&&Fate { found, played, .. }) = known.as_ref().and_then(|known| known.get(job)) {
            return Ok(Fate { laws, found, played });
        }
        // A record takes the search ten seconds, and a law that keeps the block standing under it has answered.
        let best = best(&laws);
        if matches!(motion, Motion::Record { .. }) && best.is_finite() {
            return Ok(Fate { laws, found: best, played: best });
        }
        let bound = with_loop(motion, &bench.variant(), bench.conditions, |task| task.clairvoyant(&Grid::STANDARD))?;
        let (found, played) = bound.map_or((None, None), |bound| (bound.found.peak, bound.played));
        Ok(Fate { laws, found: found.unwrap_or(OVERTURNED), played: played.unwrap_or(OVERTURNED) })
    };
    let mut found = all_in_order(&jobs, bench.progress, work)?.into_iter();
    Ok(kinds.iter().map(|kind| found.by_ref().take(kind.motions.len()).collect()).collect())
}

/// Motions of one kind, counted.
struct Count {
    /// Overturned, by law.
    laws: Vec<usize>,
    /// By the clairvoyant schedule.
    found: usize,
    /// And where neither it nor any law kept the block standing when it was played.
    played: usize,
    /// A law keeps a block standing for which the search finds no schedule.
    missed: usize,
}

impl Count {
    fn of(fates: &[Fate]) -> Count {
        let overturned = |pick: &dyn Fn(&Fate) -> f64| fates.iter().filter(|fate| pick(fate).is_infinite()).count();
        Count {
            laws: (0..fates.first().map_or(0, |fate| fate.laws.len())).map(|law| overturned(&|fate| fate.laws[law])).collect(),
            found: overturned(&|fate| fate.found),
            played: overturned(&|fate| fate.played.min(best(&fate.laws))),
            missed: fates.iter().filter(|fate| fate.found.is_infinite() && best(&fate.laws).is_finite()).count(),
        }
    }

    fn plus(mut self, other: &Count) -> Count {
        self.laws.iter_mut().zip(&other.laws).for_each(|(sum, count)| *sum += count);
        Count { found: self.found + other.found, played: self.played + other.played, missed: self.missed + other.missed, ..self }
    }

    /// Share of the gap between the best plain choice and the bound that law number `law` closes, %; negative where it overturns more than the
    /// best plain choice.
    fn closed(&self, law: usize) -> Option<f64> {
        let best = self.laws[..PLAIN].iter().copied().min()?;
        let gap = best as f64 - self.found as f64;
        (gap > 0.0).then(|| 100.0 * (best as f64 - self.laws[law] as f64) / gap)
    }
}

/// A row a law: overturned, and the share of the gap that it closes.
fn counts(kinds: &[Kind], fates: &[Vec<Fate>]) -> TextTable {
    let pulses = Family::ALL.len();
    let counts: Vec<Count> = fates.iter().map(|fates| Count::of(fates)).collect();
    let all_pulses = counts[1..pulses].iter().fold(Count::of(&fates[0]), |sum, count| sum.plus(count));
    let mut headings: Vec<String> = kinds.iter().map(|kind| format!("{} ({})", kind.name, kind.motions.len())).collect();
    headings.insert(pulses, format!("all pulses ({})", kinds[..pulses].iter().map(|kind| kind.motions.len()).sum::<usize>()));
    let columns: Vec<&Count> = counts[..pulses].iter().chain(std::iter::once(&all_pulses)).chain(&counts[pulses..]).collect();
    let mut table = TextTable::new(1, std::iter::once("law".to_owned()).chain(headings));
    for (index, law) in LAWS.iter().map(|law| law.name()).enumerate() {
        let cell = |count: &&Count| match count.closed(index).filter(|_| index >= PLAIN) {
            Some(share) => format!("{} ({share:+.0} %)", count.laws[index]),
            None => count.laws[index].to_string(),
        };
        table.row(std::iter::once(law.to_owned()).chain(columns.iter().map(cell)).collect());
    }
    let mut row = |name: &str, pick: &dyn Fn(&Count) -> usize| {
        table.row(std::iter::once(name.to_owned()).chain(columns.iter().map(|count| pick(count).to_string())).collect());
    };
    row("bound", &|count| count.found);
    row("bound, played", &|count| count.played);
    row("law stands, none found", &|count| count.missed);
    table
}

/// Median peaks |θ|/α of the motions under which some plain choice keeps the block standing; an overturned block counts as infinite.
fn peaks(kinds: &[Kind], fates: &[Vec<Fate>]) -> TextTable {
    let mut table = TextTable::new(1, std::iter::once("law".to_owned()).chain(kinds.iter().map(|kind| kind.name.clone())));
    let mut row = |name: &str, pick: &dyn Fn(&Fate) -> f64| {
        let median = |fates: &Vec<Fate>| {
            let stand = fates.iter().filter(|fate| best(&fate.laws[..PLAIN]).is_finite());
            let median = quantile(&stand.map(pick).collect::<Vec<f64>>(), 0.5);
            match median.filter(|median| median.is_finite()) {
                Some(median) => number(median, 3),
                None => "overturns".to_owned(),
            }
        };
        table.row(std::iter::once(name.to_owned()).chain(fates.iter().map(median)).collect());
    };
    for (index, law) in LAWS.iter().enumerate() {
        row(law.name(), &|fate| fate.laws[index]);
    }
    table
}

/// Runs the study over pulses and `records`.
pub fn bound(records: &[Motion], progress: &Progress, conditions: &Conditions<'_>) -> Result<Report, StudyError> {
    let recorded = Records::new(records)?;
    let base = Setting::base();
    let alpha = base.slenderness_deg.to_radians();
    let mut report = Report::new("bound", "What a clutch law can do at best");
    let motions = motions_in_words("families", records);
    report.paragraph(&format!("{motions} R = 2 m, α = {SLENDERNESS_DEG}°, σ = 0.5, η = 0.85."));
    report.paragraph(
        "Overturned blocks. The bound is a law that knew the whole motion: the best of all schedules of the clutches, found by forward dynamic \
         programming. In brackets the share of the gap between the best of bare block, inerter and Eq. 10 (the first three rows) and \
         the bound that a law closes; negative where it overturns more blocks than that best. Bound, played: what remains overturned when the \
         schedules are played to the plant of the closed loop, or a law does better. The last row counts motions under which a law keeps the \
         block standing although the search finds no schedule; 0 where the search is fine enough. Under recorded motions it is asked only where no law keeps the block \
         standing.",
    );
    report.section("Ideal model");
    let bench = Bench { setting: &base, ideal: true, specimens: 1, progress, conditions };
    let mut kinds = families(|family| family.grid(CELLS, FREQUENCIES, AMPLITUDES));
    kinds.extend(Kind::of_records(&recorded, recorded.at_each(&THRESHOLDS, alpha)));
    let ideal = fates(&bench, &kinds, None)?;
    report.table("bound-ideal", counts(&kinds, &ideal));
    report.paragraph("Median peak |θ|/α under the motions of which one of the first three keeps the block standing.");
    report.table("bound-ideal-peaks", peaks(&kinds, &ideal));
    report.figure("bound-ideal", "the plainest that keeps the block standing, ideal model", map(&kinds, &ideal)?);

    report.section("Clutches as they are");
    report.paragraph(
        "As in [laws.md](laws.md): a clutch with a jolt, flywheels that keep spinning, the sensors of an ADIS16470, each motion with a \
         specimen of its own. The bound needs no sensors and knows when to command, so that no delay is in it.",
    );
    let mut kinds = families(|family| family.spread(PULSES, FREQUENCIES, AMPLITUDES));
    kinds.extend(Kind::of_records(&recorded, recorded.at_each(&THRESHOLDS, alpha)));
    let mut braked: Option<Vec<Vec<Fate>>> = None;
    for (number, setting) in Setting::clutches().iter().enumerate() {
        let bench = Bench { setting, ideal: false, specimens: PULSES, progress, conditions };
        let found = fates(&bench, &kinds, braked.as_deref().filter(|_| setting.braked()))?;
        report.paragraph(&format!("**{}.**", setting.name));
        report.table(&format!("bound-clutch-{}", number + 1), counts(&kinds, &found));
        report.paragraph("Median peak |θ|/α under the motions of which one of the first three keeps the block standing.");
        report.table(&format!("bound-clutch-{}-peaks", number + 1), peaks(&kinds, &found));
        braked = braked.or_else(|| setting.braked().then_some(found));
    }
    Ok(report)
}

fn map(kinds: &[Kind], fates: &[Vec<Fate>]) -> Result<String, StudyError> {
    let names = ["bare block, inerter or Eq. 10 stands", "another law stands", "only a clairvoyant law would", "no law can"];
    let mut classes = Class::outcomes();
    classes.iter_mut().zip(names).for_each(|(class, name)| name.clone_into(&mut class.name));
    let map = |(kind, fates): (&Kind, &Vec<Fate>)| {
        let note = format!("{} of {} open", fates.iter().filter(|fate| fate.class() == 2).count(), fates.len());
        (kind.name.clone(), note, fates.iter().map(Fate::class).collect::<Vec<usize>>())
    };
    let maps = kinds.iter().zip(fates).take(Family::ALL.len()).map(map);
    maps_of_pulses("The plainest that keeps the block standing", classes, maps, (CELLS, 4))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fate(laws: [f64; 6], found: f64) -> Fate {
        Fate { laws: laws.to_vec(), found, played: found }
    }

    #[test]
    fn the_gap_is_from_the_best_plain_choice_to_the_bound() {
        let o = OVERTURNED;
        let fates = [
            fate([o, o, o, o, o, o], o),
            fate([o, o, o, 0.7, 0.6, o], 0.5),
            fate([o, o, o, o, 0.9, o], 0.5),
            fate([o, o, o, o, o, o], 0.5),
            fate([o, o, 0.4, o, 0.4, 0.3], 0.3),
        ];
        let count = Count::of(&fates);
        assert_eq!((count.laws.clone(), count.found, count.missed), (vec![5, 5, 4, 4, 2, 4], 1, 0));
        let closed: Vec<f64> = (PLAIN..6).filter_map(|law| count.closed(law)).collect();
        assert_eq!(closed[0], 0.0);
        assert!((closed[1] - 200.0 / 3.0).abs() < 1e-12);
        assert_eq!(fates.iter().map(Fate::class).collect::<Vec<_>>(), [3, 1, 1, 2, 0]);
        let twice = Count::of(&fates).plus(&count);
        assert_eq!((twice.laws[4], twice.found, twice.closed(4)), (4, 2, count.closed(4)));
    }
}
