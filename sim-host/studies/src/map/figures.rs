//! A map as pictures: regions of outcomes, spectra of peaks in bands, and cuts along one axis.

use sprag_ensemble::pulsed::PulseResult;
use sprag_report::heading;
use sprag_report::heading::axis_title;
use sprag_report::plot::{
    Cell, CellMap, CellMaps, Chart, ChartPanel, Class, FigureTitle, Line, PlotError, Scale, band, cell_map_figure, chart_figure,
};
use sprag_shared::math;
use sprag_shared::observers::outcome::Outcome;
use sprag_sim::scene::map::{AxisTable, OverturnedAt, ScaleName};

use super::tally::{DeviceMap, Shown, Tally};
use sprag_sim::map::grid::Grid;

/// A peak of a cell.
type Peak = fn(&PulseResult) -> f64;

/// Bands of a spectrum, at most.
const BANDS: f64 = 14.0;

/// What the spectra show.
const ROTATION: &str = "peak rotation max |θ|/α";
const ACCELERATION: &str = "peak angular acceleration max |θ̈|/(p²α)";

/// The pictures of a map: name, and SVG text where there is something to draw.
pub fn figures(grid: &Grid, tally: &Tally) -> Vec<(&'static str, Result<String, PlotError>)> {
    let Some(y) = &grid.map.y else {
        return vec![("cut", cut(grid, tally))];
    };
    let outcomes = small_multiples(grid, y, tally, "", Class::outcomes(), |result| Cell::from(result.outcome).class());
    let mut files = vec![("map", cell_map_figure(&outcomes))];
    let spectra: [(&str, &str, Peak); 2] = [
        ("rotation", ROTATION, |result| result.peak_rotation),
        ("acceleration", ACCELERATION, |result| result.peak_acceleration),
    ];
    // Nobody looks for the acceleration of closed loops.
    let shown = if grid.map.laws.is_empty() { spectra.len() } else { 1 };
    for (file, name, peak) in spectra.into_iter().take(shown) {
        let safe = tally.maps.iter().flat_map(|map| &map.shown).filter(|result| !result.outcome.overturned()).map(peak);
        let limits = limits(safe.fold(0.0, f64::max));
        let classes = Class::bands(&limits);
        let overturned = classes.len() - 1;
        let class = |result: &PulseResult| {
            if result.outcome.overturned() {
                return overturned;
            }
            let rocks = result.outcome != Outcome::NoRocking;
            band(&limits, rocks.then(|| peak(result)))
        };
        files.push((file, cell_map_figure(&small_multiples(grid, y, tally, name, classes, class))));
    }
    files
}

/// Round limits of bands from 0 up to `largest`.
fn limits(largest: f64) -> Vec<f64> {
    let rough = (largest / BANDS).max(1e-12);
    let decade = math::pow(10.0, math::log10(rough).floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * decade).find(|step| *step >= rough).unwrap_or(rough);
    (0..=(largest / step) as usize).map(|index| index as f64 * step).collect()
}

/// One map a device, side by side.
pub(super) fn small_multiples(
    grid: &Grid,
    y: &AxisTable,
    tally: &Tally,
    what: &str,
    classes: Vec<Class>,
    class: impl Fn(&PulseResult) -> usize,
) -> CellMaps {
    let cells = grid.columns() * grid.rows();
    let note = |map: &DeviceMap| format!("{} of {cells} overturn", map.counts.overturned());
    CellMaps {
        title: title(grid, what),
        classes,
        scales: (scale(&grid.map.x), scale(y)),
        x_title: axis_title(&grid.scene, &grid.map.x.key),
        x: ends(&grid.map.x, &tally.columns),
        y_title: axis_title(&grid.scene, &y.key),
        y: ends(y, &tally.rows),
        maps: tally
            .maps
            .iter()
            .map(|map| CellMap {
                title: map.device.clone(),
                note: note(map),
                columns: tally.columns.count(),
                rows: tally.rows.count(),
                to_the_edges: false,
                cells: map.shown.iter().map(&class).collect(),
                curves: Vec::new(),
            })
            .collect(),
        curves: Vec::new(),
        columns: tally.maps.len().min(3),
    }
}

/// The scene's title and what the picture shows, and below it what no axis sets: so that pictures of the same scene differ.
fn title(grid: &Grid, what: &str) -> FigureTitle {
    let (last_column, last_row) = (grid.columns() - 1, grid.rows() - 1);
    let corners = [(0, 0), (last_column, 0), (0, last_row), (last_column, last_row)];
    // The grid has made them all before; what holds at the corners holds between them.
    let corners: Vec<_> = corners.into_iter().filter_map(|(column, row)| grid.scene_of(column, row).ok()).collect();
    let parts = [grid.scene.file.title.as_str(), what];
    let text = parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(": ");
    let mut conditions = heading::of_scenes(&corners.iter().collect::<Vec<_>>());
    conditions.extend((grid.map.overturned_at == OverturnedAt::Slenderness).then(|| "overturned at |*θ*| = α".to_owned()));
    FigureTitle { text, conditions }
}

/// Peaks along the only axis, a line a device, broken where the block overturns. A device that has none is in the legend all the same, so that
/// each looks as in every other picture of the scene.
fn cut(grid: &Grid, tally: &Tally) -> Result<String, PlotError> {
    let overturns = |map: &DeviceMap| map.shown.iter().all(|result| result.outcome.overturned());
    if tally.maps.iter().all(overturns) {
        return Err(PlotError::AllOverturn);
    }
    let peaks: [(&str, Peak); 2] =
        [("max |*θ*|/α", |result| result.peak_rotation), ("max |*θ*''|/(*p*²α)", |result| result.peak_acceleration)];
    let lines = |peak: Peak| {
        let mut lines = Vec::new();
        for map in &tally.maps {
            if overturns(map) {
                lines.push(Line { name: format!("{} (overturns throughout)", map.device), ..Line::default() });
            }
            let runs = map.shown.chunk_by(|a, b| a.outcome.overturned() == b.outcome.overturned());
            let mut first = 0;
            for run in runs {
                let at = |index: usize| grid.map.x.value(first + index);
                let points: Vec<(f64, f64)> = run.iter().enumerate().map(|(index, result)| (at(index), peak(result))).collect();
                first += run.len();
                if !run[0].outcome.overturned() {
                    lines.push(Line { name: map.device.clone(), points, ..Line::default() });
                }
            }
        }
        lines
    };
    let shown = if grid.map.laws.is_empty() { peaks.len() } else { 1 };
    let panels = peaks
        .into_iter()
        .take(shown)
        .map(|(y_title, peak)| ChartPanel { y_title: y_title.to_owned(), lines: lines(peak), ..ChartPanel::default() })
        .collect();
    chart_figure(&Chart {
        title: title(grid, ""),
        x_title: axis_title(&grid.scene, &grid.map.x.key),
        x: scale(&grid.map.x),
        // Where all devices overturn at an end, the axis shows it all the same.
        x_range: Some((grid.map.x.value(0), grid.map.x.value(grid.columns() - 1))),
        panels,
        columns: 1,
        ..Chart::default()
    })
}

fn scale(axis: &AxisTable) -> Scale {
    match axis.scale {
        ScaleName::Linear => Scale::Linear,
        ScaleName::Logarithmic => Scale::Logarithmic,
    }
}

/// The first and the last of the cells that are shown, as the scale of their axis is divided.
fn ends(axis: &AxisTable, shown: &Shown) -> (f64, f64) {
    let [first, last] = [0, shown.count() - 1].map(|place| axis.value(shown.cell(place)));
    match axis.scale {
        ScaleName::Linear => (first, last),
        ScaleName::Logarithmic => (math::log10(first), math::log10(last)),
    }
}

#[cfg(test)]
mod tests {
    use sprag_report::plot::assert_drawn;
    use sprag_sim::scene::Scene;

    use super::*;

    /// The cut of a scene with three devices, in all cells of which those that `overturn` do so.
    fn cut_where(overturn: [bool; 3]) -> Result<String, PlotError> {
        cut_of(|device, _| overturn[device])
    }

    /// The same, with the devices and cells that overturn.
    fn cut_of(overturns: impl Fn(usize, usize) -> bool) -> Result<String, PlotError> {
        let scene = "
            title = 'Cut'
            block = { frequency_parameter_1_s = 2.0, slenderness_deg = 12.0 }
            device = [{ kind = 'none' }, { kind = 'inerter', mass_ratio = 0.6 }, { kind = 'clutched-pair', mass_ratio = 0.6 }]
            ground = [{ motion = 'sine', amplitude_ratio = 3.0, frequency_ratio = 2.0 }]
            map.x = { key = 'ground.0.amplitude_ratio', from = 1.0, to = 9.0, cells = 5 }";
        let text: toml::Table = toml::from_str(scene).unwrap();
        let grid = Grid::new(Scene::of_table(text.clone(), "scene").unwrap(), text).unwrap();
        let mut tally = Tally::new(&grid);
        for row in 0..grid.table_rows() {
            let outcome = if overturns(row / 5, row % 5) { Outcome::OverturnedAfterImpact } else { Outcome::Safe };
            tally.add(row, PulseResult { outcome, peak_rotation: 0.1 + 0.01 * row as f64, peak_acceleration: 1.0 });
        }
        let [("cut", svg)] = <[_; 1]>::try_from(figures(&grid, &tally)).unwrap() else { panic!("a cut is one picture") };
        svg
    }

    #[test]
    fn a_device_that_overturns_throughout_a_cut_keeps_its_look_and_its_name() {
        // The third of the palette.
        const BLUE: &str = "stroke=\"#0072b2\"";
        let (all, two) = (cut_where([false; 3]).unwrap(), cut_where([true, false, false]).unwrap());
        assert_drawn(&two);
        assert_eq!(two.matches(BLUE).count(), all.matches(BLUE).count());
        assert!(all.contains(BLUE) && !all.contains("overturns throughout"));
        assert_eq!(two.matches("none (overturns throughout)").count(), 1);
        assert_eq!(cut_where([true; 3]), Err(PlotError::AllOverturn));
    }

    #[test]
    fn a_cut_shows_its_range_where_all_devices_overturn_at_an_end() {
        let ticks = |svg: &str| [">2<", ">4<", ">6<", ">8<"].map(|tick| svg.matches(tick).count());
        let (all, low) = (cut_where([false; 3]).unwrap(), cut_of(|_, cell| cell > 1).unwrap());
        assert_drawn(&low);
        assert_eq!(ticks(&low), [2; 4]);
        assert_eq!(ticks(&low), ticks(&all));
        assert_eq!(ticks(&cut_of(|_, cell| cell < 3).unwrap()), ticks(&all));
    }

    #[test]
    fn limits_are_round_and_few() {
        assert_eq!(limits(1.0).len(), 11);
        for largest in [0.003, 0.9, 1.07, 4.4, 12.0, 99.0, 3e5] {
            let limits = limits(largest);
            assert!(limits.len() <= 15 && limits.len() >= 5, "{largest}: {limits:?}");
            assert!(limits[limits.len() - 1] <= largest);
        }
        assert_eq!(limits(0.0), vec![0.0]);
    }
}
