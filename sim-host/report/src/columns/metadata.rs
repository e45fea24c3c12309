//! What a file says of itself.

use serde::Serialize;
use serde_json::Value;

use super::error::TableError;

/// What a file says of itself: names and texts, such as the command that made it.
pub type Metadata = [(String, String)];

/// The fields of `maker`, sorted by name: texts as they are, anything else as JSON.
///
/// # Errors
/// [`TableError::Metadata`] when `maker` has no JSON.
pub fn metadata_of(maker: &impl Serialize) -> Result<Vec<(String, String)>, TableError> {
    let text = |value: Value| match value {
        Value::String(text) => text,
        other => other.to_string(),
    };
    let mut maker = serde_json::to_value(maker).map_err(TableError::Metadata)?;
    maker.sort_all_objects();
    Ok(match maker {
        Value::Object(fields) => fields.into_iter().map(|(name, value)| (name, text(value))).collect(),
        _ => Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_plain_and_the_rest_is_json() {
        #[derive(Serialize)]
        struct Maker {
            command: &'static str,
            seed: u64,
            steps: Vec<f64>,
        }
        let found = metadata_of(&Maker { command: "map", seed: 7, steps: vec![0.1, 2.0] }).unwrap();
        let found: Vec<(&str, &str)> = found.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
        assert_eq!(found, [("command", "map"), ("seed", "7"), ("steps", "[0.1,2.0]")]);
    }
}
