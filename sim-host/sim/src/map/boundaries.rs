//! The boundaries of a map: where one outcome gives way to another, to a relative 1e-6 of the axes' values.

use sprag_shared::math;
use sprag_shared::observers::outcome::Outcome;

use super::cell::CellError;
use super::grid::{Grid, Values};
use super::refine::{Evaluate, Polyline, Position, Tolerance, trace};
use crate::scene::map::{AxisTable, ScaleName};

/// How closely boundaries are followed, relative to the value of either axis.
pub const TOLERANCE: f64 = 1e-6;

/// The part of a linear axis's span below which values count as this part of it: nothing is relative to zero.
pub const NEAR_ZERO: f64 = 1e-3;

/// Evaluations of one device, unless the user has others.
pub const EVALUATIONS: usize = 2_000_000;

/// A boundary between two outcomes.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundary {
    /// Outcome on the left of a walk along the vertices, x to the right and y up. In a cut: at smaller x.
    pub left: Outcome,
    /// Outcome on the right. In a cut: at larger x.
    pub right: Outcome,
    /// Values of the axes; the first is the last of a closed boundary. In a cut: one.
    pub vertices: Vec<Values>,
}

/// The boundaries of one device's map.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundaries {
    /// Name of the device.
    pub device: String,
    /// In order of their outcomes.
    pub boundaries: Vec<Boundary>,
    /// Blocks that were followed beside those of the grid.
    pub evaluations: usize,
    /// Squares (in a cut: intervals) in which the boundaries were not followed to the tolerance, since evaluations ran out.
    pub unresolved: usize,
    /// Width of the largest of them relative to the value of its axis, as the tolerance is; 0 without any.
    pub unresolved_width: f64,
}

impl Boundaries {
    /// Vertices of all boundaries.
    pub fn vertices(&self) -> usize {
        self.boundaries.iter().map(|boundary| boundary.vertices.len()).sum()
    }
}

/// Traces the boundaries of the map of `device`, whose cells have `outcomes`, row by row from the lowest, with no more than `evaluations`
/// further blocks, whose outcomes `evaluate` gives.
///
/// A boundary that separates two neighbouring cells is followed wherever it leads. An island or a bay that no cell lies in and that is
/// not met on the way is not found.
///
/// # Errors
/// Those of `evaluate`.
// Not generic, so that it is compiled here, where it is optimised.
pub fn refine(
    grid: &Grid,
    device: usize,
    outcomes: &[Outcome],
    evaluations: usize,
    evaluate: Evaluate<'_, Values, Outcome, CellError>,
) -> Result<Boundaries, CellError> {
    let values = |place: &Position| grid.values_at(place.column, place.row);
    let tolerance = Tolerance { columns: shares(&grid.map.x), rows: grid.map.y.as_ref().map(shares).unwrap_or_default() };
    let at_positions = |places: &[Position]| evaluate(&places.iter().map(values).collect::<Vec<_>>());
    let traced = trace(grid.columns(), outcomes, tolerance, evaluations, &at_positions)?;
    let boundary = |Polyline { left, right, vertices }: &Polyline<Outcome>| Boundary {
        left: *left,
        right: *right,
        vertices: vertices.iter().map(values).collect(),
    };
    Ok(Boundaries {
        device: grid.mapped()[device].name.clone(),
        boundaries: traced.polylines.iter().map(boundary).collect(),
        evaluations: traced.evaluations,
        unresolved: traced.unresolved.squares,
        unresolved_width: traced.unresolved.largest * TOLERANCE,
    })
}

/// The tolerance between neighbouring cells of `axis`, as a share of the way from one to the next.
fn shares(axis: &AxisTable) -> Vec<f64> {
    let floor = NEAR_ZERO * (axis.to - axis.from);
    let share = |index: usize| {
        let (low, high) = (axis.value(index), axis.value(index + 1));
        match axis.scale {
            ScaleName::Linear => {
                // An interval around zero is as near to it as any.
                let least = if low < 0.0 && high > 0.0 { 0.0 } else { low.abs().min(high.abs()) };
                TOLERANCE * least.max(floor) / (high - low)
            }
            ScaleName::Logarithmic => TOLERANCE / math::ln(high / low),
        }
    };
    (0..axis.cells - 1).map(share).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_are_relative_to_values_and_near_zero_to_the_span() {
        let linear: AxisTable = "block.restitution=-1:3:5".parse().unwrap();
        let expected = [4e-9, 4e-9, 1e-6, 2e-6];
        assert!(shares(&linear).iter().zip(expected).all(|(share, expected)| (share / expected - 1.0).abs() < 1e-12));
        let logarithmic: AxisTable = "block.size_m=0.1:10:3:log".parse().unwrap();
        let expected = TOLERANCE / math::ln(10.0);
        assert!(shares(&logarithmic).iter().all(|share| (share / expected - 1.0).abs() < 1e-12));
    }
}
