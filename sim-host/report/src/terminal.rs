//! Text for standard output where that is a terminal: broken between words.

use console::{Term, measure_text_width};

use crate::lines::in_lines;

/// What a line that goes on below is indented by, beyond its beginning.
const INDENT: &str = "  ";

/// Characters in a line of standard output; without an end where that is no terminal.
pub(crate) fn room() -> usize {
    let terminal = Term::stdout();
    let size = if terminal.is_term() { terminal.size_checked() } else { None };
    size.map_or(usize::MAX, |(_, columns)| columns.into())
}

/// `text` in lines of at most `width`, broken at spaces; a single word may still be too wide.
pub(crate) fn broken(text: &str, width: usize) -> Vec<String> {
    in_lines(text.split(' '), " ", |line, word| measure_text_width(line) + 1 + measure_text_width(word) <= width)
}

/// `text` as wide as standard output where that is a terminal: lines that are wider go on below, indented.
pub fn for_terminal(text: &str) -> String {
    within(text, room())
}

fn within(text: &str, room: usize) -> String {
    let shown = |line: &str| {
        if measure_text_width(line) <= room {
            return line.to_owned();
        }
        let words = line.trim_start_matches(' ');
        let beginning = &line[..line.len() - words.len()];
        let room = room.saturating_sub(beginning.len() + INDENT.len());
        beginning.to_owned() + &broken(words, room).join(&format!("\n{beginning}{INDENT}"))
    };
    text.split('\n').map(shown).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_are_too_wide_go_on_below() {
        let text = "short\n\n  better than no device: 19.0 % fewer\n";
        assert_eq!(within(text, 38), text);
        assert_eq!(within(text, 20), "short\n\n  better than no\n    device: 19.0 %\n    fewer\n");
        assert_eq!(within(text, 3).split_whitespace().count(), text.split_whitespace().count());
        assert_eq!(within("θ/α θ/α θ/α", 11), "θ/α θ/α θ/α");
    }
}
