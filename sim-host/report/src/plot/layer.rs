//! Pieces of SVG: what plotters draws on a fine grid, and the text and rectangles it cannot draw.

use plotters::coord::Shift;
use plotters::prelude::{DrawingArea, DrawingBackend, IntoDrawingArea, SVGBackend};
use plotters::style::RGBColor;

use super::PlotError;
use super::palette::{INK, hex};

/// Drawing units per pixel. plotters rounds coordinates to whole units, and a tenth of a pixel is smooth.
pub(super) const UNIT: f64 = 10.0;

/// Whole drawing units of a length in pixels.
pub(super) fn units(px: f64) -> i32 {
    (px * UNIT).round() as i32
}

/// The elements plotters writes for `draw` on a canvas of `size` units, without the document around them.
pub(super) fn plotters_layer<F>(size: (u32, u32), draw: F) -> Result<String, PlotError>
where
    F: for<'a> FnOnce(&DrawingArea<SVGBackend<'a>, Shift>) -> Result<(), String>,
{
    let mut document = String::new();
    {
        let root = SVGBackend::with_string(&mut document, size).into_drawing_area();
        draw(&root).map_err(PlotError::Drawing)?;
        root.present().map_err(|error| PlotError::Drawing(error.to_string()))?;
    }
    let start = document.find('>').map_or(0, |end| end + 1);
    let end = document.rfind("</svg>").unwrap_or(document.len());
    Ok(document[start..end].trim_start().to_owned())
}

/// The whole SVG document around `body`, on white.
pub(super) fn document(title: &str, (width_px, height_px): (f64, f64), body: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width_px:.0}\" height=\"{height_px:.0}\" \
         viewBox=\"0 0 {} {}\" font-family=\"sans-serif\">\n\
         <title>{}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{body}</svg>\n",
        units(width_px),
        units(height_px),
        escape(title),
    )
}

/// Turns a drawing error into its text.
pub(super) fn text_of<DB: DrawingBackend>(error: plotters::drawing::DrawingAreaErrorKind<DB::ErrorType>) -> String {
    error.to_string()
}

/// `text` as XML character data; characters that XML forbids become spaces.
pub(super) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '&' => escaped.push_str("&amp;"),
            '"' => escaped.push_str("&quot;"),
            '\u{fffe}' | '\u{ffff}' => escaped.push(' '),
            control if control.is_control() => escaped.push(' '),
            other => escaped.push(other),
        }
    }
    escaped
}

/// Where a text starts from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    /// The position is the left end.
    Start,
    /// The position is the middle.
    Middle,
    /// The position is the right end.
    End,
}

/// A text element: ready-made SVG `content` at a baseline position in pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Text<'a> {
    /// Escaped text or the output of [`super::formula::formula`].
    pub content: &'a str,
    /// Baseline position (px).
    pub at: (f64, f64),
    /// Font size (px).
    pub size_px: f64,
    /// What `at` refers to.
    pub anchor: Anchor,
    /// Colour.
    pub colour: RGBColor,
    /// Further attributes, with a leading space.
    pub attributes: &'a str,
}

impl<'a> Text<'a> {
    /// Text in ink colour that starts at `at`.
    pub(super) fn new(content: &'a str, at: (f64, f64), size_px: f64) -> Self {
        Self { content, at, size_px, anchor: Anchor::Start, colour: INK, attributes: "" }
    }

    /// Appends the element to `svg`; with `turned`, the text reads upwards.
    pub(super) fn write(&self, svg: &mut String, turned: bool) {
        let (x, y) = (units(self.at.0), units(self.at.1));
        let anchor = match self.anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let turn = if turned { format!(" transform=\"rotate(-90 {x} {y})\"") } else { String::new() };
        svg.push_str(&format!(
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" text-anchor=\"{anchor}\" fill=\"{}\"{}{turn}>{}</text>\n",
            units(self.size_px),
            hex(self.colour),
            self.attributes,
            self.content,
        ));
    }
}

/// Appends a filled rectangle given in drawing units.
pub(super) fn write_rect(svg: &mut String, corner: (i32, i32), size: (i32, i32), fill: RGBColor) {
    svg.push_str(&format!(
        "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>\n",
        corner.0,
        corner.1,
        size.0,
        size.1,
        hex(fill),
    ));
}

/// Appends a filled area with `corners` in pixels; nothing for fewer than three.
pub(super) fn write_area(svg: &mut String, corners: &[(f64, f64)], fill: RGBColor, opacity: f64) {
    if corners.len() < 3 {
        return;
    }
    let corners: Vec<String> = corners.iter().map(|(x_px, y_px)| format!("{},{}", units(*x_px), units(*y_px))).collect();
    svg.push_str(&format!("<polygon points=\"{}\" fill=\"{}\" fill-opacity=\"{opacity}\"/>\n", corners.join(" "), hex(fill)));
}

/// Appends a disc around a position in pixels; `attributes` have a leading space.
pub(super) fn write_disc(svg: &mut String, (x_px, y_px): (f64, f64), radius_px: f64, colour: RGBColor, attributes: &str) {
    svg.push_str(&format!(
        "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{}\"{attributes}/>\n",
        units(x_px),
        units(y_px),
        units(radius_px),
        hex(colour),
    ));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escape_leaves_no_markup() {
        assert_eq!(escape("a<b>&\"c\"\u{1}"), "a&lt;b&gt;&amp;&quot;c&quot; ");
    }

    #[test]
    fn a_layer_has_no_document_tags() {
        let layer = plotters_layer((100, 100), |_| Ok(())).unwrap();
        assert!(!layer.contains("svg"));
    }
}
