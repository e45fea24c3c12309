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
    (names.len() == width && named).then_some(names)
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

fn first_word(name: &str) -> String {
    name.trim().split(|c: char| !c.is_alphanumeric()).next().unwrap_or("").to_lowercase()
}

/// Whether a column of this name holds times.
pub(super) fn is_time(name: &str) -> bool {
    matches!(first_word(name).as_str(), "time" | "times" | "t" | "sec" | "seconds")
}

/// Whether a name has a word or a unit of time, in any language: `Zeit (s)`.
pub(super) fn speaks_of_time(name: &str) -> bool {
    let unit = |word: &str| matches!(word.to_lowercase().as_str(), "s" | "sec" | "secs" | "second" | "seconds");
    is_time(name) || seconds_per_unit(name) != 1.0 || name.split(|c: char| !c.is_alphanumeric()).any(unit)
}

/// Whether a column of this name holds accelerations.
pub(super) fn is_acceleration(name: &str) -> bool {
    let word = first_word(name);
    word.starts_with("acc") || matches!(word.as_str(), "a" | "ag")
}

/// What a column holds, if its name says that it is no acceleration.
fn other_quantity(name: &str) -> Option<&'static str> {
    let words = || name.split(|c: char| !c.is_alphanumeric()).map(str::to_lowercase);
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

/// Refuses a column, named in line `line` from 0, whose name says that it is no acceleration.
pub(super) fn reject_other(name: &str, column: &str, line: usize) -> Result<(), RecordError> {
    other_quantity(column).map_or(Ok(()), |quantity| {
        let quantity = format!("{quantity} in column {}", column.chars().take(40).collect::<String>());
        Err(RecordError::NotAcceleration { file: name.to_owned(), line: line + 1, quantity })
    })
}

/// Seconds in one unit of a time column, by its name.
pub(super) fn seconds_per_unit(name: &str) -> f64 {
    let milliseconds = name.split(|c: char| !c.is_alphanumeric()).any(|word| {
        let word = word.to_lowercase();
        word == "ms" || word == "msec" || word.starts_with("millis")
    });
    if milliseconds { 1e-3 } else { 1.0 }
}
