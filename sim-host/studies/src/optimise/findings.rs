//! What the designs of an optimisation come to: the best, its price, and the fronts.

use serde::Serialize;

use super::choice::{best, complete, nearest};
use super::delay::DelayBudget;
use super::design::{Candidate, Design, Score};
use super::limit::{Limits, Quantity};
use super::problem::{Choices, Problem, Solution};
use super::ranking::Ranking;
use super::search::{BEST_FACTOR, Crossing, crossings};
use super::specimen::Specimen;
use crate::statistics::front::undominated;
use crate::statistics::proportion::wilson;
use crate::statistics::{Band, Level};

/// One design, or the bare block.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Clutch law; "none" for the bare block.
    pub law: String,
    /// Mount.
    pub mount: Option<String>,
    /// σ.
    pub mass_ratio: Option<f64>,
    /// Motions with a response; each counts once a specimen.
    pub motions: usize,
    /// Number of motions that overturn the block, counted likewise.
    pub overturned: usize,
    /// Motions without a response.
    pub failed: usize,
    /// Share of the motions that overturn the block: the mean over the specimens, or their quantile.
    pub probability: f64,
    /// Wilson's band of the probability behind that share.
    pub probability_band: Band,
    /// Motions that overturn the bare block, and not this one.
    pub saved: usize,
    /// Motions that overturn this one, and not the bare block.
    pub newly_overturned: usize,
    /// Quantile of max |F|/(mg) over the motions whose force counts; null where none does.
    pub peak_force_ratio: Option<f64>,
    /// Quantile of the stroke over the motions in which the block stands, m; null without a device, and where it never stands.
    pub stroke_m: Option<f64>,
    /// Quantile of the bending stress of gear teeth over the motions whose force counts, MPa; left out where the scene has no gear.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tooth_stress_mpa: Option<f64>,
    /// Quantile of the energy of the coils over the motions whose force counts, J; left out where the device has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coil_energy_j: Option<f64>,
    /// Median of max |θ|/α over the motions that rock the bare block; null where half of them or more overturn it.
    pub median_peak_rotation: Option<f64>,
    /// Whether it respects the limits.
    pub feasible: bool,
    /// Whether nothing overturns less for the same force.
    pub on_force_front: bool,
    /// Whether nothing overturns less for the same stroke.
    pub on_stroke_front: bool,
    /// Which device it is.
    #[serde(skip)]
    pub candidate: Option<Candidate>,
    /// What it comes to.
    #[serde(skip)]
    pub score: Score,
}

/// A limit, and where along the mass ratios of one law and mount it is reached.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LimitReached {
    /// What is limited.
    pub limit: Quantity,
    /// Clutch law.
    pub law: String,
    /// Mount.
    pub mount: String,
    /// σ that respects all limits.
    pub mass_ratio_within: f64,
    /// σ that does not respect this one.
    pub mass_ratio_beyond: f64,
}

/// The design that asks for the least beyond the limits, where none respects them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Nearest {
    /// The largest of what it asks for over what is allowed.
    pub demand_over_limit: f64,
    /// The design.
    pub design: Row,
}

/// Designs that nothing betters, by the number of motions that overturn them, the bare block first.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Fronts {
    /// Overturning against force, of designs that respect the other limit.
    pub force: Vec<Row>,
    /// Overturning against stroke, of designs that respect the other limit.
    pub stroke: Vec<Row>,
}

/// Everything that an optimisation finds.
#[derive(Clone, Debug, Serialize)]
pub struct Findings {
    /// Motions under which every design is tried.
    pub motions: usize,
    /// Specimens that each of them shakes; left out where the study is not robust.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub specimens: Vec<Specimen>,
    /// Devices tried.
    pub designs: usize,
    /// Runs of one of them, or of the bare block, under one motion.
    pub runs: usize,
    /// Level of the bands.
    pub level: Level,
    /// The bare block.
    pub reference: Row,
    /// The device to choose; null where none respects the limits.
    pub best: Option<Row>,
    /// What comes nearest, where none does.
    pub nearest: Option<Nearest>,
    /// The device to choose if there were no limits.
    pub best_without_limits: Option<Row>,
    /// The best of each law and mount that respects the limits.
    pub best_of_each: Vec<Row>,
    /// How late the clutches of the best may be; left out where the study names no delays, nobody commands the clutches, or they
    /// cannot be late.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub delay_budget: Option<DelayBudget>,
    /// How sure the choice is; null where none respects the limits.
    pub ranking: Option<Ranking>,
    /// The best design, and beside it the next smaller and larger mass ratio of the first grid that are another size.
    pub neighbours: Vec<Row>,
    /// Where limits are reached.
    pub limits_reached: Vec<LimitReached>,
    /// What cannot be had for less.
    pub fronts: Fronts,
    /// What to know of the choice, in a line each.
    pub notes: Vec<String>,
    /// Every device tried, by law and mount and by mass ratio.
    #[serde(skip)]
    pub rows: Vec<Row>,
}

impl Findings {
    /// What `solution` of `problem` says.
    pub fn of(problem: &Problem<'_>, solution: &Solution) -> Findings {
        let Choices { limits, table, study, .. } = &problem.choices;
        let level = study.bootstrap.level;
        let designs = &solution.designs;
        let [force, stroke] = Quantity::TRADED.map(|quantity| front(solution, limits, quantity));
        let row = |design: &Design| {
            // The bare block is the first of a front.
            let place = designs.iter().position(|other| other.candidate == design.candidate).map_or(0, |index| index + 1);
            Row { on_force_front: force[place], on_stroke_front: stroke[place], ..row(problem, design, level) }
        };
        let best_design = best(designs, limits);
        let without = limits.lifted();
        let on = |front: &[bool]| {
            let all = std::iter::once(&solution.bare).chain(designs);
            let mut rows: Vec<Row> = all.zip(front).filter(|(_, on)| **on).map(|(design, _)| row(design)).collect();
            rows.sort_by(|a, b| b.probability.total_cmp(&a.probability));
            rows
        };
        let of_curve = |curve: usize| designs.iter().filter(move |design| design.candidate.is_some_and(|at| at.curve == curve));
        let each: Vec<&Design> = (0..problem.choices.curves.len()).filter_map(|curve| best(of_curve(curve), limits)).collect();
        let ranking = best_design.map(|best| {
            let others = each.iter().copied().filter(|design| design.candidate != best.candidate);
            let rivals = std::iter::once(&solution.bare).chain(others).map(|design| (design, row(design)));
            Ranking::of(problem, solution, best, rivals.collect())
        });
        let grid = table.mass_ratio.grid();
        let neighbours = best_design.and_then(|design| design.candidate).map_or_else(Vec::new, |at| {
            let below = grid.iter().rev().find(|&&mass_ratio| BEST_FACTOR * mass_ratio < at.mass_ratio);
            let above = grid.iter().find(|&&mass_ratio| mass_ratio > BEST_FACTOR * at.mass_ratio);
            let here = [below, Some(&at.mass_ratio), above].into_iter().flatten();
            let found =
                |&mass_ratio: &f64| of_curve(at.curve).find(|design| design.candidate == Some(Candidate { mass_ratio, ..at }));
            here.filter_map(found).map(row).collect()
        });
        let nearest = nearest(designs, limits).filter(|_| best_design.is_none());
        let mut findings = Findings {
            motions: problem.motions.len(),
            specimens: if table.robust.is_some() { problem.specimens.clone() } else { Vec::new() },
            designs: designs.len(),
            runs: solution.runs,
            level,
            reference: row(&solution.bare),
            best: best_design.map(row),
            nearest: nearest.map(|design| Nearest { demand_over_limit: limits.demand(&design.score), design: row(design) }),
            best_without_limits: best(designs, &without).map(row),
            best_of_each: each.into_iter().map(row).collect(),
            delay_budget: DelayBudget::of(problem, solution, row),
            ranking,
            neighbours,
            limits_reached: crossings(designs, limits).into_iter().map(|crossing| reached(&problem.choices, crossing)).collect(),
            fronts: Fronts { force: on(&force), stroke: on(&stroke) },
            notes: Vec::new(),
            rows: designs.iter().map(row).collect(),
        };
        findings.notes = super::notes::notes(&problem.choices, &findings);
        findings
    }
}

/// Which of the bare block and the designs, in this order, are on the front of overturning against `quantity`. The bare block asks for
/// nothing.
fn front(solution: &Solution, limits: &Limits, quantity: Quantity) -> Vec<bool> {
    let bare = |design: &Design| design.candidate.is_none();
    let counts = |design: &Design| complete(design) && (bare(design) || limits.others_respected(quantity, &design.score));
    let point = |design: &Design| {
        let asks = if bare(design) { 0.0 } else { design.score.asks(quantity) };
        (asks, design.score.objective)
    };
    // What does not count is worse than all that does.
    let place = |design: &Design| if counts(design) { point(design) } else { (f64::INFINITY, f64::INFINITY) };
    let points: Vec<(f64, f64)> = std::iter::once(&solution.bare).chain(&solution.designs).map(place).collect();
    let on_front = undominated(&points);
    on_front.iter().zip(&points).map(|(on, point)| *on && point.0.is_finite()).collect()
}

fn row(problem: &Problem<'_>, design: &Design, level: Level) -> Row {
    let score = &design.score;
    // A motion counts once, whatever the number of specimens that it shakes.
    let motions = score.motions as f64 / problem.specimens.len() as f64;
    let of_quantile = problem.objective().quantile.map(|_| score.objective / motions.max(1.0));
    let row = Row { candidate: design.candidate, ..Row::of_score(score) };
    let row = Row {
        probability: of_quantile.unwrap_or(row.probability),
        probability_band: wilson(score.objective, motions, level).unwrap_or(row.probability_band),
        ..row
    };
    let Some(at) = design.candidate else {
        return Row { stroke_m: None, tooth_stress_mpa: None, feasible: complete(design), ..row };
    };
    let curve = &problem.choices.curves[at.curve];
    Row {
        law: curve.law.clone(),
        mount: Some(curve.mount.clone()),
        mass_ratio: Some(at.mass_ratio),
        feasible: complete(design) && problem.choices.limits.allow(score),
        ..row
    }
}

impl Row {
    /// The bare block's, of its `score`.
    pub(super) fn of_score(score: &Score) -> Row {
        Row {
            law: "none".to_owned(),
            mount: None,
            mass_ratio: None,
            motions: score.motions,
            overturned: score.overturned,
            failed: score.failed,
            probability: score.share(),
            // Of nothing nothing is known.
            probability_band: Band { low: 0.0, high: 1.0 },
            saved: score.saved,
            newly_overturned: score.newly_overturned,
            peak_force_ratio: score.force_ratio,
            stroke_m: score.stroke_m,
            tooth_stress_mpa: score.tooth_stress_mpa,
            coil_energy_j: score.coil_energy_j,
            median_peak_rotation: Some(score.median_rotation).filter(|rotation| rotation.is_finite()),
            feasible: true,
            on_force_front: false,
            on_stroke_front: false,
            candidate: None,
            score: *score,
        }
    }
}

fn reached(choices: &Choices<'_>, Crossing { quantity, within, beyond }: Crossing) -> LimitReached {
    let curve = &choices.curves[within.curve];
    LimitReached {
        limit: quantity,
        law: curve.law.clone(),
        mount: curve.mount.clone(),
        mass_ratio_within: within.mass_ratio,
        mass_ratio_beyond: beyond.mass_ratio,
    }
}
