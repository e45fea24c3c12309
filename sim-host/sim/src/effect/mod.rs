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

use crate::scene::Scene;

/// A key that belongs to an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EffectKey {
    /// From the root of a scene, with dots; `N` is the number of a table.
    pub key: &'static str,
    /// Value when absent, as a scene spells it; "-" for none.
    pub default: &'static str,
    /// What it may be.
    pub range: &'static str,
}

/// An effect.
#[derive(Clone, Copy, Debug)]
pub struct Effect {
    /// Its name.
    pub name: &'static str,
    /// What it adds, in one line.
    pub summary: &'static str,
    /// The equation that it adds or changes; lines.
    pub equation: &'static [&'static str],
    /// Where that comes from.
    pub source: &'static str,
    /// Its keys.
    pub keys: &'static [EffectKey],
    /// Each device has its own; otherwise it is the whole scene's.
    pub of_device: bool,
    /// The keys and values by which a scene turns it on for device number n, which the scene has; `None` while it is off.
    pub is_on: fn(&Scene, usize) -> Option<String>,
}

/// All of them, in the order of the way from the ground to the flywheels and out.
pub const EFFECTS: [&Effect; 13] = [
    &block::GEOMETRY,
    &block::VERTICAL,
    &block::IMPACT,
    &device::MOUNT,
    &device::KINEMATICS,
    &device::WEIGHT,
    &device::RACK,
    &coupling::ENGAGEMENT,
    &coupling::CLUTCH,
    &coupling::ACTUATION,
    &coupling::FLYWHEEL,
    &output::CHECKS,
    &output::ENERGY,
];

/// The effect of that name.
pub fn find(name: &str) -> Option<&'static Effect> {
    EFFECTS.into_iter().find(|effect| effect.name == name)
}

/// Those of `keys` that `scene` sets to something else than their defaults, for device number `index`: `key = value, …`.
fn settings(scene: &Scene, index: usize, keys: &[EffectKey]) -> String {
    let Ok(file) = serde_json::to_value(&scene.file) else {
        return String::new();
    };
    let set = keys.iter().filter_map(|key| {
        let name = key.key.replacen('N', &index.to_string(), 1);
        let value = name.split('.').try_fold(&file, |value, part| match part.parse::<usize>() {
            Ok(index) => value.get(index),
            Err(_) => value.get(part),
        })?;
        (!is_default(value, key.default)).then(|| format!("{name} = {value}"))
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
