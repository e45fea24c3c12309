//! Clutch laws: what an inerter may be, but for its size and its place.

use sprag_sim::scene::controller::{ControllerTable, LawName};
use sprag_sim::scene::device::{DeviceTable, Kind};
use sprag_sim::scene::drivetrain::EngagementName;
use sprag_sim::scene::error::KeyPath;
use sprag_sim::scene::{Scene, SceneError};

/// A device without its mass ratio: its kind, its clutch, and all else that a `[[device]]` says.
#[derive(Clone, Debug)]
pub struct Law {
    /// In tables and legends.
    pub name: String,
    /// The device; its mass ratio is left out.
    pub device: DeviceTable,
    /// The controller that drives its clutches; Eq. 10 does without one.
    pub controller: Option<ControllerTable>,
}

/// Before the name of a controller's law.
pub const CONTROLLER: &str = "controller:";

/// Names of laws that need no device of the scene.
pub const IDEAL_LAWS: [&str; 4] = ["inerter", "clutched-pair", "rigid", "overrunning"];

/// The laws called `names`, or all of `scene` that have an inerter where there are no names. A device of the scene goes before an
/// ideal law of the same name.
///
/// # Errors
/// [`SceneError`] at `key` for a name that is neither, one that is there twice, a device without an inerter, and a scene without one.
pub(super) fn laws(names: &[String], scene: &Scene, key: &KeyPath) -> Result<Vec<Law>, SceneError> {
    let devices = || scene.devices.iter().map(|device| device.name.as_str()).zip(&scene.file.device);
    if names.is_empty() {
        let laws: Vec<Law> =
            devices().filter(|(_, table)| table.kind != Kind::None).map(|(name, table)| law(name, table.clone())).collect();
        if laws.is_empty() {
            let reason = format!("{}, for the scene has no device with an inerter", IDEAL_LAWS.join(", "));
            return Err(key.clone().missing(&format!("a list of clutch laws among {reason}")));
        }
        return Ok(laws);
    }
    let mut laws: Vec<Law> = Vec::new();
    for (index, name) in names.iter().enumerate() {
        let key = || KeyPath { origin: key.origin.clone(), key: format!("{}.{index}", key.key) };
        if laws.iter().any(|law| law.name == *name) {
            return Err(key().conflict(&format!("\"{name}\" is there twice")));
        }
        if let Some(word) = name.strip_prefix(CONTROLLER) {
            laws.push(controlled(name, word, scene, &key())?);
            continue;
        }
        let of_scene = devices().find(|(of_device, _)| of_device == name).map(|(_, table)| table.clone());
        let device = of_scene.or_else(|| ideal(name)).ok_or_else(|| {
            let known = devices().filter(|(_, table)| table.kind != Kind::None).map(|(name, _)| format!("\"{name}\""));
            let ideal = IDEAL_LAWS.iter().map(|name| format!("\"{name}\""));
            let mut all: Vec<String> = ideal.chain(controlled_names()).collect();
            all.extend(known.filter(|name| !all.contains(name)).collect::<Vec<_>>());
            key().outside(format!("{name:?}"), &format!("among {}", all.join(", ")))
        })?;
        if device.kind == Kind::None {
            return Err(key().conflict(&format!("the device \"{name}\" of the scene has no inerter")));
        }
        laws.push(law(name, device));
    }
    Ok(laws)
}

/// Names of the laws of a controller, as messages show them.
fn controlled_names() -> impl Iterator<Item = String> {
    LawName::ALL.iter().map(|law| format!("\"{CONTROLLER}{}\"", law.name()))
}

/// The controller of `scene` by its law `word`, which drives the first pair of the scene that takes commands, or a rigid one.
fn controlled(name: &str, word: &str, scene: &Scene, key: &KeyPath) -> Result<Law, SceneError> {
    let Some(found) = LawName::ALL.into_iter().find(|law| law.name() == word) else {
        let names = controlled_names().collect::<Vec<_>>().join(", ");
        return Err(key.clone().outside(format!("{name:?}"), &format!("among {names}")));
    };
    let block = &scene.file.block;
    if block.initial_rotation_ratio != 0.0 || block.initial_velocity_ratio != 0.0 {
        return Err(key.clone().conflict("a controller calibrates itself at rest: the scene begins in motion"));
    }
    scene.check_loop_base()?;
    let commanded = scene.devices.iter().zip(&scene.file.device).find(|(device, _)| device.takes_commands());
    let rigid = || DeviceTable { engagement: Some(EngagementName::Rigid), ..DeviceTable::of(Kind::ClutchedPair) };
    let device = commanded.map_or_else(rigid, |(_, table)| table.clone());
    let own = scene.file.controller.clone().unwrap_or_default();
    let controller = ControllerTable { law: found, sign_table: own.sign_table.filter(|_| found == LawName::SignTable), ..own };
    Ok(Law { controller: Some(controller), ..law(name, device) })
}

/// A law of `device`, whose size is left open.
fn law(name: &str, device: DeviceTable) -> Law {
    Law {
        controller: None,
        name: name.to_owned(),
        device: DeviceTable { name: Some(name.to_owned()), mass_ratio: None, inertance_kg: None, flywheels: None, ..device },
    }
}

/// The ideal law of this name.
fn ideal(name: &str) -> Option<DeviceTable> {
    let pair = |engagement| DeviceTable { engagement: Some(engagement), ..DeviceTable::of(Kind::ClutchedPair) };
    match name {
        "inerter" => Some(DeviceTable::of(Kind::Inerter)),
        "clutched-pair" => Some(DeviceTable::of(Kind::ClutchedPair)),
        "rigid" => Some(pair(EngagementName::Rigid)),
        "overrunning" => Some(pair(EngagementName::Overrunning)),
        _ => None,
    }
}
