//! Lines that are broken between parts.

/// `parts` in lines, with `separator` between those that share one: each stands where `fits` says so of the line so far and the part, else on
/// the next line. A single part may still be too wide.
pub(crate) fn in_lines<'a>(
    parts: impl Iterator<Item = &'a str>,
    separator: &str,
    fits: impl Fn(&str, &str) -> bool,
) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for part in parts {
        match lines.last_mut() {
            Some(line) if fits(line, part) => line.extend([separator, part]),
            _ => lines.push(part.to_owned()),
        }
    }
    lines
}
