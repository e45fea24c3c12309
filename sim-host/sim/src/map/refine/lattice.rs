//! The points that a boundary may be looked for at: the grid's own, and dyadic ones between them.

/// A place of the grid in steps of it: whole numbers are grid points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position {
    /// From the left, 0 to columns − 1.
    pub column: f64,
    /// From below, 0 to rows − 1.
    pub row: f64,
}

/// How closely boundaries are wanted, interval by interval of the grid, each as a share of the interval (a tenth: ten tolerances fit
/// into it).
#[derive(Clone, Debug, PartialEq)]
pub struct Tolerance {
    /// Between neighbouring columns: columns − 1 shares.
    pub columns: Vec<f64>,
    /// Between neighbouring rows: rows − 1 shares.
    pub rows: Vec<f64>,
}

/// A point in units of the lattice, of which 2^depth make a step of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Point {
    pub y: u64,
    pub x: u64,
}

/// Which coordinate changes along an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Along {
    Columns,
    Rows,
}

/// A piece of a line of the lattice, as long as a power of two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Edge {
    pub start: Point,
    pub along: Along,
    pub length: u64,
}

impl Edge {
    fn at(&self, distance: u64) -> Point {
        match self.along {
            Along::Columns => Point { x: self.start.x + distance, ..self.start },
            Along::Rows => Point { y: self.start.y + distance, ..self.start },
        }
    }

    pub(super) fn end(&self) -> Point {
        self.at(self.length)
    }

    /// None for an edge of one unit.
    pub(super) fn middle(&self) -> Option<Point> {
        (self.length > 1).then(|| self.at(self.length / 2))
    }

    pub(super) fn halves(&self) -> [Edge; 2] {
        let length = self.length / 2;
        [Edge { length, ..*self }, Edge { start: self.at(length), length, ..*self }]
    }
}

/// Halvings that an interval is divided by at most: grid points and halvings together stay exact in an f64.
const DEEPEST: u32 = 34;

/// The parts of a tolerance to which crossings of edges are found, so that the straight pieces between them may use the rest.
const PARTS: f64 = 4.0;

/// Depths and tolerances.
#[derive(Clone, Debug)]
pub(super) struct Lattice {
    /// Halvings of a grid step that make one unit.
    depth: u32,
    tolerance: Tolerance,
}

/// Halvings until no more than `share` is left.
fn halvings(share: f64) -> u32 {
    (0..DEEPEST).find(|level| 1.0 / (1_u64 << level) as f64 <= share).unwrap_or(DEEPEST)
}

impl Lattice {
    pub(super) fn new(tolerance: Tolerance) -> Lattice {
        let shares = tolerance.columns.iter().chain(&tolerance.rows);
        let depth = shares.map(|share| halvings(share / PARTS)).max().unwrap_or(0);
        Lattice { depth, tolerance }
    }

    /// Halvings of a grid step that make one unit.
    pub(super) fn depth(&self) -> u32 {
        self.depth
    }

    /// Units of a grid step.
    pub(super) fn step(&self) -> u64 {
        1 << self.depth
    }

    pub(super) fn position(&self, point: Point) -> Position {
        let step = self.step() as f64;
        Position { column: point.x as f64 / step, row: point.y as f64 / step }
    }

    /// The shares of the tolerance in the interval of columns and of rows that `point` lies in or begins.
    fn shares(&self, point: Point) -> (f64, f64) {
        let share = |shares: &[f64], place: u64| {
            let interval = (place >> self.depth) as usize;
            shares.get(interval).or(shares.last()).copied().unwrap_or(1.0)
        };
        (share(&self.tolerance.columns, point.x), share(&self.tolerance.rows, point.y))
    }

    /// Length of the brackets that crossings of `edge` are narrowed to.
    pub(super) fn bracket(&self, edge: &Edge) -> u64 {
        let (columns, rows) = self.shares(edge.start);
        let share = match edge.along {
            Along::Columns => columns,
            Along::Rows => rows,
        };
        self.step() >> halvings(share / PARTS)
    }

    /// Level of the squares around `point` that are no larger than the tolerance either way.
    pub(super) fn finest_level(&self, point: Point) -> u32 {
        let (columns, rows) = self.shares(point);
        halvings(columns).max(halvings(rows)).min(self.depth)
    }

    /// Tolerances in one unit around `point`, across and up.
    pub(super) fn tolerances(&self, point: Point) -> (f64, f64) {
        let (columns, rows) = self.shares(point);
        let unit = 1.0 / self.step() as f64;
        (unit / columns, unit / rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_reach_the_tolerance_of_their_interval() {
        let lattice = Lattice::new(Tolerance { columns: vec![0.1, 2.0], rows: vec![1e-3] });
        // 4e-3 of a step is less than 2⁻¹¹.
        assert_eq!((lattice.depth(), lattice.step()), (12, 4096));
        let edge = |x: u64, along: Along| Edge { start: Point { x, y: 0 }, along, length: 4096 };
        let step = lattice.step();
        let brackets = [edge(0, Along::Columns), edge(step, Along::Columns), edge(0, Along::Rows)];
        assert_eq!(brackets.map(|edge| lattice.bracket(&edge)), [64, 2048, 1]);
        assert_eq!(lattice.finest_level(Point { x: 5, y: 5 }), 10);
        assert_eq!(lattice.position(Point { x: 4096 + 2048, y: 1 }), Position { column: 1.5, row: 1.0 / 4096.0 });
    }

    #[test]
    fn depth_is_bounded() {
        for share in [0.0, -1.0, f64::NAN, 1e-300] {
            assert_eq!(Lattice::new(Tolerance { columns: vec![share], rows: vec![1.0] }).depth(), DEEPEST);
        }
    }
}
