//! The range of a number, and the length of a list.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use serde_json::Value as Schema;
use sprag_shared::structure::error::Number;
use toml::Value;

use super::list::range;
use super::unit::unit;
use crate::effect::number::number;

/// The range of a number: its least and its largest value, and whether these themselves are allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least value.
    pub low: Option<(f64, bool)>,
    /// Largest value.
    pub high: Option<(f64, bool)>,
}

impl From<RangeInclusive<f64>> for Bounds {
    fn from(range: RangeInclusive<f64>) -> Bounds {
        Bounds { low: Some((*range.start(), true)), high: Some((*range.end(), true)) }
    }
}

impl Bounds {
    /// Those in the `schema` of a number.
    pub fn of(schema: &Schema) -> Bounds {
        let at = |name: &str, inclusive| schema.get(name).and_then(Schema::as_f64).map(|value| (value, inclusive));
        Bounds {
            low: at("exclusiveMinimum", false).or_else(|| at("minimum", true)),
            high: at("exclusiveMaximum", false).or_else(|| at("maximum", true)),
        }
    }

    /// Whether `value` is within them; what is not finite never is.
    pub fn allow(&self, value: f64) -> bool {
        let above = self.low.is_none_or(|(low, inclusive)| value > low || inclusive && value == low);
        let below = self.high.is_none_or(|(high, inclusive)| value < high || inclusive && value == high);
        value.is_finite() && above && below
    }

    /// In words, with the unit of `key`: "from 0 to 10 s".
    pub fn in_words(&self, key: &str) -> String {
        let words = match (self.low, self.high) {
            (None, None) => "a finite number".to_owned(),
            (Some((low, true)), None) => format!("{} or more", number(low)),
            (Some((low, false)), None) => format!("above {}", number(low)),
            (None, Some((high, true))) => format!("{} or less", number(high)),
            (None, Some((high, false))) => format!("below {}", number(high)),
            (Some((low, true)), Some((high, true))) => format!("from {} to {}", number(low), number(high)),
            (Some((low, true)), Some((high, false))) => format!("from {} and below {}", number(low), number(high)),
            (Some((low, false)), Some((high, true))) => format!("above {}, to {}", number(low), number(high)),
            (Some((low, false)), Some((high, false))) => format!("above {} and below {}", number(low), number(high)),
        };
        match (unit(key), words.strip_suffix(" or more")) {
            (Some(unit), Some(low)) => format!("{low} {unit} or more"),
            (Some(unit), None) => format!("{words} {unit}"),
            (None, _) => words,
        }
    }
}

/// A value outside its range.
#[derive(Clone, Debug, PartialEq)]
pub struct Outside {
    /// Its key: names, and numbers of elements.
    pub path: Vec<String>,
    /// The number, or how long a list is.
    pub value: String,
    /// What it may be.
    pub range: String,
}

impl Outside {
    /// In the table or list `name`.
    fn under(mut self, name: &str) -> Outside {
        self.path.push(name.to_owned());
        self
    }
}

/// The first value of `table`, in the order of its `schema`, that is outside the range which `schema` gives it: a number, also where only
/// words may be, or a list that is too short or too long.
pub fn outside(table: &toml::Table, schema: &Schema) -> Option<Outside> {
    let mut outside = in_table(table, schema)?;
    outside.path.reverse();
    Some(outside)
}

/// [`outside`], with the path from its end.
fn in_table(table: &toml::Table, schema: &Schema) -> Option<Outside> {
    let properties = choices(schema).find_map(|choice| choice.get("properties")?.as_object())?;
    // A table has few of the keys that it may have.
    let given = table.iter().filter_map(|(name, value)| Some((name, value, properties.get(name)?)));
    let mut outside: BTreeMap<&String, Outside> =
        given.filter_map(|(name, value, schema)| Some((name, in_value(value, schema, name)?))).collect();
    properties.keys().find_map(|name| outside.remove(name).map(|outside| outside.under(name)))
}

/// The same of the value of `key`.
fn in_value(value: &Value, schema: &Schema, key: &str) -> Option<Outside> {
    match value {
        Value::Table(table) => in_table(table, schema),
        Value::Array(values) => {
            let (list, items) = choices(schema).find_map(|choice| Some((choice, choice.get("items")?)))?;
            let mut elements = values.iter().enumerate();
            length_outside(values.len(), list).or_else(|| {
                elements.find_map(|(index, value)| in_value(value, items, key).map(|outside| outside.under(&index.to_string())))
            })
        }
        Value::Integer(value) => number_outside(*value as f64, schema, key),
        Value::Float(value) => number_outside(*value, schema, key),
        _ => None,
    }
}

fn number_outside(value: f64, schema: &Schema, key: &str) -> Option<Outside> {
    let is_number = |choice: &&Schema| choice.get("type").is_some_and(|name| name == "number" || name == "integer");
    let is_word = |choice: &Schema| choice.get("const").or(choice.get("enum")).is_some();
    let allowed = match choices(schema).find(is_number) {
        Some(number) => Bounds::of(number).allow(value),
        None => !choices(schema).any(is_word),
    };
    (!allowed).then(|| Outside { path: Vec::new(), value: Number(value).to_string(), range: range(schema, key) })
}

fn length_outside(length: usize, list: &Schema) -> Option<Outside> {
    let [least, most] = ["minItems", "maxItems"].map(|name| list.get(name).and_then(Schema::as_u64));
    let (least, length) = (least.unwrap_or(0), length as u64);
    let range = most.map_or_else(|| format!("a list of {least} or more"), |most| format!("a list of {least} to {most}"));
    let allowed = least <= length && most.is_none_or(|most| length <= most);
    (!allowed).then(|| Outside { path: Vec::new(), value: format!("a list of {length}"), range })
}

/// `schema`, or what it lets one choose from.
pub fn choices(schema: &Schema) -> impl Iterator<Item = &Schema> {
    let choices = ["anyOf", "oneOf"].iter().find_map(|name| schema.get(name)?.as_array());
    choices.map_or(std::slice::from_ref(schema), Vec::as_slice).iter()
}
