//! What `sprag` found, from the `summary.json` of a folder of results.

use crate::stop::Stop;
use serde_json::Value;
use std::{fmt::Display, fs, path::Path};

/// The first run of the results in a folder.
///
/// # Errors
/// If there is no summary, or it is no JSON.
pub fn first_run(folder: &Path) -> Result<Value, Stop> {
    let path = folder.join("summary.json");
    let cannot = |error: &dyn Display| Stop::failed(format!("{}: {error}", path.display()));
    let text = fs::read_to_string(&path).map_err(|error| cannot(&error))?;
    let mut summary: Value = serde_json::from_str(&text).map_err(|error| cannot(&error))?;
    Ok(summary["runs"][0].take())
}
