//! Widths of texts, in the font of PNG pictures: most sans-serif fonts that show SVG are narrower.

include!(concat!(env!("OUT_DIR"), "/widths.rs"));

/// Of a character that the font does not have, relative to the font size.
const MISSING: f32 = 1.0;

/// Width of `text` in pixels at `font_px`.
pub(super) fn text_width_px(text: &str, font_px: f64) -> f64 {
    let of = |character: char| {
        let found = WIDTHS.binary_search_by_key(&u32::from(character), |(character, _)| u32::from(*character));
        found.map_or(MISSING, |index| f32::from(WIDTHS[index].1) / UNITS)
    };
    text.chars().map(|character| f64::from(of(character))).sum::<f64>() * font_px
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
