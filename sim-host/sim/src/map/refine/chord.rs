//! Straight lines between crossings, measured in tolerances.

use sprag_shared::math;

use super::lattice::Point;

/// A straight line between two crossings, in tolerances from the first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chord {
    start: Point,
    along: (f64, f64),
    scale: (f64, f64),
}

impl Chord {
    /// Between vertices in halves of units; `scale` tolerances make a unit, across and up.
    pub(super) fn new(start: Point, end: Point, scale: (f64, f64)) -> Chord {
        let mut chord = Chord { start, along: (0.0, 0.0), scale };
        chord.along = chord.offset(end);
        chord
    }

    fn offset(&self, point: Point) -> (f64, f64) {
        let halves = |to: u64, from: u64| 0.5 * (to as f64 - from as f64);
        (halves(point.x, self.start.x) * self.scale.0, halves(point.y, self.start.y) * self.scale.1)
    }

    pub(super) fn length(&self) -> f64 {
        math::hypot(self.along.0, self.along.1)
    }

    /// Where the foot of `point`, in halves of units, lies on the chord: 0 at its start, 1 at its end.
    pub(super) fn share(&self, point: Point) -> f64 {
        let ((x, y), (along_x, along_y)) = (self.offset(point), self.along);
        let squared = along_x * along_x + along_y * along_y;
        if squared > 0.0 { ((x * along_x + y * along_y) / squared).clamp(0.0, 1.0) } else { 0.0 }
    }

    /// Of `point`, in halves of units, from the nearest point of the chord.
    pub(super) fn distance(&self, point: Point) -> f64 {
        let ((x, y), share) = (self.offset(point), self.share(point));
        math::hypot(x - share * self.along.0, y - share * self.along.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_in_tolerances_each_way() {
        let chord = Chord::new(Point { x: 10, y: 0 }, Point { x: 18, y: 0 }, (0.5, 4.0));
        assert_eq!(chord.length(), 2.0);
        assert_eq!(chord.distance(Point { x: 14, y: 1 }), 2.0);
        assert_eq!(chord.share(Point { x: 12, y: 7 }), 0.25);
        // Beyond the end.
        assert_eq!(chord.distance(Point { x: 22, y: 0 }), 1.0);
        let point = Chord::new(Point { x: 3, y: 3 }, Point { x: 3, y: 3 }, (1.0, 1.0));
        assert_eq!((point.length(), point.distance(Point { x: 3, y: 1 })), (0.0, 1.0));
    }
}
