//! Title and legend above the panels.

use super::FigureTitle;
use super::formula::{formula, formula_width_px};
use super::layer::{Text, escape, units, write_area, write_rect};
use super::marker::{Marker, write_mark};
use super::palette::{Colour, DeviceLook, GROUND, INK, Stroke, hex};
use super::panel::MARGIN_PX;
use super::text_width::text_width_px;
use crate::lines::in_lines;

const TITLE_FONT_PX: f64 = 14.0;
const CONDITIONS_FONT_PX: f64 = 12.0;
const FONT_PX: f64 = 11.0;
const ROW_PX: f64 = 17.0;
/// So long that the longest dash shows twice.
const SWATCH_PX: f64 = 36.0;
const GAP_PX: f64 = 14.0;

/// Part of a width that [`wrapped`] may use for bold text, which is wider.
pub(super) const BOLD_WIDTH: f64 = 0.87;

/// A legend entry: what it looks like and its name.
pub(super) type LegendEntry = (Swatch, String);

/// Appends a mark around a position (px).
pub(super) type DrawMark = fn(&mut String, (f64, f64));

/// What stands left of a legend text.
#[derive(Debug, Clone, Copy)]
pub(super) enum Swatch {
    /// A piece of a curve.
    Line(Stroke),
    /// A piece of a curve with a disc at its points.
    MarkedLine(Stroke),
    /// A piece of a fitted line on its band, with the mark of what it was fitted to.
    Fitted(DeviceLook, Option<Marker>),
    /// A mark in a colour of no device.
    Mark(Marker, Colour),
    /// What a function draws.
    Drawn(DrawMark),
    /// A band of this opacity.
    Band(f64),
    /// A line in the middle of its band of this opacity.
    BandedLine(Stroke, f64),
    /// A tint.
    Tint(Colour),
    /// A tint and the colour that stands for the same where it is alone.
    Tints(Colour, Colour),
    /// A colour that needs an edge, since it may be near white.
    Framed(Colour),
}

/// Appends title and legend at the top, over the width from `left_px`; returns the lower edge (px).
///
/// What holds in all of the figure stands below the title, and every group of entries starts a row of its own.
pub(super) fn write_heading(
    svg: &mut String,
    title: &FigureTitle,
    groups: &[Vec<LegendEntry>],
    (left_px, width_px): (f64, f64),
) -> f64 {
    let mut y = MARGIN_PX;
    for line in wrapped(&title.text, BOLD_WIDTH * width_px, TITLE_FONT_PX) {
        y += TITLE_FONT_PX + 4.0;
        let text = Text::new(&line, (left_px, y - 4.0), TITLE_FONT_PX);
        Text { attributes: " font-weight=\"bold\"", ..text }.write(svg, false);
    }
    for line in lines_of(&title.conditions, width_px) {
        y += CONDITIONS_FONT_PX + 5.0;
        let content = formula(&line);
        Text { colour: GROUND, ..Text::new(&content, (left_px, y - 4.0), CONDITIONS_FONT_PX) }.write(svg, false);
    }
    y += 4.0;
    for entries in groups {
        y = write_entries(svg, entries, (left_px, width_px), y);
    }
    y + 6.0
}

/// Appends entries in as many columns as fit; returns the lower edge (px).
fn write_entries(svg: &mut String, entries: &[LegendEntry], (left_px, width_px): (f64, f64), top_px: f64) -> f64 {
    let lefts = column_lefts(entries, width_px);
    let columns = lefts.len();
    for (index, (swatch, text)) in entries.iter().enumerate() {
        let x = left_px + lefts[index % columns];
        let middle = top_px + ((index / columns) as f64 + 0.5) * ROW_PX;
        write_swatch(svg, *swatch, x, middle);
        let content = shortened(text, width_px - SWATCH_PX - 6.0);
        let baseline = (x + SWATCH_PX + 6.0, middle + 0.36 * FONT_PX);
        Text::new(&content, baseline, FONT_PX).write(svg, false);
    }
    top_px + entries.len().div_ceil(columns) as f64 * ROW_PX
}

/// Left edges of the columns (px), at least one: the largest number of columns whose widest entries fit side by side.
fn column_lefts(entries: &[LegendEntry], width_px: f64) -> Vec<f64> {
    for columns in (2..=entries.len()).rev() {
        let mut widths = vec![0.0_f64; columns];
        for (index, (_, text)) in entries.iter().enumerate() {
            let entry_px = SWATCH_PX + 6.0 + text_width_px(text, FONT_PX) + GAP_PX;
            widths[index % columns] = widths[index % columns].max(entry_px);
        }
        if widths.iter().sum::<f64>() - GAP_PX <= width_px {
            let mut left = 0.0;
            return widths
                .iter()
                .map(|width| {
                    left += width;
                    left - width
                })
                .collect();
        }
    }
    vec![0.0]
}

fn write_swatch(svg: &mut String, swatch: Swatch, x_px: f64, middle_px: f64) {
    let (x, y, width) = (units(x_px), units(middle_px), units(SWATCH_PX));
    match swatch {
        Swatch::Line(stroke) => svg.push_str(&format!(
            "<path d=\"M{x} {y}h{width}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-dasharray=\"{}\"/>\n",
            hex(stroke.colour),
            units(stroke.width_px),
            stroke.dashes,
        )),
        Swatch::MarkedLine(stroke) => {
            write_swatch(svg, Swatch::Line(stroke), x_px, middle_px);
            write_mark(svg, (x_px + 0.5 * SWATCH_PX, middle_px), stroke.colour, false);
        }
        Swatch::Fitted(look, marker) => {
            write_swatch(svg, Swatch::Line(look.stroke()), x_px, middle_px);
            if let Some(marker) = marker {
                marker.write(svg, (x_px + 0.5 * SWATCH_PX, middle_px), look.colour);
            }
        }
        Swatch::Mark(marker, colour) => marker.write(svg, (x_px + 0.5 * SWATCH_PX, middle_px), colour),
        Swatch::Drawn(draw) => draw(svg, (x_px + 0.5 * SWATCH_PX, middle_px)),
        Swatch::Band(opacity) => {
            let [left, right, top, bottom] = [x_px, x_px + SWATCH_PX, middle_px - 5.0, middle_px + 5.0];
            write_area(svg, &[(left, top), (right, top), (right, bottom), (left, bottom)], INK, opacity);
        }
        Swatch::BandedLine(stroke, opacity) => {
            write_swatch(svg, Swatch::Band(opacity), x_px, middle_px);
            write_swatch(svg, Swatch::Line(stroke), x_px, middle_px);
        }
        Swatch::Tint(colour) => {
            write_rect(svg, (x, y - units(5.0)), (width, units(10.0)), colour);
        }
        Swatch::Tints(tint, bar) => {
            write_swatch(svg, Swatch::Tint(tint), x_px, middle_px);
            write_rect(svg, (x + width / 2, y - units(5.0)), (width - width / 2, units(10.0)), bar);
        }
        Swatch::Framed(colour) => {
            write_rect(svg, (x, y - units(5.0)), (width, units(10.0)), INK);
            write_rect(svg, (x + units(0.6), y - units(4.4)), (width - units(1.2), units(8.8)), colour);
        }
    }
}

/// `text` escaped; when it is wider than `width_px`, an ellipsis stands for the end of the device's name, so that the
/// outcome in parentheses stays, or for the end of the text when the outcome alone is long.
pub(super) fn shortened(text: &str, width_px: f64) -> String {
    if text_width_px(text, FONT_PX) <= width_px {
        return escape(text);
    }
    let (name, outcome) = text.split_at(text.rfind(" (").unwrap_or(text.len()));
    let outcome_px = text_width_px(outcome, FONT_PX);
    let (mut kept, tail, room_px) = if outcome_px <= 0.5 * width_px {
        (name.to_owned(), outcome, width_px - outcome_px)
    } else {
        (text.to_owned(), "", width_px)
    };
    while !kept.is_empty() && text_width_px(&kept, FONT_PX) + FONT_PX > room_px {
        kept.pop();
    }
    format!("{}…{}", escape(kept.trim_end()), escape(tail))
}

/// Lines of the formulas `conditions`, broken between them, and sums of motions that are wider than a line before a motion.
fn lines_of(conditions: &[String], width_px: f64) -> Vec<String> {
    let fits = |text: &str| formula_width_px(text, CONDITIONS_FONT_PX) <= width_px;
    let lines = in_lines(conditions.iter().map(String::as_str), ", ", |line, next| fits(&format!("{line}, {next}")));
    let in_motions = |line: &String| in_lines(line.split_inclusive(" + "), "", |line, next| fits(&format!("{line}{next}")));
    lines.iter().flat_map(in_motions).collect()
}

/// Lines of `title`, broken at spaces, and words wider than a line after their hyphens; without one a word may still be too wide.
pub(super) fn wrapped(title: &str, width_px: f64, font_px: f64) -> Vec<String> {
    let fits = |line: &str, word: &str| text_width_px(line, font_px) + text_width_px(word, font_px) + font_px <= width_px;
    let parts_fit = |part: &str, next: &str| text_width_px(part, font_px) + text_width_px(next, font_px) <= width_px;
    let in_parts = |word: &str| in_lines(word.split_inclusive('-'), "", parts_fit);
    let words: Vec<String> = title.split_whitespace().flat_map(in_parts).collect();
    in_lines(words.iter().map(String::as_str), " ", fits).iter().map(|line| escape(line)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_share_a_row_when_they_fit() {
        let entries = |length: usize| vec![(Swatch::Band(1.0), "x".repeat(length)); 4];
        assert_eq!(column_lefts(&entries(5), 668.0).len(), 4);
        assert_eq!(column_lefts(&entries(40), 668.0).len(), 2);
        assert_eq!(column_lefts(&entries(400), 668.0), vec![0.0]);
        assert_eq!(column_lefts(&[], 668.0), vec![0.0]);
    }

    #[test]
    fn long_texts_break_or_shorten() {
        let title = "word ".repeat(60);
        assert!(wrapped(&title, 600.0, 14.0).len() > 2);
        assert!(wrapped("", 600.0, 14.0).is_empty());
        assert_eq!(wrapped("resisting-predicted, sine", 200.0, 12.0), ["resisting-predicted, sine"]);
        assert_eq!(wrapped("resisting-predicted, sine", 100.0, 12.0), ["resisting-", "predicted, sine"]);
        assert_eq!(wrapped("a word-with-hyphens in it", 70.0, 12.0), ["a", "word-with-", "hyphens", "in it"]);
        let short = shortened(&"x".repeat(500), 300.0);
        assert!(short.ends_with('…') && text_width_px(&short, FONT_PX) <= 300.0 + FONT_PX);
        let outcome = shortened(&format!("{} (safe)", "x".repeat(500)), 300.0);
        assert!(outcome.ends_with("x… (safe)"));
        assert_eq!(shortened("a & b", 300.0), "a &amp; b");
    }

    #[test]
    fn a_sum_of_many_motions_goes_on_below() {
        let motion = "Mavroeidis-Papageorgiou pulse (*A* = 0.2 m/s, *f*_g = 1 Hz, γ = 2, ν = 30°)";
        let lines = lines_of(&["α = 10°".to_owned(), [motion; 4].join(" + ")], 668.0);
        assert!(lines.len() > 2 && lines.iter().all(|line| formula_width_px(line, CONDITIONS_FONT_PX) <= 668.0), "{lines:?}");
        assert_eq!(lines.concat(), format!("α = 10°{}", [motion; 4].join(" + ")));
    }
}
