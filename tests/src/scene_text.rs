//! Scenes as text.

use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::Scene;
use sprag_sim::simulation::{DeviceRun, simulate};

/// No device, an inerter and an ideal pair.
pub const IDEAL_DEVICES: &str = r#"
[[device]]
kind = "none"
[[device]]
kind = "inerter"
mass_ratio = 0.5
[[device]]
kind = "clutched-pair"
mass_ratio = 0.5
"#;

/// A pair of rigid clutches.
pub const RIGID_PAIR: &str = r#"
[[device]]
kind = "clutched-pair"
name = "rigid pair"
mass_ratio = 0.5
engagement = "rigid"
"#;

/// The runs of a scene, one a device.
///
/// # Panics
/// If it is no scene, or a run does not end.
pub fn runs(text: &str) -> Vec<DeviceRun> {
    run(&Scene::parse(text, "scene.toml").expect("a scene"))
}

/// The same of one that has been read.
///
/// # Panics
/// If a run does not end.
pub fn run(scene: &Scene) -> Vec<DeviceRun> {
    let ground = scene.ground_motions().expect("a motion");
    simulate(scene, &ground, &Interrupt::default()).expect("a run")
}
