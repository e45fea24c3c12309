//! The effects that a scene may ask for: what each is, its equation and source, its keys, and whether a scene turns it on.

pub mod block;
pub mod coupling;
pub mod device;
pub mod explanation;
pub mod measured;
pub mod motion;
pub mod number;
pub mod output;
pub mod rules;

use std::sync::LazyLock;

use crate::keys::list::keys;
use crate::keys::{Described, Key};
use crate::scene::Scene;
use crate::scene::schema::SceneFile;

/// An effect.
#[derive(Clone, Copy, Debug)]
pub struct Effect {
    /// Name of the effect.
    pub name: &'static str,
    /// What it adds, in one line.
    pub summary: &'static str,
    /// The equation that it adds or changes; lines.
    pub equation: &'static [&'static str],
    /// Where that comes from.
    pub source: &'static str,
    /// The paths of its keys in a scene; `N` is the number of a table.
    pub keys: &'static [&'static str],
    /// Whether a scene turns it on for device number n, which the scene has.
    pub is_on: fn(&Scene, usize) -> bool,
}

/// All of them, in the order of the way from the ground to the flywheels and out.
pub const EFFECTS: [&Effect; 18] = [
    &block::GEOMETRY,
    &block::VERTICAL,
    &block::IMPACT,
    &block::SCATTER,
    &block::SLIDING,
    &block::FOUNDATION,
    &device::MOUNT,
    &device::SUPPORT,
    &device::KINEMATICS,
    &device::WEIGHT,
    &device::RACK,
    &coupling::ENGAGEMENT,
    &coupling::CLUTCH,
    &coupling::SLIP,
    &coupling::ACTUATION,
    &coupling::FLYWHEEL,
    &output::CHECKS,
    &output::ENERGY,
];

/// The effect of that name.
pub fn find(name: &str) -> Option<&'static Effect> {
    EFFECTS.into_iter().find(|effect| effect.name == name)
}

impl Effect {
    /// Descriptions of the keys of the effect.
    pub fn described_keys(&self) -> impl Iterator<Item = &'static Key> {
        described(self.keys)
    }

    /// Each device has its own; otherwise it is the whole scene's.
    pub fn of_device(&self) -> bool {
        self.keys.iter().all(|key| key.starts_with("device.N."))
    }

    /// The keys and values by which `scene` turns it on for device number `index`, which the scene has; `None` while it is off.
    pub fn setting(&self, scene: &Scene, index: usize) -> Option<String> {
        (self.is_on)(scene, index).then(|| match (self.name, settings(scene, index, self.keys)) {
            ("vertical", _) => match scene.file.vertical.len() {
                1 => "one [[vertical]] table".to_owned(),
                several => format!("{several} [[vertical]] tables, summed"),
            },
            ("checks", set) if set.is_empty() => "[checks]".to_owned(),
            ("kinematics", set) if set.is_empty() => match scene.devices[index].drivetrain.support.moves() {
                true => format!("the clutches of device.{index} follow its support"),
                false => format!("device.{index} has flywheels with a speed of their own"),
            },
            (_, set) => set,
        })
    }
}

/// `paths` of a scene, described.
fn described(paths: &'static [&'static str]) -> impl Iterator<Item = &'static Key> {
    static KEYS: LazyLock<Vec<Key>> = LazyLock::new(|| keys(SceneFile::schema()));
    paths.iter().filter_map(|path| KEYS.iter().find(|key| key.path == *path))
}

/// Those of `keys` that `scene` sets to something else than their defaults, for device number `index`: `key = value, …`.
fn settings(scene: &Scene, index: usize, keys: &'static [&'static str]) -> String {
    let Ok(file) = serde_json::to_value(&scene.file) else {
        return String::new();
    };
    let set = described(keys).filter_map(|key| {
        let name = key.path.replacen('N', &index.to_string(), 1);
        let value = name.split('.').try_fold(&file, |value, part| match part.parse::<usize>() {
            Ok(index) => value.get(index),
            Err(_) => value.get(part),
        })?;
        (!is_default(value, &key.default_text())).then(|| format!("{name} = {value}"))
    });
    set.collect::<Vec<_>>().join(", ")
}

fn is_default(value: &serde_json::Value, default: &str) -> bool {
    match (value.as_f64(), default.parse::<f64>()) {
        (Some(number), Ok(default)) => number == default,
        _ => default.parse().is_ok_and(|default: serde_json::Value| *value == default),
    }
}

#[cfg(test)]
mod tests;
