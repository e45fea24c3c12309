//! The groups of keys beyond the ideal device at its mount: each value over what it is dimensionless by.

use std::f64::consts::TAU;

use serde_json::Value;
use sprag_shared::structure::block::GRAVITY;
use sprag_sim::scene::Scene;

/// Keys of a block that p, α, λ, η, the start and the unit of a_g stand for.
pub const OF_BLOCK: [&str; 9] = [
    "size_m",
    "frequency_parameter_1_s",
    "slenderness_deg",
    "inertia_ratio",
    "geometry",
    "mass_kg",
    "restitution",
    "initial_rotation_ratio",
    "initial_velocity_ratio",
];

/// Keys of a device that its kind, σ, ℓ and the groups of its support stand for.
pub const OF_DEVICE: [&str; 12] = [
    "kind",
    "name",
    "mass_ratio",
    "inertance_kg",
    "flywheels",
    "mount",
    "mount_height_m",
    "pulley_ratio",
    "support_amplification",
    "support_frequency_hz",
    "support_damping_ratio",
    "support_record",
];

/// What makes the keys of a block dimensionless.
pub struct Scales {
    /// 1/s.
    p: f64,
    /// m.
    size: f64,
    /// kg.
    mass: f64,
    /// α, or tan α, of the uplift threshold.
    threshold: f64,
}

impl Scales {
    /// Of the block of `scene`.
    pub fn of(scene: &Scene) -> Scales {
        Scales {
            p: scene.block.frequency_parameter(),
            size: scene.block.size(),
            mass: scene.file.block.mass_kg.unwrap_or(1.0),
            threshold: scene.uplift_threshold(),
        }
    }

    /// The value of `key` by the unit at its end: times over 1/p, travels over Rα, forces over mgα.
    fn group(&self, key: &str, value: f64) -> f64 {
        let Scales { p, size, mass, threshold } = *self;
        let by_unit = [
            ("_1_s", 1.0 / p),
            ("_n_s_m", 1.0 / (mass * p)),
            ("_n_m", 1.0 / (mass * p * p)),
            ("_m_s2", 1.0 / (GRAVITY * threshold)),
            ("_n", 1.0 / (mass * GRAVITY * threshold)),
            ("_kg", 1.0 / mass),
            ("_m", 1.0 / (size * threshold)),
            ("_hz", TAU / p),
            ("_s", p),
            ("capacity_ratio", 1.0 / threshold),
            ("dry_friction_ratio", 1.0 / threshold),
            ("friction_coefficient", 1.0 / threshold),
        ];
        let factor = by_unit.into_iter().find(|(unit, _)| key.ends_with(unit)).map_or(1.0, |(_, factor)| factor);
        factor * value
    }

    /// The groups of the keys of `table` but for those of `known`: a number by its key, and a word as part of its name. What is 0 is not there.
    pub fn groups(&self, table: &Value, known: &[&str]) -> Vec<(String, Option<f64>)> {
        let mut found = Vec::new();
        self.collect(table, "", known, &mut found);
        found
    }

    fn collect(&self, value: &Value, key: &str, known: &[&str], found: &mut Vec<(String, Option<f64>)>) {
        match value {
            Value::Object(table) => {
                for (name, value) in table.iter().filter(|(name, _)| !known.contains(&name.as_str())) {
                    let key = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
                    // Names below a table are its own.
                    self.collect(value, &key, &[], found);
                }
            }
            Value::Number(number) => {
                let number = number.as_f64().filter(|number| *number != 0.0);
                found.extend(number.map(|number| (key.to_owned(), Some(self.group(key, number)))));
            }
            Value::String(word) => found.push((format!("{key} = {word}"), None)),
            Value::Bool(true) => found.push((key.to_owned(), None)),
            Value::Null | Value::Bool(false) | Value::Array(_) => {}
        }
    }
}
