//! Widths of texts, in the font of PNG pictures: most sans-serif fonts that show SVG are narrower.

use std::sync::LazyLock;

use skrifa::charmap::Charmap;
use skrifa::instance::{LocationRef, Size};
use skrifa::metrics::GlyphMetrics;
use skrifa::{FontRef, MetadataProvider};

/// Of a character that the font does not have, relative to the font size.
const MISSING: f32 = 1.0;

/// Characters and widths (for a font size of 1) of a font.
struct Face {
    characters: Charmap<'static>,
    widths: GlyphMetrics<'static>,
}

/// `None` should the font be unreadable; texts are then taken to be as wide as they can be.
static UPRIGHT: LazyLock<Option<Face>> = LazyLock::new(|| {
    let font = FontRef::new(dejavu::sans::regular()).ok()?;
    Some(Face { characters: font.charmap(), widths: font.glyph_metrics(Size::new(1.0), LocationRef::default()) })
});

/// Width of `text` in pixels at `font_px`.
pub(super) fn text_width_px(text: &str, font_px: f64) -> f64 {
    let of = |character: char| {
        let face = UPRIGHT.as_ref()?;
        face.widths.advance_width(face.characters.map(character)?)
    };
    text.chars().map(|character| f64::from(of(character).unwrap_or(MISSING))).sum::<f64>() * font_px
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widths_are_those_of_the_font() {
        // From the tables of DejaVu Sans, in 2048ths.
        assert!((text_width_px("0m", 2048.0) - (1303.0 + 1995.0)).abs() < 1.0);
        assert_eq!(text_width_px("", 11.0), 0.0);
        assert_eq!(text_width_px("\u{5730}", 11.0), 11.0);
    }
}
