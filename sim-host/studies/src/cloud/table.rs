//! A table of a page: Markdown whose columns are aligned, so that a terminal shows it well too.

/// A table; its first columns are words, the others numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Columns of words.
    pub words: usize,
    /// The titles, then the rows, all of the same number of cells.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// With titles, the first `words` of which are above words.
    pub fn new(words: usize, titles: &[&str]) -> Table {
        Table { words, rows: vec![titles.iter().map(|&title| title.to_owned()).collect()] }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: Vec<String>) {
        self.rows.push(cells);
    }

    /// As Markdown.
    pub fn markdown(&self) -> String {
        let rows: Vec<Vec<String>> =
            self.rows.iter().map(|row| row.iter().map(|cell| cell.replace('|', "\\|")).collect()).collect();
        let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
        let width = |column: usize| rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max();
        let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or(0).max(3)).collect();
        let mut text = String::new();
        for (index, row) in rows.iter().enumerate() {
            for (column, (cell, width)) in row.iter().zip(&widths).enumerate() {
                text += &if column < self.words { format!("| {cell:<width$} ") } else { format!("| {cell:>width$} ") };
            }
            text += "|\n";
            if index == 0 {
                for (column, width) in widths.iter().enumerate() {
                    let dashes = "-".repeat(width + 1);
                    text += &if column < self.words { format!("|{dashes}-") } else { format!("|{dashes}:") };
                }
                text += "|\n";
            }
        }
        text
    }
}

/// A number with `digits` decimals and a true minus sign; a dash for none.
pub fn number(value: Option<f64>, digits: usize) -> String {
    match value {
        Some(value) if value.is_finite() => format!("{value:.digits$}").replace('-', "\u{2212}"),
        _ => "-".to_owned(),
    }
}

/// The change that `ratio` is, in percent with a sign; a dash for none.
pub fn change(ratio: Option<f64>) -> String {
    match ratio.filter(|ratio| ratio.is_finite()) {
        Some(ratio) => {
            let percent = (100.0 * (ratio - 1.0)).round();
            if percent == 0.0 { "0 %".to_owned() } else { format!("{percent:+.0} %").replace('-', "\u{2212}") }
        }
        None => "-".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_have_one_width_and_bars_are_escaped() {
        let mut table = Table::new(1, &["device", "|θ|"]);
        table.row(vec!["a|b".to_owned(), number(Some(-0.25), 1)]);
        table.row(vec!["none".to_owned(), number(None, 1)]);
        let text = table.markdown();
        let width = text.lines().next().unwrap().chars().count();
        assert!(text.lines().all(|line| line.chars().count() == width) && text.lines().count() == 4, "{text}");
        assert!(text.contains("a\\|b") && text.contains("\u{2212}0.2"));
    }

    #[test]
    fn changes_are_percent_of_the_first() {
        assert_eq!([0.7, 1.004, 1.25].map(|ratio| change(Some(ratio))), ["\u{2212}30 %", "0 %", "+25 %"]);
        assert_eq!(change(None), "-");
    }
}
