//! One panel: its rectangle, its two scales, and its frame with ticks.

use std::ops::Range;

use super::axis_ticks::{Axis, Label, TICK_FONT_PX, Way};
use super::formula::{formula, formula_width_px};
use super::layer::{Anchor, Text, path_through, units, write_path};
use super::palette::{GUIDE, INK, Stroke, guide_stroke, hex};
use super::ticks::Scale;

/// Around a figure (px).
pub(super) const MARGIN_PX: f64 = 10.0;

/// Right of a figure, where half of the last tick label sticks out (px).
pub(super) const RIGHT_MARGIN_PX: f64 = 20.0;

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
/// From ticks to their labels (px).
const LABEL_GAP_PX: (f64, f64) = (6.0, 8.0);
/// Width of a label of the vertical axis that its title leaves (px).
const LEFT_LABEL_PX: f64 = 34.0;
const TITLE_FONT_PX: f64 = 13.0;
const FRAME_PX: f64 = 0.8;
const GUIDE_PX: f64 = 0.7;
const GRID_PX: f64 = 0.4;

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
    /// First and last values of both axes that have a meaning: they are labelled, and no tick lies beyond.
    pub ends: Option<((f64, f64), (f64, f64))>,
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
        Self { left_px, top_px, width_px, height_px, x, y, scales, ends: None, title: None, y_ticks: true, guides: &[] }
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
    pub(super) fn write_axes(&self, svg: &mut String, x_title: Option<&str>) {
        self.write_guides(svg);
        self.write_frame(svg, x_title);
    }

    /// Appends frame, ticks and titles, as [`Self::write_axes`] does.
    pub(super) fn write_frame(&self, svg: &mut String, x_title: Option<&str>) {
        self.write_edge(svg);
        self.write_ticks(svg, x_title.is_some());

        if let Some(title) = self.title.filter(|title| !title.is_empty()) {
            let middle = (self.left_px - LEFT_LABELS_PX + TITLE_FONT_PX, self.top_px + 0.5 * self.height_px);
            let font_px = title_font_px(title, self.height_px);
            Text { anchor: Anchor::Middle, ..Text::new(&formula(title), middle, font_px) }.write(svg, true);
        }
        if let Some(title) = x_title.filter(|title| !title.is_empty()) {
            let middle = (self.left_px + 0.5 * self.width_px, self.bottom_px() + BOTTOM_LABELS_PX - 6.0);
            let font_px = title_font_px(title, self.width_px);
            Text { anchor: Anchor::Middle, ..Text::new(&formula(title), middle, font_px) }.write(svg, false);
        }
    }

    /// Appends vertical lines at the labels of the shared axis.
    pub(super) fn write_grid(&self, svg: &mut String) {
        let line = |label: &Label| path_through([self.y.start, self.y.end].map(|at| self.position_px((label.at, at))));
        let path: String = self.axes().0.ticks().labelled.iter().map(line).collect();
        write_path(svg, &path, Stroke { width_px: GRID_PX, ..Stroke::solid(GUIDE) });
    }

    fn write_guides(&self, svg: &mut String) {
        let inside = |height: &&f64| self.y.contains(*height);
        let line = |height: &f64| path_through([self.x.start, self.x.end].map(|at| self.position_px((at, *height))));
        // The zero of a logarithmic axis is a one.
        if self.scales.1 != Scale::Logarithmic && inside(&&0.0) {
            write_path(svg, &line(&0.0), Stroke { width_px: GUIDE_PX, ..Stroke::solid(GUIDE) });
        }
        let path: String = self.guides.iter().filter(inside).map(line).collect();
        write_path(svg, &path, Stroke { width_px: GUIDE_PX, ..guide_stroke(0) });
    }

    /// Both axes.
    fn axes(&self) -> (Axis, Axis) {
        let across = Axis {
            range: self.x.clone(),
            scale: self.scales.0,
            ends: self.ends.map(|ends| ends.0),
            way: Way::Across,
            length_px: self.width_px,
            target: ((self.width_px / LABEL_WIDTH_PX) as usize).clamp(2, MOST_LABELS),
            margin: 0.0,
        };
        let up = Axis {
            range: self.y.clone(),
            scale: self.scales.1,
            ends: self.ends.map(|ends| ends.1),
            way: Way::Up,
            length_px: self.height_px,
            target: (self.height_px / TICK_DISTANCE_PX) as usize,
            // Half a label's height keeps clear of the neighbouring panels.
            margin: if self.ends.is_some() { 0.0 } else { 0.5 * TICK_FONT_PX / self.height_px },
        };
        (across, up)
    }

    /// How far labels of the horizontal axis stick out beyond the left and the right edge (px).
    pub(super) fn overhang_px(&self) -> (f64, f64) {
        let labels = self.axes().0.ticks().labelled;
        let extent = |label: &Label| {
            let (x, half) = (self.position_px((label.at, self.y.start)).0, 0.5 * label.text.width_px(TICK_FONT_PX));
            (self.left_px - (x - half), x + half - self.right_px())
        };
        labels.iter().map(extent).fold((0.0, 0.0), |most, label| (most.0.max(label.0), most.1.max(label.1)))
    }

    fn write_edge(&self, svg: &mut String) {
        let (left, top) = (units(self.left_px), units(self.top_px));
        svg.push_str(&format!(
            "<rect x=\"{left}\" y=\"{top}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"/>\n",
            units(self.right_px()) - left,
            units(self.bottom_px()) - top,
            hex(INK),
            units(FRAME_PX)
        ));
    }

    /// Appends ticks and labels; those of the vertical axis are as small as it takes to stay clear of its title.
    fn write_ticks(&self, svg: &mut String, labels_x: bool) {
        let (across, up) = self.axes();
        let mut path = String::new();
        // Unlabelled ticks point inwards, away from the next panel.
        let downward = if labels_x { 1 } else { -1 };
        let mut tick = |at: f64, length_px: f64| {
            let (x, y) = self.position_px((at, self.y.start));
            path.push_str(&format!("M{} {}v{}", units(x), units(y), downward * units(length_px)));
            (x, y + TICK_PX + LABEL_GAP_PX.1 + 0.36 * TICK_FONT_PX)
        };
        let ticks = across.ticks();
        ticks.minor.into_iter().for_each(|at| _ = tick(at, MINOR_TICK_PX));
        for label in ticks.labelled {
            let at = tick(label.at, TICK_PX);
            if labels_x {
                Text { anchor: Anchor::Middle, ..Text::new(&label.text.svg(), at, TICK_FONT_PX) }.write(svg, false);
            }
        }
        if self.y_ticks {
            let ticks = up.ticks();
            let widest = ticks.labelled.iter().map(|label| label.text.width_px(TICK_FONT_PX)).fold(1.0, f64::max);
            let font_px = TICK_FONT_PX * (LEFT_LABEL_PX / widest).min(1.0);
            let leftward = if self.title.is_some() { -1 } else { 1 };
            let mut tick = |at: f64, length_px: f64| {
                let (x, y) = self.position_px((self.x.start, at));
                path.push_str(&format!("M{} {}h{}", units(x), units(y), leftward * units(length_px)));
                (x - TICK_PX - LABEL_GAP_PX.0, y + 0.36 * font_px)
            };
            ticks.minor.into_iter().for_each(|at| _ = tick(at, MINOR_TICK_PX));
            for label in ticks.labelled {
                let at = tick(label.at, TICK_PX);
                if self.title.is_some() {
                    Text { anchor: Anchor::End, ..Text::new(&label.text.svg(), at, font_px) }.write(svg, false);
                }
            }
        }
        if !path.is_empty() {
            svg.push_str(&format!("<path d=\"{path}\" stroke=\"{}\" stroke-width=\"{}\"/>\n", hex(INK), units(FRAME_PX)));
        }
    }
}

/// Font size (px) of the axis title `markup`, as small as it takes to be no longer than `length_px`.
fn title_font_px(markup: &str, length_px: f64) -> f64 {
    TITLE_FONT_PX * (length_px / formula_width_px(markup, TITLE_FONT_PX)).min(1.0)
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
