//! What the names of columns say: which holds times, which accelerations, and which what is no acceleration.

use super::error::RecordError;

/// The names in a line, if it has one for each of `width` columns and they speak of what records hold.
pub(super) fn in_line(line: &str, width: usize) -> Option<Vec<&str>> {
    // As of a row of numbers, a separator at its end parts nothing.
    let line = line.strip_suffix([',', ';']).unwrap_or(line);
    let parted = line.contains([',', ';', '\t']);
    let names: Vec<&str> =
        if parted { line.split([',', ';', '\t']).map(|field| field.trim().trim_matches('"')).collect() } else { words(line) };
    let named = names.iter().any(|name| is_time(name) || is_acceleration(name) || other_quantity(name).is_some());
    // Lines of prose begin with a frequency as well, but numbers stand behind it: `Frequency, 100 Hz`.
    let first_spectral = names.iter().find(|name| !name.is_empty()).is_some_and(|name| is_spectral(name));
    let spectral = || first_spectral && !names.iter().any(|name| name.starts_with(|c: char| c.is_ascii_digit()));
    (names.len() == width && (named || spectral())).then_some(names)
}

/// The words of a line, each with the unit in brackets behind it: `Time (s)`.
fn words(line: &str) -> Vec<&str> {
    let mut words = Vec::new();
    let mut rest = line.trim_start();
    while !rest.is_empty() {
        let word = rest.find(char::is_whitespace).unwrap_or(rest.len());
        let blanks = rest[word..].len() - rest[word..].trim_start().len();
        let unit = &rest[word + blanks..];
        let end = match unit.find([')', ']']).filter(|_| unit.starts_with(['(', '['])) {
            Some(bracket) => word + blanks + bracket + 1,
            None => word,
        };
        words.push(&rest[..end]);
        rest = rest[end..].trim_start();
    }
    words
}

/// What stands between brackets, underscores, blanks and the like; empty between two of them.
fn parts(name: &str) -> impl Iterator<Item = &str> {
    name.split(|c: char| !c.is_alphanumeric())
}

fn first_word(name: &str) -> String {
    parts(name.trim()).next().unwrap_or("").to_lowercase()
}

/// Whether a column of this name holds times.
pub(super) fn is_time(name: &str) -> bool {
    matches!(first_word(name).as_str(), "time" | "times" | "t" | "sec" | "seconds")
}

/// Whether a name has a word or a unit of time, in any language: `Zeit (s)`.
pub(super) fn speaks_of_time(name: &str) -> bool {
    let unit = |word: &str| matches!(word.to_lowercase().as_str(), "s" | "sec" | "secs" | "second" | "seconds");
    is_time(name) || seconds_per_unit(name) == Ok(1e-3) || parts(name).any(unit)
}

/// Whether a column of this name holds accelerations.
pub(super) fn is_acceleration(name: &str) -> bool {
    let word = first_word(name);
    word.starts_with("acc") || matches!(word.as_str(), "a" | "ag")
}

/// What a column holds, if its name says that it is no acceleration.
fn other_quantity(name: &str) -> Option<&'static str> {
    let words = || parts(name).map(str::to_lowercase);
    if words().any(|word| word.starts_with("acc")) {
        return None;
    }
    words().find_map(|word| match word.as_str() {
        word if word.starts_with("disp") || word.contains("displac") => Some("displacement"),
        word if word.contains("veloc") || matches!(word, "vel" | "vels") => Some("velocity"),
        word if word.contains("spectr") => Some("a spectrum"),
        _ => None,
    })
}

/// Most words in the name of a column, its unit among them, that is one by a word in its midst; more are prose.
const MOST_WORDS: usize = 3;

/// Whether a column of this name is one of a spectrum: periods, frequencies, or what is plotted over them.
fn is_spectral(name: &str) -> bool {
    let lower = name.to_lowercase();
    let words: Vec<&str> = parts(&lower).filter(|word| !word.is_empty()).collect();
    if words.iter().any(|word| word.starts_with("acc")) {
        return words.contains(&"spectral");
    }
    // `Sampling frequency: 200 Hz` is a remark, `PSA 5% (g)` is none.
    let number = |word: &str| word.starts_with(|c: char| c.is_ascii_digit()) && !word.contains('%');
    if lower.contains([':', '=']) || lower.split_whitespace().any(number) {
        return false;
    }
    let of_spectra = |word: &&str| matches!(*word, "period" | "periods" | "sa" | "psa") || word.starts_with("freq");
    let in_hertz = ["(hz)", "[hz]"].iter().any(|unit| lower.contains(unit)) || words.last() == Some(&"hz");
    words.first().is_some_and(of_spectra) || (words.len() <= MOST_WORDS && (in_hertz || words.iter().any(of_spectra)))
}

/// Refuses a column, named in line `line` from 0, whose name says that it is no acceleration.
pub(super) fn reject_other(name: &str, column: &str, line: usize) -> Result<(), RecordError> {
    other_quantity(column).map_or(Ok(()), |quantity| Err(refused(name, quantity, column, line)))
}

/// Refuses columns, named in line `line` from 0, of which one is of a spectrum.
pub(super) fn reject_spectra(name: &str, columns: &[&str], line: usize) -> Result<(), RecordError> {
    let column = columns.iter().find(|column| is_spectral(column));
    column.map_or(Ok(()), |column| Err(refused(name, "a spectrum", column, line)))
}

fn refused(name: &str, quantity: &str, column: &str, line: usize) -> RecordError {
    let quantity = format!("{quantity} in column {}", column.chars().take(40).collect::<String>());
    RecordError::NotAcceleration { file: name.to_owned(), line: line + 1, quantity }
}

/// Units of time that no record is in, as names of columns have them.
const OTHER_TIMES: &str = "min mins minute minutes h hr hrs hour hours day days cs us usec µs μs ns nsec sample samples";

/// Seconds in one unit of a time column, by its name; the unit itself where it is neither s nor ms.
pub(super) fn seconds_per_unit(name: &str) -> Result<f64, &str> {
    let is_other = |word: &&str| OTHER_TIMES.split(' ').any(|other| other == word.to_lowercase());
    if let Some(unit) = parts(name).find(is_other) {
        return Err(unit);
    }
    let milliseconds = parts(name).any(|word| {
        let word = word.to_lowercase();
        word == "ms" || word == "msec" || word.starts_with("millis")
    });
    Ok(if milliseconds { 1e-3 } else { 1.0 })
}
