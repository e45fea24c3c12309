//! The search for the best design: a grid of mass ratios for every law and mount, then more where a limit is reached and around the
//! best of each.
//!
//! Outcomes are counted, so that the objective is a staircase in σ: it has no slope that a method of descent could follow, and a
//! unimodal search would stop at the first of its steps. Forces and rotations are continuous where no outcome changes, and it is these
//! that the refinement follows.

use super::choice::{best, complete, nearest};
use super::design::{Candidate, Design};
use super::limit::{Limits, Quantity};

/// A limit is located between mass ratios whose ratio is at most this.
pub const LIMIT_FACTOR: f64 = 1.001;

/// The neighbours of the best mass ratio of a law and mount are at most this factor away.
pub const BEST_FACTOR: f64 = 1.01;

/// A pair of neighbouring designs of one law and mount, one of which respects the limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// A limit that the other does not respect.
    pub quantity: Quantity,
    /// The design that respects them all.
    pub within: Candidate,
    /// The other.
    pub beyond: Candidate,
}

/// Tries the `grid` of mass ratios, ascending, on every one of `curves` laws and mounts, and refines it; `evaluate` gives a design for
/// each candidate, in their order, and is asked for none twice. The designs come by law and mount, and by mass ratio.
///
/// # Errors
/// The errors of `evaluate`.
pub fn search<E>(
    curves: usize,
    grid: &[f64],
    limits: &Limits,
    mut evaluate: impl FnMut(&[Candidate]) -> Result<Vec<Design>, E>,
) -> Result<Vec<Design>, E> {
    let first = (0..curves).flat_map(|curve| grid.iter().map(move |&mass_ratio| Candidate { curve, mass_ratio, delay_s: 0.0 }));
    let mut batch: Vec<Candidate> = first.collect();
    let mut designs: Vec<Design> = Vec::new();
    while !batch.is_empty() {
        designs.append(&mut evaluate(&batch)?);
        designs.sort_by(|a, b| place(a).partial_cmp(&place(b)).unwrap_or(std::cmp::Ordering::Equal));
        batch = at_limits(&designs, limits);
        if batch.is_empty() {
            batch = around_best(&designs, limits);
        }
    }
    Ok(designs)
}

fn place(design: &Design) -> (usize, f64) {
    design.candidate.map_or((0, 0.0), |candidate| (candidate.curve, candidate.mass_ratio))
}

/// Neighbours of one law and mount.
fn neighbours(designs: &[Design]) -> impl Iterator<Item = ((&Design, Candidate), (&Design, Candidate))> {
    designs.windows(2).filter_map(|pair| {
        let [low, high] = [&pair[0], &pair[1]];
        let (at_low, at_high) = low.candidate.zip(high.candidate)?;
        (at_low.curve == at_high.curve).then_some(((low, at_low), (high, at_high)))
    })
}

/// Halfway between neighbours one of which respects the limits, unless they are close already.
fn at_limits(designs: &[Design], limits: &Limits) -> Vec<Candidate> {
    let between = |((low, at_low), (high, at_high)): ((&Design, Candidate), (&Design, Candidate))| {
        let differ = complete(low) && complete(high) && limits.allow(&low.score) != limits.allow(&high.score);
        halfway(at_low, at_high, LIMIT_FACTOR).filter(|_| differ)
    };
    neighbours(designs).filter_map(between).collect()
}

/// Halfway from the best design of each law and mount to its neighbours, unless they are close already. Where none respects the
/// limits, the one that comes nearest takes its place.
fn around_best(designs: &[Design], limits: &Limits) -> Vec<Candidate> {
    let mut batch = Vec::new();
    for of_curve in designs.chunk_by(|a, b| place(a).0 == place(b).0) {
        let Some(leading) = best(of_curve, limits).or_else(|| nearest(of_curve, limits)) else { continue };
        let touches = |at: Candidate| leading.candidate == Some(at);
        let beside = neighbours(of_curve).filter(|((_, low), (_, high))| touches(*low) || touches(*high));
        batch.extend(beside.filter_map(|((_, low), (_, high))| halfway(low, high, BEST_FACTOR)));
    }
    batch
}

/// Halfway between two that are farther apart than `factor`.
fn halfway(low: Candidate, high: Candidate, factor: f64) -> Option<Candidate> {
    let middle = low.halfway(high);
    let between = low.mass_ratio < middle.mass_ratio && middle.mass_ratio < high.mass_ratio;
    (between && high.mass_ratio > factor * low.mass_ratio).then_some(middle)
}

/// Where limits are reached, by law and mount and mass ratio.
pub fn crossings(designs: &[Design], limits: &Limits) -> Vec<Crossing> {
    let mut found = Vec::new();
    for ((low, at_low), (high, at_high)) in neighbours(designs).filter(|((low, _), (high, _))| complete(low) && complete(high)) {
        let (within, (beyond, at_beyond)) = match [low, high].map(|design| limits.allow(&design.score)) {
            [true, false] => (at_low, (high, at_high)),
            [false, true] => (at_high, (low, at_low)),
            _ => continue,
        };
        let broken = Quantity::ALL.into_iter().filter(|quantity| !limits.respected(*quantity, &beyond.score));
        found.extend(broken.map(|quantity| Crossing { quantity, within, beyond: at_beyond }));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optimise::design::Score;
    use sprag_shared::math;

    /// Two laws whose force grows with σ, the second's twice as fast, and whose overturned motions fall in steps, but for one spike.
    fn design(at: Candidate) -> Design {
        let force_ratio = at.mass_ratio * (at.curve + 1) as f64;
        let steps = math::ln(at.mass_ratio / 4.0).abs().floor();
        let score = Score {
            motions: 50,
            overturned: 10 + steps as usize,
            objective: 10.0 + steps,
            force_ratio: Some(force_ratio),
            median_rotation: (at.mass_ratio - 3.3).abs(),
            ..Score::default()
        };
        Design { candidate: Some(at), responses: Vec::new(), score }
    }

    const GRID: [f64; 6] = [0.1, 0.3, 0.9, 2.7, 8.1, 24.3];

    fn limits(force: Option<f64>) -> Limits {
        Limits { force, ..Limits::NONE }
    }

    fn found(force: Option<f64>) -> (Vec<Design>, usize) {
        let mut asked: Vec<Candidate> = Vec::new();
        let designs = search(2, &GRID, &limits(force), |batch| {
            asked.extend(batch);
            Ok::<_, ()>(batch.iter().copied().map(design).collect())
        })
        .unwrap();
        (designs, asked.len())
    }

    #[test]
    fn nothing_is_asked_for_twice_and_designs_are_in_order() {
        for force in [None, Some(2.0), Some(1e-3), Some(1e3)] {
            let (designs, asked) = found(force);
            assert_eq!(designs.len(), asked);
            assert!(designs.windows(2).all(|pair| place(&pair[0]) < place(&pair[1])), "{force:?}");
            let on_grid =
                |curve: usize| GRID.into_iter().all(|sigma| designs.iter().any(|design| place(design) == (curve, sigma)));
            assert!(on_grid(0) && on_grid(1));
        }
    }

    #[test]
    fn a_limit_is_located_to_a_thousandth() {
        for limit in [0.11, 0.7123, 2.0, 15.0] {
            let (designs, _) = found(Some(limit));
            let crossings = crossings(&designs, &limits(Some(limit)));
            let expected = [0, 1].map(|curve| limit / (curve + 1) as f64);
            let inside = expected.into_iter().enumerate().filter(|(_, sigma)| GRID[0] <= *sigma && *sigma < GRID[5]);
            for (curve, sigma) in inside {
                let crossing = crossings.iter().find(|crossing| crossing.within.curve == curve).unwrap();
                let [within, beyond] = [crossing.within, crossing.beyond].map(|at| at.mass_ratio);
                assert!(
                    within <= sigma && sigma < beyond && beyond <= LIMIT_FACTOR * within,
                    "{limit}: {within} {sigma} {beyond}"
                );
            }
        }
    }

    #[test]
    fn the_best_of_each_law_is_refined_beyond_the_grid() {
        let (designs, _) = found(None);
        for curve in 0..2 {
            let of_curve: Vec<Design> = designs.iter().filter(|design| place(design).0 == curve).cloned().collect();
            let leading = best(&of_curve, &limits(None)).unwrap();
            // The median is least at 3.3, where as few overturn as anywhere.
            let mass_ratio = place(leading).1;
            assert!((mass_ratio / 3.3 - 1.0).abs() < 0.01 && !GRID.contains(&mass_ratio), "{mass_ratio}");
        }
        // Where nothing respects the limit, what asks for least is at the lower end.
        let (designs, _) = found(Some(1e-3));
        assert!(best(&designs, &limits(Some(1e-3))).is_none());
        assert_eq!(nearest(&designs, &limits(Some(1e-3))).map(place), Some((0, 0.1)));
    }

    #[test]
    fn an_evaluation_that_fails_ends_the_search() {
        assert_eq!(search(1, &GRID, &limits(None), |_| Err("stopped")), Err("stopped"));
    }
}
