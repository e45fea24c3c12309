//! A figure of panels in rows, each below its heading.

use super::layer::document;
use super::legend::{LegendEntry, write_heading};
use super::panel::{BOTTOM_LABELS_PX, LEFT_LABELS_PX, MARGIN_PX, RIGHT_MARGIN_PX};
use super::panel_heading::Heading;
use super::{FigureTitle, PlotError};

/// Width of title and legend over a small panel (px).
const LEAST_WIDTH_PX: f64 = 360.0;

/// Where the panels are.
#[derive(Debug, Clone, Copy)]
pub(super) struct PanelGrid {
    /// Panels in a row.
    pub columns: usize,
    /// Width and height of a panel's data area (px).
    pub panel_px: (f64, f64),
    /// Right of a panel, and below a row (px).
    pub gap_px: (f64, f64),
    /// Right of the last panel, for labels (px).
    pub labels_px: f64,
}

/// The place of a panel.
pub(super) struct Place {
    /// Number of the panel, row by row.
    pub index: usize,
    /// Left and upper edge of its data area (px).
    pub corner_px: (f64, f64),
    /// It is the first of its row.
    pub first: bool,
    /// It is the lowest of its column.
    pub lowest: bool,
}

impl PanelGrid {
    /// The document with a panel for each of `headings`, which `draw` appends.
    pub(super) fn document(
        self,
        title: &FigureTitle,
        keys: &[Vec<LegendEntry>],
        headings: &[Heading],
        mut draw: impl FnMut(&mut String, Place) -> Result<(), PlotError>,
    ) -> Result<String, PlotError> {
        let Self { columns, panel_px, gap_px, labels_px } = self;
        let (left_px, column_px) = (MARGIN_PX + LEFT_LABELS_PX, panel_px.0 + labels_px + gap_px.0);
        let area_px = (columns as f64 * column_px - gap_px.0).max(LEAST_WIDTH_PX);
        let mut svg = String::new();
        let mut top_px = write_heading(&mut svg, title, keys, (left_px, area_px)) + 4.0;
        for (row, row_headings) in headings.chunks(columns).enumerate() {
            top_px += row_headings.iter().map(Heading::height_px).fold(0.0, f64::max);
            for (column, heading) in row_headings.iter().enumerate() {
                let index = row * columns + column;
                let corner_px = (left_px + column as f64 * column_px, top_px);
                heading.write(&mut svg, (corner_px.0, top_px - 5.0));
                draw(&mut svg, Place { index, corner_px, first: column == 0, lowest: index + columns >= headings.len() })?;
            }
            top_px += panel_px.1 + gap_px.1;
        }
        let height_px = top_px - gap_px.1 + BOTTOM_LABELS_PX + 4.0;
        Ok(document(&title.text, (left_px + area_px + RIGHT_MARGIN_PX, height_px), &svg))
    }
}
