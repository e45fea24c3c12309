//! A file to start from, with a comment on every key.

use super::Described;
use super::list::{Key, keys, text_of};

/// A file of kind `T` with the keys `given`, each with its value in TOML; all others are commented out, with their defaults or examples.
/// `head` is its first comment.
pub fn template<T: Described>(head: &str, given: &[(&str, &str)]) -> String {
    let keys = keys(T::schema());
    let mut text = head.lines().map(|line| format!("# {line}\n")).collect::<String>();
    let is_table = |key: &&Key| key.is_table && !key.path.contains('.');
    let of_no_table = keys.iter().filter(|key| !key.path.contains('.') && !is_table(key));
    for key in of_no_table {
        text += &entry(key, &key.path, given, &keys);
    }
    let mut shown: Vec<Vec<&str>> = Vec::new();
    for table in keys.iter().filter(is_table) {
        let prefix = if table.is_list { format!("{}.N.", table.path) } else { format!("{}.", table.path) };
        let below: Vec<(&Key, &str)> = keys
            .iter()
            .filter_map(|key| Some((key, key.path.strip_prefix(&prefix)?)))
            .filter(|(key, _)| !key.of_list_below)
            .collect();
        let names: Vec<&str> = below.iter().map(|(_, name)| *name).collect();
        let is_given = given.iter().any(|(path, _)| path.starts_with(&prefix));
        let mark = if is_given || !table.is_list && table.default.is_some() { "" } else { "#" };
        let header = if table.is_list { format!("[[{}]]", table.path) } else { format!("[{}]", table.path) };
        text += &format!("\n# {}\n{mark}{header}\n", table.meaning);
        let as_before = table.is_list && shown.contains(&names);
        for (key, name) in below.into_iter().filter(|(key, _)| key.required || !as_before) {
            text += &entry(key, name, given, &keys);
        }
        if as_before {
            text += "# Its other keys are those of the table before.\n";
        }
        shown.push(names);
    }
    text
}

/// `key`, called `name` in its table, with what it is and may be.
fn entry(key: &Key, name: &str, given: &[(&str, &str)], all: &[Key]) -> String {
    if key.is_table && !key.is_list {
        return format!("# {name}: {}\n", key.meaning);
    }
    let range = match key.range.split_at(1) {
        _ if key.range == "a text" => String::new(),
        (first, rest) => format!(" {}{rest}.", first.to_ascii_uppercase()),
    };
    let given = given.iter().find(|(path, _)| *path == key.path).map(|(_, value)| (*value).to_owned());
    let says_something = |value: &&toml::Value| !matches!(value.to_string().as_str(), "[]" | "{}" | "\"\"");
    let shown = key.default.as_ref().filter(says_something).or(key.example.as_ref());
    let (mark, value) = match (given, shown) {
        (Some(value), _) => ("", value),
        (None, Some(value)) => ("#", text_of(value)),
        (None, None) if key.is_table => return format!("# {name}: {}\n{}", key.meaning, elements(key, all)),
        (None, None) => return String::new(),
    };
    let default =
        if mark.is_empty() || key.default.as_ref().is_some_and(|value| says_something(&value)) { "" } else { " No default." };
    format!("# {}{range}{default}\n{}{mark}{name} = {value}\n", key.meaning, elements(key, all))
}

/// The keys of the tables in the list `key`, a comment each.
fn elements(key: &Key, all: &[Key]) -> String {
    let below = format!("{}.N.", key.path);
    let elements = all.iter().filter_map(|element| {
        Some(format!("#   {}: {} {}.\n", element.path.strip_prefix(&below)?, element.meaning, element.range))
    });
    elements.collect()
}
