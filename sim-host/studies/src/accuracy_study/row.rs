//! One line of the results.

use serde::Serialize;

use super::board::BoardCost;
use super::variant::Variant;
use crate::statistics::front::undominated;
use crate::statistics::{DemandPoint, PowerLaw};

/// One device, followed in one way.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Number of the device.
    pub device: usize,
    /// How it was followed.
    pub variant: Variant,
    /// Its outcome is that of the reference.
    pub outcome_right: bool,
    /// Relative error of max |θ|/α; `None` where either block overturned.
    pub peak_error: Option<f64>,
    /// Largest error of θ/α over the history, likewise.
    pub history_error: Option<f64>,
    /// Part of the grid's cells whose outcome is wrong, where that was counted.
    pub wrong_share: Option<f64>,
    /// Steps to a simulated second.
    pub steps_per_second: f64,
    /// Nanoseconds to a simulated second, on the host.
    pub nanoseconds: f64,
    /// What a step takes on the microcontroller, where that was measured.
    pub board: Option<BoardCost>,
    /// No other way is both faster and more accurate, by the error of the peak.
    pub on_front: bool,
}

/// As `accuracy.csv` and `summary.json` have it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RowText<'a> {
    pub(super) device: &'a str,
    pub(super) method: &'static str,
    pub(super) events: &'static str,
    pub(super) precision: &'static str,
    pub(super) math: &'static str,
    pub(super) setting: &'static str,
    pub(super) value: f64,
    pub(super) outcome_right: bool,
    pub(super) peak_rotation_error: Option<f64>,
    pub(super) history_error: Option<f64>,
    pub(super) wrong_outcome_share: Option<f64>,
    pub(super) steps_per_s: f64,
    pub(super) nanoseconds_per_s: f64,
    pub(super) board_instructions_per_step: Option<u32>,
    pub(super) board_cycles_per_step: Option<f64>,
    pub(super) on_pareto_front: bool,
}

impl Row {
    /// With the name of its device.
    pub fn text<'a>(&self, device: &'a str) -> RowText<'a> {
        let Variant { family, setting } = self.variant;
        RowText {
            device,
            method: family.method.name(),
            events: family.events(),
            precision: family.number.precision(),
            math: family.number.math(),
            setting: setting.name(),
            value: setting.value(),
            outcome_right: self.outcome_right,
            peak_rotation_error: self.peak_error,
            history_error: self.history_error,
            wrong_outcome_share: self.wrong_share,
            steps_per_s: self.steps_per_second,
            nanoseconds_per_s: self.nanoseconds,
            board_instructions_per_step: self.board.map(|cost| cost.instructions),
            board_cycles_per_step: self.board.map(|cost| cost.cycles()),
            on_pareto_front: self.on_front,
        }
    }
}

/// Marks the rows of every device that no other one beats in both time and error.
pub fn mark_front(rows: &mut [Row]) {
    for device in 0..rows.iter().map(|row| row.device + 1).max().unwrap_or(0) {
        let cost = |row: &Row| row.peak_error.filter(|_| row.device == device).map(|error| (row.nanoseconds, error));
        let on_front = undominated(&rows.iter().filter_map(cost).collect::<Vec<_>>());
        for (row, on_front) in rows.iter_mut().filter(|row| cost(row).is_some()).zip(on_front) {
            row.on_front = on_front && row.outcome_right;
        }
    }
}

/// Order of a family: the slope of the error over the step, both in logarithms, by least squares over the points with errors from
/// `floor` to 0.1. `None` with fewer than three.
pub fn order(points: impl Iterator<Item = (f64, f64)>, floor: f64) -> Option<f64> {
    // An error is a power of the step, as a demand is one of an intensity.
    let read = points.filter(|(_, error)| (floor..=0.1).contains(error));
    let points: Vec<DemandPoint> = read.map(|(intensity, demand)| DemandPoint { intensity, demand }).collect();
    Some(PowerLaw::fit(&points).ok()?.b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy_study::variant::variants;

    fn row(device: usize, nanoseconds: f64, error: f64) -> Row {
        Row {
            device,
            variant: variants(false, 1e-2)[0],
            outcome_right: true,
            peak_error: Some(error),
            history_error: None,
            wrong_share: None,
            steps_per_second: 1.0,
            nanoseconds,
            board: None,
            on_front: false,
        }
    }

    #[test]
    fn the_front_holds_what_nobody_beats() {
        let mut rows = vec![row(0, 1.0, 1e-2), row(0, 2.0, 1e-1), row(0, 3.0, 1e-4), row(0, 2.5, 1e-4), row(1, 9.0, 0.5)];
        mark_front(&mut rows);
        assert_eq!(rows.iter().map(|row| row.on_front).collect::<Vec<_>>(), [true, false, false, true, true]);
    }

    #[test]
    fn an_order_is_found_and_rounding_is_left_out() {
        let fourth = [1e-1, 3e-2, 1e-2, 3e-3, 1e-3].map(|step: f64| (step, 0.3 * step * step * step * step + 1e-13));
        let found = order(fourth.into_iter(), 1e-11).unwrap();
        assert!((found - 4.0).abs() < 0.01, "{found}");
        assert_eq!(order(fourth[..2].iter().copied(), 1e-11), None);
    }
}
