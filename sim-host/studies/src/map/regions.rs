//! The regions of a map as its traced boundaries divide it, finer than the grid.

use sprag_shared::math;
use sprag_shared::observers::outcome::Outcome;

/// Parts that a picture shows along an axis: a side of the largest map in halves of pixels.
const PARTS: usize = 720;

/// Relative difference below which two pieces of a boundary are equally near, since they meet in the nearest point.
const SAME_DISTANCE: f64 = 1e-9;

/// A straight piece of a boundary, in cells from the first, across and up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Where it starts.
    pub from: (f64, f64),
    /// Where it ends.
    pub to: (f64, f64),
    /// Outcome on the left of the way from start to end, x to the right and y up.
    pub left: Outcome,
    /// Outcome on the right.
    pub right: Outcome,
}

/// Regions between the outermost grid points.
#[derive(Clone, Debug, PartialEq)]
pub struct Regions {
    /// Parts in a row.
    pub columns: usize,
    /// Rows of parts.
    pub rows: usize,
    /// Outcomes of the parts, row by row from the lowest.
    pub outcomes: Vec<Outcome>,
}

/// Divides the squares between the points of `grid`, rows of `columns` outcomes, so that regions end at the boundaries `pieces`.
///
/// A part lies on that side of the boundaries in its square on which the nearest of them has it. In squares where that contradicts a
/// corner, such as one that was left coarser, parts are like the nearest grid point; so are squares without a boundary.
pub fn regions(grid: &[Outcome], columns: usize, pieces: &[Piece]) -> Regions {
    let rows = grid.len() / columns;
    let parts = PARTS.div_ceil(columns.max(rows));
    let squares = columns - 1;
    let mut of_square: Vec<Vec<Piece>> = vec![Vec::new(); squares * (rows - 1)];
    for piece in pieces {
        for row in span(piece.from.1, piece.to.1, rows) {
            for column in span(piece.from.0, piece.to.0, columns) {
                of_square[row * squares + column].push(*piece);
            }
        }
    }
    let outcome = |column: usize, row: usize| grid[row * columns + column];
    for row in 0..rows - 1 {
        for column in 0..squares {
            let own = &mut of_square[row * squares + column];
            let corners = [(column, row), (column + 1, row), (column, row + 1), (column + 1, row + 1)];
            let agrees = |(x, y): &(usize, usize)| side(own, (*x as f64, *y as f64)) == Some(outcome(*x, *y));
            if !corners.iter().all(agrees) {
                own.clear();
            }
        }
    }
    let place = |index: usize| (index as f64 + 0.5) / parts as f64;
    let (across, up) = (squares * parts, (rows - 1) * parts);
    let part = |index: usize| {
        let (x, y) = (index % across, index / across);
        let at = (place(x), place(y));
        let of_grid = || outcome(at.0.round() as usize, at.1.round() as usize);
        side(&of_square[y / parts * squares + x / parts], at).unwrap_or_else(of_grid)
    };
    Regions { columns: across, rows: up, outcomes: (0..across * up).map(part).collect() }
}

/// Squares that a piece from `one` to `other` may go through, along an axis of `count` grid points.
fn span(one: f64, other: f64, count: usize) -> std::ops::RangeInclusive<usize> {
    let last = (count - 2) as f64;
    let square = |place: f64| place.floor().clamp(0.0, last) as usize;
    square(one.min(other) - 1e-9)..=square(one.max(other) + 1e-9)
}

/// The outcome on that side of the nearest of `pieces` on which `point` lies; `None` without any.
fn side(pieces: &[Piece], point: (f64, f64)) -> Option<Outcome> {
    let mut nearest: Option<(f64, f64, &Piece)> = None;
    for piece in pieces {
        let (dx, dy) = (piece.to.0 - piece.from.0, piece.to.1 - piece.from.1);
        let (px, py) = (point.0 - piece.from.0, point.1 - piece.from.1);
        let length = dx * dx + dy * dy;
        if length == 0.0 {
            continue;
        }
        let along = ((px * dx + py * dy) / length).clamp(0.0, 1.0);
        let (ex, ey) = (px - along * dx, py - along * dy);
        let distance = ex * ex + ey * ey;
        // How far the point is from the line through the piece: of two that meet in the nearest point, the one that shows its side.
        let across = (dx * py - dy * px) / math::square_root(length);
        let better = nearest.is_none_or(|(least, seen, _)| {
            let same = (distance - least).abs() <= SAME_DISTANCE * (1.0 + least);
            if same { across.abs() > seen.abs() } else { distance < least }
        });
        if better {
            nearest = Some((distance, across, piece));
        }
    }
    nearest.map(|(_, across, piece)| if across >= 0.0 { piece.left } else { piece.right })
}

#[cfg(test)]
mod tests {
    use super::*;

    const IN: Outcome = Outcome::OverturnedAfterImpact;
    const OUT: Outcome = Outcome::Safe;

    /// How far outside the disc a place is.
    fn from_edge((x, y): (f64, f64)) -> f64 {
        math::square_root((x - 5.6) * (x - 5.6) + (y - 4.3) * (y - 4.3)) - 3.3
    }

    /// A disc around the middle of a grid of 12 x 10, its edge in `corners` straight pieces.
    fn disc(corners: usize) -> (Vec<Outcome>, Vec<Piece>) {
        let grid =
            (0..120).map(|cell| if from_edge(((cell % 12) as f64, (cell / 12) as f64)) < 0.0 { IN } else { OUT }).collect();
        let corner = |index: usize| {
            let angle = index as f64 / corners as f64 * std::f64::consts::TAU;
            (5.6 + 3.3 * math::cos(angle), 4.3 + 3.3 * math::sin(angle))
        };
        let pieces = (0..corners).map(|index| Piece { from: corner(index), to: corner(index + 1), left: IN, right: OUT });
        (grid, pieces.collect())
    }

    #[test]
    fn regions_end_at_the_boundaries() {
        let (grid, pieces) = disc(2000);
        let regions = regions(&grid, 12, &pieces);
        assert_eq!((regions.columns, regions.rows), (11 * 60, 9 * 60));
        for (index, outcome) in regions.outcomes.iter().enumerate() {
            let place = |index: usize| (index as f64 + 0.5) / 60.0;
            let at = (place(index % regions.columns), place(index / regions.columns));
            assert!((*outcome == IN) == (from_edge(at) < 0.0) || from_edge(at).abs() < 1e-3, "{at:?}");
        }
    }

    #[test]
    fn without_boundaries_regions_are_the_cells() {
        let (grid, pieces) = disc(2000);
        let cells = regions(&grid, 12, &[]);
        let nearest = |part: usize| (part + 30) / 60;
        let cell = |index: usize| nearest(index / cells.columns) * 12 + nearest(index % cells.columns);
        assert!(cells.outcomes.iter().enumerate().all(|(index, outcome)| *outcome == grid[cell(index)]));
        // A boundary that contradicts the grid is not believed.
        let wrong: Vec<Piece> = pieces.iter().map(|piece| Piece { left: OUT, right: IN, ..*piece }).collect();
        assert_eq!(regions(&grid, 12, &wrong), cells);
    }

    #[test]
    fn a_sharp_corner_has_the_side_that_its_pieces_show() {
        let tip = (0.5, 0.5);
        let piece = |from, to| Piece { from, to, left: IN, right: OUT };
        let wedge = [piece((0.0, 0.6), tip), piece(tip, (0.0, 0.4))];
        for (point, expected) in [((0.1, 0.5), OUT), ((0.9, 0.5), IN), ((0.7, 0.52), IN), ((0.7, 0.48), IN), ((0.1, 0.9), IN)] {
            assert_eq!(side(&wedge, point), Some(expected), "{point:?}");
        }
    }
}
