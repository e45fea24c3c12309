//! What a study leaves: a page of tables, the same as CSV, and pictures.

use std::fmt::Write as _;

/// One table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Column headings.
    pub columns: Vec<String>,
    /// Rows.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// With columns.
    pub fn new(columns: &[&str]) -> Table {
        Table { columns: columns.iter().map(|&name| name.to_owned()).collect(), rows: Vec::new() }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: Vec<String>) {
        self.rows.push(cells);
    }

    /// As Markdown.
    pub fn markdown(&self) -> String {
        let mut text = String::new();
        let line = |cells: &[String]| {
            format!("| {} |\n", cells.iter().map(|cell| cell.replace('|', "\\|")).collect::<Vec<_>>().join(" | "))
        };
        text.push_str(&line(&self.columns));
        let _ = writeln!(text, "|{}", " --- |".repeat(self.columns.len()));
        for row in &self.rows {
            text.push_str(&line(row));
        }
        text
    }

    /// As CSV (RFC 4180).
    pub fn csv(&self) -> String {
        let field = |cell: &String| {
            if cell.contains([',', '"', '\n']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.clone() }
        };
        let mut text = String::new();
        for row in std::iter::once(&self.columns).chain(&self.rows) {
            let _ = writeln!(text, "{}", row.iter().map(field).collect::<Vec<_>>().join(","));
        }
        text
    }
}

/// A page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Name of its files.
    pub name: String,
    /// Markdown.
    pub text: String,
    /// Tables by name.
    pub tables: Vec<(String, Table)>,
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
    pub fn table(&mut self, name: &str, table: Table) {
        let _ = writeln!(self.text, "{}", table.markdown());
        self.tables.push((name.to_owned(), table));
    }

    /// Adds a picture, which is written as NAME.svg.
    pub fn figure(&mut self, name: &str, caption: &str, svg: String) {
        let _ = write!(self.text, "![{caption}]({name}.svg)\n\n");
        self.figures.push((name.to_owned(), svg));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_read_back() {
        let mut table = Table::new(&["a", "b, c"]);
        table.row(vec!["1".into(), "say \"x\"".into()]);
        assert_eq!(table.markdown(), "| a | b, c |\n| --- | --- |\n| 1 | say \"x\" |\n");
        assert_eq!(table.csv(), "a,\"b, c\"\n1,\"say \"\"x\"\"\"\n");
    }
}
