//! Title and notes above one panel of a figure.

use super::layer::Text;
use super::legend::{BOLD_WIDTH, wrapped};
use super::palette::GROUND;

const HEADING_FONT_PX: f64 = 12.0;
const NOTE_FONT_PX: f64 = 10.5;
const HEADING_LINE_PX: f64 = 15.0;

/// What stands above a panel.
pub(super) struct Heading {
    title: Vec<String>,
    notes: Vec<String>,
}

impl Heading {
    /// Of `title` and `notes`, wrapped to `width_px`.
    pub(super) fn of(title: &str, notes: &[String], width_px: f64) -> Heading {
        Heading {
            title: wrapped(title, BOLD_WIDTH * width_px, HEADING_FONT_PX),
            notes: notes.iter().flat_map(|note| wrapped(note, width_px, NOTE_FONT_PX)).collect(),
        }
    }

    /// What it takes (px).
    pub(super) fn height_px(&self) -> f64 {
        self.lines() as f64 * HEADING_LINE_PX
    }

    fn lines(&self) -> usize {
        self.title.len() + self.notes.len()
    }

    /// Appends it, the last line at the height of `at`.
    pub(super) fn write(&self, svg: &mut String, at: (f64, f64)) {
        let lines = self.lines();
        let baseline = |line: usize| (at.0, at.1 - (lines - 1 - line) as f64 * HEADING_LINE_PX);
        for (line, title) in self.title.iter().enumerate() {
            let text = Text::new(title, baseline(line), HEADING_FONT_PX);
            Text { attributes: " font-weight=\"bold\"", ..text }.write(svg, false);
        }
        for (line, note) in self.notes.iter().enumerate() {
            let text = Text::new(note, baseline(self.title.len() + line), NOTE_FONT_PX);
            Text { colour: GROUND, ..text }.write(svg, false);
        }
    }
}
