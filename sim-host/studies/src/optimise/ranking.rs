//! How sure a choice is: the chosen device beside its rivals under the same motions, and what would be chosen under others.

use rayon::prelude::*;
use serde::Serialize;
use sprag_shared::math::ln;
use sprag_shared::observers::outcome::Outcome;

use super::choice::complete;
use super::design::Design;
use super::findings::Row;
use super::limit::Limits;
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
    /// The bare block, and the best of every other law and mount that respects the limits.
    pub rivals: Vec<Rival>,
    /// Laws and mounts by how often they are chosen when as many groups are drawn with replacement.
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
        let names: Vec<&str> = problem.motions.iter().map(|motion| motion.group()).collect();
        let groups = Groups::of(&names);
        let rival = |(design, row): (&Design, Row)| {
            let compared = |of: fn(&Response, &Response) -> Option<f64>| {
                groups.paired(&differences(best, design, names.len(), of), bootstrap)
            };
            let overturning = compared(|best, other| Some(overturned(other) - overturned(best)))?;
            let sure = overturning.is_sure(bootstrap.level);
            Some(Rival { row, overturning, log_rotation: compared(log_rotation), sure })
        };
        let (chosen_again, probability_left_out) = again(problem, solution, &groups, bootstrap);
        Ranking {
            bootstrap,
            groups: groups.number(),
            records_without_event: without_event(problem),
            rivals: rivals.into_iter().filter_map(rival).collect(),
            chosen_again,
            probability_left_out,
        }
    }
}

fn without_event(problem: &Problem<'_>) -> usize {
    let mut names: Vec<&str> =
        problem.motions.iter().filter(|motion| motion.record.event.is_none()).map(|motion| motion.group()).collect();
    names.dedup();
    names.len()
}

fn overturned(response: &Response) -> f64 {
    f64::from(u8::from(response.outcome.overturned()))
}

/// ln of the other peak rotation over the best one's, where both rock and stand.
fn log_rotation(best: &Response, other: &Response) -> Option<f64> {
    let peak = |response: &Response| response.peak_rotation.filter(|peak| response.outcome != Outcome::NoRocking && *peak > 0.0);
    Some(ln(peak(other)? / peak(best)?))
}

/// What `of` makes of both designs under each of so many `motions`, in the mean of what it can be made of.
fn differences(best: &Design, other: &Design, motions: usize, of: fn(&Response, &Response) -> Option<f64>) -> Vec<Option<f64>> {
    let under = |motion: usize| {
        let pairs = best.responses.iter().zip(&other.responses).skip(motion).step_by(motions);
        let found: Vec<f64> = pairs.filter_map(|(best, other)| of(best.as_ref().ok()?, other.as_ref().ok()?)).collect();
        (!found.is_empty()).then(|| found.iter().sum::<f64>() / found.len() as f64)
    };
    (0..motions).map(under).collect()
}

/// A design that may be chosen, group by group.
struct Contender<'a> {
    design: &'a Design,
    /// Motions that overturn it.
    overturned: Vec<u32>,
    /// Rotations that its median is of, infinite where it overturns.
    rotations: Vec<Vec<f64>>,
}

impl<'a> Contender<'a> {
    fn new(design: &'a Design, bare: &Design, groups: &Groups) -> Contender<'a> {
        let (mut overturned, mut rotations) = (vec![0; groups.number()], vec![Vec::new(); groups.number()]);
        let pairs = design.responses.iter().zip(&bare.responses).zip(groups.of_pairs().iter().cycle());
        for ((response, bare), &group) in pairs {
            let Ok(response) = response else { continue };
            overturned[group] += u32::from(response.outcome.overturned());
            if bare.as_ref().is_ok_and(|bare| bare.outcome != Outcome::NoRocking) {
                rotations[group].push(response.peak_rotation.unwrap_or(f64::INFINITY));
            }
        }
        Contender { design, overturned, rotations }
    }

    fn count(&self, weights: &[u32]) -> u64 {
        weights.iter().zip(&self.overturned).map(|(weight, count)| u64::from(weight * count)).sum()
    }

    fn median(&self, weights: &[u32]) -> f64 {
        let drawn = weights.iter().zip(&self.rotations).flat_map(|(weight, rotations)| (0..*weight).flat_map(move |_| rotations));
        quantile(&drawn.copied().collect::<Vec<f64>>(), 0.5).unwrap_or(0.0)
    }
}

/// What is chosen when groups are drawn anew, among the designs that respect the limits under all motions: a limit is a demand, and no
/// statistic. Beside it the share of the motions left out that overturn what is chosen without them.
fn again(problem: &Problem<'_>, solution: &Solution, groups: &Groups, bootstrap: Bootstrap) -> (Vec<ChosenAgain>, Option<f64>) {
    let choices = &problem.choices;
    let limits: &Limits = &choices.limits;
    let allowed = solution.designs.iter().filter(|design| complete(design) && limits.allow(&design.score));
    let contenders: Vec<Contender<'_>> = allowed.map(|design| Contender::new(design, &solution.bare, groups)).collect();
    let mut sizes = vec![0_u64; groups.number()];
    let specimens = (solution.bare.responses.len() / problem.motions.len().max(1)) as u64;
    groups.of_pairs().iter().for_each(|&group| sizes[group] += specimens);
    let choose = |index: u32| {
        let weights = groups.weights(bootstrap.seed, index);
        let counts: Vec<u64> = contenders.iter().map(|contender| contender.count(&weights)).collect();
        let least = *counts.iter().min()?;
        let tied = contenders.iter().zip(&counts).filter(|(_, count)| **count == least).map(|(contender, _)| contender);
        let merit = |contender: &&Contender<'_>| (contender.median(&weights), contender.design.score.force_ratio);
        let ranked = tied.map(|contender| (merit(&contender), contender));
        let (_, chosen) = ranked.min_by(|(a, _), (b, _)| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)))?;
        let out = |values: &mut dyn Iterator<Item = u64>| -> u64 {
            weights.iter().zip(values).filter(|(weight, _)| **weight == 0).map(|(_, value)| value).sum()
        };
        let left_out = (out(&mut chosen.overturned.iter().map(|count| u64::from(*count))), out(&mut sizes.iter().copied()));
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
