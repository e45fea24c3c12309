//! Text for standard output where that is a terminal: broken between words.

use console::{Term, measure_text_width};

use crate::lines::in_lines;

/// What a line that goes on below is indented by, beyond its beginning.
const INDENT: &str = "  ";

/// Characters in a line of standard output; without an end where that is no terminal.
pub fn room() -> usize {
    let terminal = Term::stdout();
    let size = if terminal.is_term() { terminal.size_checked() } else { None };
    size.map_or(usize::MAX, |(_, columns)| columns.into())
}

/// `text` in lines of at most `width`, broken at spaces; a single word may still be too wide.
fn broken(text: &str, width: usize) -> Vec<String> {
    in_lines_of(width, text.split_inclusive(' '))
}

/// `pieces`, each with the spaces after it, in lines of at most `width` without the spaces that end them; a single piece may still be too wide.
pub(crate) fn in_lines_of<'a>(width: usize, pieces: impl Iterator<Item = &'a str>) -> Vec<String> {
    let fits = |line: &str, piece: &str| {
        let shown = piece.trim_end_matches(' ');
        shown.is_empty() || measure_text_width(line) + measure_text_width(shown) <= width
    };
    in_lines(pieces, "", fits).iter().map(|line| line.trim_end_matches(' ').to_owned()).collect()
}

/// `text` as wide as standard output where that is a terminal: lines that are wider go on below, indented.
pub fn for_terminal(text: &str) -> String {
    within(text, room())
}

/// `text` beside `first`, as wide as standard output where that is a terminal: what is wider goes on below `text`.
pub fn beside(first: &str, text: &str) -> String {
    beside_within(first, text, room())
}

fn beside_within(first: &str, text: &str, room: usize) -> String {
    let column = measure_text_width(first);
    first.to_owned() + &broken(text, room.saturating_sub(column)).join(&format!("\n{}", " ".repeat(column)))
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

    #[test]
    fn a_line_that_goes_on_below_begins_with_a_word() {
        assert_eq!(within("  key        default      allowed", 20), "  key\n    default\n    allowed");
        assert_eq!(within("  key        default      allowed", 31), "  key        default\n    allowed");
        // What fits stays as it is.
        assert_eq!(within("  key        default      allowed", 33), "  key        default      allowed");
    }

    #[test]
    fn text_beside_a_name_goes_on_below_itself() {
        let mount = |room| beside_within("mount  ", "where it is tied to the block", room);
        assert_eq!(mount(20), "mount  where it is\n       tied to the\n       block");
        assert_eq!(mount(usize::MAX), "mount  where it is tied to the block");
    }
}
