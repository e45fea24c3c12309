//! Which of two designs is better, and which of many is best.

use std::cmp::Ordering;

use super::design::Design;
use super::limit::{Limits, Quantity};

/// `one` before `other` if it overturns under fewer motions, in the mean over the specimens or in their quantile; if equally many, by the
/// smaller median rotation, then by the smaller force, and else by the order of laws, mounts and mass ratios.
///
/// With as many motions that overturn the block, as many of the rotations are infinite for both.
pub fn preference(one: &Design, other: &Design) -> Ordering {
    let place = |design: &Design| design.candidate.map_or((0, 0.0), |candidate| (candidate.curve + 1, candidate.mass_ratio));
    let ((curve, mass_ratio), (other_curve, other_mass_ratio)) = (place(one), place(other));
    let (a, b) = (&one.score, &other.score);
    a.objective
        .total_cmp(&b.objective)
        .then(a.median_rotation.total_cmp(&b.median_rotation))
        .then(a.asks(Quantity::Force).total_cmp(&b.asks(Quantity::Force)))
        .then(curve.cmp(&other_curve))
        .then(mass_ratio.total_cmp(&other_mass_ratio))
}

/// Whether every motion has a response.
pub fn complete(design: &Design) -> bool {
    design.score.failed == 0
}

/// The best of the `designs` that respect `limits`; `None` where none does.
pub fn best<'a>(designs: impl IntoIterator<Item = &'a Design>, limits: &Limits) -> Option<&'a Design> {
    designs.into_iter().filter(|design| complete(design) && limits.allow(&design.score)).min_by(|a, b| preference(a, b))
}

/// The one of the `designs` that asks for the least beyond `limits`.
pub fn nearest<'a>(designs: impl IntoIterator<Item = &'a Design>, limits: &Limits) -> Option<&'a Design> {
    let demand = |design: &Design| limits.demand(&design.score);
    let order = |a: &&Design, b: &&Design| demand(a).total_cmp(&demand(b)).then(preference(a, b));
    designs.into_iter().filter(|design| complete(design)).min_by(order)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optimise::design::{Candidate, Score};

    fn design(curve: usize, mass_ratio: f64, score: Score) -> Design {
        Design { candidate: Some(Candidate { curve, mass_ratio, delay_s: 0.0 }), responses: Vec::new(), score }
    }

    fn scored(overturned: usize, median_rotation: f64, force_ratio: f64) -> Score {
        Score {
            motions: 87,
            overturned,
            objective: overturned as f64,
            median_rotation,
            force_ratio: Some(force_ratio),
            ..Score::default()
        }
    }

    const LIMITS: Limits = Limits { force: Some(0.3), ..Limits::NONE };

    #[test]
    fn ties_are_broken_by_rotation_then_force_then_order() {
        let better_first = [
            scored(2, f64::INFINITY, 0.9),
            scored(3, 0.2, 0.9),
            scored(3, 0.4, 0.1),
            scored(3, 0.4, 0.2),
            scored(3, f64::INFINITY, 0.1),
            scored(3, f64::INFINITY, 0.2),
        ];
        for pair in better_first.windows(2) {
            let [one, other] = [design(5, 3.0, pair[0]), design(0, 1.0, pair[1])];
            assert_eq!(preference(&one, &other), Ordering::Less, "{pair:?}");
            assert_eq!(preference(&other, &one), Ordering::Greater);
        }
        let same = scored(3, 0.4, 0.1);
        assert_eq!(preference(&design(0, 2.0, same), &design(1, 1.0, same)), Ordering::Less);
        assert_eq!(preference(&design(1, 1.0, same), &design(1, 2.0, same)), Ordering::Less);
    }

    #[test]
    fn only_what_is_allowed_and_complete_is_best() {
        let designs = [
            design(0, 0.1, scored(9, 0.5, 0.1)),
            design(0, 0.2, scored(5, 0.5, 0.3)),
            design(0, 0.3, scored(1, 0.5, 0.31)),
            design(0, 0.4, Score { failed: 1, ..scored(0, 0.5, 0.1) }),
        ];
        assert_eq!(best(&designs, &LIMITS), Some(&designs[1]));
        let tighter = Limits { force: Some(0.05), ..LIMITS };
        assert_eq!(best(&designs, &tighter), None);
        assert_eq!(nearest(&designs, &tighter), Some(&designs[0]));
    }

    #[test]
    fn a_tighter_limit_is_never_better() {
        let designs: Vec<Design> =
            (1..40_u32).map(|k| design(0, f64::from(k), scored(((k * 7) % 13) as usize, 0.1, f64::from(k % 11)))).collect();
        let overturned = |limit: f64| best(&designs, &Limits { force: Some(limit), ..LIMITS }).unwrap().score.overturned;
        let found: Vec<usize> = (0..11).map(|limit| overturned(f64::from(limit))).collect();
        assert!(found.windows(2).all(|pair| pair[1] <= pair[0]) && found[0] > found[10], "{found:?}");
    }
}
