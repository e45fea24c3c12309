//! Curves over a map, such as the boundaries between its regions.

use super::layer::{path_through, write_path};
use super::legend::{LegendEntry, Swatch};
use super::palette::{Stroke, device_look};
use super::panel::Panel;

/// Distance below which points of a curve are drawn as one (px).
const DETAIL_PX: f64 = 0.2;
/// Thinner than a curve alone, for boundaries that lie close together (px).
const STROKE_PX: f64 = 1.1;

/// A curve over a map.
#[derive(Debug, Clone, PartialEq)]
pub struct MapCurve {
    /// Place of its name among [`super::CellMaps::curves`], and so its look.
    pub kind: usize,
    /// Points in drawing order, on the scales of the axes (decimal logarithms on a logarithmic one); the first again at the end of a
    /// closed curve.
    pub points: Vec<(f64, f64)>,
}

fn stroke(kind: usize) -> Stroke {
    Stroke { width_px: STROKE_PX, ..device_look(kind).stroke() }
}

/// The legend entry of a kind of curves.
pub(super) fn curve_key(kind: usize, name: &str) -> LegendEntry {
    (Swatch::Line(stroke(kind)), name.to_owned())
}

/// Appends `curves`, a path for each kind, so that those of one kind lie on one level.
pub(super) fn write_curves(svg: &mut String, panel: &Panel<'_>, curves: &[MapCurve], kinds: usize) {
    for kind in 0..kinds {
        let path: String = curves.iter().filter(|curve| curve.kind == kind).map(|curve| path(panel, &curve.points)).collect();
        write_path(svg, &path, stroke(kind));
    }
}

/// The curve in drawing units, without points that nobody can distinguish from the one before; nothing for a curve smaller than that.
fn path(panel: &Panel<'_>, points: &[(f64, f64)]) -> String {
    let mut drawn: Vec<(f64, f64)> = Vec::new();
    for (index, point) in points.iter().enumerate() {
        let (x, y) = panel.position_px(*point);
        let near = drawn.last().is_some_and(|last| (last.0 - x).abs().max((last.1 - y).abs()) < DETAIL_PX);
        if !near {
            drawn.push((x, y));
        } else if index + 1 == points.len() && drawn.len() > 1 {
            drawn.pop();
            drawn.push((x, y));
        }
    }
    if drawn.len() < 2 {
        return String::new();
    }
    path_through(drawn)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_seen_is_not_drawn() {
        let panel = Panel::new((0.0, 0.0), (100.0, 100.0), 0.0..1.0, 0.0..1.0);
        assert_eq!(path(&panel, &[(0.5, 0.5), (0.5001, 0.5)]), "");
        assert_eq!(path(&panel, &[(0.0, 0.0), (0.0001, 0.0), (0.5, 0.5), (0.5001, 0.5)]), "M0 1000L500 500");
        let closed = path(&panel, &[(0.0, 0.0), (0.5, 0.0), (0.0, 0.5), (0.001, 0.0), (0.0, 0.0)]);
        assert_eq!(closed, "M0 1000L500 1000L0 500L0 1000");
    }
}
