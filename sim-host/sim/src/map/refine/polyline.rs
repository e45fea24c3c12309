//! From pieces of boundaries inside squares to polylines.

use std::collections::BTreeMap;

use super::crossing::Crossing;
use super::lattice::Point;

/// A straight piece of a boundary between points in halves of units; walking along it, `left` lies on the left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Piece<O> {
    pub start: Point,
    pub end: Point,
    pub left: O,
    pub right: O,
}

/// A boundary: vertices in halves of units. Closed where the first is also the last.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Chain<O> {
    pub left: O,
    pub right: O,
    pub vertices: Vec<Point>,
}

/// The crossings met on a counterclockwise walk around a square, joined two by two.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Joined<O> {
    /// Between crossings of one pair of outcomes, none of them across another of its pair.
    pub pieces: Vec<Piece<O>>,
    /// What is left over: more than two outcomes meet inside.
    pub alone: Vec<Crossing<O>>,
}

impl<O: Copy + Ord> Joined<O> {
    /// Of all crossings of a square in the order of the walk.
    pub(super) fn of(crossings: &[Crossing<O>]) -> Joined<O> {
        let mut pieces = Vec::new();
        let mut open: BTreeMap<(O, O), Vec<Crossing<O>>> = BTreeMap::new();
        for &crossing in crossings {
            let (left, right) = (crossing.from.min(crossing.to), crossing.from.max(crossing.to));
            let same_pair = open.entry((left, right)).or_default();
            match same_pair.pop_if(|other| other.from == crossing.to) {
                // Into the square, what the walk comes from lies on the left.
                Some(other) if other.from == left => {
                    pieces.push(Piece { start: other.vertex(), end: crossing.vertex(), left, right });
                }
                Some(other) => pieces.push(Piece { start: crossing.vertex(), end: other.vertex(), left, right }),
                None => same_pair.push(crossing),
            }
        }
        Joined { pieces, alone: open.into_values().flatten().collect() }
    }

    /// All pieces, those of crossings that are left over to a vertex where they `meet`.
    pub(super) fn meeting(mut self, meet: Point) -> Vec<Piece<O>> {
        // One of the crossings may be where they meet.
        for crossing in self.alone.into_iter().filter(|crossing| crossing.vertex() != meet) {
            let vertex = crossing.vertex();
            let (left, right) = (crossing.from.min(crossing.to), crossing.from.max(crossing.to));
            let (start, end) = if crossing.from == left { (vertex, meet) } else { (meet, vertex) };
            self.pieces.push(Piece { start, end, left, right });
        }
        self.pieces
    }
}

/// Joins pieces to chains that end only at the edge of the grid or where more than two boundaries meet; in order of the outcomes, open
/// ones first.
pub(super) fn chains<O: Copy + Ord>(pieces: &[Piece<O>]) -> Vec<Chain<O>> {
    let mut pairs: BTreeMap<(O, O), BTreeMap<Point, Joint>> = BTreeMap::new();
    for piece in pieces {
        let joints = pairs.entry((piece.left, piece.right)).or_default();
        joints.entry(piece.start).or_default().onward.push(piece.end);
        joints.entry(piece.end).or_default().arriving += 1;
    }
    let mut chains = Vec::new();
    for ((left, right), mut joints) in pairs {
        let ends: Vec<Point> = joints.iter().filter(|(_, joint)| !joint.passes()).map(|(point, _)| *point).collect();
        let passing: Vec<Point> = joints.iter().filter(|(_, joint)| joint.passes()).map(|(point, _)| *point).collect();
        for start in ends.iter().chain(&passing) {
            while let Some(vertices) = walk(*start, &mut joints, &ends) {
                chains.push(Chain { left, right, vertices });
            }
        }
    }
    chains
}

/// A vertex with the pieces that start there and the number of those that end there.
#[derive(Default)]
struct Joint {
    onward: Vec<Point>,
    arriving: usize,
}

impl Joint {
    fn passes(&self) -> bool {
        self.onward.len() == 1 && self.arriving == 1
    }
}

/// The chain from `start` to the next of `ends`, which are in order, or back to the start; its pieces are used up. None without a piece
/// from `start`.
fn walk(start: Point, joints: &mut BTreeMap<Point, Joint>, ends: &[Point]) -> Option<Vec<Point>> {
    let mut vertices = vec![start];
    let mut here = start;
    while let Some(next) = joints.get_mut(&here).and_then(|joint| joint.onward.pop()) {
        vertices.push(next);
        here = next;
        if ends.binary_search(&here).is_ok() {
            break;
        }
    }
    (vertices.len() > 1).then_some(vertices)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::refine::lattice::{Along, Edge};

    fn point(x: u64, y: u64) -> Point {
        Point { x, y }
    }

    fn piece(start: (u64, u64), end: (u64, u64), right: u8) -> Piece<u8> {
        Piece { start: point(start.0, start.1), end: point(end.0, end.1), left: 0, right }
    }

    #[test]
    fn chains_are_as_long_as_they_can_be() {
        let pieces = [
            piece((2, 0), (3, 0), 1),
            piece((0, 0), (1, 0), 1),
            piece((1, 0), (2, 0), 1),
            // Another pair of outcomes at the same vertex.
            piece((2, 0), (2, 5), 2),
            // A closed one.
            piece((7, 7), (8, 7), 1),
            piece((8, 8), (7, 7), 1),
            piece((8, 7), (8, 8), 1),
        ];
        let found = chains(&pieces);
        let lengths: Vec<(u8, usize)> = found.iter().map(|chain| (chain.right, chain.vertices.len())).collect();
        assert_eq!(lengths, [(1, 4), (1, 4), (2, 2)]);
        assert_eq!((found[0].vertices[0], found[0].vertices[3]), (point(0, 0), point(3, 0)));
        assert_eq!(found[1].vertices[0], found[1].vertices[3]);
    }

    #[test]
    fn chains_end_where_three_pieces_meet() {
        let pieces = [piece((0, 0), (1, 1), 1), piece((1, 1), (2, 2), 1), piece((1, 1), (2, 0), 1)];
        assert_eq!(chains(&pieces).iter().map(|chain| chain.vertices.len()).collect::<Vec<_>>(), [2, 2, 2]);
    }

    fn crossing(x: u64, from: u8, to: u8) -> Crossing<u8> {
        Crossing { bracket: Edge { start: point(x, 0), along: Along::Columns, length: 1 }, from, to }
    }

    fn meet(crossings: &[Crossing<u8>], centre: Point) -> Vec<Piece<u8>> {
        Joined::of(crossings).meeting(centre)
    }

    #[test]
    fn crossings_of_a_pair_are_joined_and_three_outcomes_meet() {
        let centre = point(100, 100);
        let two = meet(&[crossing(0, 1, 2), crossing(5, 2, 1)], centre);
        assert_eq!(two, [Piece { start: point(1, 0), end: point(11, 0), left: 1, right: 2 }]);
        let reversed = meet(&[crossing(0, 2, 1), crossing(5, 1, 2)], centre);
        assert_eq!(reversed, [Piece { start: point(11, 0), end: point(1, 0), left: 1, right: 2 }]);
        let three = meet(&[crossing(0, 1, 2), crossing(5, 2, 3), crossing(9, 3, 1)], centre);
        assert!(three.len() == 3 && three.iter().all(|piece| (piece.start == centre) != (piece.end == centre)));
        let four = meet(&[crossing(0, 1, 2), crossing(1, 2, 1), crossing(2, 1, 2), crossing(3, 2, 1)], centre);
        assert!(four.len() == 2 && four.iter().all(|piece| piece.start != centre && piece.end != centre));
        // A band between two boundaries.
        let band = meet(&[crossing(0, 1, 2), crossing(1, 2, 3), crossing(2, 3, 2), crossing(3, 2, 1)], centre);
        assert!(band.len() == 2 && band.iter().all(|piece| piece.start != centre && piece.end != centre));
    }
}
