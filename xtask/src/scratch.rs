//! Folders that a task works in.

use crate::stop::Stop;
use std::{fs, path::Path};

/// Makes a folder, empty if it is there.
///
/// # Errors
/// If it cannot be made or emptied.
pub fn empty(folder: &Path) -> Result<(), Stop> {
    if folder.exists() { fs::remove_dir_all(folder) } else { Ok(()) }
        .and_then(|()| fs::create_dir_all(folder))
        .map_err(|error| Stop::failed(format!("{}: {error}", folder.display())))
}
