//! A curve in a panel: decimated, cut at the panel's edges, dashed.

use std::ops::Range;

use super::decimate::decimate;
use super::layer::{path_through, write_path};
use super::palette::Stroke;
use super::panel::Panel;

/// Appends the curve through `points` to `svg`.
pub(super) fn write_curve(svg: &mut String, panel: &Panel<'_>, points: &[(f64, f64)], stroke: Stroke) {
    let few = decimate(points, &panel.x, panel.width_px as usize);
    let piece = |piece: Vec<(f64, f64)>| path_through(piece.into_iter().map(|point| panel.position_px(point)));
    write_path(svg, &cut(&few, &panel.y).into_iter().map(piece).collect::<String>(), stroke);
}

/// The pieces of a polyline that lie within `y`, with end points on the edges where it leaves and enters.
fn cut(points: &[(f64, f64)], y: &Range<f64>) -> Vec<Vec<(f64, f64)>> {
    let mut pieces: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut open = false;
    for pair in points.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let Some((enter, leave)) = inside(from.1, to.1, y) else {
            open = false;
            continue;
        };
        let at = |part: f64| match part {
            0.0 => from,
            1.0 => to,
            part => (from.0 + part * (to.0 - from.0), (from.1 + part * (to.1 - from.1)).clamp(y.start, y.end)),
        };
        match pieces.last_mut() {
            Some(piece) if open && enter == 0.0 => piece.push(at(leave)),
            _ => pieces.push(vec![at(enter), at(leave)]),
        }
        open = leave == 1.0;
    }
    pieces
}

/// The fractions of the way from `from` to `to` at which a segment enters and leaves `y`.
fn inside(from: f64, to: f64, y: &Range<f64>) -> Option<(f64, f64)> {
    let rise = to - from;
    if rise == 0.0 {
        return (from >= y.start && from <= y.end).then_some((0.0, 1.0));
    }
    let (start, end) = ((y.start - from) / rise, (y.end - from) / rise);
    let enter = start.min(end).max(0.0);
    let leave = start.max(end).min(1.0);
    (enter < leave).then_some((enter, leave))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_inside_is_one_piece() {
        let points = [(0.0, 0.0), (1.0, 1.0), (1.0, -1.0), (2.0, 0.0)];
        assert_eq!(cut(&points, &(-1.0..1.0)), vec![points.to_vec()]);
    }

    #[test]
    fn a_curve_is_cut_where_it_leaves_and_enters() {
        let points = [(0.0, 0.0), (1.0, 2.0), (2.0, 2.0), (3.0, -2.0)];
        let pieces = cut(&points, &(-1.0..1.0));
        assert_eq!(pieces, vec![vec![(0.0, 0.0), (0.5, 1.0)], vec![(2.25, 1.0), (2.75, -1.0)]]);
        assert!(cut(&[(0.0, 5.0), (1.0, 1e300)], &(-1.0..1.0)).is_empty());
    }
}
