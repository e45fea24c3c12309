//! Squares of the quadtree.

use super::lattice::{Along, Edge, Lattice, Point};

/// A square of side 2^−level grid steps, by its lower left corner. Squares are in order of their level, then row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Square {
    pub level: u32,
    pub corner: Point,
}

impl Square {
    /// Units of its side.
    pub(super) fn side(&self, lattice: &Lattice) -> u64 {
        lattice.step() >> self.level
    }

    /// Its four edges: the lower and the right one lie in the direction of a counterclockwise walk, the upper and the left one against it.
    pub(super) fn edges(&self, lattice: &Lattice) -> [Edge; 4] {
        let length = self.side(lattice);
        let Point { x, y } = self.corner;
        [
            Edge { start: self.corner, along: Along::Columns, length },
            Edge { start: Point { x: x + length, y }, along: Along::Rows, length },
            Edge { start: Point { x, y: y + length }, along: Along::Columns, length },
            Edge { start: self.corner, along: Along::Rows, length },
        ]
    }

    /// The four edges that divide it, from its centre to the middles of its sides. Not for squares of one unit.
    pub(super) fn inner_edges(&self, lattice: &Lattice) -> [Edge; 4] {
        let length = self.side(lattice) / 2;
        let Point { x, y } = self.corner;
        let (centre_x, centre_y) = (x + length, y + length);
        [
            Edge { start: Point { x, y: centre_y }, along: Along::Columns, length },
            Edge { start: Point { x: centre_x, y: centre_y }, along: Along::Columns, length },
            Edge { start: Point { x: centre_x, y }, along: Along::Rows, length },
            Edge { start: Point { x: centre_x, y: centre_y }, along: Along::Rows, length },
        ]
    }

    /// Its quarters. Not for squares of one unit.
    pub(super) fn quarters(&self, lattice: &Lattice) -> [Square; 4] {
        let half = self.side(lattice) / 2;
        let Point { x, y } = self.corner;
        [(0, 0), (half, 0), (0, half), (half, half)]
            .map(|(right, up)| Square { level: self.level + 1, corner: Point { x: x + right, y: y + up } })
    }

    /// The square that it is a quarter of; none for a square of the grid.
    pub(super) fn parent(&self, lattice: &Lattice) -> Option<Square> {
        let level = self.level.checked_sub(1)?;
        let inside = (lattice.step() >> level) - 1;
        Some(Square { level, corner: Point { x: self.corner.x & !inside, y: self.corner.y & !inside } })
    }

    /// Squares of its level beside it, within a lattice that ends at `end`.
    pub(super) fn neighbours(&self, lattice: &Lattice, end: Point) -> impl Iterator<Item = Square> {
        let side = self.side(lattice);
        let Point { x, y } = self.corner;
        let corners = [
            x.checked_sub(side).map(|x| Point { x, y }),
            y.checked_sub(side).map(|y| Point { x, y }),
            (x + side < end.x).then_some(Point { x: x + side, y }),
            (y + side < end.y).then_some(Point { x, y: y + side }),
        ];
        let level = self.level;
        corners.into_iter().flatten().map(move |corner| Square { level, corner })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::refine::lattice::Tolerance;

    #[test]
    fn quarters_know_their_square_and_its_neighbours() {
        let lattice = Lattice::new(Tolerance { columns: vec![0.25; 2], rows: vec![0.25] });
        let step = lattice.step();
        let end = Point { x: 2 * step, y: step };
        let square = Square { level: 0, corner: Point { x: step, y: 0 } };
        assert_eq!(square.neighbours(&lattice, end).collect::<Vec<_>>(), [Square { corner: Point { x: 0, y: 0 }, ..square }]);
        for quarter in square.quarters(&lattice) {
            assert_eq!(quarter.parent(&lattice), Some(square));
            assert_eq!(quarter.neighbours(&lattice, end).count(), 3 - usize::from(quarter.corner.x > step));
            assert!(quarter.edges(&lattice).iter().all(|edge| edge.length * 2 == step));
        }
        assert_eq!(square.parent(&lattice), None);
    }
}
