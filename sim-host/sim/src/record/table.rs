//! Plain text and CSV: values alone in any number of columns, or a time column with one or more components.

use super::at2;
use super::columns::{self, is_acceleration, is_time, reject_other, reject_spectra, seconds_per_unit, speaks_of_time};
use super::contents::{Contents, Format, Header, StatedStep, bad_field, header_units, reject_scale_factor};
use super::error::RecordError;
use super::number::{append_numbers, column_resolution, last_digit};
use super::text::comment;
use super::units::{StatedUnits, Units, said_in, stated_in};
use super::warning::Warning;
use super::{Component, ReadOptions, resample, time_axis};

/// Lines that are neither numbers nor comments may stand only this far before the data.
const MAXIMUM_HEADER_LINES: usize = 100;
/// A first column is a time column if at least this share of its steps is positive: nine in ten, so that a damaged
/// time column is reported as one and not read as accelerations, of which half would be positive.
const TIME_COLUMN_SHARE: f64 = 0.9;
/// Rows needed to distinguish a time column from values that happen to grow, in tables of more than two columns.
const TIME_COLUMN_ROWS: usize = 8;

/// The rows of numbers of a text, and the lines before and between them.
struct Rows<'a> {
    values: Vec<f64>,
    /// Line index from 0 and index of the first value of each row.
    starts: Vec<(usize, usize)>,
    /// Comments and leading text, with line index, without comment marks.
    header: Vec<(usize, &'a str)>,
}

impl Rows<'_> {
    /// Whether every row has several numbers.
    fn have_columns(&self) -> bool {
        (0..self.starts.len()).all(|row| self.row(row).len() > 1)
    }

    fn row(&self, row: usize) -> &[f64] {
        let end = self.starts.get(row + 1).map_or(self.values.len(), |next| next.1);
        self.starts.get(row).and_then(|start| self.values.get(start.1..end)).unwrap_or(&[])
    }
}

fn rows<'a>(name: &str, lines: &[&'a str]) -> Result<Rows<'a>, RecordError> {
    let mut rows = Rows { values: Vec::new(), starts: Vec::new(), header: Vec::new() };
    for (index, line) in lines.iter().enumerate() {
        if let Some(text) = comment(line) {
            rows.header.push((index, text.trim()));
            continue;
        }
        let start = rows.values.len();
        match append_numbers(line, None, &mut rows.values) {
            Ok(0) => {}
            Ok(_) => rows.starts.push((index, start)),
            Err(field) if rows.starts.is_empty() && !field.not_finite && index < MAXIMUM_HEADER_LINES => {
                rows.header.push((index, line.trim()));
            }
            Err(field) => return Err(bad_field(name, index, field)),
        }
    }
    Ok(rows)
}

/// Whether what stands behind the words NPTS, in the first of `lines`, is a table and not the samples of one history: a line names its
/// columns, or there are as many rows as samples, of several numbers each.
pub(super) fn follows(name: &str, lines: &[&str]) -> bool {
    let Ok(rows) = rows(name, lines) else { return false };
    // `ACCELERATION IN UNITS OF G` has five words, and rows of AT2 files five samples.
    let behind = rows.header.iter().skip(1).map(|(_, line)| *line).filter(|line| said_in(line).is_none());
    let mut names = behind.filter_map(|line| columns::in_line(line, rows.row(0).len()));
    let named = names.any(|names| names.len() > 1 && names.iter().any(|name| is_time(name) || is_acceleration(name)));
    named || (stated_counts(&rows).0 == Some(rows.starts.len() as u64) && rows.have_columns())
}

/// Reads the lines of a text with columns.
pub(super) fn read(name: &str, lines: &[&str], options: &ReadOptions) -> Result<Contents, RecordError> {
    let mut rows = rows(name, lines)?;
    reject_scale_factor(name, &rows.header)?;
    let (samples, step) = stated_counts(&rows);
    let unreadable_samples = rows.header.iter().find_map(|(_, line)| at2::unreadable_samples(line)).filter(|_| samples.is_none());
    let stated_first_row = take_counts_row(&mut rows, lines);
    let header = Header {
        title: rows.header.iter().map(|(_, line)| *line).find(|line| !line.is_empty()).unwrap_or("").chars().take(200).collect(),
        samples: stated_first_row.0.or(samples),
        peak_m_s2: None,
        time_step: stated_first_row.1.or(step),
    };
    let columns = Columns::of(&rows);
    if let Some((line, names)) = &columns.names {
        reject_spectra(name, names, *line)?;
    }
    let row_each = header.samples == Some(rows.starts.len() as u64) && rows.have_columns();
    let mut contents = if columns.are_one_history() && !row_each {
        let mut contents = Contents::new(Format::Values);
        let (line, column) =
            columns.names.as_ref().map_or((0, ""), |(line, names)| (*line, names.first().copied().unwrap_or_default()));
        reject_other(name, column, line)?;
        contents.units = units_of(name, column, line, &rows)?;
        contents.header = header;
        contents.values = rows.values;
        contents
    } else {
        read_columns(name, lines, &rows, header, &columns, options)?
    };
    contents.warnings.splice(0..0, unreadable_samples);
    Ok(contents)
}

/// Units of a column, by its name in line `line` from 0 or else by the header.
fn units_of(name: &str, column: &str, line: usize, rows: &Rows<'_>) -> Result<Option<Units>, RecordError> {
    match stated_in(column) {
        Some(StatedUnits::Known(units)) => Ok(Some(units)),
        Some(StatedUnits::Unknown(value)) => Err(RecordError::UnknownUnits { file: name.to_owned(), line: line + 1, value }),
        None => header_units(name, &rows.header),
    }
}

/// Number of samples and step in comments such as `# NPTS = 4000, DT = 0.005`.
fn stated_counts(rows: &Rows<'_>) -> (Option<u64>, Option<StatedStep>) {
    let mut found = (None, None);
    for (_, line) in &rows.header {
        let (samples, step) = at2::stated_counts(line);
        found = (found.0.or(samples), found.1.or(step));
    }
    found
}

/// Removes a first row that is `samples` or `samples step`, recognised by the number of values that follow.
fn take_counts_row(rows: &mut Rows<'_>, lines: &[&str]) -> (Option<u64>, Option<StatedStep>) {
    let first = rows.row(0);
    let after = rows.values.len() - first.len();
    let (count, step) = match *first {
        [count] => (count, None),
        [count, step] if step > 0.0 && step < 1.0 => (count, Some(step)),
        _ => return (None, None),
    };
    // Below this a small whole number may be a sample as well.
    const FEWEST: usize = 10;
    let same_width = rows.row(1).len() == first.len() && first.len() == 2;
    if after < FEWEST || count != after as f64 || same_width {
        return (None, None);
    }
    let text = lines.get(rows.starts[0].0).and_then(|line| line.split([' ', '\t', ',', ';']).rfind(|field| !field.is_empty()));
    let step = step.map(|value_s| StatedStep { value_s, resolution_s: text.map_or(0.0, last_digit) });
    let width = first.len();
    rows.values.drain(..width);
    rows.starts.remove(0);
    rows.starts.iter_mut().for_each(|start| start.1 -= width);
    (Some(after as u64), step)
}

/// What the columns of a text are.
struct Columns<'a> {
    /// Their names, and the index of the line that has them.
    names: Option<(usize, Vec<&'a str>)>,
    /// The one that holds times.
    time: Option<usize>,
    /// Whether the first one counts the rows, and is left out.
    counted: bool,
}

impl Columns<'_> {
    fn of<'a>(rows: &Rows<'a>) -> Columns<'a> {
        let names = column_names(rows);
        let name = |column: usize| names.as_ref().map(|(_, names)| names[column]);
        let counted = looks_like_time(rows, 0)
            && counts_rows(rows)
            && name(0).is_none_or(|name| !speaks_of_time(name) && !is_acceleration(name));
        let named = names.as_ref().and_then(|(_, names)| names.iter().position(|name| is_time(name)));
        let first = usize::from(counted);
        let time = named.or_else(|| looks_like_time(rows, first).then_some(first));
        Columns { names, time, counted }
    }

    /// Whether the numbers are the samples of one history, row by row.
    fn are_one_history(&self) -> bool {
        self.time.is_none() && !self.counted && self.names.as_ref().is_none_or(|(_, names)| names.len() < 2)
    }
}

/// Names in the last header line that has as many fields as the first row has columns, and the index of that line.
fn column_names<'a>(rows: &Rows<'a>) -> Option<(usize, Vec<&'a str>)> {
    let width = rows.row(0).len();
    let first_row = rows.starts.first()?.0;
    let mut before = rows.header.iter().rev().filter(|(index, line)| *index < first_row && !line.is_empty());
    before.find_map(|(index, line)| Some((*index, columns::in_line(line, width)?)))
}

/// Whether a column grows as times do, and others stand behind it.
fn looks_like_time(rows: &Rows<'_>, column: usize) -> bool {
    let count = rows.starts.len();
    let width = rows.row(0).len().saturating_sub(column);
    if width < 2 || count < 2 || (width > 2 && count < TIME_COLUMN_ROWS) {
        return false;
    }
    let time = |row: usize| rows.row(row).get(column).copied().unwrap_or(f64::NAN);
    let positive = (1..count).filter(|row| time(*row) > time(row - 1)).count();
    positive as f64 >= TIME_COLUMN_SHARE * (count - 1) as f64
}

/// Whether the first column is 0, 1, 2… or 1, 2, 3…, as programs write the numbers of rows beside them.
fn counts_rows(rows: &Rows<'_>) -> bool {
    let number = |row: usize| rows.row(row).first().copied().unwrap_or(f64::NAN);
    [0.0, 1.0].contains(&number(0)) && (1..rows.starts.len()).all(|row| number(row) == number(0) + row as f64)
}

/// Which of the value columns to take.
fn choose(name: &str, columns: &[usize], labels: &[&str], component: Option<&Component>) -> Result<usize, RecordError> {
    let available = || labels.iter().map(|label| label.chars().take(40).collect()).take(20).collect::<Vec<String>>().join(", ");
    let accelerations: Vec<usize> = (0..columns.len()).filter(|index| is_acceleration(labels[*index])).collect();
    let chosen = match (component, accelerations.as_slice(), columns) {
        (Some(component), ..) if columns.len() > 1 => component.position_in(labels),
        (_, _, [_]) => Some(0),
        (_, [only], _) => Some(*only),
        _ => None,
    };
    chosen.ok_or_else(|| RecordError::Component {
        file: name.to_owned(),
        asked: component.map_or("(none chosen)".to_owned(), |component| format!("`{component}`")),
        available: available(),
    })
}

fn read_columns(
    name: &str,
    lines: &[&str],
    rows: &Rows<'_>,
    header: Header,
    Columns { names, time: time_column, counted }: &Columns<'_>,
    options: &ReadOptions,
) -> Result<Contents, RecordError> {
    let width = rows.row(0).len();
    for (row, start) in rows.starts.iter().enumerate() {
        let found = rows.row(row).len();
        if found != width {
            return Err(RecordError::RaggedRow { file: name.to_owned(), line: start.0 + 1, found, expected: width });
        }
    }
    let first = usize::from(*counted);
    let columns: Vec<usize> = (first..width).filter(|column| Some(*column) != *time_column).collect();
    let numbered: Vec<String> = (1..=columns.len()).map(|number| number.to_string()).collect();
    let labels: Vec<&str> = match names {
        Some((_, names)) => columns.iter().map(|column| names[*column]).collect(),
        None => numbered.iter().map(String::as_str).collect(),
    };
    let chosen = choose(name, &columns, &labels, options.component.as_ref())?;
    let column = |column: usize| (0..rows.starts.len()).map(move |row| rows.row(row)[column]);

    let mut contents = Contents::new(if time_column.is_some() { Format::Table } else { Format::Values });
    contents.header = header;
    contents.component = (columns.len() > 1).then(|| labels[chosen].to_owned());
    let names_line = names.as_ref().map_or(0, |names| names.0);
    reject_other(name, labels[chosen], names_line)?;
    contents.units = units_of(name, labels[chosen], names_line, rows)?;
    contents.values = column(columns[chosen]).collect();
    contents.warnings.extend(counted.then_some(Warning::RowNumbers));
    let Some(time_column) = *time_column else { return Ok(contents) };

    let scale = names.as_ref().map_or(Ok(1.0), |(_, names)| seconds_per_unit(names[time_column]));
    let scale = scale.map_err(|unit| RecordError::UnknownTimeUnit {
        file: name.to_owned(),
        line: names_line + 1,
        value: unit.to_owned(),
    })?;
    let times: Vec<f64> = column(time_column).map(|time| time * scale).collect();
    let printed = rows.starts.iter().filter_map(|start| field(lines[start.0], time_column));
    let resolution = column_resolution(printed) * scale;
    if times.len() < 2 {
        return Ok(contents);
    }
    match time_axis::equal_steps(&times, resolution) {
        Ok(equal) => {
            contents.start_time_s = equal.start_s;
            contents.header.time_step = Some(equal.step);
        }
        Err(unequal) => {
            let line = |row: usize| rows.starts.get(row).map_or(0, |start| start.0 + 1);
            let Some(step_s) = options.resample_to_s else {
                return Err(RecordError::UnequalSteps {
                    file: name.to_owned(),
                    line: line(unequal.row),
                    found: rounded(unequal.found_s),
                    expected: rounded(unequal.mean_s),
                });
            };
            if let Some(row) = (1..times.len()).find(|row| times[*row] <= times[row - 1]) {
                let found = rounded(times[row] - times[row - 1]);
                return Err(RecordError::TimeNotIncreasing { file: name.to_owned(), line: line(row), found });
            }
            contents.start_time_s = times[0];
            contents.values = resample::linear(name, &times, &contents.values, step_s)?;
            contents.header.time_step = Some(StatedStep { value_s: step_s, resolution_s: 0.0 });
            // The rows are compared here: later there are others.
            let (stated, present) = (contents.header.samples.take(), times.len());
            let disagree = stated.filter(|stated| *stated != present as u64);
            contents.warnings.extend(disagree.map(|stated| Warning::SamplesDisagree { stated, present }));
            contents.warnings.push(Warning::Resampled { from_s: rounded(unequal.mean_s), to_s: step_s });
        }
    }
    Ok(contents)
}

/// Six significant digits, for messages.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

fn field(line: &str, column: usize) -> Option<&str> {
    let mut fields = line.split([' ', '\t', ',', ';']).filter(|field| !field.is_empty());
    fields.nth(column).map(|field| field.trim_matches('"'))
}

#[cfg(test)]
#[path = "table_tests.rs"]
mod tests;
