//! One panel: its rectangle, its two scales, and its frame with ticks.

use std::ops::Range;

use plotters::prelude::{ChartBuilder, IntoFont, LabelAreaPosition, PathElement, SVGBackend, ShapeStyle};
use plotters::style::{Color, IntoTextStyle};

use super::PlotError;
use super::layer::{Anchor, Text, formula, plotters_layer, text_of, units};
use super::palette::{GUIDE, INK};
use super::round_scale::RoundScale;
use super::ticks::{round_ticks, tick_text};

/// Space left of a panel for tick labels and the axis title (px).
pub(super) const LEFT_LABELS_PX: f64 = 62.0;

/// Space below the last panel for tick labels and the axis title (px).
pub(super) const BOTTOM_LABELS_PX: f64 = 42.0;

const TICK_PX: f64 = 4.0;
/// Distance that ticks of the vertical axis aim for (px).
const TICK_DISTANCE_PX: f64 = 28.0;
const TICK_FONT_PX: f64 = 11.0;
const TITLE_FONT_PX: f64 = 13.0;
const FRAME_PX: f64 = 0.8;

// plotters writes 1/1.24 of the size it is given.
const PLOTTERS_FONT_FACTOR: f64 = 1.24;

/// A panel of the figure.
#[derive(Debug, Clone)]
pub(super) struct Panel {
    /// Left edge of the data area (px).
    pub left_px: f64,
    /// Upper edge of the data area (px).
    pub top_px: f64,
    /// Width of the data area (px).
    pub width_px: f64,
    /// Height of the data area (px).
    pub height_px: f64,
    /// Scale of the shared time axis.
    pub x: Range<f64>,
    /// Scale of the panel's own quantity.
    pub y: Range<f64>,
    /// Title of the vertical axis, in the markup of [`formula`].
    pub title: &'static str,
    /// Heights of dashed guide lines.
    pub guides: &'static [f64],
}

impl Panel {
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

    /// Appends zero line, guide lines, frame, ticks and titles. The time axis is labelled when it has a title.
    pub(super) fn write_axes(&self, svg: &mut String, canvas: (u32, u32), time_title: Option<&str>) -> Result<(), PlotError> {
        self.write_guides(svg, canvas)?;
        svg.push_str(&self.axes(canvas, time_title.is_some())?);

        let middle = (self.left_px - LEFT_LABELS_PX + TITLE_FONT_PX, self.top_px + 0.5 * self.height_px);
        let title = formula(self.title);
        Text { anchor: Anchor::Middle, ..Text::new(&title, middle, TITLE_FONT_PX) }.write(svg, true);
        if let Some(time_title) = time_title {
            let middle = (self.left_px + 0.5 * self.width_px, self.bottom_px() + BOTTOM_LABELS_PX - 6.0);
            let title = formula(time_title);
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
        svg.push_str(&plotters_layer(canvas, |root| root.draw(&line(0.0)).map_err(text_of::<SVGBackend<'_>>))?);
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

    fn axes(&self, canvas: (u32, u32), labels_time: bool) -> Result<String, PlotError> {
        let x_ticks = round_ticks(&self.x, 8, 0.0);
        // Half a label's height keeps clear of the neighbouring panels.
        let y_ticks = round_ticks(&self.y, (self.height_px / TICK_DISTANCE_PX) as usize, 0.5 * TICK_FONT_PX / self.height_px);
        let (x_step, y_step) = (tick_step(&x_ticks), tick_step(&y_ticks));
        let below = if labels_time { units(BOTTOM_LABELS_PX) } else { 0 };
        let beside = units(LEFT_LABELS_PX);
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
            if !labels_time {
                // Unlabelled ticks point inwards, away from the next panel.
                paths.extend(x_ticks.iter().map(|&tick| {
                    let x = units(self.position_px((tick, self.y.start)).0);
                    vec![(x, bottom), (x, bottom - units(TICK_PX))]
                }));
            }
            for path in paths {
                root.draw(&PathElement::new(path, frame)).map_err(text_of::<SVGBackend<'_>>)?;
            }
            Ok(())
        })
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
