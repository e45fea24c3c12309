//! A figure of panels one above the other, which share the horizontal axis.

use std::ops::Range;

use super::FigureTitle;
use super::layer::document;
use super::legend::{LegendEntry, write_heading};
use super::panel::{BOTTOM_LABELS_PX, LEFT_LABELS_PX, MARGIN_PX, Panel, RIGHT_MARGIN_PX};

const WIDTH_PX: f64 = 760.0;
/// Left edge of the panels (px).
pub(super) const LEFT_PX: f64 = MARGIN_PX + LEFT_LABELS_PX;
/// Width of the panels (px).
pub(super) const PANELS_PX: f64 = WIDTH_PX - LEFT_PX - RIGHT_MARGIN_PX;
/// Height of panels, of one of the ground motion and one of rotations (px).
pub(super) const PANEL_PX: f64 = 118.0;
pub(super) const GROUND_PANEL_PX: f64 = 84.0;
pub(super) const ROTATION_PANEL_PX: f64 = 184.0;
/// Between two panels (px).
const GAP_PX: f64 = 11.0;

/// Title, legend, and below them panels.
pub(super) struct Stack {
    /// What is drawn so far.
    pub svg: String,
    /// Upper edge of the next panel (px).
    pub top_px: f64,
    /// Range of the shared axis.
    pub x: Range<f64>,
}

impl Stack {
    /// A stack without panels.
    pub(super) fn new(title: &FigureTitle, keys: &[Vec<LegendEntry>], x: Range<f64>) -> Self {
        let mut svg = String::new();
        let top_px = write_heading(&mut svg, title, keys, (LEFT_PX, PANELS_PX));
        Self { svg, top_px, x }
    }

    /// Whether the shared axis shows `at`.
    pub(super) fn shows(&self, at: f64) -> bool {
        at >= self.x.start && at <= self.x.end
    }

    /// Where `at` is across the figure (px).
    pub(super) fn position_px(&self, at: f64) -> f64 {
        LEFT_PX + (at - self.x.start) / (self.x.end - self.x.start) * PANELS_PX
    }

    /// The next panel, `height_px` high, over the range `y`.
    pub(super) fn panel<'a>(&mut self, height_px: f64, y: Range<f64>, title: Option<&'a str>) -> Panel<'a> {
        let panel = Panel { title, ..Panel::new((LEFT_PX, self.top_px), (PANELS_PX, height_px), self.x.clone(), y) };
        self.top_px += height_px + GAP_PX;
        panel
    }

    /// The document, which ends below the last panel.
    pub(super) fn document(self, title: &FigureTitle) -> String {
        document(&title.text, (WIDTH_PX, self.top_px - GAP_PX + BOTTOM_LABELS_PX + 4.0), &self.svg)
    }
}
