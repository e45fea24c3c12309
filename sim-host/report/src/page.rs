//! A page of results: Markdown in a file, aligned tables on a terminal.

use crate::text_table::TextTable;

/// Headings, paragraphs, tables and pictures, one below another.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Page {
    parts: Vec<Part>,
}

/// A part of a page.
#[derive(Clone, Debug, PartialEq)]
enum Part {
    Heading { depth: usize, text: String },
    Paragraph(String),
    Table(TextTable),
    Picture { file: String, caption: String },
}

impl Page {
    /// A page with a heading.
    pub fn new(heading: &str) -> Page {
        let mut page = Page::default();
        page.heading(1, heading);
        page
    }

    /// Adds a section.
    pub fn section(&mut self, heading: &str) {
        self.heading(2, heading);
    }

    /// Adds a paragraph.
    pub fn paragraph(&mut self, text: &str) {
        self.parts.push(Part::Paragraph(text.to_owned()));
    }

    /// Adds a table.
    pub fn table(&mut self, table: TextTable) {
        self.parts.push(Part::Table(table));
    }

    /// Adds the picture of a file beside the page.
    pub fn picture(&mut self, file: &str, caption: &str) {
        self.parts.push(Part::Picture { file: file.to_owned(), caption: caption.to_owned() });
    }

    fn heading(&mut self, depth: usize, text: &str) {
        self.parts.push(Part::Heading { depth, text: text.to_owned() });
    }

    /// Markdown.
    pub fn markdown(&self) -> String {
        joined(self.parts.iter().map(|part| match part {
            Part::Heading { depth, text } => format!("{} {text}", "#".repeat(*depth)),
            Part::Paragraph(text) => text.clone(),
            Part::Table(table) => table.markdown(),
            Part::Picture { file, caption } => format!("![{caption}]({file})"),
        }))
    }

    /// Text with tables no wider than standard output where that is a terminal, without the pictures.
    pub fn for_terminal(&self) -> String {
        joined(self.parts.iter().filter_map(|part| match part {
            Part::Heading { text, .. } | Part::Paragraph(text) => Some(text.clone()),
            Part::Table(table) => Some(table.for_terminal()),
            Part::Picture { .. } => None,
        }))
    }
}

/// Parts with an empty line between them.
fn joined(parts: impl Iterator<Item = String>) -> String {
    let parts: Vec<String> = parts.map(|part| part.trim_end().to_owned()).collect();
    parts.join("\n\n") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_is_markdown_in_a_file_and_aligned_text_on_a_terminal() {
        let mut table = TextTable::new(1, ["method", "error"]);
        table.row(vec!["RK4".into(), "1e-4".into()]);
        let mut page = Page::new("Methods");
        page.section("Errors");
        page.paragraph("At 1 ms.");
        page.table(table);
        page.picture("errors.svg", "error over step");
        assert_eq!(
            page.markdown(),
            "# Methods\n\n## Errors\n\nAt 1 ms.\n\n| method | error |\n|--------|------:|\n| RK4    |  1e-4 |\n\n![error over step](errors.svg)\n"
        );
        assert_eq!(page.for_terminal(), "Methods\n\nErrors\n\nAt 1 ms.\n\nmethod  error\nRK4      1e-4\n");
    }
}
