//! Panels of many runs by intensity: a fitted line with its band for each device, over the runs that it was fitted to.

use std::ops::Range;

use super::curve::write_curve;
use super::layer::{escape, write_area};
use super::legend::{LegendEntry, Swatch};
use super::marker::device_marker;
use super::palette::{INK, Stroke, device_look};
use super::panel::{LEFT_LABELS_PX, Panel};
use super::panel_grid::PanelGrid;
use super::panel_heading::Heading;
use super::rug::{Rug, rugs_px, write_rug_key};
use super::ticks::{Scale, axis_range, close_range, drawable};
use super::{FigureTitle, PlotError};

/// Data area of a panel in a figure of one or of more columns (px).
const PANEL_SIZES_PX: [(f64, f64); 2] = [(600.0, 360.0), (350.0, 290.0)];
const COLUMN_GAP_PX: f64 = 16.0;
/// Below a panel that is not the last of its column, for tick labels (px).
const TICK_LABELS_PX: f64 = 34.0;

/// A figure of panels in rows.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CloudFigure {
    /// What stands above the figure.
    pub title: FigureTitle,
    /// Names of the devices, for the legend.
    pub devices: Vec<String>,
    /// Title of the shared horizontal axis, in the markup of [`super::Chart::x_title`].
    pub x_title: String,
    /// How both axes of every panel are divided.
    pub scales: (Scale, Scale),
    /// Panels in a row; zero counts as one.
    pub columns: usize,
    /// What bands are, for the legend.
    pub band: String,
    /// What marks are, for the legend.
    pub marks: String,
    /// Panels, row by row. Those with the same vertical title have the same vertical axis.
    pub panels: Vec<CloudPanel>,
}

/// A panel.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CloudPanel {
    /// Heading; empty for none.
    pub title: String,
    /// Lines of small text below it.
    pub notes: Vec<String>,
    /// Title of the vertical axis.
    pub y_title: String,
    /// Devices.
    pub series: Vec<CloudSeries>,
    /// Its vertical axis is a share from 0 to 1, with room for rugs above and below.
    pub share: bool,
}

/// One device of a panel, in the units of the axes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CloudSeries {
    /// Number of the device.
    pub device: usize,
    /// Runs, as marks.
    pub points: Vec<(f64, f64)>,
    /// The fitted line; empty for none.
    pub line: Vec<(f64, f64)>,
    /// Confidence band of the curve; empty for none.
    pub band: Vec<BandPoint>,
    /// Runs as ticks at both edges.
    pub rug: Option<Rug>,
}

/// A place of a band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BandPoint {
    /// Place on the horizontal axis.
    pub at: f64,
    /// Lower edge of the band.
    pub low: f64,
    /// Upper edge of the band.
    pub high: f64,
}

/// Draws `figure` as an SVG document. The text is the same for the same input. On logarithmic axes what is not positive is left out.
///
/// # Errors
/// [`PlotError`] without panels or without a point in all of them, and for numbers that are not finite.
pub fn cloud_figure(figure: &CloudFigure) -> Result<String, PlotError> {
    let nothing = || PlotError::NothingToDraw { title: figure.title.text.clone() };
    let panels: Vec<Vec<CloudSeries>> = figure
        .panels
        .iter()
        .map(|panel| panel.series.iter().map(|series| series.on(figure)).collect())
        .collect::<Result<_, _>>()?;
    let x = range(panels.iter().flatten().flat_map(CloudSeries::intensities), figure.scales.0).ok_or_else(nothing)?;
    // Intensities are not below zero.
    let x = if figure.scales.0 != Scale::Logarithmic { x.start.max(0.0)..x.end } else { x };

    let columns = figure.columns.clamp(1, figure.panels.len().max(1));
    let panel_px = PANEL_SIZES_PX[columns.min(PANEL_SIZES_PX.len()) - 1];
    let grid = PanelGrid { columns, panel_px, gap_px: (LEFT_LABELS_PX + COLUMN_GAP_PX, TICK_LABELS_PX), labels_px: 0.0 };
    let headings: Vec<Heading> = figure.panels.iter().map(|panel| Heading::of(&panel.title, &panel.notes, panel_px.0)).collect();
    grid.document(&figure.title, &figure.keys(), &headings, |svg, place| {
        let source = &figure.panels[place.index];
        let y = figure.heights(source, &panels, panel_px.1).ok_or_else(nothing)?;
        let panel = Panel {
            scales: figure.scales,
            title: Some(&source.y_title),
            guides: if source.share { &[1.0] } else { &[] },
            ..Panel::new(place.corner_px, panel_px, x.clone(), y)
        };
        panel.write_axes(svg, Some(if place.lowest { &figure.x_title } else { "" }));
        write_series(svg, &panel, &panels[place.index], figure.devices.len());
        Ok(())
    })
}

/// The range of an axis that shows `values`; `None` without any.
fn range(values: impl Iterator<Item = f64>, scale: Scale) -> Option<Range<f64>> {
    match scale {
        Scale::Linear | Scale::Whole => axis_range(values, scale),
        Scale::Logarithmic => close_range(values),
    }
}

/// Bands below, marks above them, lines on top.
fn write_series(svg: &mut String, panel: &Panel<'_>, all: &[CloudSeries], devices: usize) {
    for series in all {
        let inside = |value: f64| value.clamp(panel.y.start, panel.y.end);
        let lower = series.band.iter().map(|point| (point.at, inside(point.low)));
        let upper = series.band.iter().rev().map(|point| (point.at, inside(point.high)));
        let corners: Vec<(f64, f64)> = lower.chain(upper).map(|point| panel.position_px(point)).collect();
        write_area(svg, &corners, device_look(series.device).colour, BAND_OPACITY);
    }
    for series in all {
        let colour = device_look(series.device).colour;
        series.points.iter().for_each(|point| device_marker(series.device).write(svg, panel.position_px(*point), colour));
    }
    for series in all {
        let stroke = Stroke { width_px: LINE_PX, ..device_look(series.device).stroke() };
        write_curve(svg, panel, &series.line, stroke);
        if let Some(rug) = &series.rug {
            rug.write(svg, panel, series.device, devices);
        }
    }
}

/// Opacity of bands.
const BAND_OPACITY: f64 = 0.16;
/// Width of fitted lines (px).
const LINE_PX: f64 = 1.8;

impl CloudFigure {
    /// The vertical range of `panel`, which all panels with the same title share.
    fn heights(&self, panel: &CloudPanel, all: &[Vec<CloudSeries>], height_px: f64) -> Option<Range<f64>> {
        if panel.share {
            let rugs_px = rugs_px(self.devices.len());
            let beyond = rugs_px / (height_px - 2.0 * rugs_px);
            return Some(-beyond..1.0 + beyond);
        }
        let alike = self.panels.iter().zip(all).filter(|(other, _)| other.y_title == panel.y_title);
        let heights = |series: &'_ CloudSeries| -> Vec<f64> {
            let of_points = series.points.iter().chain(&series.line).map(|point| point.1);
            of_points.chain(series.band.iter().flat_map(|point| [point.low, point.high])).collect()
        };
        range(alike.flat_map(|(_, series)| series).flat_map(heights), self.scales.1)
    }

    /// The devices that are drawn, and what else is.
    fn keys(&self) -> [Vec<LegendEntry>; 2] {
        let all = || self.panels.iter().flat_map(|panel| &panel.series);
        let drawn = |device: &usize| all().any(|series| series.device == *device);
        let marked = all().any(|series| !series.points.is_empty());
        let device = |(index, name): (usize, &String)| {
            drawn(&index).then(|| (Swatch::Fitted(device_look(index), marked.then(|| device_marker(index))), name.clone()))
        };
        let mut others = Vec::new();
        if all().any(|series| !series.band.is_empty()) {
            others.push((Swatch::Band(BAND_OPACITY), self.band.clone()));
        }
        if marked {
            others.push((Swatch::Mark(device_marker(0), INK), self.marks.clone()));
        }
        if all().any(|series| series.rug.is_some()) {
            others.push((Swatch::Drawn(write_rug_key), "a motion: above when it overturns the block, below when not".to_owned()));
        }
        [self.devices.iter().enumerate().filter_map(device).collect(), others]
    }
}

impl CloudSeries {
    fn intensities(&self) -> impl Iterator<Item = f64> {
        let of_rug = self.rug.iter().flat_map(|rug| rug.stood.iter().chain(&rug.overturned)).copied();
        self.points.iter().chain(&self.line).map(|point| point.0).chain(of_rug)
    }

    /// On the scales of `figure`.
    fn on(&self, figure: &CloudFigure) -> Result<CloudSeries, PlotError> {
        let (across, up) = figure.scales;
        let of_points = self.points.iter().chain(&self.line).flat_map(|point| [point.0, point.1]);
        let of_band = self.band.iter().flat_map(|point| [point.at, point.low, point.high]);
        if !of_points.chain(of_band).chain(self.intensities()).all(drawable) {
            let name = figure.devices.get(self.device).cloned().unwrap_or_default();
            return Err(PlotError::NotFiniteValue { name: escape(&name) });
        }
        let points = |points: &[(f64, f64)]| -> Vec<(f64, f64)> {
            points.iter().filter_map(|point| Some((across.place(point.0)?, up.place(point.1)?))).collect()
        };
        let band = |point: &BandPoint| {
            Some(BandPoint { at: across.place(point.at)?, low: up.place(point.low)?, high: up.place(point.high)? })
        };
        let rug = |values: &[f64]| values.iter().filter_map(|value| across.place(*value)).collect();
        Ok(CloudSeries {
            device: self.device,
            points: points(&self.points),
            line: points(&self.line),
            band: self.band.iter().filter_map(band).collect(),
            rug: self.rug.as_ref().map(|both| Rug { stood: rug(&both.stood), overturned: rug(&both.overturned) }),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::assert_drawn;

    fn demand() -> CloudFigure {
        let series = |device: usize| CloudSeries {
            device,
            points: (1..20).map(|k| (f64::from(k), 0.01 * f64::from(k * k))).collect(),
            line: vec![(1.0, 0.01), (20.0, 4.0)],
            band: vec![BandPoint { at: 1.0, low: 0.008, high: 0.012 }, BandPoint { at: 20.0, low: 3.0, high: 5.0 }],
            rug: None,
        };
        let panel = |title: &str, y_title: &str| CloudPanel {
            title: title.to_owned(),
            y_title: y_title.to_owned(),
            series: (0..3).map(series).collect(),
            ..CloudPanel::default()
        };
        CloudFigure {
            title: "A <title>".into(),
            devices: ["none", "in & erter", "pair"].map(str::to_owned).to_vec(),
            x_title: "*p* *t*_{uni}".to_owned(),
            scales: (Scale::Logarithmic, Scale::Logarithmic),
            columns: 2,
            band: "95 % band".to_owned(),
            marks: "a motion".to_owned(),
            panels: vec![panel("pier", "θ"), panel("pier", "θ''")],
        }
    }

    fn fragility() -> CloudFigure {
        let series = |device: usize| CloudSeries {
            device,
            line: vec![(0.0, 0.0), (1.0, 0.5), (3.0, 1.0)],
            band: vec![BandPoint { at: 1.0, low: 0.4, high: 0.6 }, BandPoint { at: 3.0, low: 0.9, high: 1.0 }],
            rug: Some(Rug { stood: vec![0.5, 1.5], overturned: vec![2.0] }),
            ..CloudSeries::default()
        };
        let panel = CloudPanel {
            title: "R = 1 m".to_owned(),
            notes: vec!["pair: never overturned".to_owned()],
            y_title: "P".to_owned(),
            series: (0..3).map(series).collect(),
            share: true,
        };
        let scales = (Scale::Linear, Scale::Linear);
        CloudFigure { scales, columns: 1, panels: vec![panel], ..demand() }
    }

    #[test]
    fn figures_are_well_formed_and_repeat_to_the_byte() {
        for figure in [demand(), fragility()] {
            let svg = cloud_figure(&figure).unwrap();
            assert_drawn(&svg);
            assert!(svg.contains("A &lt;title&gt;") && svg.matches("in &amp; erter").count() == 1);
            assert_eq!(svg, cloud_figure(&figure).unwrap());
        }
    }

    #[test]
    fn every_run_has_a_mark_and_the_legend_one_of_each() {
        let svg = cloud_figure(&demand()).unwrap();
        assert_eq!(svg.matches("<circle").count(), 2 * 19 + 2);
        assert_eq!(svg.matches("<polygon").count(), 2 * 3 + 1);
        let svg = cloud_figure(&fragility()).unwrap();
        assert!(svg.contains("pair: never overturned") && !svg.contains("<circle"));
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        assert!(matches!(cloud_figure(&CloudFigure::default()), Err(PlotError::NothingToDraw { .. })));
        let mut figure = demand();
        figure.panels[0].series[1].points[0].1 = f64::NAN;
        assert!(matches!(cloud_figure(&figure), Err(PlotError::NotFiniteValue { .. })));
    }
}
