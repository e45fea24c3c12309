//! What every command that closes a loop needs of a scene.

use std::path::Path;

use sprag_shared::structure::device::DeviceKind;
use sprag_shared::structure::drivetrain::Engagement;
use sprag_sim::closed_loop::LoopTask;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::controller::ControllerTable;
use sprag_sim::scene::ground::GroundError;
use sprag_sim::scene::motions::GroundMotions;
use sprag_sim::scene::schema::SceneFile;
use sprag_sim::scene::{Scene, SceneError};
use sprag_sim::sensor::Suite;

use super::record_arguments::SceneRecordArguments;

/// Why a loop cannot be closed over a scene.
#[derive(Debug, thiserror::Error)]
pub enum LoopSceneError {
    /// The scene.
    #[error("{0}")]
    Scene(#[from] SceneError),
    /// Its ground motion.
    #[error("{0}")]
    Ground(#[from] GroundError),
    /// Nothing to be commanded.
    #[error("{scene}: a closed loop needs a [[device]] of kind \"clutched-pair\"")]
    NoPair {
        /// The scene.
        scene: String,
    },
    /// It begins in motion.
    #[error(
        "{scene}: block.initial_rotation_ratio and block.initial_velocity_ratio must be 0: the controller calibrates itself at rest"
    )]
    NotAtRest {
        /// The scene.
        scene: String,
    },
    /// A clutch without a coil.
    #[error("{scene}: device {device}: an overrunning clutch takes no commands")]
    Uncommanded {
        /// The scene.
        scene: String,
        /// The device.
        device: String,
    },
}

/// A scene over which loops can be closed.
pub struct LoopScene {
    /// The scene.
    pub scene: Scene,
    /// Its ground motion.
    pub ground: GroundMotions,
    /// Its controller, the default one where it has none.
    pub controller: ControllerTable,
    /// Its sensors.
    pub suite: Suite,
    /// Devices that can be commanded, by their index.
    pub pairs: Vec<usize>,
}

impl LoopScene {
    /// Reads a scene with changes, and with other records where there are some.
    ///
    /// # Errors
    /// [`LoopSceneError`].
    pub fn load(path: &Path, set: &[String], records: &SceneRecordArguments) -> Result<LoopScene, LoopSceneError> {
        let mut scene = Scene::load(path, set)?;
        records.apply(&mut scene)?;
        let name = || path.display().to_string();
        let pairs: Vec<usize> =
            (0..scene.devices.len()).filter(|&index| scene.devices[index].device.kind == DeviceKind::ClutchedPair).collect();
        if pairs.is_empty() {
            return Err(LoopSceneError::NoPair { scene: name() });
        }
        if scene.file.block.initial_rotation_ratio != 0.0 || scene.file.block.initial_velocity_ratio != 0.0 {
            return Err(LoopSceneError::NotAtRest { scene: name() });
        }
        for &index in &pairs {
            if scene.devices[index].drivetrain.engagement == Engagement::Overrunning {
                return Err(LoopSceneError::Uncommanded { scene: name(), device: scene.devices[index].name.clone() });
            }
        }
        let ground = scene.ground_motions()?;
        let controller = scene.file.controller.clone().unwrap_or_default();
        let suite = controller.suite(&scene.origin)?;
        Ok(LoopScene { scene, ground, controller, suite, pairs })
    }

    /// The loop over device `index` with sensors of this `seed`.
    pub fn task<'a>(&'a self, index: usize, seed: u64, interrupt: &'a Interrupt) -> LoopTask<'a> {
        let LoopScene { scene, ground, controller, suite, .. } = self;
        LoopTask { scene, ground, index, controller, suite, seed, closeness: None, interrupt }
    }

    /// The scene as it was run, for a summary.
    pub fn resolved(&self) -> SceneFile {
        SceneFile { controller: Some(self.controller.clone()), ..self.scene.file.clone() }
    }
}
