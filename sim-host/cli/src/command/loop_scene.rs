//! What every command that closes a loop needs of a scene.

use std::path::Path;

use anyhow::ensure;
use sprag_shared::structure::device::DeviceKind;
use sprag_shared::structure::drivetrain::Engagement;
use sprag_sim::closed_loop::LoopTask;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::Scene;
use sprag_sim::scene::controller::ControllerTable;
use sprag_sim::scene::motions::GroundMotions;
use sprag_sim::scene::schema::SceneFile;
use sprag_sim::sensor::Suite;

use super::record_arguments::SceneRecordArguments;

/// A scene over which loops can be closed.
pub struct LoopScene {
    /// The scene.
    pub scene: Scene,
    /// Its ground motion.
    pub ground: GroundMotions,
    /// Its controller, the default one where it has none.
    pub controller: ControllerTable,
    /// Sensors of the controller.
    pub suite: Suite,
    /// Devices that can be commanded, by their index.
    pub pairs: Vec<usize>,
}

impl LoopScene {
    /// Reads a scene with changes, and with other records where there are some.
    ///
    /// # Errors
    /// A scene that cannot be read, without a pair that takes commands, or that begins in motion.
    pub fn load(path: &Path, set: &[String], records: &SceneRecordArguments) -> anyhow::Result<LoopScene> {
        let mut scene = Scene::load(path, set)?;
        records.apply(&mut scene)?;
        let name = path.display();
        let pairs: Vec<usize> =
            (0..scene.devices.len()).filter(|&index| scene.devices[index].device.kind == DeviceKind::ClutchedPair).collect();
        ensure!(!pairs.is_empty(), "{name}: a closed loop needs a [[device]] of kind \"clutched-pair\"");
        let block = &scene.file.block;
        ensure!(
            block.initial_rotation_ratio == 0.0 && block.initial_velocity_ratio == 0.0,
            "{name}: block.initial_rotation_ratio and block.initial_velocity_ratio must be 0: the controller calibrates itself at rest"
        );
        for device in pairs.iter().map(|&index| &scene.devices[index]) {
            let commanded = device.drivetrain.engagement != Engagement::Overrunning;
            ensure!(commanded, "{name}: device {}: an overrunning clutch takes no commands", device.name);
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
