//! What a map keeps of its cells: how many have each outcome, and those that pictures show.

use serde::Serialize;
use sprag_ensemble::pulsed::PulseResult;
use sprag_shared::observers::outcome::Outcome;

use sprag_sim::map::grid::Grid;

/// Cells that a picture shows along an axis, at most: more than a page can print. A cut, which is a line, shows all.
const MOST_SHOWN: usize = 1024;

/// How many cells have each outcome.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Counts {
    /// The block never uplifts.
    pub no_rocking: usize,
    /// It rocks and stays up.
    pub safe: usize,
    /// It overturns before any impact.
    pub overturned_without_impact: usize,
    /// It overturns after one impact or more.
    pub overturned_after_impact: usize,
}

impl Counts {
    /// One more of `outcome`.
    pub fn add(&mut self, outcome: Outcome) {
        *match outcome {
            Outcome::NoRocking => &mut self.no_rocking,
            // Studies refuse a run that ends in flight.
            Outcome::Safe | Outcome::LiftedOff => &mut self.safe,
            Outcome::OverturnedWithoutImpact => &mut self.overturned_without_impact,
            Outcome::OverturnedAfterImpact => &mut self.overturned_after_impact,
        } += 1;
    }

    /// Number of cells that overturn.
    pub fn overturned(&self) -> usize {
        self.overturned_without_impact + self.overturned_after_impact
    }

    /// Number of all cells.
    pub fn cells(&self) -> usize {
        self.no_rocking + self.safe + self.overturned()
    }
}

/// The map of one device, as it is or by one law.
#[derive(Clone, Debug)]
pub struct DeviceMap {
    /// Name of the device.
    pub device: String,
    /// Outcomes of all cells.
    pub counts: Counts,
    /// The cells that are shown, row by row from the lowest, each from the left.
    pub shown: Vec<PulseResult>,
    /// Cells that were worked out in this run, which are fewer than all of a run that was resumed.
    pub worked_out: usize,
    /// Time that those took, s.
    pub seconds: f64,
}

/// The cells along an axis that are shown: all, or as many as a picture has room for, evenly spread.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shown {
    shown: usize,
    /// Where each cell is shown, if it is.
    places: Vec<Option<usize>>,
}

impl Shown {
    fn new(cells: usize, most: usize) -> Shown {
        let shown = cells.min(most);
        let mut new = Shown { shown, places: vec![None; cells] };
        for place in 0..shown {
            let cell = new.cell(place);
            new.places[cell] = Some(place);
        }
        new
    }

    /// How many.
    pub fn count(&self) -> usize {
        self.shown
    }

    /// The cell that is shown in `place`: the one in the middle of its share of the axis.
    pub fn cell(&self, place: usize) -> usize {
        (2 * place + 1) * self.places.len() / (2 * self.shown)
    }
}

/// What is kept of a map, however many cells it has.
#[derive(Clone, Debug)]
pub struct Tally {
    /// Shown across.
    pub columns: Shown,
    /// Shown up.
    pub rows: Shown,
    /// A map a device.
    pub maps: Vec<DeviceMap>,
    of_device: usize,
}

impl Tally {
    /// Tally of no cell yet.
    pub fn new(grid: &Grid) -> Tally {
        let most = if grid.rows() == 1 { grid.columns() } else { MOST_SHOWN };
        let (columns, rows) = (Shown::new(grid.columns(), most), Shown::new(grid.rows(), most));
        let map = |name: &str| DeviceMap {
            device: name.to_owned(),
            counts: Counts::default(),
            shown: vec![PulseResult::NO_ROCKING; columns.count() * rows.count()],
            worked_out: 0,
            seconds: 0.0,
        };
        let maps = grid.mapped().iter().map(|mapped| map(&mapped.name)).collect();
        Tally { columns, rows, maps, of_device: grid.columns() * grid.rows() }
    }

    /// Notes the `result` of row number `row` of the map's table.
    pub fn add(&mut self, row: usize, result: PulseResult) {
        let (device, cell) = (row / self.of_device, row % self.of_device);
        let Some(map) = self.maps.get_mut(device) else { return };
        map.counts.add(result.outcome);
        let across = self.columns.places.len();
        if let (Some(column), Some(up)) = (self.columns.places[cell % across], self.rows.places[cell / across]) {
            map.shown[up * self.columns.count() + column] = result;
        }
    }

    /// Notes that `cells` cells of device number `device` took `seconds`.
    pub fn time(&mut self, device: usize, cells: usize, seconds: f64) {
        if let Some(map) = self.maps.get_mut(device) {
            map.worked_out += cells;
            map.seconds += seconds;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shown_cells_are_spread_evenly() {
        assert!((0..40).all(|cell| Shown::new(40, 100).places[cell] == Some(cell)));
        for (cells, most) in [(41, 40), (100, 7), (1024, 1024), (99_999, 1024)] {
            let shown = Shown::new(cells, most);
            let places: Vec<usize> = shown.places.iter().copied().flatten().collect();
            assert!(places.iter().copied().eq(0..most), "{cells} {most}");
            for place in 0..most {
                let middle = (place as f64 + 0.5) * cells as f64 / most as f64;
                assert!((shown.cell(place) as f64 + 0.5 - middle).abs() <= 1.0, "{cells} {most} {place}");
            }
        }
    }
}
