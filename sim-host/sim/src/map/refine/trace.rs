//! Boundaries between the outcomes of a grid.

use super::crossing::{Crossing, Outcomes};
use super::lattice::{Edge, Lattice, Point, Position, Tolerance};
use super::polyline::Chain;
use super::tree::Tree;

/// Gives the outcomes of places, in order.
pub type Evaluate<'a, P, O, E> = &'a dyn Fn(&[P]) -> Result<Vec<O>, E>;

/// A boundary between two outcomes.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyline<O> {
    /// Outcome on the left of a walk along the vertices, with rows upward: the lesser one. Of a single row: the one before.
    pub left: O,
    /// Outcome on the right. Of a single row: the one behind.
    pub right: O,
    /// Its vertices; the first is the last of a closed one. Of a single row: one.
    pub vertices: Vec<Position>,
}

/// What was not followed to the tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Unresolved {
    /// Squares, or intervals of a single row, which boundaries go through somehow.
    pub squares: usize,
    /// Width or height of the largest, whichever is more, in tolerances.
    pub largest: f64,
}

/// Boundaries of a grid of outcomes.
#[derive(Clone, Debug, PartialEq)]
pub struct Traced<O> {
    /// In order of their outcomes.
    pub polylines: Vec<Polyline<O>>,
    /// Points that were evaluated beside those of the grid.
    pub evaluations: usize,
    /// What the budget left coarser.
    pub unresolved: Unresolved,
}

/// Traces the boundaries between different outcomes of a grid: a boundary that separates neighbouring grid points is followed to within
/// `tolerance`, wherever it leads; one that goes unnoticed between them, such as an island in a square, is not found.
///
/// `grid` are the outcomes at the grid points, row by row from the lowest, each of `columns`. `evaluate` gives those of other places in
/// order; it is called with few large batches and never twice for one place. With one row, changes of outcome along it are narrowed
/// down. No more than `budget` places are evaluated; simple boundaries come first, tangles of several after them, and what is left
/// coarser is reported. The same input gives the same result.
///
/// # Errors
/// The errors of `evaluate`.
pub fn trace<O: Copy + Ord, E>(
    columns: usize,
    grid: &[O],
    tolerance: Tolerance,
    budget: usize,
    evaluate: Evaluate<'_, Position, O, E>,
) -> Result<Traced<O>, E> {
    let rows = grid.len().checked_div(columns).unwrap_or(0);
    let outcomes = Outcomes::new(Lattice::new(tolerance), columns, grid, evaluate, budget);
    if rows < 2 {
        return row(outcomes);
    }
    let mut tree = Tree::new(outcomes, rows)?;
    tree.divide_all()?;
    Ok(tree.traced())
}

/// A single row of the grid.
fn row<O: Copy + Ord, E>(mut outcomes: Outcomes<'_, O, E>) -> Result<Traced<O>, E> {
    let edges: Vec<Edge> = outcomes.grid_edges().collect();
    let mut crossings = Vec::new();
    loop {
        crossings.clear();
        edges.iter().for_each(|edge| outcomes.crossings(*edge, &mut crossings));
        let wide: Vec<Edge> =
            crossings.iter().filter(|crossing| outcomes.wide(crossing)).map(|crossing| crossing.bracket).collect();
        if wide.is_empty() || outcomes.exhausted {
            break;
        }
        outcomes.narrow(wide)?;
    }
    let mut unresolved = Unresolved::default();
    for crossing in crossings.iter().filter(|crossing| outcomes.wide(crossing)) {
        let (across, _) = outcomes.lattice.tolerances(crossing.bracket.start);
        unresolved.add(crossing.bracket.length as f64 * across);
    }
    let chain = |crossing: &Crossing<O>| Chain { left: crossing.from, right: crossing.to, vertices: vec![crossing.vertex()] };
    let polylines = crossings.iter().map(|crossing| polyline(&outcomes.lattice, chain(crossing))).collect();
    Ok(Traced { polylines, evaluations: outcomes.evaluations(), unresolved })
}

impl Unresolved {
    /// One more, so many tolerances wide.
    pub(super) fn add(&mut self, width: f64) {
        self.squares += 1;
        self.largest = self.largest.max(width);
    }
}

/// `chain` in steps of the grid; its vertices are in halves of units.
pub(super) fn polyline<O>(lattice: &Lattice, chain: Chain<O>) -> Polyline<O> {
    let place = |vertex: &Point| {
        let twice = lattice.position(*vertex);
        Position { column: 0.5 * twice.column, row: 0.5 * twice.row }
    };
    Polyline { left: chain.left, right: chain.right, vertices: chain.vertices.iter().map(place).collect() }
}
