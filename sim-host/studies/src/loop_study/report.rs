//! What a study leaves: a page of tables, the same as CSV, and pictures.

use std::fmt::Write as _;

use sprag_report::text_table::TextTable;

/// A page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Name of its files.
    pub name: String,
    /// Markdown.
    pub text: String,
    /// Tables by name.
    pub tables: Vec<(String, TextTable)>,
    /// Pictures by name, SVG.
    pub figures: Vec<(String, String)>,
}

impl Report {
    /// With a heading.
    pub fn new(name: &str, heading: &str) -> Report {
        Report { name: name.to_owned(), text: format!("# {heading}\n\n"), ..Report::default() }
    }

    /// Adds a paragraph.
    pub fn paragraph(&mut self, text: &str) {
        let _ = write!(self.text, "{text}\n\n");
    }

    /// Adds a section.
    pub fn section(&mut self, heading: &str) {
        let _ = write!(self.text, "## {heading}\n\n");
    }

    /// Adds a table, which is also written as NAME.csv.
    pub fn table(&mut self, name: &str, table: TextTable) {
        let _ = writeln!(self.text, "{}", table.markdown());
        self.tables.push((name.to_owned(), table));
    }

    /// Adds a picture, which is written as NAME.svg.
    pub fn figure(&mut self, name: &str, caption: &str, svg: String) {
        let _ = write!(self.text, "![{caption}]({name}.svg)\n\n");
        self.figures.push((name.to_owned(), svg));
    }
}
