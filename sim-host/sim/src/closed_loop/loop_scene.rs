//! A scene over which loops can be closed.

use sprag_shared::structure::device::DeviceKind;
use sprag_shared::structure::drivetrain::Engagement;

use super::LoopTask;
use crate::interrupt::Interrupt;
use crate::scene::Scene;
use crate::scene::controller::ControllerTable;
use crate::scene::ground::GroundError;
use crate::scene::motions::GroundMotions;
use crate::scene::schema::SceneFile;
use crate::sensor::Suite;

/// A scene over which loops can be closed.
#[derive(Clone, Debug)]
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
    /// Closed loop of `scene`, with its records.
    ///
    /// # Errors
    /// [`GroundError`] for a scene without a pair that takes commands, one on a foundation or that begins in motion, and a record that cannot be read.
    pub fn new(scene: Scene) -> Result<LoopScene, GroundError> {
        let pairs: Vec<usize> =
            (0..scene.devices.len()).filter(|&index| scene.devices[index].device.kind == DeviceKind::ClutchedPair).collect();
        if pairs.is_empty() {
            return Err(scene.key("device").missing("a closed loop needs a [[device]] of kind \"clutched-pair\"").into());
        }
        scene.check_loop_base()?;
        let block = &scene.file.block;
        for (key, ratio) in
            [("initial_rotation_ratio", block.initial_rotation_ratio), ("initial_velocity_ratio", block.initial_velocity_ratio)]
        {
            let range = "0 in a closed loop: the controller calibrates itself at rest";
            scene.key(&format!("block.{key}")).require(ratio, ratio == 0.0, range)?;
        }
        for &index in &pairs {
            if scene.devices[index].drivetrain.engagement == Engagement::Overrunning {
                let reason = "an overrunning clutch takes no commands";
                return Err(scene.key(&format!("device.{index}.engagement")).conflict(reason).into());
            }
            if let Some(name) = scene.file.device[index].support_key() {
                let reason = "the controller's encoder reads the rack against the support, whose displacement is not known";
                return Err(scene.key(&format!("device.{index}.{name}")).conflict(reason).into());
            }
        }
        let ground = scene.ground_motions()?;
        let controller = scene.file.controller.clone().unwrap_or_default();
        let suite = scene.loop_sensors(&controller, &pairs)?;
        Ok(LoopScene { scene, ground, controller, suite, pairs })
    }

    /// The loop over device `index` with sensors of this `seed`.
    pub fn task<'a>(&'a self, index: usize, seed: u64, interrupt: &'a Interrupt) -> LoopTask<'a> {
        let LoopScene { scene, ground, controller, suite, .. } = self;
        LoopTask { scene, ground, index, controller, suite, seed, closeness: None, interrupt }
    }

    /// The same without `[checks]`, for loops of which nobody asks what their devices bear.
    #[must_use]
    pub fn unchecked(&self) -> LoopScene {
        let mut desk = self.clone();
        desk.scene.file.checks = None;
        desk
    }

    /// The scene as it was run, for a summary.
    pub fn resolved(&self) -> SceneFile {
        SceneFile { controller: Some(self.controller.clone()), ..self.scene.file.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_without_a_loop_are_refused_by_key() {
        let scene = |change: &str| {
            let text = "block = { size_m = 2.0, slenderness_deg = 10.0 }
                device = [{ kind = 'none' }, { kind = 'clutched-pair', mass_ratio = 0.5, engagement = 'rigid' }]
                ground = [{ motion = 'sine', amplitude_g = 0.3, frequency_hz = 1.0 }]";
            LoopScene::new(Scene::parse_with(text, "scene", &[change]).unwrap())
        };
        assert_eq!(scene("title=pier").unwrap().pairs, [1]);
        for (change, refusal) in [
            ("device.1=", "scene: device is missing: "),
            ("block.initial_rotation_ratio=0.5", "scene: block.initial_rotation_ratio is 0.5, but must be 0"),
            ("block.initial_velocity_ratio=-1", "scene: block.initial_velocity_ratio is -1, but must be 0"),
            ("device.1.engagement=overrunning", "scene: device.1.engagement: "),
            (
                "device.1={ kind='clutched-pair', mass_ratio=0.5, support_amplification=1.1 }",
                "scene: device.1.support_amplification: ",
            ),
            (
                "device.1={ kind='clutched-pair', mass_ratio=0.5, support_frequency_hz=5, support_damping_ratio=0.05 }",
                "scene: device.1.support_frequency_hz: ",
            ),
        ] {
            let error = scene(change).unwrap_err().to_string();
            assert!(error.starts_with(refusal), "{error}");
        }
        let text =
            "block = { size_m = 2.0, slenderness_deg = 10.0, foundation = { vertical_frequency_hz = 8.0, damping_ratio = 0.3 } }
            device = [{ kind = 'clutched-pair', mass_ratio = 0.5 }]
            ground = [{ motion = 'sine', amplitude_g = 0.3, frequency_hz = 1.0 }]";
        let error = LoopScene::new(Scene::parse(text, "scene").unwrap()).unwrap_err().to_string();
        assert_eq!(error, "scene: block.foundation: a controller follows a block on rigid ground");
    }
}
