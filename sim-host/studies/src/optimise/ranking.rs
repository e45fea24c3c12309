//! How sure a choice is: the chosen device beside its rivals under the same motions, and what would be chosen under others.

use rayon::prelude::*;
use serde::Serialize;
use sprag_shared::math::ln;
use sprag_shared::observers::outcome::Outcome;

use super::choice::complete;
use super::design::Design;
use super::findings::Row;
use super::limit::{Limits, Quantity};
use super::motion::{Motion, Shaking};
use super::problem::{Problem, Solution};
use super::response::Response;
use crate::statistics::{Bootstrap, Groups, Paired, quantile};

/// How sure the choice is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ranking {
    /// How the motions were drawn anew.
    pub bootstrap: Bootstrap,
    /// Groups of motions that are taken as independent: earthquakes, and records whose earthquake is not known.
    pub groups: usize,
    /// The latter.
    pub records_without_event: usize,
    /// Pulses, each a group: no sample of anything, so that a band says how much the choice depends on which of them there are.
    #[serde(skip_serializing_if = "is_zero")]
    pub pulses: usize,
    /// The bare block, and the best of every other law and mount that respects the limits.
    pub rivals: Vec<Rival>,
    /// Laws and mounts by how often they are chosen when as many groups are drawn with replacement; none where there is one group, which
    /// every resample is.
    pub chosen_again: Vec<ChosenAgain>,
    /// Share of the motions that overturn the device that is chosen without them: what to expect under motions of the same kind that had no
    /// say in the choice. Null where no resample leaves a motion out.
    pub probability_left_out: Option<f64>,
}

/// The chosen device beside another one. Differences are those of the other one less those of the chosen: above 0 the chosen is better.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rival {
    /// The other one.
    #[serde(flatten)]
    pub row: Row,
    /// Difference of the shares of the motions that overturn.
    pub overturning: Paired,
    /// Whether under every motion both overturn or both stand.
    #[serde(skip)]
    pub alike: bool,
    /// Difference of ln max |θ| under motions that rock both and overturn neither; null without any.
    pub log_rotation: Option<Paired>,
    /// Whether the difference in overturning is more than chance: its band leaves 0 out, and so does the sign test over groups.
    pub sure: bool,
}

/// A law on a mount.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChosenAgain {
    /// Clutch law.
    pub law: String,
    /// Mount.
    pub mount: String,
    /// Share of the resamples.
    pub share: f64,
}

impl Ranking {
    /// Of `best`, the choice among the designs of `solution`, beside `rivals`, each with its row.
    pub(super) fn of(problem: &Problem<'_>, solution: &Solution, best: &Design, rivals: Vec<(&Design, Row)>) -> Ranking {
        let bootstrap = problem.choices.study.bootstrap;
        let groups = problem.groups();
        let rival = |(design, row): (&Design, Row)| {
            let overturning = overturning(problem, best, design)?;
            let sure = overturning.is_sure(bootstrap.level);
            let rotations = sums(best, design, problem.motions.len(), log_rotation);
            let outcomes = |design: &Design| -> Vec<Option<bool>> {
                design.responses.iter().map(|response| Some(response.as_ref().ok()?.outcome.overturned())).collect()
            };
            let alike = outcomes(best) == outcomes(design);
            Some(Rival { row, overturning, alike, log_rotation: groups.paired_repeatedly(&rotations, bootstrap), sure })
        };
        let (chosen_again, probability_left_out) =
            if groups.number() > 1 { again(problem, solution, &groups, bootstrap) } else { (Vec::new(), None) };
        Ranking {
            bootstrap,
            groups: groups.number(),
            records_without_event: without_event(problem),
            pulses: problem.choices.pulses.len(),
            rivals: rivals.into_iter().filter_map(rival).collect(),
            chosen_again,
            probability_left_out,
        }
    }
}

fn is_zero(count: &usize) -> bool {
    *count == 0
}

fn without_event(problem: &Problem<'_>) -> usize {
    let unknown = |motion: &&Motion<'_>| matches!(motion.shaking, Shaking::Record { record, .. } if record.event.is_none());
    let mut names: Vec<&str> = problem.motions.iter().filter(unknown).map(Motion::group).collect();
    names.dedup();
    names.len()
}

/// Share of the motions that overturn `other` less that of `best`.
pub(super) fn overturning(problem: &Problem<'_>, best: &Design, other: &Design) -> Option<Paired> {
    let shares = |best: &Response, other: &Response| Some(overturned(other) - overturned(best));
    let found = sums(best, other, problem.motions.len(), shares);
    problem.groups().paired_repeatedly(&found, problem.choices.study.bootstrap)
}

fn overturned(response: &Response) -> f64 {
    f64::from(u8::from(response.outcome.overturned()))
}

/// ln of the other peak rotation over the best one's, where both rock and stand.
fn log_rotation(best: &Response, other: &Response) -> Option<f64> {
    let peak = |response: &Response| response.peak_rotation.filter(|peak| response.outcome != Outcome::NoRocking && *peak > 0.0);
    Some(ln(peak(other)? / peak(best)?))
}

/// What `of` makes of both designs under each of so many `motions`: its sum over the specimens, and the number of those that it can be made of.
fn sums(best: &Design, other: &Design, motions: usize, of: fn(&Response, &Response) -> Option<f64>) -> Vec<Option<(f64, u32)>> {
    let under = |motion: usize| {
        let pairs = best.responses.iter().zip(&other.responses).skip(motion).step_by(motions);
        let found: Vec<f64> = pairs.filter_map(|(best, other)| of(best.as_ref().ok()?, other.as_ref().ok()?)).collect();
        (!found.is_empty()).then(|| (found.iter().sum(), found.len() as u32))
    };
    (0..motions).map(under).collect()
}

/// A design that may be chosen, group by group.
struct Contender<'a> {
    design: &'a Design,
    /// Motions that overturn it, specimen by specimen.
    overturned: Vec<Vec<u32>>,
    /// Rotations that its median is of, infinite where it overturns.
    rotations: Vec<Vec<f64>>,
}

impl<'a> Contender<'a> {
    fn new(design: &'a Design, bare: &Design, groups: &Groups) -> Contender<'a> {
        let motions = groups.of_pairs().len();
        let specimens = design.responses.len() / motions.max(1);
        let (mut overturned, mut rotations) = (vec![vec![0; groups.number()]; specimens], vec![Vec::new(); groups.number()]);
        for (index, (response, bare)) in design.responses.iter().zip(&bare.responses).enumerate() {
            let (Ok(response), group) = (response, groups.of_pairs()[index % motions]) else { continue };
            overturned[index / motions][group] += u32::from(response.outcome.overturned());
            if bare.as_ref().is_ok_and(|bare| bare.outcome != Outcome::NoRocking) {
                rotations[group].push(response.peak_rotation.unwrap_or(f64::INFINITY));
            }
        }
        Contender { design, overturned, rotations }
    }

    /// Motions that overturn each specimen, where every group counts by its weight.
    fn counts(&self, weights: &[u32]) -> Vec<u64> {
        let of = |counts: &Vec<u32>| weights.iter().zip(counts).map(|(weight, count)| u64::from(weight * count)).sum();
        self.overturned.iter().map(of).collect()
    }

    fn median(&self, weights: &[u32]) -> f64 {
        let drawn = weights.iter().zip(&self.rotations).flat_map(|(weight, rotations)| (0..*weight).flat_map(move |_| rotations));
        quantile(&drawn.copied().collect::<Vec<f64>>(), 0.5).unwrap_or(0.0)
    }
}

/// What is chosen when groups are drawn anew, among the designs that respect the limits under all motions: a limit is a demand, and no
/// statistic. Beside it the share of the motions left out that overturn what is chosen without them.
fn again(problem: &Problem<'_>, solution: &Solution, groups: &Groups, bootstrap: Bootstrap) -> (Vec<ChosenAgain>, Option<f64>) {
    let (choices, objective) = (&problem.choices, problem.objective());
    let limits: &Limits = &choices.limits;
    let allowed = solution.designs.iter().filter(|design| complete(design) && limits.allow(&design.score));
    let contenders: Vec<Contender<'_>> = allowed.map(|design| Contender::new(design, &solution.bare, groups)).collect();
    let mut sizes = vec![0_u64; groups.number()];
    groups.of_pairs().iter().for_each(|&group| sizes[group] += problem.specimens.len() as u64);
    let choose = |index: u32| {
        let weights = groups.weights(bootstrap.seed, index);
        let values: Vec<f64> = contenders.iter().map(|contender| objective.of(&contender.counts(&weights))).collect();
        let least = values.iter().copied().min_by(f64::total_cmp)?;
        let tied = contenders.iter().zip(&values).filter(|(_, value)| **value == least).map(|(contender, _)| contender);
        let merit = |contender: &&Contender<'_>| (contender.median(&weights), contender.design.score.asks(Quantity::Force));
        let ranked = tied.map(|contender| (merit(&contender), contender));
        let (_, chosen) = ranked.min_by(|(a, _), (b, _)| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)))?;
        let unseen: Vec<u32> = weights.iter().map(|weight| u32::from(*weight == 0)).collect();
        let motions: u64 = unseen.iter().zip(&sizes).map(|(unseen, size)| u64::from(*unseen) * size).sum();
        let left_out = (chosen.counts(&unseen).into_iter().sum::<u64>(), motions);
        Some((chosen.design.candidate?.curve, left_out))
    };
    let chosen: Vec<(usize, (u64, u64))> = (0..bootstrap.resamples).into_par_iter().filter_map(choose).collect();
    let mut counts = vec![0_usize; choices.curves.len()];
    chosen.iter().for_each(|(curve, _)| counts[*curve] += 1);
    let mut of_curves: Vec<(usize, usize)> = counts.into_iter().enumerate().filter(|(_, count)| *count > 0).collect();
    of_curves.sort_by_key(|(curve, count)| (std::cmp::Reverse(*count), *curve));
    let named = |(curve, count): (usize, usize)| ChosenAgain {
        law: choices.curves[curve].law.clone(),
        mount: choices.curves[curve].mount.clone(),
        share: count as f64 / chosen.len() as f64,
    };
    let (overturned, of) = chosen.iter().fold((0, 0), |(sum, of), (_, out)| (sum + out.0, of + out.1));
    (of_curves.into_iter().map(named).collect(), (of > 0).then(|| overturned as f64 / of as f64))
}
