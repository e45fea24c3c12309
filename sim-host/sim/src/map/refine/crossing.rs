//! Where boundaries cross the edges of squares: outcomes found so far, and bisection of many edges at once.

use std::collections::HashMap;

use foldhash::fast::FixedState;

use super::lattice::{Along, Edge, Lattice, Point, Position};
use super::square::Square;
use super::trace::Evaluate;

/// A change of outcome on an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Crossing<O> {
    /// The shortest edge that is known to be crossed.
    pub bracket: Edge,
    /// Outcome where a walk along the edge comes from.
    pub from: O,
    /// Outcome where it goes to.
    pub to: O,
}

impl<O> Crossing<O> {
    /// The middle of its bracket in halves of units, which no other bracket shares.
    pub(super) fn vertex(&self) -> Point {
        let (start, end) = (self.bracket.start, self.bracket.end());
        Point { x: start.x + end.x, y: start.y + end.y }
    }
}

/// Times that a bisection continues in both halves.
const MOST_FORKS: u32 = 2;

/// Outcomes of points, each evaluated once and no more of them than a budget allows.
pub(super) struct Outcomes<'a, O, E> {
    pub lattice: Lattice,
    columns: usize,
    grid: &'a [O],
    found: HashMap<Point, O, FixedState>,
    evaluate: Evaluate<'a, Position, O, E>,
    budget: usize,
    /// A point was wanted that the budget did not allow.
    pub exhausted: bool,
}

impl<'a, O: Copy + Eq, E> Outcomes<'a, O, E> {
    pub(super) fn new(
        lattice: Lattice,
        columns: usize,
        grid: &'a [O],
        evaluate: Evaluate<'a, Position, O, E>,
        budget: usize,
    ) -> Self {
        Outcomes { lattice, columns, grid, found: HashMap::default(), evaluate, budget, exhausted: false }
    }

    /// Columns of the grid.
    pub(super) fn columns(&self) -> usize {
        self.columns
    }

    /// Points evaluated so far.
    pub(super) fn evaluations(&self) -> usize {
        self.found.len()
    }

    /// Points that the budget still allows.
    pub(super) fn remaining(&self) -> usize {
        self.budget - self.found.len()
    }

    /// What is known about `point`.
    pub(super) fn get(&self, point: Point) -> Option<O> {
        let (depth, inside) = (self.lattice.depth(), self.lattice.step() - 1);
        if (point.x | point.y) & inside == 0 {
            return self.grid.get((point.y >> depth) as usize * self.columns + (point.x >> depth) as usize).copied();
        }
        self.found.get(&point).copied()
    }

    /// Evaluates those of `points` that are not known yet, in one batch in order of their rows.
    pub(super) fn learn(&mut self, mut points: Vec<Point>) -> Result<(), E> {
        points.retain(|point| self.get(*point).is_none());
        points.sort_unstable();
        points.dedup();
        if points.len() > self.remaining() {
            self.exhausted = true;
            points.truncate(self.remaining());
        }
        let positions: Vec<Position> = points.iter().map(|point| self.lattice.position(*point)).collect();
        if !positions.is_empty() {
            let found = (self.evaluate)(&positions)?;
            self.found.extend(points.into_iter().zip(found));
        }
        Ok(())
    }

    /// The edge's crossing, as far as it is known: from its start and from its end.
    fn crossed(&self, edge: Edge) -> Option<Crossing<O>> {
        let (from, to) = (self.get(edge.start)?, self.get(edge.end())?);
        (from != to).then_some(Crossing { bracket: edge, from, to })
    }

    /// Bisects those of `edges` whose ends differ until their brackets are narrow. Where another outcome turns up inside, both sides of it
    /// are, up to a few on an edge: the squares beside an edge with more are divided, and its halves come back.
    pub(super) fn narrow(&mut self, edges: impl IntoIterator<Item = Edge>) -> Result<(), E> {
        let mut open: Vec<(Crossing<O>, u32)> =
            edges.into_iter().filter_map(|edge| self.crossed(edge)).map(|crossing| (crossing, 0)).collect();
        while !open.is_empty() && !self.exhausted {
            let mut wanted = Vec::new();
            let mut waiting = Vec::new();
            while let Some((crossing, forks)) = open.pop() {
                let middle = crossing.bracket.middle().filter(|_| self.wide(&crossing));
                let Some(middle) = middle else { continue };
                let [lower, upper] = crossing.bracket.halves();
                match self.get(middle) {
                    None => {
                        wanted.push(middle);
                        waiting.push((crossing, forks));
                    }
                    Some(outcome) if outcome == crossing.from => open.push((Crossing { bracket: upper, ..crossing }, forks)),
                    Some(outcome) if outcome == crossing.to => open.push((Crossing { bracket: lower, ..crossing }, forks)),
                    Some(outcome) if forks < MOST_FORKS => {
                        open.push((Crossing { bracket: lower, to: outcome, ..crossing }, forks + 1));
                        open.push((Crossing { bracket: upper, from: outcome, ..crossing }, forks + 1));
                    }
                    Some(_) => {}
                }
            }
            open = waiting;
            self.learn(wanted)?;
        }
        Ok(())
    }

    /// Appends the crossings of `edge` from its start to its end.
    pub(super) fn crossings(&self, edge: Edge, all: &mut Vec<Crossing<O>>) {
        if edge.middle().is_some_and(|middle| self.get(middle).is_some()) {
            edge.halves().into_iter().for_each(|half| self.crossings(half, all));
        } else {
            all.extend(self.crossed(edge));
        }
    }

    /// The crossings met on a counterclockwise walk around `square` from its lower left corner.
    pub(super) fn around(&self, square: &Square) -> Vec<Crossing<O>> {
        let mut all = Vec::new();
        for (number, edge) in square.edges(&self.lattice).into_iter().enumerate() {
            // The walk goes along the lower and the right edge, then back along the upper and the left one.
            if number < 2 {
                self.crossings(edge, &mut all);
            } else {
                let mut back = Vec::new();
                self.crossings(edge, &mut back);
                all.extend(back.into_iter().rev().map(|crossing| Crossing { from: crossing.to, to: crossing.from, ..crossing }));
            }
        }
        all
    }

    /// Whether the bracket of a crossing is wider than the tolerance has it.
    pub(super) fn wide(&self, crossing: &Crossing<O>) -> bool {
        crossing.bracket.length > self.lattice.bracket(&crossing.bracket)
    }

    /// The grid's own edges: those of a row, or of a column.
    pub(super) fn grid_edges(&self) -> impl Iterator<Item = Edge> + use<O, E> {
        let (columns, rows, length) = (self.columns, self.grid.len() / self.columns.max(1), self.lattice.step());
        let places = (0..columns * rows).map(move |index| (index % columns, index / columns));
        places.flat_map(move |(column, row)| {
            let start = Point { x: column as u64 * length, y: row as u64 * length };
            let across = (column + 1 < columns).then_some(Edge { start, along: Along::Columns, length });
            across.into_iter().chain((row + 1 < rows).then_some(Edge { start, along: Along::Rows, length }))
        })
    }
}
