//! The JSON schema of a type.

use schemars::generate::SchemaSettings;
use schemars::transform::RecursiveTransform;
use schemars::{JsonSchema, Schema};
use serde_json::{Map, Value};

/// The JSON schema of `T`: draft 7, the newest that editors check TOML by, and without references, so that whoever reads it can walk it.
pub fn schema_of<T: JsonSchema>() -> Value {
    let settings = SchemaSettings::draft07().with(|settings| settings.inline_subschemas = true);
    settings.with_transform(RecursiveTransform(plain)).into_generator().into_root_schema_for::<T>().to_value()
}

/// What TOML has no use for is left out: null, the size of numbers in memory, and line breaks of comments.
fn plain(schema: &mut Schema) {
    let Some(object) = schema.as_object_mut() else { return };
    while let Some(only) = only_choice(object) {
        for (name, value) in only {
            object.entry(name).or_insert(value);
        }
    }
    object.remove("format");
    if object.get("default").is_some_and(Value::is_null) {
        object.remove("default");
    }
    if let Some(Value::Array(types)) = object.get_mut("type") {
        types.retain(|name| name != "null");
        if let [only] = &types[..] {
            object["type"] = only.clone();
        }
    }
    if let Some(Value::String(text)) = object.get_mut("description") {
        *text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    }
}

/// The one schema of an `anyOf` that is left without null, taken out of it.
fn only_choice(object: &mut Map<String, Value>) -> Option<Map<String, Value>> {
    let choices = object.get_mut("anyOf")?.as_array_mut()?;
    choices.retain(|choice| choice.get("type").is_none_or(|name| name != "null"));
    if choices.len() != 1 {
        return None;
    }
    let only = choices.pop()?;
    object.shift_remove("anyOf");
    only.as_object().cloned()
}
