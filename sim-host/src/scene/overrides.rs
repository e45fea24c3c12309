//! `--set KEY=VALUE`: changes one value of a scene from the command line.

use toml::{Table, Value};

use super::SceneError;

/// Sets the key of `item` (`block.size_m=2`, `device.1.mass_ratio=0.5`) in `table`. The value is read as TOML, and as a
/// plain string where it is none.
///
/// # Errors
/// [`SceneError::Conflict`] when `item` has no `=`, or its key leads through a value that is not a table or an array.
pub fn apply(table: &mut Table, item: &str, origin: &str) -> Result<(), SceneError> {
    let refuse =
        |key: &str, reason: String| SceneError::Conflict { origin: origin.to_owned(), key: format!("--set {key}"), reason };
    let Some((path, text)) = item.split_once('=') else {
        return Err(refuse(item, "must be KEY=VALUE, such as block.size_m=2".to_owned()));
    };
    let path = path.trim();
    if path.is_empty() || path.split('.').any(str::is_empty) {
        return Err(refuse(item, "must be KEY=VALUE, such as block.size_m=2".to_owned()));
    }
    let value = toml::from_str::<Table>(&format!("value = {text}"))
        .ok()
        .filter(|parsed| parsed.len() == 1)
        .and_then(|mut parsed| parsed.remove("value"))
        .unwrap_or_else(|| Value::String(text.to_owned()));
    let (parents, last) = path.rsplit_once('.').map_or((None, path), |(parents, last)| (Some(parents), last));
    let mut place = Place::Table(table);
    for part in parents.into_iter().flat_map(|parents| parents.split('.')) {
        place = place.descend(part).map_err(|reason| refuse(path, reason))?;
    }
    match place {
        Place::Table(table) => {
            table.insert(last.to_owned(), value);
            Ok(())
        }
        Place::Array(array) => {
            let length = array.len();
            let slot = last.parse::<usize>().ok().and_then(|index| array.get_mut(index));
            let slot = slot.ok_or_else(|| refuse(path, format!("`{last}` must be a number below {length}")))?;
            *slot = value;
            Ok(())
        }
    }
}

enum Place<'a> {
    Table(&'a mut Table),
    Array(&'a mut Vec<Value>),
}

impl<'a> Place<'a> {
    fn descend(self, part: &str) -> Result<Place<'a>, String> {
        let value = match self {
            Place::Table(table) => table.entry(part).or_insert_with(|| Value::Table(Table::new())),
            Place::Array(array) => {
                let length = array.len();
                let index = part.parse::<usize>().ok();
                index.and_then(|index| array.get_mut(index)).ok_or_else(|| format!("`{part}` must be a number below {length}"))?
            }
        };
        match value {
            Value::Table(table) => Ok(Place::Table(table)),
            Value::Array(array) => Ok(Place::Array(array)),
            _ => Err(format!("`{part}` is a value, not a table")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        for item in ["a", "=1", "a.b=1", "b.1.c=2", "b.x=2", "a..b=1"] {
            assert!(apply(&mut table, item, "scene").is_err(), "{item}");
        }
    }
}
