//! The figure of paired comparisons: an interval along a shared axis for each, with its name on the left and words on the right.

use super::layer::{Anchor, Text, document, escape, path_through, units, write_disc, write_path, write_rect};
use super::legend::write_heading;
use super::palette::{Colour, GROUND, INK, Stroke, device_look};
use super::panel::{BOTTOM_LABELS_PX, MARGIN_PX, Panel, RIGHT_MARGIN_PX, scale_around_zero};
use super::text_width::text_width_px;
use super::{FigureTitle, PlotError};
use crate::band::Band;

/// Data area (px).
const AXIS_PX: f64 = 420.0;
const ROW_PX: f64 = 24.0;
const LABEL_GAP_PX: f64 = 12.0;
const FONT_PX: f64 = 11.5;
const DISC_PX: f64 = 4.6;
const BAND_PX: f64 = 2.0;
/// Behind every other row.
const STRIPE: Colour = Colour(245, 245, 245);

/// A comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct Interval {
    /// What is compared.
    pub name: String,
    /// The difference.
    pub value: f64,
    /// Its band.
    pub band: Band,
    /// What it comes to, in a few words.
    pub verdict: String,
    /// Whether the band is coloured; else it is grey.
    pub sure: bool,
}

/// Draws `intervals` from the top as an SVG document; `x_title` is in the markup of [`super::Chart::x_title`]. The axis holds 0, at which a
/// line stands. The text is the same for the same input.
///
/// # Errors
/// [`PlotError`] without intervals, and for numbers that are not finite.
pub fn interval_figure(title: &FigureTitle, x_title: &str, intervals: &[Interval]) -> Result<String, PlotError> {
    if intervals.is_empty() {
        return Err(PlotError::NothingToDraw { title: title.text.clone() });
    }
    let values = |interval: &Interval| [interval.band.low, interval.value, interval.band.high];
    if let Some(interval) = intervals.iter().find(|interval| !values(interval).iter().all(|value| value.is_finite())) {
        return Err(PlotError::NotFiniteValue { name: interval.name.clone() });
    }
    let widest =
        |text: fn(&Interval) -> &str| intervals.iter().map(|interval| text_width_px(text(interval), FONT_PX)).fold(0.0, f64::max);
    let names_px = widest(|interval| &interval.name) + LABEL_GAP_PX;
    let words_px = widest(|interval| &interval.verdict) + LABEL_GAP_PX;
    let width_px = names_px + AXIS_PX + words_px;
    let mut body = String::new();
    let top_px = write_heading(&mut body, title, &[], (MARGIN_PX, width_px)) + 4.0;
    let x = scale_around_zero(intervals.iter().flat_map(values), 1.0);
    let panel = Panel::new((MARGIN_PX + names_px, top_px), (AXIS_PX, ROW_PX * intervals.len() as f64), x, 0.0..1.0);
    let panel = Panel { y_ticks: false, ..panel };
    for row in (0..intervals.len()).step_by(2) {
        let corner = (units(MARGIN_PX), units(top_px + ROW_PX * row as f64));
        write_rect(&mut body, corner, (units(width_px), units(ROW_PX)), STRIPE);
    }
    panel.write_grid(&mut body);
    let zero = [panel.y.start, panel.y.end].map(|at| panel.position_px((0.0, at)));
    write_path(&mut body, &path_through(zero), Stroke { width_px: 1.0, ..Stroke::solid(INK) });
    panel.write_frame(&mut body, Some(x_title));
    for (row, interval) in intervals.iter().enumerate() {
        let middle = top_px + ROW_PX * (row as f64 + 0.5);
        let across = |value: f64| (panel.position_px((value, 0.0)).0, middle);
        let baseline = middle + 0.36 * FONT_PX;
        Text::new(&escape(&interval.name), (MARGIN_PX + 4.0, baseline), FONT_PX).write(&mut body, false);
        let colour = if interval.sure { device_look(0).colour } else { GROUND };
        let ends = [interval.band.low, interval.band.high].map(across);
        write_path(&mut body, &path_through(ends), Stroke { width_px: BAND_PX, ..Stroke::solid(colour) });
        write_disc(&mut body, across(interval.value), DISC_PX, colour, " stroke=\"#ffffff\" stroke-width=\"12\"");
        let words = Text::new("", (panel.right_px() + LABEL_GAP_PX, baseline), FONT_PX);
        let content = escape(&interval.verdict);
        Text { content: &content, colour, anchor: Anchor::Start, ..words }.write(&mut body, false);
    }
    let height_px = panel.bottom_px() + BOTTOM_LABELS_PX + 4.0;
    Ok(document(&title.text, (MARGIN_PX + width_px + RIGHT_MARGIN_PX, height_px), &body))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::assert_drawn;

    fn interval(value: f64, half: f64) -> Interval {
        Interval {
            name: "a < b".to_owned(),
            value,
            band: Band { low: value - half, high: value + half },
            verdict: "better & sure".to_owned(),
            sure: half < value,
        }
    }

    #[test]
    fn intervals_are_drawn_and_escaped() {
        let title = FigureTitle { text: "A & B".to_owned(), conditions: Vec::new() };
        let svg = interval_figure(&title, "difference (%)", &[interval(3.0, 1.0), interval(1.0, 2.0)]).unwrap();
        assert_drawn(&svg);
        assert!(svg.contains("A &amp; B") && svg.matches("a &lt; b").count() == 2 && svg.contains("better &amp; sure"));
        // One is as good as its rival in every motion: no width.
        assert_drawn(&interval_figure(&title, "", &[interval(0.0, 0.0)]).unwrap());
        assert_eq!(interval_figure(&title, "", &[]), Err(PlotError::NothingToDraw { title: "A & B".to_owned() }));
        assert!(matches!(interval_figure(&title, "", &[interval(f64::NAN, 1.0)]), Err(PlotError::NotFiniteValue { .. })));
    }
}
