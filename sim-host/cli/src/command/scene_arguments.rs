//! Options that say which scene a command takes, and what is changed in it.

use std::path::PathBuf;

use clap::Args;
use sprag_sim::scene::{Scene, SceneError};

/// A scene, and values of its keys.
#[derive(Args, Clone, Debug)]
pub struct SceneArguments {
    /// Scene file: a block, its devices and the ground motion.
    #[arg(value_name = "SCENE.toml", value_hint = clap::ValueHint::FilePath)]
    pub scene: PathBuf,
    /// Change one value of the scene, such as block.size_m=2 or device.1.mass_ratio=0.5; may be given more than once.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

impl SceneArguments {
    /// The changes of the scene, with one more.
    pub fn changes(&self, more: Option<String>) -> Vec<String> {
        self.set.iter().cloned().chain(more).collect()
    }

    /// The scene, with one more change.
    pub fn load(&self, more: Option<String>) -> Result<Scene, SceneError> {
        Scene::load(&self.scene, &self.changes(more))
    }
}
