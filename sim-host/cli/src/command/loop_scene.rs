//! The scene of a command that closes a loop.

use std::path::Path;

use sprag_sim::closed_loop::LoopScene;
use sprag_sim::scene::Scene;

use super::record_arguments::SceneRecordArguments;

/// Reads a scene with changes, and with other records where there are some.
///
/// # Errors
/// A scene that cannot be read, and those of [`LoopScene::new`].
pub fn load(path: &Path, set: &[String], records: &SceneRecordArguments) -> anyhow::Result<LoopScene> {
    let mut scene = Scene::load(path, set)?;
    records.apply(&mut scene)?;
    Ok(LoopScene::new(scene)?)
}
