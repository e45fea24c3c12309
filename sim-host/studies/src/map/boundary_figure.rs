//! Boundaries as curves around the regions that they divide a map into, small multiples a device.

use sprag_ensemble::pulsed::PulseResult;
use sprag_report::plot::{Cell, Class, MapCurve, PlotError, cell_map_figure};
use sprag_shared::math;
use sprag_shared::observers::outcome::Outcome;
use sprag_sim::scene::map::{AxisTable, ScaleName};

use super::figures::small_multiples;
use super::regions::{Piece, regions};
use super::tally::Tally;
use sprag_sim::map::boundaries::{Boundaries, Boundary};
use sprag_sim::map::grid::{Grid, Values};

/// Every pair of outcomes that a boundary may separate, with its name in the legend; the place is that of its look.
const PAIRS: [(Outcome, Outcome, &str); 6] = [
    (Outcome::Safe, Outcome::OverturnedWithoutImpact, "stands | overturns without an impact"),
    (Outcome::Safe, Outcome::OverturnedAfterImpact, "stands | overturns after an impact"),
    (Outcome::OverturnedWithoutImpact, Outcome::OverturnedAfterImpact, "overturns without | after an impact"),
    (Outcome::NoRocking, Outcome::Safe, "no rocking | stands"),
    (Outcome::NoRocking, Outcome::OverturnedWithoutImpact, "no rocking | overturns without an impact"),
    (Outcome::NoRocking, Outcome::OverturnedAfterImpact, "no rocking | overturns after an impact"),
];

/// The picture of `all`, a [`Boundaries`] for each map of `tally`; none for a cut, whose boundaries are points.
pub fn figure(grid: &Grid, tally: &Tally, all: &[Boundaries]) -> Result<Option<String>, PlotError> {
    let Some(y) = &grid.map.y else { return Ok(None) };
    let class = |outcome: Outcome| Cell::from(outcome).class();
    let mut figure =
        small_multiples(grid, y, tally, "boundaries", Class::pale_outcomes(), |result: &PulseResult| class(result.outcome));
    figure.curves = PAIRS.map(|(_, _, name)| name.to_owned()).to_vec();
    // Of more cells than that the picture shows no steps.
    let all_shown = tally.columns.count() == grid.columns() && tally.rows.count() == grid.rows();
    for ((map, of_device), cells) in figure.maps.iter_mut().zip(all).zip(&tally.maps) {
        map.note = match of_device.unresolved {
            0 => String::new(),
            squares => format!("coarser than the tolerance in {squares} squares"),
        };
        map.curves = curves(grid, y, of_device);
        if all_shown {
            let outcomes: Vec<Outcome> = cells.shown.iter().map(|result| result.outcome).collect();
            let divided = regions(&outcomes, grid.columns(), &pieces(grid, y, of_device));
            (map.columns, map.rows) = (divided.columns, divided.rows);
            map.to_the_edges = true;
            map.cells = divided.outcomes.into_iter().map(class).collect();
        }
    }
    Ok(Some(cell_map_figure(&figure)?))
}

/// The boundaries of a device on the scales of the axes.
fn curves(grid: &Grid, y: &AxisTable, of_device: &Boundaries) -> Vec<MapCurve> {
    let point = |values: &Values| (on_scale(&grid.map.x, values.0), on_scale(y, values.1.unwrap_or_default()));
    let curve = |boundary: &Boundary| {
        let pair = (boundary.left.min(boundary.right), boundary.left.max(boundary.right));
        let kind = PAIRS.iter().position(|(one, other, _)| (*one, *other) == pair)?;
        Some(MapCurve { kind, points: boundary.vertices.iter().map(point).collect() })
    };
    of_device.boundaries.iter().filter_map(curve).collect()
}

/// The boundaries of a device in straight pieces, in cells from the first.
fn pieces(grid: &Grid, y: &AxisTable, of_device: &Boundaries) -> Vec<Piece> {
    let place = |axis: &AxisTable, value: f64| {
        let [first, last, value] = [axis.value(0), axis.value(axis.cells - 1), value].map(|value| on_scale(axis, value));
        (value - first) / (last - first) * (axis.cells - 1) as f64
    };
    let point = |values: &Values| (place(&grid.map.x, values.0), place(y, values.1.unwrap_or_default()));
    let of_boundary = |boundary: &Boundary| {
        let (left, right) = (boundary.left, boundary.right);
        let piece = |pair: &[Values]| Piece { from: point(&pair[0]), to: point(&pair[1]), left, right };
        boundary.vertices.windows(2).map(piece).collect::<Vec<_>>()
    };
    of_device.boundaries.iter().flat_map(of_boundary).collect()
}

fn on_scale(axis: &AxisTable, value: f64) -> f64 {
    match axis.scale {
        ScaleName::Linear => value,
        ScaleName::Logarithmic => math::log10(value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pair_has_a_look() {
        let outcomes = [Outcome::NoRocking, Outcome::Safe, Outcome::OverturnedWithoutImpact, Outcome::OverturnedAfterImpact];
        for (index, one) in outcomes.iter().enumerate() {
            for other in &outcomes[index + 1..] {
                let known = PAIRS.iter().filter(|pair| (pair.0, pair.1) == ((*one).min(*other), (*one).max(*other)));
                assert_eq!(known.count(), 1, "{one} {other}");
            }
        }
    }
}
