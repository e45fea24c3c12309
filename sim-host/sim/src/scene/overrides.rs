//! `KEY=VALUE`: changes one value of a scene, from the command line, in a study or by a page.

use toml::{Table, Value};

use super::SceneError;

/// Parts of a key, at most. A scene has none of more than five, and whatever reads tables within tables without end runs out of stack.
const MOST_PARTS: usize = 16;

/// Sets the key of `item` (`block.size_m=2`, `device.1.mass_ratio=0.5`) in `table`. The value is read as TOML, and as a
/// plain string where it is none. Without a value (`block.size_m=`) the key is left out. The number after the last of a list, or 0 where
/// there is none, adds a table to it (`vertical.0.motion=sine`).
///
/// # Errors
/// [`SceneError::Conflict`] when `item` has no `=`, its key has too many parts or leads through a value that is not a table or an array, or
/// what shall be left out is not there.
pub fn apply(table: &mut Table, item: &str, origin: &str) -> Result<(), SceneError> {
    let refuse = |key: &str, reason: String| SceneError::Conflict { origin: origin.to_owned(), key: key.to_owned(), reason };
    let Some((path, text)) = item.split_once('=') else {
        return Err(refuse(item, "must be KEY=VALUE, such as block.size_m=2".to_owned()));
    };
    let path = path.trim();
    if path.is_empty() || path.split('.').any(str::is_empty) {
        return Err(refuse(item, "must be KEY=VALUE, such as block.size_m=2".to_owned()));
    }
    if let Some((end, _)) = path.match_indices('.').nth(MOST_PARTS - 1) {
        return Err(refuse(&path[..end], format!("a key has {MOST_PARTS} parts at most, and this one goes on")));
    }
    let value = toml::from_str::<Table>(&format!("value = {text}"))
        .ok()
        .filter(|parsed| parsed.len() == 1)
        .and_then(|mut parsed| parsed.remove("value"))
        .unwrap_or_else(|| Value::String(text.to_owned()));
    let last = path.rsplit('.').next().unwrap_or(path);
    let mut place = Place::Table(table);
    let mut parts = path.split('.').peekable();
    while let (Some(part), Some(next)) = (parts.next(), parts.peek()) {
        place = place.descend(part, next).map_err(|reason| refuse(path, reason))?;
    }
    let given = (!text.trim().is_empty()).then_some(value);
    place.put(path, last, given).map_err(|reason| refuse(path, reason))
}

/// [`apply`] of each of `items` in turn.
///
/// # Errors
/// As [`apply`], at the first that it refuses.
pub fn apply_all(table: &mut Table, items: &[impl AsRef<str>], origin: &str) -> Result<(), SceneError> {
    items.iter().try_for_each(|item| apply(table, item.as_ref(), origin))
}

/// The items of `list` that commas separate, but for commas in TOML's brackets, braces and quotes:
/// `block.size_m=2, device.0={ kind = "inerter", mass_ratio = 0.5 }` has two.
pub fn items(list: &str) -> impl Iterator<Item = &str> {
    let (mut depth, mut quote) = (0_u32, None);
    let separates = move |character| {
        match (quote, character) {
            (Some(open), close) if open == close => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(character),
            (None, '[' | '{') => depth += 1,
            (None, ']' | '}') => depth = depth.saturating_sub(1),
            (None, ',') => return depth == 0,
            _ => {}
        }
        false
    };
    list.split(separates).map(str::trim).filter(|item| !item.is_empty())
}

enum Place<'a> {
    Table(&'a mut Table),
    Array(&'a mut Vec<Value>),
}

impl<'a> Place<'a> {
    /// What `part` leads to, made where it is not there; `next` follows.
    fn descend(self, part: &str, next: &str) -> Result<Place<'a>, String> {
        let empty = || if next.parse::<usize>().is_ok() { Value::Array(Vec::new()) } else { Value::Table(Table::new()) };
        let value = match self {
            Place::Table(table) => table.entry(part).or_insert_with(empty),
            Place::Array(array) => {
                let index = index_in(array, part)?;
                if index == array.len() {
                    array.push(empty());
                }
                &mut array[index]
            }
        };
        match value {
            Value::Table(table) => Ok(Place::Table(table)),
            Value::Array(array) => Ok(Place::Array(array)),
            _ => Err(format!("`{part}` is a value, not a table")),
        }
    }

    /// Sets `last` to `value`, or leaves it out.
    fn put(self, path: &str, last: &str, value: Option<Value>) -> Result<(), String> {
        let absent = || format!("{path} is not there, so it cannot be left out; `KEY=` is a key without a value");
        match (self, value) {
            (Place::Table(table), Some(value)) => _ = table.insert(last.to_owned(), value),
            (Place::Table(table), None) => _ = table.remove(last).ok_or_else(absent)?,
            (Place::Array(array), value) => {
                let index = index_in(array, last)?;
                match (value, index < array.len()) {
                    (Some(value), true) => array[index] = value,
                    (Some(value), false) => array.push(value),
                    (None, true) => _ = array.remove(index),
                    (None, false) => return Err(absent()),
                }
            }
        }
        Ok(())
    }
}

/// The index that `part` names: of an element of `array`, or of the next one.
fn index_in(array: &[Value], part: &str) -> Result<usize, String> {
    let length = array.len();
    let index = part.parse::<usize>().ok().filter(|index| *index <= length);
    index.ok_or_else(|| match length {
        0 => format!("`{part}` must be 0, for there is none yet"),
        _ => format!("`{part}` must be a number from 0 to {}, or {length} to add one", length - 1),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commas_inside_values_separate_nothing() {
        let list = r#"block.size_m=2,, device.0={kind="inerter",mass_ratio=0.5}, a=[1,[2,3]] ,title='x, y',b="]","#;
        let found: Vec<&str> = items(list).collect();
        let expected =
            ["block.size_m=2", r#"device.0={kind="inerter",mass_ratio=0.5}"#, "a=[1,[2,3]]", "title='x, y'", r#"b="]""#];
        assert_eq!(found, expected);
    }

    #[test]
    fn values_are_set_where_the_path_leads() {
        let mut table: Table = toml::from_str("a = 1\n[[b]]\nc = 2\n[[b]]\nc = 3").unwrap();
        for item in ["a=2.5", "b.1.c = 7", "d.e=text", "f=\"quoted\"", "g=[1, 2]", "b.0={c=9}"] {
            apply(&mut table, item, "scene").unwrap();
        }
        let expected: Table =
            toml::from_str("a = 2.5\nf = \"quoted\"\ng = [1, 2]\nd.e = \"text\"\n[[b]]\nc = 9\n[[b]]\nc = 7").unwrap();
        assert_eq!(table, expected);
    }

    #[test]
    fn a_path_that_leads_nowhere_is_refused() {
        let mut table: Table = toml::from_str("a = 1\n[[b]]\nc = 2").unwrap();
        for item in ["a", "=1", "a.b=1", "b.2.c=2", "b.x=2", "a..b=1", "d.1.e=1", "e=", "b.1=", "b.0.d="] {
            assert!(apply(&mut table, item, "scene").is_err(), "{item}");
        }
    }

    #[test]
    fn a_path_without_end_is_refused() {
        let mut table = Table::new();
        let message = apply(&mut table, &format!("a{}=1", ".b".repeat(100_000)), "scene").unwrap_err().to_string();
        assert_eq!(message, format!("scene: a{}: a key has 16 parts at most, and this one goes on", ".b".repeat(15)));
        assert!(table.is_empty());
    }

    #[test]
    fn lists_grow_at_their_ends_and_keys_can_be_left_out() {
        let mut table: Table = toml::from_str("a = 1\nz = 2\n[[b]]\nc = 2").unwrap();
        for item in ["b.1.c=3", "d.0.e=4", "d.1={e=5}", "a=", "b.0= "] {
            apply(&mut table, item, "scene").unwrap_or_else(|error| panic!("{item}: {error}"));
        }
        let expected: Table = toml::from_str("z = 2\n[[b]]\nc = 3\n[[d]]\ne = 4\n[[d]]\ne = 5").unwrap();
        assert_eq!(table, expected);
    }
}
