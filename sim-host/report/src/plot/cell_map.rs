//! Small multiples of maps: classes of cells over a grid of two parameters.

use super::cell::Class;
use super::layer::{units, write_rect};
use super::legend::{LegendEntry, Swatch};
use super::map_curve::{MapCurve, curve_key, write_curves};
use super::palette::hex;
use super::panel::Panel;
use super::panel_grid::PanelGrid;
use super::panel_heading::Heading;
use super::ticks::{Scale, drawable};
use super::{FigureTitle, PlotError};

/// Between maps side by side at least, and between a map and the heading below it (px).
const GAP_PX: (f64, f64) = (14.0, 18.0);
/// Width that the maps of a row share, and the limits of one map (px).
const ROW_PX: f64 = 900.0;
const SMALLEST_MAP_PX: f64 = 110.0;
const LARGEST_MAP_PX: f64 = 360.0;
/// Between labels of neighbouring maps (px).
const LABELS_APART_PX: f64 = 8.0;

/// One map.
#[derive(Debug, Clone, PartialEq)]
pub struct CellMap {
    /// Heading.
    pub title: String,
    /// Line below the heading, such as "436 of 1024"; empty for none.
    pub note: String,
    /// Cells in a row.
    pub columns: usize,
    /// Rows of cells.
    pub rows: usize,
    /// Whether the values of the axes are the outer edges of the outermost cells; otherwise they are their middles.
    pub to_the_edges: bool,
    /// Numbers of classes, row by row from the lowest, each from the left.
    pub cells: Vec<usize>,
    /// Curves over the cells.
    pub curves: Vec<MapCurve>,
}

/// A figure of maps over the same two axes.
#[derive(Debug, Clone, PartialEq)]
pub struct CellMaps {
    /// What stands above the figure.
    pub title: FigureTitle,
    /// What cells may be, in the order of the legend.
    pub classes: Vec<Class>,
    /// How the two axes are divided.
    pub scales: (Scale, Scale),
    /// Title of the horizontal axis. In axis titles `*x*` is italic, `_x` one subscript character, `'` a dot and `''` two dots over
    /// the symbol before.
    pub x_title: String,
    /// Values at the centres of the first and the last column of cells; their decimal logarithms on a logarithmic axis.
    pub x: (f64, f64),
    /// Title of the vertical axis.
    pub y_title: String,
    /// Values at the centres of the lowest and the highest row of cells; their decimal logarithms on a logarithmic axis.
    pub y: (f64, f64),
    /// Maps, row by row.
    pub maps: Vec<CellMap>,
    /// Names of the kinds of curves in the legend; none for maps without curves.
    pub curves: Vec<String>,
    /// Maps in a row; zero counts as one.
    pub columns: usize,
}

/// Draws `maps` as an SVG document; the legend has the classes and the kinds of curves that occur.
///
/// Only maps at the left and at the lower edge have labelled axes. Runs of equal cells in a row are one rectangle. The text is the
/// same for the same input.
///
/// # Errors
/// [`PlotError`] without maps or cells, for a list of cells of the wrong length, and for axes that are not finite or do not
/// increase; an axis of a single cell may have two equal values.
pub fn cell_map_figure(maps: &CellMaps) -> Result<String, PlotError> {
    if maps.maps.is_empty() {
        return Err(PlotError::NothingToDraw { title: maps.title.text.clone() });
    }
    for map in &maps.maps {
        check(map, maps)?;
    }
    let columns = maps.columns.clamp(1, maps.maps.len());
    let map_px = |gap_px: f64| (ROW_PX / columns as f64 - gap_px).clamp(SMALLEST_MAP_PX, LARGEST_MAP_PX).floor();
    // Labels at the ends of neighbouring axes keep clear of each other.
    let overhang_px = maps.panel(&maps.maps[0], (0.0, 0.0), map_px(GAP_PX.0)).overhang_px();
    let gap_px = (overhang_px.0 + overhang_px.1 + LABELS_APART_PX).max(GAP_PX.0).ceil();
    let map_px = map_px(gap_px);

    let used = |class: usize| maps.maps.iter().any(|map| map.cells.contains(&class));
    let numbered = maps.classes.iter().enumerate();
    let keys: Vec<LegendEntry> =
        numbered.filter(|(class, _)| used(*class)).map(|(_, class)| (Swatch::Framed(class.colour), class.name.clone())).collect();
    let drawn = |kind: usize| maps.maps.iter().any(|map| map.curves.iter().any(|curve| curve.kind == kind));
    let numbered = maps.curves.iter().enumerate();
    let curve_keys: Vec<LegendEntry> =
        numbered.filter(|(kind, _)| drawn(*kind)).map(|(kind, name)| curve_key(kind, name)).collect();
    let headings: Vec<Heading> =
        maps.maps.iter().map(|map| Heading::of(&map.title, std::slice::from_ref(&map.note), map_px)).collect();
    let grid = PanelGrid { columns, panel_px: (map_px, map_px), gap_px: (gap_px, GAP_PX.1), labels_px: 0.0 };
    grid.document(&maps.title, &[keys, curve_keys], &headings, |svg, place| {
        let map = &maps.maps[place.index];
        let panel = Panel { title: place.first.then_some(&maps.y_title), ..maps.panel(map, place.corner_px, map_px) };
        write_cells(svg, &panel, map, &maps.classes);
        write_curves(svg, &panel, &map.curves, maps.curves.len());
        panel.write_frame(svg, place.lowest.then_some(&maps.x_title));
        Ok(())
    })
}

impl CellMap {
    /// Ends of an axis of `count` cells, the first and the last of which have the values `ends`.
    fn edges(&self, ends: (f64, f64), count: usize) -> (f64, f64) {
        if self.to_the_edges { ends } else { edges(ends, count) }
    }
}

impl CellMaps {
    /// The panel of `map`, `side_px` wide and high, without a title.
    fn panel(&self, map: &CellMap, corner_px: (f64, f64), side_px: f64) -> Panel<'_> {
        let (x, y) = (map.edges(self.x, map.columns), map.edges(self.y, map.rows));
        let panel = Panel::new(corner_px, (side_px, side_px), x.0..x.1, y.0..y.1);
        Panel { scales: self.scales, ends: Some((self.x, self.y)), ..panel }
    }
}

/// Refuses what cannot be drawn.
fn check(map: &CellMap, maps: &CellMaps) -> Result<(), PlotError> {
    let expected = map.columns.saturating_mul(map.rows);
    if map.cells.len() != expected {
        return Err(PlotError::WrongLength { name: map.title.clone(), found: map.cells.len(), expected });
    }
    if expected == 0 || map.cells.iter().any(|class| *class >= maps.classes.len()) {
        return Err(PlotError::NothingToDraw { title: map.title.clone() });
    }
    let points = map.curves.iter().flat_map(|curve| &curve.points);
    if points.flat_map(|point| [point.0, point.1]).any(|value| !value.is_finite()) {
        return Err(PlotError::NotFiniteValue { name: map.title.clone() });
    }
    for (title, (first, last), count) in [(&maps.x_title, maps.x, map.columns), (&maps.y_title, maps.y, map.rows)] {
        if !(drawable(first) && drawable(last)) {
            return Err(PlotError::NotFiniteValue { name: title.clone() });
        }
        // Ticks need steps that change the values they are added to.
        let (low, high) = map.edges((first, last), count);
        if high - low <= 1e-9 * low.abs().max(high.abs()) || high - low < 1e-200 {
            return Err(PlotError::EmptyAxis { title: title.clone() });
        }
    }
    Ok(())
}

/// Outer edges of the first and last of `count` cells with these centres.
fn edges((first, last): (f64, f64), count: usize) -> (f64, f64) {
    let half = match count {
        0 | 1 if first == last => 0.5 * if first == 0.0 { 1.0 } else { first.abs() },
        // A single cell lies between its two values.
        0 | 1 => 0.0,
        count => 0.5 * (last - first) / (count - 1) as f64,
    };
    (first - half, last + half)
}

/// Runs of equal cells in a row: first cell, number of cells, what they are.
fn runs(row: &[usize]) -> Vec<(usize, usize, usize)> {
    let mut runs: Vec<(usize, usize, usize)> = Vec::new();
    for (column, &cell) in row.iter().enumerate() {
        match runs.last_mut() {
            Some(run) if run.2 == cell => run.1 += 1,
            _ => runs.push((column, 1, cell)),
        }
    }
    runs
}

/// Appends the cells: the commonest class as the ground, the others as one path each.
fn write_cells(svg: &mut String, panel: &Panel<'_>, map: &CellMap, classes: &[Class]) {
    let count = |class: &usize| map.cells.iter().filter(|other| *other == class).count();
    let Some(commonest) = (0..classes.len()).max_by_key(count) else {
        return;
    };
    let corner = (units(panel.left_px), units(panel.top_px));
    write_rect(svg, corner, (units(panel.width_px), units(panel.height_px)), classes[commonest].colour);
    let across = |column: usize| units(panel.left_px + panel.width_px * column as f64 / map.columns as f64);
    let up = |row: usize| units(panel.bottom_px() - panel.height_px * row as f64 / map.rows as f64);
    for class in (0..classes.len()).filter(|class| *class != commonest) {
        let mut path = String::new();
        for (row, cells) in map.cells.chunks(map.columns).enumerate() {
            for (first, length, _) in runs(cells).into_iter().filter(|run| run.2 == class) {
                let (left, width) = (across(first), across(first + length) - across(first));
                path.push_str(&format!("M{left} {}h{width}V{}h{}z", up(row), up(row + 1), -width));
            }
        }
        if !path.is_empty() {
            // Crisp edges leave no seams between rows.
            svg.push_str(&format!(
                "<path d=\"{path}\" fill=\"{}\" shape-rendering=\"crispEdges\"/>\n",
                hex(classes[class].colour)
            ));
        }
    }
}

#[cfg(test)]
mod tests {
    use sprag_shared::math;

    use super::*;
    use crate::plot::Cell;
    use crate::plot::assert_drawn;

    fn map(title: &str, columns: usize, rows: usize) -> CellMap {
        let cell = |index: usize| match (index % columns + index / columns, index % columns) {
            (0..4, _) => Cell::NoRocking,
            (4..9, _) => Cell::Stands,
            (_, 0..6) => Cell::OverturnsAfterImpact,
            _ => Cell::Overturns,
        };
        let cells = (0..columns * rows).map(|index| cell(index).class()).collect();
        CellMap {
            title: title.to_owned(),
            note: "1 of <2>".to_owned(),
            columns,
            rows,
            to_the_edges: false,
            cells,
            curves: Vec::new(),
        }
    }

    fn maps(count: usize, columns: usize) -> CellMaps {
        CellMaps {
            title: "A & B".into(),
            classes: Class::outcomes(),
            scales: (Scale::Linear, Scale::Linear),
            x_title: "ω/*p*".to_owned(),
            x: (0.5, 6.0),
            y_title: "*a*_p (g)".to_owned(),
            y: (0.1, 2.0),
            maps: (0..count).map(|index| map(&format!("map <{index}>"), 8, 9)).collect(),
            curves: vec!["first".to_owned(), "second".to_owned(), "third".to_owned()],
            columns,
        }
    }

    #[test]
    fn curves_lie_over_the_cells_and_in_the_legend() {
        let mut maps = maps(2, 2);
        let plain = cell_map_figure(&maps).unwrap();
        assert!(!plain.contains("first"));
        maps.maps[1].curves = vec![MapCurve { kind: 1, points: vec![(1.0, 0.2), (2.0, 0.4), (5.5, 1.9)] }; 2];
        let svg = cell_map_figure(&maps).unwrap();
        assert_drawn(&svg);
        assert!(svg.contains(">second<") && !svg.contains(">first<") && !svg.contains(">third<"));
        maps.maps[1].curves[0].points[1].0 = f64::NAN;
        assert!(matches!(cell_map_figure(&maps), Err(PlotError::NotFiniteValue { .. })));
    }

    #[test]
    fn maps_are_well_formed_and_repeat_to_the_byte() {
        for (count, columns) in [(1, 0), (1, 3), (5, 3), (12, 6)] {
            let svg = cell_map_figure(&maps(count, columns)).unwrap();
            assert_drawn(&svg);
            assert!(svg.contains("A &amp; B") && svg.contains("map &lt;0&gt;") && svg.contains("1 of &lt;2&gt;"));
            // Axes on the left of every row only.
            assert_eq!(svg.matches("rotate(-90 ").count(), count.div_ceil(columns.max(1)));
            assert_eq!(svg, cell_map_figure(&maps(count, columns)).unwrap());
        }
        let mut one = maps(1, 1);
        one.maps[0].cells.fill(Cell::Stands.class());
        let svg = cell_map_figure(&one).unwrap();
        assert!(svg.contains("rocks and stands") && !svg.contains("overturns"));
    }

    #[test]
    fn no_texts_collide_whatever_the_axes() {
        let linear = [(0.2, 8.0), (5.0, 40.0), (0.0, 0.1), (-0.013, 0.97), (1.0, 1.000_01), (12_345.6, 98_765.4)];
        let logarithmic = [(-2.0, 1.0), (math::log10(0.3), math::log10(8.0)), (-6.0, 7.0), (0.1, 0.15), (-0.01, 1.99)];
        let spans = |scale: Scale| if scale == Scale::Linear { &linear[..] } else { &logarithmic[..] };
        for (count, columns, cells) in [(1, 1, 8), (3, 3, 20), (7, 7, 2)] {
            for scales in
                [Scale::Linear, Scale::Logarithmic].into_iter().flat_map(|x| [(x, Scale::Linear), (x, Scale::Logarithmic)])
            {
                for (index, &x) in spans(scales.0).iter().enumerate() {
                    let y = spans(scales.1)[(index + count) % spans(scales.1).len()];
                    let mut figure = CellMaps { scales, x, y, ..maps(count, columns) };
                    figure.x_title = "viscous friction of the rack over mass of a long-named clutched pair (1/s)".to_owned();
                    figure.y_title = "mass of the flywheels over that of the block of clutched pair 2".to_owned();
                    figure.title.conditions = vec!["*a*_g = 8 *g* tan α".to_owned(); 12];
                    figure.maps = (0..count).map(|index| map(&format!("a clutched pair, {index}"), cells, cells)).collect();
                    for map in &mut figure.maps {
                        map.note = "26,214 of 40,000 overturn".to_owned();
                    }
                    let svg = cell_map_figure(&figure).unwrap();
                    assert_drawn(&svg);
                }
            }
        }
    }

    #[test]
    fn equal_neighbours_merge() {
        assert_eq!(runs(&[1, 1, 3, 1]), vec![(0, 2, 1), (2, 1, 3), (3, 1, 1)]);
        assert!(runs(&[]).is_empty());
        let mut large = maps(1, 1);
        let cells: Vec<usize> = (0..1024).map(|index| if index % 32 < 20 { 0 } else { 3 }).collect();
        large.maps = vec![CellMap { columns: 32, rows: 32, cells, ..map("large", 1, 1) }];
        let svg = cell_map_figure(&large).unwrap();
        let path = svg.split("<path d=\"").find(|path| path.contains("crispEdges")).unwrap();
        assert_eq!(path.split('"').next().unwrap().matches('z').count(), 32);
    }

    #[test]
    fn edges_lie_half_a_cell_out() {
        assert_eq!(edges((1.0, 3.0), 3), (0.5, 3.5));
        assert_eq!(edges((2.0, 2.0), 1), (1.0, 3.0));
        assert_eq!(edges((0.0, 0.0), 1), (-0.5, 0.5));
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        assert!(matches!(cell_map_figure(&maps(0, 1)), Err(PlotError::NothingToDraw { .. })));
        let mut short = maps(1, 1);
        short.maps[0].cells.pop();
        assert!(matches!(cell_map_figure(&short), Err(PlotError::WrongLength { found: 71, expected: 72, .. })));
        let with = |x: (f64, f64)| cell_map_figure(&CellMaps { x, ..maps(1, 1) });
        assert!(matches!(with((0.0, f64::NAN)), Err(PlotError::NotFiniteValue { .. })));
        for x in [(1.0, 1.0), (2.0, 1.0)] {
            assert!(matches!(with(x), Err(PlotError::EmptyAxis { .. })));
        }
        let mut none = maps(1, 1);
        none.maps[0] = CellMap { columns: 0, rows: 4, cells: Vec::new(), ..none.maps[0].clone() };
        assert!(matches!(cell_map_figure(&none), Err(PlotError::NothingToDraw { .. })));
    }
}
