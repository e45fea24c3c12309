//! The boundaries through a square as straight lines, alone or side by side.

use super::chord::Chord;
use super::crossing::Crossing;
use super::lattice::Point;
use super::polyline::Joined;

/// How far boundaries may be from their chords, in tolerances.
pub(super) const STRAIGHT: f64 = 1.0;

/// How far from each other, in tolerances, the crossings of a bundle may be whose outcomes cannot all be seen: brackets and what may hide
/// in them.
const BUNDLE: f64 = 0.5;

/// The part of a chord whose surroundings show how far a boundary goes from it; next to its ends every boundary is near.
const CENTRAL: std::ops::RangeInclusive<f64> = 0.12..=0.88;

/// What the crossings around a square let one expect inside.
#[derive(Clone, Debug)]
pub(super) struct Strands {
    /// From each crossing to another. Boundaries that run side by side, nearer to each other than the tolerance, may have one chord.
    pub chords: Vec<Chord>,
    /// Where boundaries of such a bundle meet.
    pub meet: Option<Point>,
    /// There are more crossings than the chords account for.
    pub tangled: bool,
}

impl Strands {
    /// Of all crossings around a square in the order of a walk; `scale` tolerances make a unit, across and up.
    pub(super) fn of<O: Copy + Ord>(crossings: &[Crossing<O>], scale: (f64, f64)) -> Strands {
        let Joined { pieces, alone } = Joined::of(crossings);
        let mut chords: Vec<Chord> = pieces.iter().map(|piece| Chord::new(piece.start, piece.end, scale)).collect();
        let Some(first) = alone.first() else { return Strands { chords, meet: None, tangled: false } };
        // Of a bundle so thin that not every outcome in it is seen on both sides, the crossings lie around two points.
        let one = first.vertex();
        let near = |here: Point, there: Point| Chord::new(here, there, scale).length() <= BUNDLE;
        let other = alone.iter().map(Crossing::vertex).find(|vertex| !near(one, *vertex)).unwrap_or(one);
        chords.push(Chord::new(one, other, scale));
        let tangled = alone.iter().any(|crossing| !near(one, crossing.vertex()) && !near(other, crossing.vertex()));
        let meet = Point { x: one.x.midpoint(other.x), y: one.y.midpoint(other.y) };
        Strands { chords, meet: (!tangled).then_some(meet), tangled }
    }

    /// Length of the longest chord, in tolerances.
    pub(super) fn longest(&self) -> f64 {
        self.chords.iter().map(Chord::length).fold(0.0, f64::max)
    }

    /// How far boundaries through the points `inside` go from the chords in the middle of them, in tolerances; none unless every chord that
    /// is longer than a tolerance has one of them beside its middle part.
    pub(super) fn deviation(&self, inside: &[Point]) -> Option<f64> {
        let nearest = |point: &Point| self.chords.iter().map(|chord| chord.distance(*point)).fold(f64::INFINITY, f64::min);
        let shown = |chord: &Chord| {
            let beside = |point: &&Point| chord.distance(**point) <= nearest(point) + STRAIGHT;
            inside.iter().filter(beside).any(|point| CENTRAL.contains(&chord.share(*point)))
        };
        if !self.chords.iter().all(|chord| chord.length() <= STRAIGHT || shown(chord)) {
            return None;
        }
        let in_the_middle = |point: &Point| {
            let on = |chord: &Chord| {
                let share = chord.share(*point).clamp(*CENTRAL.start(), *CENTRAL.end());
                // As of a parabola through both ends of the chord.
                chord.distance(*point) / (4.0 * share * (1.0 - share))
            };
            self.chords.iter().map(on).fold(f64::INFINITY, f64::min)
        };
        inside.iter().map(in_the_middle).reduce(f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::refine::lattice::{Along, Edge};

    fn crossing(x: u64, from: u8, to: u8) -> Crossing<u8> {
        Crossing { bracket: Edge { start: Point { x, y: 0 }, along: Along::Columns, length: 2 }, from, to }
    }

    #[test]
    fn boundaries_side_by_side_have_their_chords() {
        let strands = Strands::of(&[crossing(0, 0, 1), crossing(10, 1, 2), crossing(50, 2, 1), crossing(90, 1, 0)], (0.1, 0.1));
        assert!(strands.chords.len() == 2 && !strands.tangled && strands.meet.is_none());
        let inside = [Point { x: 42, y: 4 }, Point { x: 62, y: 6 }];
        let share: f64 = (62.0 - 22.0) / 80.0;
        assert!(
            (strands.deviation(&inside).unwrap() - 0.3 / (4.0 * share * (1.0 - share))).abs() < 1e-12
                && strands.deviation(&[]).is_none()
        );
        // Near the ends of the outer chord, from 2 to 182 halves of units, and beyond those of the inner one.
        assert!(strands.deviation(&[Point { x: 10, y: 4 }, Point { x: 170, y: 6 }]).is_none());
    }

    #[test]
    fn a_bundle_may_have_lost_an_outcome_on_one_side() {
        let bundle = [crossing(0, 0, 2), crossing(100, 2, 1), crossing(102, 1, 0)];
        let strands = Strands::of(&bundle, (0.1, 0.1));
        assert!(strands.chords.len() == 1 && !strands.tangled);
        assert_eq!(strands.meet, Some(Point { x: 104, y: 0 }));
        // Apart, the three meet somewhere.
        let strands = Strands::of(&[bundle[0], bundle[1], crossing(200, 1, 0)], (0.1, 0.1));
        assert!(strands.tangled && strands.meet.is_none());
    }
}
