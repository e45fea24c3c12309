//! The keys of scenes and studies: meanings, ranges and defaults, as the types of the files declare them.

pub mod bounds;
pub mod list;
mod schema;
pub mod table;
pub mod template;
#[cfg(test)]
mod tests;
pub mod unit;

use serde::de::DeserializeOwned;
use serde_json::Value;

pub use list::Key;
pub use schema::schema_of;

/// A kind of TOML file that describes its keys.
pub trait Described: DeserializeOwned {
    /// Its JSON schema (draft 7), without references.
    fn schema() -> &'static Value;

    /// Whose key `key` is where it is none of this kind of file, and who takes that.
    fn stranger(_key: &str) -> Option<&'static str> {
        None
    }
}
