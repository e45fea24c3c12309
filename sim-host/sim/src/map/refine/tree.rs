//! Follows boundaries by dividing the squares that they cross.

use std::collections::{BTreeMap, BTreeSet, HashSet};

use foldhash::fast::FixedState;

use super::crossing::{Crossing, Outcomes};
use super::lattice::{Edge, Point};
use super::polyline::{Joined, Piece, chains};
use super::square::Square;
use super::strands::{STRAIGHT, Strands};
use super::trace::{Traced, Unresolved, polyline};

/// Evaluations that dividing a square takes, about: so many squares are divided at a time that a budget which runs out does so on the
/// squares that come last.
const SQUARE_EVALUATIONS: usize = 80;

/// How far a boundary may have been from its chord in the square before, in tolerances, so that a point of inflection on the chord does
/// not pass for a straight boundary.
const STRAIGHT_BEFORE: f64 = 4.0;

/// The part of a chord near a boundary that needs no look of its own where a single boundary cuts the corner of a square.
const CORNER: f64 = 1.0 / 4.0;

/// A square that a boundary crosses and that is not divided.
#[derive(Clone, Copy, Debug, Default)]
struct Leaf {
    /// The straight pieces between its crossings are as near as wanted, unless they are a tangle.
    settled: bool,
    /// How far boundaries were from their chords in the square that this one is a quarter of, in tolerances; none when that is not known.
    deviation: Option<f64>,
    /// Length of a chord, in tolerances, that a boundary around here was seen to be near to; 0 before.
    straight: f64,
    /// Crossings around it when it was last looked at.
    crossings: Option<usize>,
}

/// Squares of the grid, quarters of those, and so on where boundaries are.
pub(super) struct Tree<'a, O, E> {
    outcomes: Outcomes<'a, O, E>,
    /// Upper right corner of the grid.
    end: Point,
    divided: HashSet<Square, FixedState>,
    leaves: BTreeMap<Square, Leaf>,
    /// Leaves to divide: those with a single boundary first, then tangles; larger ones before smaller ones.
    waiting: BTreeSet<(bool, Square)>,
}

impl<'a, O: Copy + Ord, E> Tree<'a, O, E> {
    /// The squares of a grid with so many rows, two or more, which no boundary has been followed in.
    pub(super) fn new(mut outcomes: Outcomes<'a, O, E>, rows: usize) -> Result<Self, E> {
        let edges: Vec<Edge> = outcomes.grid_edges().collect();
        outcomes.narrow(edges)?;
        let step = outcomes.lattice.step();
        let end = Point { x: (outcomes.columns() as u64 - 1) * step, y: (rows as u64 - 1) * step };
        let mut tree = Tree { outcomes, end, divided: HashSet::default(), leaves: BTreeMap::new(), waiting: BTreeSet::new() };
        for corner in (0..end.y / step).flat_map(|y| (0..end.x / step).map(move |x| Point { x: x * step, y: y * step })) {
            tree.look(Square { level: 0, corner });
        }
        Ok(tree)
    }

    /// Divides until every leaf is settled, no larger than the tolerance, or beyond the budget.
    pub(super) fn divide_all(&mut self) -> Result<(), E> {
        while !self.waiting.is_empty() && !self.outcomes.exhausted {
            let most = (self.outcomes.remaining() / SQUARE_EVALUATIONS).max(1);
            let batch: Vec<Square> = self.waiting.iter().take(most).map(|(_, square)| *square).collect();
            let lattice = &self.outcomes.lattice;
            let inner: Vec<Edge> = batch.iter().flat_map(|square| square.inner_edges(lattice)).collect();
            let outer: Vec<Edge> = batch.iter().flat_map(|square| square.edges(lattice)).collect();
            self.outcomes.learn(inner.iter().flat_map(|edge| [edge.start, edge.end()]).collect())?;
            self.outcomes.narrow(inner.into_iter().chain(outer.into_iter().flat_map(|edge| edge.halves())))?;
            let mut changed = BTreeSet::new();
            for square in batch {
                changed.extend(square.neighbours(&self.outcomes.lattice, self.end).filter_map(|beside| self.leaf_over(beside)));
                if self.outcomes.exhausted {
                    changed.insert(square);
                } else {
                    changed.extend(self.divide(square));
                }
            }
            // Some of them have been divided after they were noted.
            changed.retain(|square| !self.divided.contains(square));
            changed.into_iter().for_each(|square| self.look(square));
        }
        Ok(())
    }

    /// The leaf that `square` is or lies in; none when it is divided.
    fn leaf_over(&self, square: Square) -> Option<Square> {
        if self.divided.contains(&square) {
            return None;
        }
        let mut leaf = square;
        while let Some(parent) = leaf.parent(&self.outcomes.lattice) {
            if self.divided.contains(&parent) {
                break;
            }
            leaf = parent;
        }
        Some(leaf)
    }

    /// Notes whether boundaries cross an undivided square, and whether it needs to be divided.
    fn look(&mut self, square: Square) {
        let crossings = self.outcomes.around(&square);
        self.waiting.remove(&(false, square));
        self.waiting.remove(&(true, square));
        if crossings.is_empty() {
            self.leaves.remove(&square);
            return;
        }
        let leaf = self.leaves.entry(square).or_default();
        // A neighbour that was divided has come upon further ones.
        if leaf.crossings.is_some_and(|before| before != crossings.len()) {
            *leaf = Leaf::default();
        }
        leaf.crossings = Some(crossings.len());
        let Leaf { settled, straight, .. } = *leaf;
        let alone = crossings.len() == 2;
        let strands = Strands::of(&crossings, self.outcomes.lattice.tolerances(square.corner));
        let near =
            !strands.tangled && (settled || strands.longest() <= STRAIGHT || alone && strands.longest() <= CORNER * straight);
        if !near && square.level < self.outcomes.lattice.finest_level(square.corner) {
            self.waiting.insert((!alone, square));
        }
    }

    /// Replaces `square`, whose inner edges are known, by its quarters.
    fn divide(&mut self, square: Square) -> [Square; 4] {
        let leaf = self.leaves.remove(&square).unwrap_or_default();
        self.waiting.remove(&(false, square));
        self.waiting.remove(&(true, square));
        self.divided.insert(square);
        let crossings = self.outcomes.around(&square);
        let alone = crossings.len() == 2;
        let strands = Strands::of(&crossings, self.outcomes.lattice.tolerances(square.corner));
        let mut inside = Vec::new();
        square.inner_edges(&self.outcomes.lattice).into_iter().for_each(|edge| self.outcomes.crossings(edge, &mut inside));
        let inside: Vec<Point> = inside.iter().map(Crossing::vertex).collect();
        let next = match strands.deviation(&inside) {
            _ if strands.tangled => Leaf::default(),
            // Without crossings in the midst nothing has been learnt.
            None if alone => Leaf { crossings: None, ..leaf },
            None => Leaf::default(),
            Some(found) => Leaf {
                settled: found <= STRAIGHT && leaf.deviation.is_some_and(|before| before <= STRAIGHT_BEFORE),
                deviation: Some(found),
                straight: if alone && found <= STRAIGHT_BEFORE { strands.longest() } else { 0.0 },
                crossings: None,
            },
        };
        let quarters = square.quarters(&self.outcomes.lattice);
        self.leaves.extend(quarters.map(|quarter| (quarter, next)));
        quarters
    }

    /// The boundaries through all leaves.
    pub(super) fn traced(self) -> Traced<O> {
        let lattice = &self.outcomes.lattice;
        let mut unresolved = Unresolved::default();
        let mut all: Vec<Piece<O>> = Vec::new();
        for square in self.leaves.keys() {
            let crossings = self.outcomes.around(square);
            let side = square.side(lattice);
            let waits = [false, true].iter().any(|tangled| self.waiting.contains(&(*tangled, *square)));
            let (across, up) = lattice.tolerances(square.corner);
            let size = side as f64 * across.max(up);
            if waits || size > 1.0 && crossings.iter().any(|crossing| self.outcomes.wide(crossing)) {
                unresolved.add(size);
            }
            let strands = Strands::of(&crossings, (across, up));
            let centre = Point { x: 2 * square.corner.x + side, y: 2 * square.corner.y + side };
            all.extend(Joined::of(&crossings).meeting(strands.meet.unwrap_or(centre)));
        }
        let polylines = chains(&all).into_iter().map(|chain| polyline(lattice, chain)).collect();
        Traced { polylines, evaluations: self.outcomes.evaluations(), unresolved }
    }
}
