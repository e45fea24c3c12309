//! One panel: its rectangle, its two scales, and its frame with ticks.

use std::ops::Range;

use plotters::prelude::{ChartBuilder, IntoFont, LabelAreaPosition, PathElement, SVGBackend, ShapeStyle};
use plotters::style::{Color, IntoTextStyle};

use super::PlotError;
use super::layer::{Anchor, Text, formula, plotters_layer, text_of, units};
use super::palette::{GUIDE, INK, hex};
use super::round_scale::RoundScale;
use super::ticks::{Scale, decade_texts, decade_ticks, round_ticks, tick_text};

/// Space left of a panel for tick labels and the axis title (px).
pub(super) const LEFT_LABELS_PX: f64 = 62.0;

/// Space below the last panel for tick labels and the axis title (px).
pub(super) const BOTTOM_LABELS_PX: f64 = 42.0;

const TICK_PX: f64 = 4.0;
const MINOR_TICK_PX: f64 = 2.5;
/// Distance that ticks of the vertical axis aim for (px).
const TICK_DISTANCE_PX: f64 = 28.0;
/// Width that a label of the horizontal axis needs (px).
const LABEL_WIDTH_PX: f64 = 42.0;
/// Most labels of the horizontal axis.
const MOST_LABELS: usize = 8;
/// From ticks to their labels, where plotters has it too (px).
const LABEL_GAP_PX: (f64, f64) = (6.0, 8.0);
const TICK_FONT_PX: f64 = 11.0;
const TITLE_FONT_PX: f64 = 13.0;
const FRAME_PX: f64 = 0.8;

// plotters writes 1/1.24 of the size it is given.
const PLOTTERS_FONT_FACTOR: f64 = 1.24;

/// A panel of the figure.
#[derive(Debug, Clone)]
pub(super) struct Panel<'a> {
    /// Left edge of the data area (px).
    pub left_px: f64,
    /// Upper edge of the data area (px).
    pub top_px: f64,
    /// Width of the data area (px).
    pub width_px: f64,
    /// Height of the data area (px).
    pub height_px: f64,
    /// Range of the shared axis; of powers of ten on a logarithmic one.
    pub x: Range<f64>,
    /// Range of the panel's own quantity; of powers of ten on a logarithmic axis.
    pub y: Range<f64>,
    /// How the two axes are divided.
    pub scales: (Scale, Scale),
    /// Title of the vertical axis, in the markup of [`formula`]; without one, its ticks have no labels either.
    pub title: Option<&'a str>,
    /// Whether the vertical axis has ticks.
    pub y_ticks: bool,
    /// Heights of dashed guide lines.
    pub guides: &'a [f64],
}

impl Panel<'_> {
    /// A panel with linear axes, without title and guide lines.
    pub(super) fn new(corner_px: (f64, f64), size_px: (f64, f64), x: Range<f64>, y: Range<f64>) -> Self {
        let ((left_px, top_px), (width_px, height_px)) = (corner_px, size_px);
        let scales = (Scale::Linear, Scale::Linear);
        Self { left_px, top_px, width_px, height_px, x, y, scales, title: None, y_ticks: true, guides: &[] }
    }

    /// Position of a data point in pixels.
    pub(super) fn position_px(&self, point: (f64, f64)) -> (f64, f64) {
        let across = (point.0 - self.x.start) / (self.x.end - self.x.start);
        let up = (point.1 - self.y.start) / (self.y.end - self.y.start);
        (self.left_px + across * self.width_px, self.top_px + (1.0 - up) * self.height_px)
    }

    /// Lower edge of the data area (px).
    pub(super) fn bottom_px(&self) -> f64 {
        self.top_px + self.height_px
    }

    /// Right edge of the data area (px).
    pub(super) fn right_px(&self) -> f64 {
        self.left_px + self.width_px
    }

    /// Appends zero line, guide lines, frame, ticks and titles. The shared axis is labelled when it has a title, which may be
    /// empty.
    pub(super) fn write_axes(&self, svg: &mut String, canvas: (u32, u32), x_title: Option<&str>) -> Result<(), PlotError> {
        self.write_guides(svg, canvas)?;
        self.write_frame(svg, canvas, x_title)
    }

    /// Appends frame, ticks and titles, as [`Self::write_axes`] does.
    pub(super) fn write_frame(&self, svg: &mut String, canvas: (u32, u32), x_title: Option<&str>) -> Result<(), PlotError> {
        svg.push_str(&self.axes(canvas, x_title.is_some())?);
        self.write_decades(svg, x_title.is_some());

        if let Some(title) = self.title.filter(|title| !title.is_empty()) {
            let middle = (self.left_px - LEFT_LABELS_PX + TITLE_FONT_PX, self.top_px + 0.5 * self.height_px);
            let title = formula(title);
            Text { anchor: Anchor::Middle, ..Text::new(&title, middle, TITLE_FONT_PX) }.write(svg, true);
        }
        if let Some(title) = x_title.filter(|title| !title.is_empty()) {
            let middle = (self.left_px + 0.5 * self.width_px, self.bottom_px() + BOTTOM_LABELS_PX - 6.0);
            let title = formula(title);
            Text { anchor: Anchor::Middle, ..Text::new(&title, middle, TITLE_FONT_PX) }.write(svg, false);
        }
        Ok(())
    }

    fn write_guides(&self, svg: &mut String, canvas: (u32, u32)) -> Result<(), PlotError> {
        let (left, right) = (units(self.left_px), units(self.right_px()));
        let style: ShapeStyle = GUIDE.stroke_width(units(0.7) as u32);
        let line = |height: f64| {
            let y = units(self.position_px((self.x.start, height)).1);
            PathElement::new(vec![(left, y), (right, y)], style)
        };
        let inside = |height: &&f64| self.y.contains(*height);
        // The zero of a logarithmic axis is a one.
        if self.scales.1 == Scale::Linear && inside(&&0.0) {
            svg.push_str(&plotters_layer(canvas, |root| root.draw(&line(0.0)).map_err(text_of::<SVGBackend<'_>>))?);
        }
        svg.push_str("<g stroke-dasharray=\"40 30\">\n");
        svg.push_str(&plotters_layer(canvas, |root| {
            for &height in self.guides.iter().filter(inside) {
                root.draw(&line(height)).map_err(text_of::<SVGBackend<'_>>)?;
            }
            Ok(())
        })?);
        svg.push_str("</g>\n");
        Ok(())
    }

    /// Number of labels that the axes aim for.
    fn label_counts(&self) -> (usize, usize) {
        let across = (self.width_px / LABEL_WIDTH_PX) as usize;
        (across.clamp(2, MOST_LABELS), (self.height_px / TICK_DISTANCE_PX) as usize)
    }

    /// Frame, and ticks and labels of linear axes.
    fn axes(&self, canvas: (u32, u32), labels_x: bool) -> Result<String, PlotError> {
        let (across, up) = self.label_counts();
        let linear = |scale: Scale, ticks: Vec<f64>| if scale == Scale::Linear { ticks } else { Vec::new() };
        let x_ticks = linear(self.scales.0, round_ticks(&self.x, across, 0.0));
        // Half a label's height keeps clear of the neighbouring panels.
        let y_ticks = linear(self.scales.1, round_ticks(&self.y, up, 0.5 * TICK_FONT_PX / self.height_px));
        let (x_step, y_step) = (tick_step(&x_ticks), tick_step(&y_ticks));
        let below = if labels_x { units(BOTTOM_LABELS_PX) } else { 0 };
        let beside = if self.title.is_some() { units(LEFT_LABELS_PX) } else { 0 };
        let frame: ShapeStyle = INK.stroke_width(units(FRAME_PX) as u32);
        let (left, right) = (units(self.left_px), units(self.right_px()));
        let (top, bottom) = (units(self.top_px), units(self.bottom_px()));

        plotters_layer(canvas, |root| {
            let area = root.clone().shrink((left - beside, top), (right - left + beside, bottom - top + below));
            let mut chart = ChartBuilder::on(&area)
                .set_label_area_size(LabelAreaPosition::Left, beside)
                .set_label_area_size(LabelAreaPosition::Bottom, below)
                .build_cartesian_2d(RoundScale::new(&self.x, &x_ticks), RoundScale::new(&self.y, &y_ticks))
                .map_err(text_of::<SVGBackend<'_>>)?;
            let font_size = TICK_FONT_PX * PLOTTERS_FONT_FACTOR * super::layer::UNIT;
            let font = ("sans-serif", font_size).into_font().color(&INK);
            chart
                .configure_mesh()
                .disable_mesh()
                .axis_style(frame)
                .label_style(font.into_text_style(root))
                .x_labels(x_ticks.len() + 1)
                .y_labels(y_ticks.len() + 1)
                .x_label_formatter(&|value| tick_text(*value, x_step))
                .y_label_formatter(&|value| tick_text(*value, y_step))
                .set_all_tick_mark_size(units(TICK_PX))
                .draw()
                .map_err(text_of::<SVGBackend<'_>>)?;

            let mut paths = vec![vec![(left, top), (right, top), (right, bottom), (left, bottom), (left, top)]];
            if !labels_x {
                // Unlabelled ticks point inwards, away from the next panel.
                paths.extend(x_ticks.iter().map(|&tick| {
                    let x = units(self.position_px((tick, self.y.start)).0);
                    vec![(x, bottom), (x, bottom - units(TICK_PX))]
                }));
            }
            if self.title.is_none() && self.y_ticks {
                paths.extend(y_ticks.iter().map(|&tick| {
                    let y = units(self.position_px((self.x.start, tick)).1);
                    vec![(left, y), (left + units(TICK_PX), y)]
                }));
            }
            for path in paths {
                root.draw(&PathElement::new(path, frame)).map_err(text_of::<SVGBackend<'_>>)?;
            }
            Ok(())
        })
    }

    /// Appends ticks and labels of logarithmic axes.
    fn write_decades(&self, svg: &mut String, labels_x: bool) {
        let (across, up) = self.label_counts();
        let mut path = String::new();
        if self.scales.0 == Scale::Logarithmic {
            let (labelled, minor) = decade_ticks(&self.x, across, self.width_px);
            // Unlabelled ticks point inwards, away from the next panel.
            let outward = if labels_x { 1 } else { -1 };
            let mut tick = |power: f64, length_px: f64| {
                let (x, y) = self.position_px((power, self.y.start));
                path.push_str(&format!("M{} {}v{}", units(x), units(y), outward * units(length_px)));
                (x, y + TICK_PX + LABEL_GAP_PX.1 + 0.36 * TICK_FONT_PX)
            };
            minor.into_iter().for_each(|power| _ = tick(power, MINOR_TICK_PX));
            for (power, text) in labelled.iter().zip(decade_texts(&labelled)) {
                let at = tick(*power, TICK_PX);
                if labels_x {
                    Text { anchor: Anchor::Middle, ..Text::new(&text, at, TICK_FONT_PX) }.write(svg, false);
                }
            }
        }
        if self.scales.1 == Scale::Logarithmic {
            let (labelled, minor) = decade_ticks(&self.y, up, self.height_px);
            let outward = if self.title.is_some() { -1 } else { 1 };
            let mut tick = |power: f64, length_px: f64| {
                let (x, y) = self.position_px((self.x.start, power));
                path.push_str(&format!("M{} {}h{}", units(x), units(y), outward * units(length_px)));
                (x - TICK_PX - LABEL_GAP_PX.0, y + 0.36 * TICK_FONT_PX)
            };
            minor.into_iter().for_each(|power| _ = tick(power, MINOR_TICK_PX));
            for (power, text) in labelled.iter().zip(decade_texts(&labelled)) {
                let at = tick(*power, TICK_PX);
                if self.title.is_some() {
                    Text { anchor: Anchor::End, ..Text::new(&text, at, TICK_FONT_PX) }.write(svg, false);
                }
            }
        }
        if !path.is_empty() {
            svg.push_str(&format!("<path d=\"{path}\" stroke=\"{}\" stroke-width=\"{}\"/>\n", hex(INK), units(FRAME_PX)));
        }
    }
}

fn tick_step(ticks: &[f64]) -> f64 {
    match ticks {
        [first, second, ..] => second - first,
        _ => 1.0,
    }
}

/// A scale around zero that holds `values` with some air; `floor` is half the height when all values are zero.
pub(super) fn scale_around_zero(values: impl Iterator<Item = f64>, floor: f64) -> Range<f64> {
    let (low, high) = values.fold((0.0_f64, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
    // Rounding noise of a block at rest is not a signal.
    if high - low < 1e-9 {
        return -floor..floor;
    }
    let air = 0.08 * (high - low);
    low - air..high + air
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_hold_their_values_and_zero() {
        let scale = scale_around_zero([2.0, 3.0].into_iter(), 1.0);
        assert!(scale.contains(&0.0) && scale.contains(&3.0) && !scale.contains(&4.0));
        assert_eq!(scale_around_zero([0.0, 1e-14].into_iter(), 0.5), -0.5..0.5);
    }
}
