//! The delay budget: what is left of the advantage of the chosen device when its clutches engage and release later.

use serde::Serialize;
use sprag_sim::scene::device::Kind;
use sprag_sim::scene::drivetrain::EngagementName;

use super::choice::{best, complete, preference};
use super::design::{Candidate, Design};
use super::findings::Row;
use super::problem::{Choices, Problem, Solution};
use super::ranking::overturning;
use crate::statistics::Paired;

/// How often the delay at which the advantage is lost is bisected between two of the study.
const BISECTIONS: usize = 4;

/// The chosen device with later clutches, beside its best plain rival: the bare block or one inerter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DelayBudget {
    /// The rival.
    pub rival: Row,
    /// By delay, 0 first; none where a run failed.
    pub late: Vec<Late>,
    /// Largest delay tried up to which the chosen device is better for sure and respects the limits; null where it is not better without a
    /// delay.
    pub largest_delay_s: Option<f64>,
    /// Least delay tried at which one of both is lost, or a run failed; null where there is none.
    pub lost_at_s: Option<f64>,
}

/// The chosen device with clutches that are later.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Late {
    /// By so much, s.
    pub delay_s: f64,
    /// Share of the motions that overturn it; in the mean over the specimens, as the difference is.
    pub probability: f64,
    /// Share of the motions that overturn the rival less that.
    pub overturning: Paired,
    /// Whether it is better than the rival for sure, as [`super::ranking::Rival::sure`].
    pub better: bool,
    /// Whether it respects the limits.
    pub feasible: bool,
}

/// Whether anybody commands the clutches of a law and mount of `choices`.
pub(super) fn is_commanded(choices: &Choices<'_>, curve: usize) -> bool {
    let device = &choices.curves[curve].device;
    device.kind == Kind::ClutchedPair && device.engagement != Some(EngagementName::Overrunning)
}

/// Why the device `at` cannot have clutches that are as late as the study asks for, if so.
pub(super) fn refusal(choices: &Choices<'_>, at: Candidate) -> Option<String> {
    let refused = |&delay_s: &f64| choices.curves[at.curve].refusal(&choices.structure.scene, at.mass_ratio, delay_s);
    choices.table.delays_s.iter().filter(|_| is_commanded(choices, at.curve)).find_map(refused)
}

/// The bare block or the best single inerter within the limits, whichever is better.
fn plain<'a>(choices: &Choices<'_>, bare: &'a Design, designs: &'a [Design]) -> &'a Design {
    let is_inerter = |design: &&Design| design.candidate.is_some_and(|at| choices.curves[at.curve].device.kind == Kind::Inerter);
    let inerter = best(designs.iter().filter(is_inerter), &choices.limits);
    inerter.filter(|inerter| preference(inerter, bare).is_lt()).unwrap_or(bare)
}

/// Tries the best of `designs` with the delays of the study, and then between the last at which it is better than its plain rival for sure within
/// the limits and the first at which it is not. By delay; none where it cannot be late.
///
/// # Errors
/// The errors of `evaluate`.
pub(super) fn try_late<E>(
    problem: &Problem<'_>,
    bare: &Design,
    designs: &[Design],
    mut evaluate: impl FnMut(&[Candidate]) -> Result<Vec<Design>, E>,
) -> Result<Vec<Design>, E> {
    let choices = &problem.choices;
    let chosen = best(designs, &choices.limits);
    let can_be_late = |at: &Candidate| is_commanded(choices, at.curve) && refusal(choices, *at).is_none();
    let Some(at) = chosen.and_then(|design| design.candidate).filter(can_be_late) else { return Ok(Vec::new()) };
    let Some(chosen) = chosen.filter(|_| !choices.table.delays_s.is_empty()) else { return Ok(Vec::new()) };
    let rival = plain(choices, bare, designs);
    let delayed: Vec<Candidate> = choices.table.delays_s.iter().map(|&delay_s| Candidate { delay_s, ..at }).collect();
    let mut late = evaluate(&delayed)?;
    for _ in 0..BISECTIONS {
        let Some(lost) = late.iter().position(|design| !is_kept(problem, design, rival)) else { break };
        let before = lost.checked_sub(1).map_or(chosen, |before| &late[before]);
        if !is_kept(problem, before, rival) {
            break;
        }
        let middle = Candidate { delay_s: 0.5 * (delay(before) + delay(&late[lost])), ..at };
        let found = evaluate(&[middle])?;
        late.splice(lost..lost, found);
    }
    Ok(late)
}

fn is_better(problem: &Problem<'_>, design: &Design, rival: &Design) -> bool {
    let level = problem.choices.study.bootstrap.level;
    complete(design) && overturning(problem, design, rival).is_some_and(|paired| paired.difference > 0.0 && paired.is_sure(level))
}

fn is_kept(problem: &Problem<'_>, design: &Design, rival: &Design) -> bool {
    is_better(problem, design, rival) && problem.choices.limits.allow(&design.score)
}

fn delay(design: &Design) -> f64 {
    design.candidate.map_or(0.0, |at| at.delay_s)
}

impl DelayBudget {
    /// Of the designs that `solution` has with later clutches; none without any. `row` makes the row of a design.
    pub(super) fn of(problem: &Problem<'_>, solution: &Solution, row: impl Fn(&Design) -> Row) -> Option<DelayBudget> {
        let choices = &problem.choices;
        let first = solution.late.first()?.candidate?;
        let undelayed = solution.designs.iter().find(|design| design.candidate == Some(Candidate { delay_s: 0.0, ..first }))?;
        let rival = plain(choices, &solution.bare, &solution.designs);
        let of_design = |design: &Design| {
            Some(Late {
                delay_s: delay(design),
                probability: design.score.share(),
                overturning: overturning(problem, design, rival)?,
                better: is_better(problem, design, rival),
                feasible: choices.limits.allow(&design.score),
            })
        };
        let tried: Vec<&Design> = std::iter::once(undelayed).chain(&solution.late).collect();
        let lost = tried.iter().position(|design| !is_kept(problem, design, rival));
        Some(DelayBudget {
            rival: row(rival),
            largest_delay_s: tried[..lost.unwrap_or(tried.len())].last().map(|design| delay(design)),
            lost_at_s: lost.map(|lost| delay(tried[lost])),
            late: tried.into_iter().filter(|design| complete(design)).filter_map(of_design).collect(),
        })
    }

    /// In a line.
    pub fn words(&self) -> String {
        let rival = super::verdict::rival_name(&self.rival);
        match (self.largest_delay_s, self.lost_at_s) {
            (Some(delay), None) => {
                format!("delay budget: still better than {rival} for sure at {delay} s, the largest delay tried")
            }
            (Some(delay), Some(lost)) => {
                let lost_how = match self.late.iter().find(|late| late.delay_s == lost) {
                    Some(late) if late.better => "beyond the limits",
                    Some(_) => "no more",
                    None => "runs fail",
                };
                format!("delay budget: better than {rival} for sure up to {delay:.4} s later, {lost_how} at {lost:.4} s")
            }
            (None, _) => format!("delay budget: none, for it is not better than {rival} for sure without a delay"),
        }
    }
}
