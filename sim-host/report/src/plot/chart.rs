//! A chart of lines in panels that share the horizontal axis, with linear or logarithmic scales.

use super::curve::write_curve;
use super::layer::{Text, escape, units};
use super::legend::{DrawMark, LegendEntry, Swatch};
use super::marker::write_mark;
use super::palette::{INK, Stroke, device_look, guide_stroke, hex, stroke_of};
use super::panel::{LEFT_LABELS_PX, Panel};
use super::panel_grid::PanelGrid;
use super::panel_heading::Heading;
use super::text_width::text_width_px;
use super::ticks::{Scale, axis_range, drawable};
use super::{FigureTitle, PlotError};

/// Data area of a panel in a figure of one, two or more columns (px).
const PANEL_SIZES_PX: [(f64, f64); 3] = [(668.0, 300.0), (350.0, 250.0), (260.0, 200.0)];
const COLUMN_GAP_PX: f64 = 14.0;
/// Below a panel that is not the last of its column, for tick labels (px).
const TICK_LABELS_PX: f64 = 34.0;
/// Labels at the ends of lines, and the distance that they keep (px).
const LABEL_FONT_PX: f64 = 9.5;
const LABEL_LINE_PX: f64 = 11.5;
/// From the panel to those labels (px).
const LEADER_PX: f64 = 18.0;

/// A line of a chart.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Line {
    /// Name in the legend. Lines of one name look the same in every panel and share an entry.
    pub name: String,
    /// Points in drawing order, in the units of the axes.
    pub points: Vec<(f64, f64)>,
    /// Draws a disc at every point.
    pub marks: bool,
    /// Makes it a thin grey dashed reference line, such as a slope.
    pub guide: bool,
    /// How it looks; by its name without.
    pub look: Option<LineLook>,
    /// Text at its right end, instead of an entry of its own in the legend; empty for none.
    pub label: String,
}

/// How a line looks: what lines share a part of their look for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LineLook {
    /// Number of its colour.
    pub colour: usize,
    /// Number of its dashes; the first is a solid line.
    pub dashes: usize,
    /// Its marks are circles instead of discs.
    pub open: bool,
}

/// A panel of a chart.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ChartPanel {
    /// Heading of the panel; empty for none.
    pub title: String,
    /// Title of the vertical axis, in the markup of [`Chart::x_title`].
    pub y_title: String,
    /// Vertical axis, which is the panel's own.
    pub y: Scale,
    /// Lines, drawn in this order.
    pub lines: Vec<Line>,
}

/// A figure of panels in rows.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Chart {
    /// What stands above the figure.
    pub title: FigureTitle,
    /// Title of the horizontal axis. In axis titles `*x*` is italic, `_x` one subscript character, `'` a dot and `''` two dots over
    /// the symbol before.
    pub x_title: String,
    /// Horizontal axis, the same for all panels.
    pub x: Scale,
    /// Two values, in the unit of that axis, that it shows whether or not there are points at them.
    pub x_range: Option<(f64, f64)>,
    /// Panels, row by row.
    pub panels: Vec<ChartPanel>,
    /// Panels in a row; zero counts as one.
    pub columns: usize,
    /// Entries of the legend that explain looks, a row each: they look like lines of this look.
    pub keys: Vec<Vec<ChartKey>>,
}

/// An entry of the legend that explains a part of looks.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ChartKey {
    /// What a colour stands for, by its number.
    Colour(usize, String),
    /// What dashes stand for, by their number.
    Dashes(usize, String),
    /// What discs stand for, or circles if it is true.
    Marks(bool, String),
}

/// Draws `chart` as an SVG document.
///
/// Lines get their looks by name in the order of first appearance. A logarithmic axis has ticks at powers of ten, and points that
/// are not positive there are left out. The text is the same for the same input, and long lines are thinned to the width of the
/// panels.
///
/// # Errors
/// [`PlotError`] without panels, when no point of the figure or of a panel can be shown, and for numbers that are not finite.
pub fn chart_figure(chart: &Chart) -> Result<String, PlotError> {
    let nothing = || PlotError::NothingToDraw { title: chart.title.text.clone() };
    if chart.panels.is_empty() {
        return Err(nothing());
    }
    let mut panels: Vec<Vec<Vec<(f64, f64)>>> = Vec::new();
    for panel in &chart.panels {
        panels.push(panel.lines.iter().map(|line| shown(line, chart.x, panel.y)).collect::<Result<_, _>>()?);
    }
    let ends: Vec<f64> = chart.x_range.into_iter().flat_map(<[f64; 2]>::from).collect();
    if !ends.iter().all(|end| drawable(*end)) {
        return Err(PlotError::NotFiniteValue { name: chart.x_title.clone() });
    }
    let ends = ends.into_iter().filter_map(|end| chart.x.place(end));
    let x = axis_range(panels.iter().flatten().flatten().map(|point| point.0).chain(ends), chart.x).ok_or_else(nothing)?;
    let looks = Looks::new(chart);

    let columns = chart.columns.clamp(1, chart.panels.len().max(1));
    let (panel_width_px, panel_height_px) = PANEL_SIZES_PX[columns.min(PANEL_SIZES_PX.len()) - 1];
    let labels = chart.panels.iter().flat_map(|panel| &panel.lines).map(|line| text_width_px(&line.label, LABEL_FONT_PX));
    let labels_px = labels.fold(0.0, f64::max);
    let labels_px = if labels_px > 0.0 { labels_px + LEADER_PX } else { 0.0 };
    let grid = PanelGrid {
        columns,
        panel_px: (panel_width_px, panel_height_px),
        gap_px: (LEFT_LABELS_PX + COLUMN_GAP_PX, TICK_LABELS_PX),
        labels_px,
    };
    let groups = [chart.keys.iter().map(|row| row.iter().map(ChartKey::entry).collect()).collect(), looks.groups().to_vec()];
    let headings: Vec<Heading> = chart.panels.iter().map(|panel| Heading::of(&panel.title, &[], panel_width_px)).collect();
    grid.document(&chart.title, &groups.concat(), &headings, |svg, place| {
        let (source, curves) = (&chart.panels[place.index], &panels[place.index]);
        let y = axis_range(curves.iter().flatten().map(|point| point.1), source.y).ok_or_else(nothing)?;
        let panel = Panel {
            scales: (chart.x, source.y),
            title: Some(&source.y_title),
            ..Panel::new(place.corner_px, grid.panel_px, x.clone(), y)
        };
        panel.write_axes(svg, Some(if place.lowest { &chart.x_title } else { "" }));
        for (line, points) in source.lines.iter().zip(curves) {
            let stroke = looks.stroke(line);
            write_curve(svg, &panel, points, stroke);
            if line.marks || points.len() == 1 {
                let open = line.look.is_some_and(|look| look.open);
                points.iter().for_each(|point| write_mark(svg, panel.position_px(*point), stroke.colour, open));
            }
        }
        write_labels(svg, &panel, source.lines.iter().zip(curves).map(|(line, points)| (line, &points[..], looks.stroke(line))));
        Ok(())
    })
}

impl LineLook {
    fn stroke(self) -> Stroke {
        stroke_of(self.colour, self.dashes)
    }
}

impl ChartKey {
    fn entry(&self) -> LegendEntry {
        match self {
            ChartKey::Colour(colour, name) => (Swatch::Line(stroke_of(*colour, 0)), name.clone()),
            ChartKey::Dashes(dashes, name) => (Swatch::Line(Stroke { colour: INK, ..stroke_of(0, *dashes) }), name.clone()),
            ChartKey::Marks(open, name) => {
                let disc: DrawMark = |svg, at| write_mark(svg, at, INK, false);
                let circle: DrawMark = |svg, at| write_mark(svg, at, INK, true);
                (Swatch::Drawn(if *open { circle } else { disc }), name.clone())
            }
        }
    }
}

/// Appends the labels of `lines` right of the panel, in the order of the ends of their curves and apart from each other, with a thin line
/// from each end to its label.
fn write_labels<'a>(svg: &mut String, panel: &Panel<'_>, lines: impl Iterator<Item = (&'a Line, &'a [(f64, f64)], Stroke)>) {
    let last = |points: &[(f64, f64)]| points.iter().copied().max_by(|a, b| a.0.total_cmp(&b.0));
    let mut ends: Vec<((f64, f64), &str, Stroke)> = lines
        .filter(|(line, ..)| !line.label.is_empty())
        .filter_map(|(line, points, stroke)| Some((panel.position_px(last(points)?), line.label.as_str(), stroke)))
        .collect();
    ends.sort_by(|a, b| a.0.1.total_cmp(&b.0.1));
    let wanted: Vec<f64> = ends.iter().map(|end| end.0.1).collect();
    let heights = apart(&wanted, LABEL_LINE_PX, (panel.top_px, panel.bottom_px()));
    let left_px = panel.right_px() + LEADER_PX;
    for (((x, y), label, stroke), height) in ends.into_iter().zip(heights) {
        svg.push_str(&format!(
            "<path d=\"M{} {}L{} {}\" fill=\"none\" stroke=\"{}\" stroke-width=\"5\" stroke-opacity=\"0.5\"/>\n",
            units(x),
            units(y),
            units(left_px - 3.0),
            units(height),
            hex(stroke.colour)
        ));
        let at = (left_px, height + 0.36 * LABEL_FONT_PX);
        Text { colour: stroke.colour, ..Text::new(&escape(label), at, LABEL_FONT_PX) }.write(svg, false);
    }
}

/// Places near `wanted`, which rise, at least `distance` apart and within `range` if there is room.
fn apart(wanted: &[f64], distance: f64, (low, high): (f64, f64)) -> Vec<f64> {
    let mut places: Vec<f64> = Vec::with_capacity(wanted.len());
    for &wish in wanted {
        let least = places.last().map_or(low, |before| before + distance);
        places.push(wish.max(least));
    }
    let mut most = high.max(low + distance * wanted.len().saturating_sub(1) as f64);
    for place in places.iter_mut().rev() {
        *place = place.min(most);
        most = *place - distance;
    }
    places
}

/// The points of `line` on the panel's scales: those that it can show.
fn shown(line: &Line, x: Scale, y: Scale) -> Result<Vec<(f64, f64)>, PlotError> {
    if !line.points.iter().all(|point| drawable(point.0) && drawable(point.1)) {
        return Err(PlotError::NotFiniteValue { name: line.name.clone() });
    }
    Ok(line.points.iter().filter_map(|point| Some((x.place(point.0)?, y.place(point.1)?))).collect())
}

/// Which look belongs to which name.
struct Looks<'a> {
    /// Name, and whether some line of that name has marks.
    lines: Vec<(&'a str, bool)>,
    guides: Vec<&'a str>,
}

impl<'a> Looks<'a> {
    fn new(chart: &'a Chart) -> Self {
        let mut looks = Self { lines: Vec::new(), guides: Vec::new() };
        for line in chart.panels.iter().flat_map(|panel| &panel.lines) {
            let name = line.name.as_str();
            if line.look.is_some() && !line.guide {
                continue;
            }
            if line.guide {
                if !looks.guides.contains(&name) {
                    looks.guides.push(name);
                }
            } else if let Some(known) = looks.lines.iter_mut().find(|known| known.0 == name) {
                known.1 |= line.marks;
            } else {
                looks.lines.push((name, line.marks));
            }
        }
        looks
    }

    fn stroke(&self, line: &Line) -> Stroke {
        if let Some(look) = line.look.filter(|_| !line.guide) {
            look.stroke()
        } else if line.guide {
            guide_stroke(self.guides.iter().position(|name| *name == line.name).unwrap_or(0))
        } else {
            device_look(self.lines.iter().position(|(name, _)| *name == line.name).unwrap_or(0)).stroke()
        }
    }

    /// Legend entries; nameless lines have none.
    fn groups(&self) -> [Vec<LegendEntry>; 2] {
        let line = |(index, (name, marks)): (usize, &(&str, bool))| {
            let stroke = device_look(index).stroke();
            (if *marks { Swatch::MarkedLine(stroke) } else { Swatch::Line(stroke) }, (*name).to_owned())
        };
        let guide = |(index, name): (usize, &&str)| (Swatch::Line(guide_stroke(index)), (*name).to_owned());
        let named = |key: &LegendEntry| !key.1.is_empty();
        [
            self.lines.iter().enumerate().map(line).filter(named).collect(),
            self.guides.iter().enumerate().map(guide).filter(named).collect(),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::assert_drawn;

    fn line(name: &str, exponent: i32) -> Line {
        let points = (0..10).map(|k| (f64::from(1 << k), 1e-2 * (0..k * exponent).fold(1.0, |value, _| 0.5 * value)));
        Line { name: name.to_owned(), points: points.collect(), marks: true, ..Line::default() }
    }

    fn chart(scale: Scale, columns: usize) -> Chart {
        let guide = Line { guide: true, marks: false, ..line("slope −4", 4) };
        let panel = |title: &str| ChartPanel {
            title: title.to_owned(),
            y_title: "error".to_owned(),
            y: scale,
            lines: vec![line("a & <b>", 2), line("fourth order", 4), guide.clone()],
        };
        Chart {
            title: "A <title>".into(),
            x_title: "steps".to_owned(),
            x: scale,
            panels: ["one", "two & a half", "three"].map(panel).to_vec(),
            columns,
            ..Chart::default()
        }
    }

    #[test]
    fn a_chart_is_well_formed_and_repeats_to_the_byte() {
        for scale in [Scale::Linear, Scale::Logarithmic] {
            for columns in [0, 1, 2, 5] {
                let svg = chart_figure(&chart(scale, columns)).unwrap();
                assert_drawn(&svg);
                assert!(svg.contains("A &lt;title&gt;") && svg.contains("two &amp; a half"));
                // Once in the legend, in spite of three panels.
                assert_eq!(svg.matches("a &amp; &lt;b&gt;").count(), 1);
                assert_eq!(svg.matches("<circle").count(), 3 * 2 * 10 + 2);
                assert_eq!(svg, chart_figure(&chart(scale, columns)).unwrap());
            }
        }
    }

    #[test]
    fn logarithmic_axes_label_powers_of_ten_and_leave_out_what_is_not_positive() {
        let mut chart = chart(Scale::Logarithmic, 3);
        chart.panels.truncate(1);
        chart.panels[0].lines.truncate(1);
        chart.panels[0].lines[0].points.extend([(0.0, 1.0), (1.0, -1.0), (2.0, 0.0)]);
        let svg = chart_figure(&chart).unwrap();
        assert_drawn(&svg);
        assert_eq!(svg.matches("<circle").count(), 10 + 1);
        for power in ["\u{2212}3", "0", "1", "2"] {
            assert!(svg.contains(&format!("10<tspan dy=\"-0.45em\" font-size=\"0.75em\">{power}</tspan>")), "{power}");
        }
        chart.panels[0].lines[0].points = vec![(1.0, -1.0)];
        assert!(matches!(chart_figure(&chart), Err(PlotError::NothingToDraw { .. })));
    }

    #[test]
    fn an_axis_shows_the_range_that_was_asked_for_beyond_its_points() {
        for (scale, range, tick) in [(Scale::Linear, (-500.0, 3000.0), ">3000<"), (Scale::Logarithmic, (0.1, 1e6), ">6</tspan>")]
        {
            let mut chart = chart(scale, 1);
            assert!(!chart_figure(&chart).unwrap().contains(tick));
            chart.x_range = Some(range);
            let svg = chart_figure(&chart).unwrap();
            assert_drawn(&svg);
            assert!(svg.contains(tick));
            chart.x_range = Some((1.0, 512.0));
            let within = chart_figure(&chart).unwrap();
            chart.x_range = None;
            assert_eq!(within, chart_figure(&chart).unwrap());
        }
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        assert!(matches!(chart_figure(&Chart::default()), Err(PlotError::NothingToDraw { .. })));
        for bad in [f64::NAN, f64::INFINITY, f64::MIN] {
            let mut chart = chart(Scale::Linear, 1);
            chart.panels[1].lines[1].points[3].1 = bad;
            assert_eq!(chart_figure(&chart), Err(PlotError::NotFiniteValue { name: "fourth order".to_owned() }));
        }
        let range = Chart { x_range: Some((1.0, f64::NAN)), ..chart(Scale::Linear, 1) };
        assert_eq!(chart_figure(&range), Err(PlotError::NotFiniteValue { name: "steps".to_owned() }));
        let empty = Chart { x_range: Some((1.0, 2.0)), ..Chart::default() };
        assert!(matches!(chart_figure(&empty), Err(PlotError::NothingToDraw { .. })));
    }
}
