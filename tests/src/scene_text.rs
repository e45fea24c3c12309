//! Scenes as text.

use std::path::Path;

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

/// The run of a scene with one device, whose records are in `folder`.
///
/// # Errors
/// Why it is no scene, or its run does not end.
pub fn run_in(text: &str, folder: &Path) -> Result<DeviceRun, String> {
    let mut scene = Scene::parse(text, "scene.toml").map_err(|error| error.to_string())?;
    scene.folder = folder.to_owned();
    let ground = scene.ground_motions().map_err(|error| error.to_string())?;
    Ok(simulate(&scene, &ground, &Interrupt::default()).map_err(|error| error.to_string())?.remove(0))
}

/// The runs of a scene that has been read.
///
/// # Panics
/// If a run does not end.
pub fn run(scene: &Scene) -> Vec<DeviceRun> {
    let ground = scene.ground_motions().expect("a motion");
    simulate(scene, &ground, &Interrupt::default()).expect("a run")
}
