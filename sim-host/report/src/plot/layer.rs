//! Pieces of SVG: lines, areas and texts, on a grid of tenths of a pixel.

use super::palette::{Colour, INK, Stroke, hex};

/// Drawing units per pixel: whole units keep the text short, and a tenth of a pixel is smooth.
pub(super) const UNIT: f64 = 10.0;

/// Whole drawing units of a length in pixels.
pub(super) fn units(px: f64) -> i32 {
    (px * UNIT).round() as i32
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
    pub colour: Colour,
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

/// The path through positions in pixels, with the elements of SVG's `d`.
pub(super) fn path_through(positions: impl IntoIterator<Item = (f64, f64)>) -> String {
    let element = |(index, (x_px, y_px)): (usize, (f64, f64))| {
        format!("{}{} {}", if index == 0 { "M" } else { "L" }, units(x_px), units(y_px))
    };
    positions.into_iter().enumerate().map(element).collect()
}

/// Appends the lines of `path`; nothing for an empty one.
pub(super) fn write_path(svg: &mut String, path: &str, stroke: Stroke) {
    if path.is_empty() {
        return;
    }
    svg.push_str(&format!(
        "<path d=\"{path}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-dasharray=\"{}\" stroke-linejoin=\"round\"/>\n",
        hex(stroke.colour),
        units(stroke.width_px),
        stroke.dashes,
    ));
}

/// Appends a filled rectangle given in drawing units.
pub(super) fn write_rect(svg: &mut String, corner: (i32, i32), size: (i32, i32), fill: Colour) {
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
pub(super) fn write_area(svg: &mut String, corners: &[(f64, f64)], fill: Colour, opacity: f64) {
    if corners.len() < 3 {
        return;
    }
    let corners: Vec<String> = corners.iter().map(|(x_px, y_px)| format!("{},{}", units(*x_px), units(*y_px))).collect();
    svg.push_str(&format!("<polygon points=\"{}\" fill=\"{}\" fill-opacity=\"{opacity}\"/>\n", corners.join(" "), hex(fill)));
}

/// Appends a disc around a position in pixels; `attributes` have a leading space.
pub(super) fn write_disc(svg: &mut String, (x_px, y_px): (f64, f64), radius_px: f64, colour: Colour, attributes: &str) {
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
}
