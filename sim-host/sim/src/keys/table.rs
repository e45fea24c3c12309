//! Keys as a table of the manual.

use serde_json::Value as Schema;

use super::list::{Key, keys};

/// The keys of the file with `schema` that are directly below the tables `parts` of the table `within`, in Markdown, by their names within it;
/// its own are those of the part "*". Tables end in a dot, and "." is the file.
pub fn table(schema: &Schema, within: &str, parts: &[&str]) -> String {
    let keys = keys(schema);
    let mut text = "| key | meaning | what it may be | default |\n| --- | --- | --- | --- |\n".to_owned();
    for part in parts {
        let start = format!("{}{}", within.trim_start_matches('.'), part.trim_start_matches('*'));
        let below = keys.iter().filter_map(|key| Some((key, key.path.strip_prefix(&start)?)));
        for (key, _) in below.filter(|(_, name)| !name.contains('.')) {
            text += &row(key, key.path.strip_prefix(within).unwrap_or(&key.path));
        }
    }
    text
}

fn row(key: &Key, name: &str) -> String {
    let default = match &key.default {
        _ if key.required => "needed".to_owned(),
        Some(toml::Value::Table(_)) | None => String::new(),
        Some(_) => format!("`{}`", key.default_text()),
    };
    let words: Vec<String> =
        key.words.iter().map(|(word, meaning)| format!("`{word}`: {}", meaning.trim_end_matches('.'))).collect();
    // A number or a word has its range, which names the words; of many words there is a table of their own.
    let range = if key.range.starts_with('"') && (1..=4).contains(&words.len()) { words.join("; ") } else { key.range.clone() };
    let [meaning, range] = [&key.meaning, &range].map(|text| text.replace('|', "\\|"));
    format!("| `{name}` | {} | {range} | {default} |\n", meaning.trim_end_matches('.'))
}
