//! The keys of a file, one by one.

use serde_json::Value as Schema;

use sprag_shared::structure::error::Number;

use super::bounds::{Bounds, choices};

/// A key of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Key {
    /// From the root of the file, with dots; `N` is the number of an element of a list.
    pub path: String,
    /// What it is.
    pub meaning: String,
    /// What it may be.
    pub range: String,
    /// The words that it may be, with what they mean where that is described.
    pub words: Vec<(String, String)>,
    /// Value when absent, as TOML has it.
    pub default: Option<toml::Value>,
    /// A value to show where there is no default; tables have none.
    pub example: Option<toml::Value>,
    /// Whether the file, or the table that it is in, needs it.
    pub required: bool,
    /// Whether it holds keys of its own, which follow it.
    pub is_table: bool,
    /// Whether it is a list.
    pub is_list: bool,
    /// Whether it belongs to an element of a list that is a value of a table, as of `device.N.flywheels`.
    pub of_list_below: bool,
}

impl Key {
    /// The default as a file spells it; "-" for none.
    pub fn default_text(&self) -> String {
        self.default.as_ref().map_or("-".to_owned(), text_of)
    }
}

/// `value` as a file spells it.
pub(super) fn text_of(value: &toml::Value) -> String {
    match value {
        toml::Value::Float(value) => Number(*value).to_string(),
        value => value.to_string(),
    }
}

/// The keys that `schema` describes, in its order.
pub fn keys(schema: &Schema) -> Vec<Key> {
    let mut keys = Vec::new();
    collect(schema, "", false, &mut keys);
    keys
}

fn collect(schema: &Schema, prefix: &str, of_list_below: bool, keys: &mut Vec<Key>) {
    let (of_table, Some(object)) = (schema, table_of(schema)) else { return };
    let required = |name: &str| object["required"].as_array().is_some_and(|required| required.iter().any(|key| key == name));
    let Some(properties) = object["properties"].as_object() else { return };
    for (name, schema) in properties {
        let path = format!("{prefix}{name}");
        let items = choices(schema).find_map(|choice| choice.get("items"));
        let inner = items.unwrap_or(schema);
        // A list of texts or tables is a value.
        let is_table = table_of(inner).is_some() && (items.is_none() || choices(inner).count() == 1);
        keys.push(Key {
            meaning: schema["description"].as_str().unwrap_or_default().to_owned(),
            range: range(schema, name),
            words: words(schema),
            default: schema.get("default").and_then(as_toml),
            example: [&schema["examples"][0], &of_table["default"][name]]
                .into_iter()
                .find_map(as_toml)
                .or_else(|| example(schema)),
            required: required(name),
            is_table,
            is_list: items.is_some(),
            of_list_below,
            path: path.clone(),
        });
        let below = if items.is_some() { format!("{path}.N.") } else { format!("{path}.") };
        let is_value = items.is_some() && (!is_table || path.contains('.'));
        collect(inner, &below, of_list_below || is_value, keys);
    }
}

/// `schema`, or the one among its choices, that has keys of its own.
fn table_of(schema: &Schema) -> Option<&Schema> {
    choices(schema).find(|choice| choice.get("properties").is_some())
}

/// What a value of the key `name` may be, in words.
pub(super) fn range(schema: &Schema, name: &str) -> String {
    let mut ranges = choices(schema).flat_map(|choice| match choice.get("enum").and_then(Schema::as_array) {
        Some(words) => words.iter().map(Schema::to_string).collect(),
        None if std::ptr::eq(choice, schema) => vec![range_of_kind(schema, name)],
        None => vec![range(choice, name)],
    });
    let (Some(first), others) = (ranges.next(), ranges.collect::<Vec<_>>()) else { return String::new() };
    match others.split_last() {
        None => first,
        Some((last, [])) => format!("{first} or {last}"),
        Some((last, between)) => format!("{first}, {} or {last}", between.join(", ")),
    }
}

/// The words among the choices of `schema` that are described.
fn words(schema: &Schema) -> Vec<(String, String)> {
    let text = |value: &Schema| value.as_str().map(str::to_owned);
    choices(schema).filter_map(|choice| Some((text(&choice["const"])?, text(&choice["description"])?))).collect()
}

/// [`range`] of a value of one kind.
fn range_of_kind(schema: &Schema, name: &str) -> String {
    if let Some(word) = schema.get("const") {
        return word.to_string();
    }
    let bounds = Bounds::of(schema);
    let unbounded = bounds == Bounds { low: None, high: None };
    match schema["type"].as_str() {
        Some("integer") if unbounded => "a whole number".to_owned(),
        Some("integer") if bounds == Bounds { low: Some((0.0, true)), high: None } => "a whole number from 0".to_owned(),
        Some("number") if unbounded => super::unit::unit(name).map_or("a number".to_owned(), |unit| format!("a number, {unit}")),
        Some("number" | "integer") => bounds.in_words(name),
        Some("boolean") => "true or false".to_owned(),
        Some("array") => match &schema["items"] {
            items if table_of(items).is_some() && choices(items).count() == 1 => "a list of tables".to_owned(),
            items => format!("a list, each {}", range(items, name)),
        },
        Some("object") => "a table".to_owned(),
        Some("string") => "a text".to_owned(),
        _ => "any value".to_owned(),
    }
}

/// `value` in TOML; none of null.
fn as_toml(value: &Schema) -> Option<toml::Value> {
    Some(match value {
        Schema::Null => return None,
        Schema::Bool(value) => (*value).into(),
        Schema::Number(number) => number.as_i64().map_or_else(|| number.as_f64().map(Into::into), |whole| Some(whole.into()))?,
        Schema::String(text) => text.as_str().into(),
        Schema::Array(values) => toml::Value::Array(values.iter().filter_map(as_toml).collect()),
        Schema::Object(values) => {
            values.iter().filter_map(|(name, value)| Some((name.clone(), as_toml(value)?))).collect::<toml::Table>().into()
        }
    })
}

/// A value that `schema` allows; none of a table.
fn example(schema: &Schema) -> Option<toml::Value> {
    let first = choices(schema).next()?;
    if !std::ptr::eq(first, schema) {
        return example(first);
    }
    if let Some(word) = schema.get("const").or_else(|| schema["enum"].get(0)) {
        return as_toml(word);
    }
    let bounds = Bounds::of(schema);
    let number = || [1.0, 0.1, 0.01].into_iter().chain(bounds.high.map(|(high, _)| high)).find(|value| bounds.allow(*value));
    match schema["type"].as_str()? {
        "integer" => Some((bounds.low.map_or(1.0, |(low, _)| low) as i64).into()),
        "number" => number().map(Into::into),
        "boolean" => Some(true.into()),
        "string" => Some("".into()),
        "array" => Some(toml::Value::Array(vec![example(&schema["items"])?])),
        _ => None,
    }
}
