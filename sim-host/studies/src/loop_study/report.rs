//! What a study leaves: a page of tables, the same as CSV, and pictures.

use sprag_report::page::Page;
use sprag_report::text_table::TextTable;

/// A page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Name of its files.
    pub name: String,
    /// Text, tables and pictures in their order.
    pub page: Page,
    /// Tables by name.
    pub tables: Vec<(String, TextTable)>,
    /// Pictures by name, SVG.
    pub figures: Vec<(String, String)>,
}

impl Report {
    /// With a heading, and the command that makes it again.
    pub fn new(name: &str, heading: &str) -> Report {
        let mut page = Page::new(heading);
        page.paragraph(&format!("Made by `sprag loop-study {name}`."));
        Report { name: name.to_owned(), page, ..Report::default() }
    }

    /// Adds a paragraph.
    pub fn paragraph(&mut self, text: &str) {
        self.page.paragraph(text);
    }

    /// Adds a section.
    pub fn section(&mut self, heading: &str) {
        self.page.section(heading);
    }

    /// Adds a table, which is also written as NAME.csv.
    pub fn table(&mut self, name: &str, table: TextTable) {
        self.page.table(table.clone());
        self.tables.push((name.to_owned(), table));
    }

    /// Adds a picture, which is written as NAME.svg.
    pub fn figure(&mut self, name: &str, caption: &str, svg: String) {
        self.page.picture(&format!("{name}.svg"), caption);
        self.figures.push((name.to_owned(), svg));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_names_the_command_that_makes_it() {
        assert_eq!(
            Report::new("practice", "In practice").page.markdown(),
            "# In practice\n\nMade by `sprag loop-study practice`.\n"
        );
    }
}
