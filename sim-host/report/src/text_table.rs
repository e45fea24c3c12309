//! Tables for people: aligned columns for a terminal, or Markdown that is aligned as well.

use console::measure_text_width;
use sprag_sim::effect::number::{scientific, true_minus};

use crate::columns::{Column, Kind, RowWriter, Shown, Table, TableError, Value};
use crate::terminal::{in_lines_of, room};

/// A table whose first columns are words, to the left, and the others numbers, to the right.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TextTable {
    /// Number of columns of words.
    words: usize,
    /// Whether the last column has words too.
    ends_in_words: bool,
    /// The headings, then the rows, all of the same number of cells.
    rows: Vec<Vec<String>>,
}

/// Space between two columns of a terminal.
const GAP: &str = "  ";

impl TextTable {
    /// A table without rows, with these headings, the first `words` of which are above words.
    pub fn new<H: Into<String>>(words: usize, headings: impl IntoIterator<Item = H>) -> TextTable {
        TextTable { words, ends_in_words: false, rows: vec![headings.into_iter().map(Into::into).collect()] }
    }

    /// The table, whose last column has words too.
    #[must_use]
    pub fn ending_in_words(self) -> TextTable {
        TextTable { ends_in_words: true, ..self }
    }

    /// The columns of `table` that people see, with its rows: words first.
    ///
    /// # Errors
    /// [`TableError`] of a table that cannot be written either.
    pub fn of(table: &dyn Table) -> Result<TextTable, TableError> {
        let columns = table.columns();
        let words = columns.iter().filter(|column| column.shown.is_some()).take_while(|column| column.kind == Kind::Text).count();
        let headings = columns.iter().filter_map(|column| column.shown.map(|(heading, _)| heading));
        let mut text = TextTable::new(words, headings);
        table.rows(&mut Cells { columns: &columns, text: &mut text })?;
        Ok(text)
    }

    /// Adds a row.
    pub fn row(&mut self, cells: Vec<String>) {
        self.rows.push(cells);
    }

    /// Markdown.
    pub fn markdown(&self) -> String {
        let escaped: Vec<Vec<String>> =
            self.rows.iter().map(|row| row.iter().map(|cell| cell.replace('|', "\\|")).collect()).collect();
        let widths: Vec<usize> = widths(&escaped).into_iter().map(|width| width.max(3)).collect();
        let line = |row: &Vec<String>| format!("| {} |\n", self.aligned(row, &widths).join(" | "));
        let rule = widths.iter().enumerate().map(|(column, width)| {
            let dashes = "-".repeat(width + 1);
            format!("|{dashes}{}", if self.has_words(column) { '-' } else { ':' })
        });
        let rule = rule.collect::<String>() + "|\n";
        escaped.iter().take(1).map(line).chain([rule]).chain(escaped.iter().skip(1).map(line)).collect()
    }

    /// Columns that are aligned by spaces.
    pub fn plain(&self) -> String {
        self.within(usize::MAX)
    }

    /// Columns that are aligned by spaces, as wide as standard output where that is a terminal.
    pub fn for_terminal(&self) -> String {
        self.within(room())
    }

    /// Columns that are aligned by spaces; where they are wider than `room`, in several tables one below another, each with the first words.
    /// What has no room even so goes on below, from a space.
    fn within(&self, room: usize) -> String {
        let widths = widths(&self.rows);
        let needed = |columns: &[usize]| needed(&widths, columns);
        let mut tables: Vec<Vec<usize>> = Vec::new();
        for column in self.words..widths.len() {
            match tables.last_mut() {
                Some(table) if needed(&[&table[..], &[column]].concat()) <= room => table.push(column),
                _ => tables.push((0..self.words).chain([column]).collect()),
            }
        }
        if tables.is_empty() {
            tables.push((0..widths.len()).collect());
        }
        let tables: Vec<String> = tables.iter().map(|table| self.shown(table, &self.narrowed(&widths, table, room))).collect();
        tables.join("\n")
    }

    /// The `columns` alone, with these widths of all.
    fn shown(&self, columns: &[usize], widths: &[usize]) -> String {
        let row = |row: &Vec<String>| {
            let broken: Vec<Vec<String>> =
                row.iter().zip(widths).map(|(cell, width)| in_lines_of(*width, pieces(cell))).collect();
            let height = columns.iter().map(|&column| broken[column].len()).max().unwrap_or(0);
            let line = |number: usize| {
                let parts: Vec<String> = broken.iter().map(|lines| lines.get(number).cloned().unwrap_or_default()).collect();
                let cells = self.aligned(&parts, widths);
                let shown: Vec<&str> = columns.iter().map(|&column| cells[column].as_str()).collect();
                shown.join(GAP).trim_end().to_owned() + "\n"
            };
            (0..height).map(line).collect::<String>()
        };
        self.rows.iter().map(row).collect()
    }

    /// `widths`, so much less for the widest of `columns` that these have `room`, but with room for every piece of words and every number.
    fn narrowed(&self, widths: &[usize], columns: &[usize], room: usize) -> Vec<usize> {
        let mut widths = widths.to_vec();
        let least = |column: usize| {
            let words = |(number, row): (usize, &Vec<String>)| match number == 0 || self.has_words(column) {
                true => pieces(&row[column]).map(|piece| measure_text_width(piece.trim_end_matches(' '))).max(),
                false => Some(measure_text_width(&row[column])),
            };
            self.rows.iter().enumerate().filter_map(words).max().unwrap_or(0)
        };
        let least: Vec<usize> = (0..widths.len()).map(least).collect();
        while needed(&widths, columns) > room {
            let wider = columns.iter().copied().filter(|&column| widths[column] > least[column]);
            // Headings go on below sooner than words.
            let Some(widest) = wider.max_by_key(|&column| (!self.has_words(column), widths[column])) else { break };
            widths[widest] -= 1;
        }
        widths
    }

    fn has_words(&self, column: usize) -> bool {
        column < self.words || (self.ends_in_words && self.rows.first().is_some_and(|row| column + 1 == row.len()))
    }

    fn aligned(&self, row: &[String], widths: &[usize]) -> Vec<String> {
        let cell = |(column, (cell, width)): (usize, (&String, &usize))| {
            let space = " ".repeat(width.saturating_sub(measure_text_width(cell)));
            if self.has_words(column) { format!("{cell}{space}") } else { format!("{space}{cell}") }
        };
        row.iter().zip(widths).enumerate().map(cell).collect()
    }
}

impl Table for TextTable {
    fn columns(&self) -> Vec<Column> {
        self.rows.iter().take(1).flatten().map(Column::text).collect()
    }

    fn rows(&self, writer: &mut dyn RowWriter) -> Result<(), TableError> {
        let mut values = self.rows.iter().skip(1).map(|row| row.iter().map(Value::from).collect::<Vec<_>>());
        values.try_for_each(|row| writer.row(&row))
    }
}

/// Takes rows as their cells.
struct Cells<'t> {
    columns: &'t [Column],
    text: &'t mut TextTable,
}

impl RowWriter for Cells<'_> {
    fn row(&mut self, values: &[Value<'_>]) -> Result<(), TableError> {
        let cell = |(column, value): (&Column, &Value<'_>)| {
            Some(match (column.shown?.1, value) {
                (_, Value::Nothing) => "-".to_owned(),
                (_, Value::Text(text)) => (*text).to_owned(),
                (_, Value::Count(count)) => count.to_string(),
                (Shown::Digits(digits), Value::Number(value)) => true_minus(&number(*value, digits)),
                (Shown::Figures(figures), Value::Number(value)) => true_minus(&in_figures(*value, figures)),
                (Shown::Percent, Value::Number(share)) => format!("{} %", number(100.0 * share, 1)),
                (Shown::Change, Value::Number(ratio)) => change(ratio - 1.0),
            })
        };
        self.text.row(self.columns.iter().zip(values).filter_map(cell).collect());
        Ok(())
    }
}

/// What of `cell` stays in one line, with the spaces after it: words, and parts of words that end with a hyphen after two letters or more,
/// which no number has.
fn pieces(cell: &str) -> impl Iterator<Item = &str> {
    let mut letters = 0;
    cell.split_inclusive(move |character: char| {
        let ends = character == ' ' || (character == '-' && letters > 1);
        letters = if character.is_alphabetic() { letters + 1 } else { 0 };
        ends
    })
}

/// Width of every column in a terminal.
fn widths(rows: &[Vec<String>]) -> Vec<usize> {
    let columns = rows.first().map_or(0, Vec::len);
    let width = |column: usize| rows.iter().filter_map(|row| row.get(column)).map(|cell| measure_text_width(cell)).max();
    (0..columns).map(|column| width(column).unwrap_or(0)).collect()
}

/// Width of `columns` together.
fn needed(widths: &[usize], columns: &[usize]) -> usize {
    columns.iter().map(|&column| widths[column] + GAP.len()).sum::<usize>().saturating_sub(GAP.len())
}

/// A number with `digits` decimals; a dash for none and for one that is not finite.
pub fn number(value: impl Into<Option<f64>>, digits: usize) -> String {
    match value.into() {
        Some(value) if value.is_finite() => format!("{value:.digits$}"),
        _ => "-".to_owned(),
    }
}

/// A number with so many decimals, or with as many `figures` where these would be fewer; with an exponent below 1e-4 and from 1e7 on.
fn in_figures(value: f64, figures: usize) -> String {
    let size = value.abs();
    if !value.is_finite() || value == 0.0 || (0.1..1e7).contains(&size) {
        return number(value, figures);
    }
    let (mantissa, exponent) = scientific(value, figures);
    if !(1e-4..1e7).contains(&size) {
        return format!("{mantissa}e{exponent}");
    }
    let decimals = usize::try_from(figures as i32 - 1 - exponent).unwrap_or(0);
    format!("{value:.decimals$}")
}

/// A relative change in percent with a sign and no decimals; a dash for none.
pub fn change(change: impl Into<Option<f64>>) -> String {
    percent(change.into().map(|change| (100.0 * change).round()), 0)
}

/// A relative change in percent with a sign and one decimal; a dash for none.
pub fn change_in_tenths(change: impl Into<Option<f64>>) -> String {
    percent(change.into().map(|change| (1000.0 * change).round() / 10.0), 1)
}

/// Rounded percent, without a sign where it is nothing.
fn percent(percent: Option<f64>, digits: usize) -> String {
    match percent {
        Some(0.0) => "0 %".to_owned(),
        Some(percent) if percent.is_finite() => true_minus(&format!("{percent:+.digits$} %")),
        _ => "-".to_owned(),
    }
}

#[cfg(test)]
mod tests;
