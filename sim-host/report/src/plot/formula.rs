//! Formulas in plain markup: symbols in italics, subscripts, dots over symbols.

use super::layer::escape;
use super::text_width::text_width_px;

/// Size of subscripts and superscripts, relative to the text.
const SMALL: f64 = 0.75;

// How the text after a subscript or a dot finds its place again.
const UP_FROM_SUBSCRIPT: &str = " dy=\"-0.19em\"";
const UP_AND_ON_FROM_SUBSCRIPT: &str = " dx=\"0.3em\" dy=\"-0.19em\"";
const BACK_FROM_DOT: &str = " dx=\"0.14em\" dy=\"0.8em\"";
const BACK_FROM_TWO_DOTS: &str = " dx=\"0.02em\" dy=\"0.8em\"";

/// SVG text of plain markup: `*x*` italic, `_x` one subscript character, `_{xyz}` several, `'` a dot and `''` two dots over the
/// symbol before them; [`literal`] writes these characters as they are.
///
/// The dot is a full stop moved back and up by fractions of the font size, because fonts place combining dots badly.
pub(super) fn formula(markup: &str) -> String {
    let mut svg = String::new();
    let mut italic = false;
    let mut return_shift = "";
    let mut characters = markup.chars().peekable();
    while let Some(character) = characters.next() {
        match character {
            '*' => {
                svg.push_str(if italic { "</tspan>" } else { "<tspan font-style=\"italic\">" });
                italic = !italic;
            }
            '_' => {
                let subscript = escape(&subscript(&mut characters));
                svg.push_str(&format!("<tspan dy=\"0.25em\" font-size=\"0.75em\">{subscript}</tspan>"));
                return_shift = UP_FROM_SUBSCRIPT;
            }
            '\'' if characters.next_if_eq(&'\'').is_some() => {
                svg.push_str("<tspan dx=\"-0.56em\" dy=\"-0.8em\">..</tspan>");
                return_shift = BACK_FROM_TWO_DOTS;
            }
            '\'' => {
                svg.push_str("<tspan dx=\"-0.45em\" dy=\"-0.8em\">.</tspan>");
                return_shift = BACK_FROM_DOT;
            }
            // A space at the start of an element would be dropped, so it becomes a shift.
            ' ' if return_shift == UP_FROM_SUBSCRIPT => return_shift = UP_AND_ON_FROM_SUBSCRIPT,
            other => {
                let other = if other == '\\' { characters.next().unwrap_or(other) } else { other };
                let other = escape(&other.to_string());
                if return_shift.is_empty() {
                    svg.push_str(&other);
                } else {
                    svg.push_str(&format!("<tspan{return_shift}>{other}</tspan>"));
                    return_shift = "";
                }
            }
        }
    }
    if italic {
        svg.push_str("</tspan>");
    }
    svg
}

/// What stands below the line after `_`.
fn subscript(characters: &mut std::iter::Peekable<std::str::Chars<'_>>) -> String {
    match characters.next() {
        Some('{') => characters.by_ref().take_while(|character| *character != '}').collect(),
        other => other.unwrap_or(' ').to_string(),
    }
}

/// `text` in the markup of formulas that is written as it is, such as a name that a user has given.
pub fn literal(text: &str) -> String {
    text.chars()
        .flat_map(|character| ['*', '_', '\'', '\\'].contains(&character).then_some('\\').into_iter().chain([character]))
        .collect()
}

/// Width of `markup` in pixels at `font_px`, as [`formula`] writes it.
pub(super) fn formula_width_px(markup: &str, font_px: f64) -> f64 {
    let mut width_px = 0.0;
    let mut characters = markup.chars().peekable();
    while let Some(character) = characters.next() {
        width_px += match character {
            // Dots lie over what is before them.
            '*' | '\'' => 0.0,
            '_' => text_width_px(&subscript(&mut characters), SMALL * font_px),
            other => {
                let other = if other == '\\' { characters.next().unwrap_or(other) } else { other };
                text_width_px(other.encode_utf8(&mut [0; 4]), font_px)
            }
        };
    }
    width_px
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_balance_their_tags() {
        for markup in
            ["*a*_g (g)", "*t*_{uni} (s)", "_{open", "θ'/(*p*α)", "θ''/(*p*²α)", "*F*/(*mg*)", "plain", "*open", "_", "\\"]
        {
            let svg = formula(markup);
            assert_eq!(svg.matches("<tspan").count(), svg.matches("</tspan>").count(), "{svg}");
        }
        assert_eq!(formula("time (s)"), "time (s)");
        assert!(formula("θ''").contains(">..<") && formula("θ'").contains(">.<"));
        assert!(formula("a_<").contains("&lt;"));
        assert!(formula("*t*_{u<i}").ends_with(">u&lt;i</tspan>"));
    }

    #[test]
    fn a_literal_is_written_as_it_is() {
        for text in ["soft_pair*2", "the owner's \\ device", "plain"] {
            assert_eq!(formula(&literal(text)), text);
            assert!((formula_width_px(&literal(text), 13.0) - text_width_px(text, 13.0)).abs() < 1e-9);
        }
    }

    #[test]
    fn a_formula_is_as_wide_as_its_characters() {
        let expected = text_width_px("a/p", 10.0) + text_width_px("uni", 7.5);
        assert!((formula_width_px("*a*_{uni}/*p*''", 10.0) - expected).abs() < 1e-9);
    }
}
