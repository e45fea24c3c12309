//! Panels of a probability against what it costs: a line of designs for each series, the Pareto front below them, and the limit.

use super::curve::write_curve;
use super::layer::{write_area, write_disc};
use super::legend::{DrawMark, LegendEntry, Swatch};
use super::marker::{device_marker, write_chosen, write_chosen_key};
use super::palette::{FRONT, GUIDE, INK, Stroke, device_look, guide_stroke};
use super::panel::{LEFT_LABELS_PX, Panel};
use super::panel_grid::PanelGrid;
use super::panel_heading::Heading;
use super::{FigureTitle, PlotError};
use crate::band::Band;

/// Data area of a panel that is alone, and of one of several (px).
const PANEL_SIZES_PX: [(f64, f64); 2] = [(640.0, 380.0), (390.0, 320.0)];
const COLUMN_GAP_PX: f64 = 18.0;
/// Air beyond the points, relative to the axis.
const AIR: f64 = 0.04;
/// Shortest vertical axis, a share.
const LEAST_SHARE: f64 = 0.05;
/// Radius of a design between those of the line (px).
const DOT_PX: f64 = 1.3;
/// Opacity of the band of the reference.
const BAND_OPACITY: f64 = 0.07;
const FRONT_STROKE: Stroke = Stroke { colour: FRONT, dashes: "none", width_px: 6.0 };
const LIMIT_STROKE: Stroke = Stroke { colour: INK, dashes: "70 40", width_px: 1.4 };

/// A figure of panels side by side.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TradeOffFigure {
    /// What stands above the figure.
    pub title: FigureTitle,
    /// Names of the series, for the legend.
    pub series: Vec<String>,
    /// What bands are, for the legend.
    pub band: String,
    /// Panels, from left to right.
    pub panels: Vec<TradeOffPanel>,
}

/// A panel, with costs across and probabilities up.
#[derive(Debug, Clone, PartialEq)]
pub struct TradeOffPanel {
    /// Title of the horizontal axis, in the markup of [`super::Chart::x_title`].
    pub x_title: String,
    /// Largest cost that is allowed.
    pub limit: Option<f64>,
    /// Designs of each series, in the order of its line.
    pub series: Vec<Vec<TradeOffPoint>>,
    /// Points that nothing betters, by rising cost.
    pub front: Vec<(f64, f64)>,
    /// The design that was chosen.
    pub chosen: Option<TradeOffMark>,
    /// What it is compared with.
    pub reference: TradeOffMark,
}

/// A design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TradeOffPoint {
    /// Cost and probability.
    pub at: (f64, f64),
    /// Whether the line goes there and has a mark; else it is a dot.
    pub marked: bool,
    /// Whether it counts for the front; else it is grey.
    pub counts: bool,
}

/// A design with the band of its probability.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TradeOffMark {
    /// Cost and probability.
    pub at: (f64, f64),
    /// The band.
    pub band: Band,
}

/// Draws `figure` as an SVG document. The text is the same for the same input.
///
/// # Errors
/// [`PlotError`] without panels or without a design in one of them, and for numbers that are not finite.
pub fn trade_off_figure(figure: &TradeOffFigure) -> Result<String, PlotError> {
    if figure.panels.is_empty() || figure.panels.iter().any(|panel| panel.series.iter().all(Vec::is_empty)) {
        return Err(PlotError::NothingToDraw { title: figure.title.text.clone() });
    }
    if let Some(panel) = figure.panels.iter().find(|panel| !panel.values().all(f64::is_finite)) {
        return Err(PlotError::NotFiniteValue { name: panel.x_title.clone() });
    }
    let columns = figure.panels.len();
    let panel_px = PANEL_SIZES_PX[columns.min(PANEL_SIZES_PX.len()) - 1];
    let grid = PanelGrid { columns, panel_px, gap_px: (LEFT_LABELS_PX + COLUMN_GAP_PX, 0.0), labels_px: 0.0 };
    // Probabilities of all panels are those of the same designs.
    let highest = figure.panels.iter().map(TradeOffPanel::highest).fold(LEAST_SHARE, f64::max);
    let headings: Vec<Heading> = figure.panels.iter().map(|_| Heading::of("", &[], panel_px.0)).collect();
    grid.document(&figure.title, &figure.keys(), &headings, |svg, place| {
        let source = &figure.panels[place.index];
        let [x, y] = [source.farthest(), highest].map(|most| -AIR * most..(1.0 + AIR) * most);
        let panel = Panel { title: Some("probability of overturning"), ..Panel::new(place.corner_px, panel_px, x, y) };
        source.write(svg, &panel);
        Ok(())
    })
}

impl TradeOffFigure {
    fn keys(&self) -> [Vec<LegendEntry>; 2] {
        let series =
            |(index, name): (usize, &String)| (Swatch::Fitted(device_look(index), Some(device_marker(index))), name.clone());
        let any = |has: fn(&TradeOffPanel) -> bool| self.panels.iter().any(has);
        let mut others = vec![(Swatch::Line(FRONT_STROKE), "Pareto front".to_owned())];
        if any(|panel| panel.limit.is_some()) {
            others.push((Swatch::Line(LIMIT_STROKE), "limit".to_owned()));
        }
        if any(|panel| panel.series.iter().flatten().any(|point| !point.marked)) {
            let dot: DrawMark = |svg, at| write_disc(svg, at, DOT_PX, INK, "");
            others.push((Swatch::Drawn(dot), "tried later, near a limit or the best".to_owned()));
        }
        if any(|panel| panel.series.iter().flatten().any(|point| !point.counts)) {
            others.push((Swatch::Mark(device_marker(0), GUIDE), "left out of the front".to_owned()));
        }
        if any(|panel| panel.chosen.is_some()) {
            others.push((Swatch::Drawn(write_chosen_key), format!("best, with its {}", self.band)));
        }
        others.push((Swatch::BandedLine(guide_stroke(0), 2.0 * BAND_OPACITY), format!("bare block, with its {}", self.band)));
        [self.series.iter().enumerate().map(series).collect(), others]
    }
}

impl TradeOffPanel {
    /// Every number that is drawn.
    fn values(&self) -> impl Iterator<Item = f64> {
        let points = self.series.iter().flatten().map(|point| point.at).chain(self.front.iter().copied());
        let marks = || self.chosen.iter().chain([&self.reference]);
        let of_marks = marks().flat_map(|mark| [mark.at.0, mark.at.1, mark.band.low, mark.band.high]);
        points.flat_map(|(across, up)| [across, up]).chain(of_marks).chain(self.limit)
    }

    fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        let marks = self.chosen.iter().chain([&self.reference]).map(|mark| mark.at);
        self.series.iter().flatten().map(|point| point.at).chain(self.front.iter().copied()).chain(marks)
    }

    fn highest(&self) -> f64 {
        let bands = self.chosen.iter().chain([&self.reference]).map(|mark| mark.band.high);
        self.points().map(|point| point.1).chain(bands).fold(0.0, f64::max)
    }

    fn farthest(&self) -> f64 {
        let farthest = self.points().map(|point| point.0).chain(self.limit).fold(0.0, f64::max);
        if farthest > 0.0 { farthest } else { 1.0 }
    }

    /// What is below first: the reference, the front, the limit, the lines, their marks, the choice.
    fn write(&self, svg: &mut String, panel: &Panel<'_>) {
        let (left, right) = (panel.x.start, panel.x.end);
        let Band { low, high } = self.reference.band;
        let corners = [(left, low), (right, low), (right, high), (left, high)].map(|corner| panel.position_px(corner));
        write_area(svg, &corners, INK, BAND_OPACITY);
        let level = self.reference.at.1;
        write_curve(svg, panel, &[(left, level), (right, level)], guide_stroke(0));
        write_curve(svg, panel, &self.stairs(right), FRONT_STROKE);
        if let Some(limit) = self.limit {
            write_curve(svg, panel, &[(limit, panel.y.start), (limit, panel.y.end)], LIMIT_STROKE);
        }
        panel.write_axes(svg, Some(&self.x_title));
        for (index, points) in self.series.iter().enumerate() {
            let (look, place) = (device_look(index), |point: &TradeOffPoint| panel.position_px(point.at));
            let line: Vec<(f64, f64)> = points.iter().filter(|point| point.marked).map(|point| point.at).collect();
            write_curve(svg, panel, &line, look.stroke());
            for point in points {
                let colour = if point.counts { look.colour } else { GUIDE };
                if point.marked {
                    device_marker(index).write(svg, place(point), colour);
                } else {
                    write_disc(svg, place(point), DOT_PX, colour, "");
                }
            }
        }
        if let Some(TradeOffMark { at, band }) = self.chosen {
            let end = |share: f64| panel.position_px((at.0, share)).1;
            write_chosen(svg, panel.position_px(at), (end(band.low), end(band.high)));
        }
    }

    /// The front as what is to be had up to each cost, as far as `right`.
    fn stairs(&self, right: f64) -> Vec<(f64, f64)> {
        let mut stairs: Vec<(f64, f64)> = Vec::new();
        for &(cost, share) in &self.front {
            if let Some(&(_, before)) = stairs.last() {
                stairs.push((cost, before));
            }
            stairs.push((cost, share));
        }
        if let Some(&(_, last)) = stairs.last() {
            stairs.push((right, last));
        }
        stairs
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::assert_drawn;

    fn figure(panels: usize) -> TradeOffFigure {
        let point = |k: u32| TradeOffPoint {
            at: (0.05 * f64::from(k), 0.3 - 0.03 * f64::from(k)),
            marked: k.is_multiple_of(2),
            counts: k != 3,
        };
        let mark = |at: (f64, f64)| TradeOffMark { at, band: Band { low: 0.8 * at.1, high: 1.3 * at.1 } };
        let panel = TradeOffPanel {
            x_title: "*F*/(*mg*)".to_owned(),
            limit: Some(0.21),
            series: vec![(1..9).map(point).collect(), (1..5).map(point).collect()],
            front: vec![(0.0, 0.3), (0.1, 0.2), (0.4, 0.05)],
            chosen: Some(mark((0.2, 0.18))),
            reference: mark((0.0, 0.3)),
        };
        TradeOffFigure {
            title: "A <title>".into(),
            series: ["in & erter".to_owned(), "pair".to_owned()].to_vec(),
            band: "95 % band".to_owned(),
            panels: vec![panel; panels],
        }
    }

    #[test]
    fn figures_are_well_formed_and_repeat_to_the_byte() {
        for panels in [1, 2, 3] {
            let svg = trade_off_figure(&figure(panels)).unwrap();
            assert_drawn(&svg);
            assert!(svg.contains("A &lt;title&gt;") && svg.matches("in &amp; erter").count() == 1);
            assert_eq!(svg, trade_off_figure(&figure(panels)).unwrap());
        }
    }

    #[test]
    fn the_front_falls_in_steps() {
        let stairs = figure(1).panels[0].stairs(0.5);
        assert_eq!(stairs, [(0.0, 0.3), (0.1, 0.3), (0.1, 0.2), (0.4, 0.2), (0.4, 0.05), (0.5, 0.05)]);
    }

    #[test]
    fn marks_are_where_they_are_asked_for() {
        let svg = trade_off_figure(&figure(1)).unwrap();
        // Four of the first series' designs and its legend entry, dots of both and of the legend, the grey mark of the legend, and the ring
        // of the choice here and in the legend.
        assert_eq!(svg.matches("<circle").count(), (4 + 1) + (4 + 2 + 1) + 1 + 2);
        assert!(svg.contains(">tried later, near a limit or the best<"));
        // No dots, no entry.
        let mut lines = figure(1);
        lines.panels[0].series.iter_mut().flatten().for_each(|point| point.marked = true);
        assert!(!trade_off_figure(&lines).unwrap().contains("tried later"));
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        assert!(matches!(trade_off_figure(&TradeOffFigure::default()), Err(PlotError::NothingToDraw { .. })));
        let mut bad = figure(1);
        bad.panels[0].series.iter_mut().for_each(Vec::clear);
        assert!(matches!(trade_off_figure(&bad), Err(PlotError::NothingToDraw { .. })));
        let mut bad = figure(2);
        bad.panels[1].limit = Some(f64::NAN);
        assert!(matches!(trade_off_figure(&bad), Err(PlotError::NotFiniteValue { .. })));
    }
}
