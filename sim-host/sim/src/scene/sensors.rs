//! `sensors` of `[controller]`: what the controller's sensors are, as parts by name, with single figures of one's own.

mod encoder;
mod inertial;
mod name_or;
mod sampling;
#[cfg(test)]
mod tests;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_with::skip_serializing_none;

use super::error::SceneError;
use super::schema::KeyOf;
use crate::sensor::preset::{self, Preset};
use crate::sensor::{Inertial, Suite};

pub use encoder::EncoderTable;
pub use inertial::{AccelerometerTable, GyroscopeTable};
pub use name_or::NameOr;

/// Seed unless a scene has another.
const SEED: u64 = 1;

/// `sensors`. Without any key all sensors are ideal.
#[skip_serializing_none]
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SensorsTable {
    /// All sensors by one name; each can be replaced by the keys below.
    #[schemars(example = &"icm-42688-p", extend("enum" = preset::names(preset::SUITES).collect::<Vec<_>>()))]
    pub suite: Option<String>,
    /// Gyroscope on the block, by name or by table.
    pub gyroscope: Option<NameOr<GyroscopeTable>>,
    /// Accelerometers on the block, by name or by table.
    pub block_accelerometer: Option<NameOr<AccelerometerTable>>,
    /// Accelerometer on the ground, by name or by table.
    pub ground_accelerometer: Option<NameOr<AccelerometerTable>>,
    /// Encoder on the rack, by name or by table.
    pub encoder: Option<NameOr<EncoderTable>>,
    /// Seed of errors and noise.
    #[schemars(extend("default" = SEED))]
    pub seed: Option<u64>,
}

impl SensorsTable {
    /// The sensors, in SI units. Keys in messages are `sensors.…`.
    ///
    /// # Errors
    /// [`SceneError`] names the key.
    pub fn resolve(&self, key: &KeyOf<'_>) -> Result<Suite, SceneError> {
        let suite = match &self.suite {
            Some(name) => find(preset::SUITES, name, "sensors.suite", key)?,
            None => Suite::IDEAL,
        };
        let gyroscope = part(self.gyroscope.as_ref(), suite.gyroscope, "sensors.gyroscope", key)?;
        let accelerometer =
            |table: &Option<NameOr<AccelerometerTable>>, start: Inertial, place: &str| part(table.as_ref(), start, place, key);
        Ok(Suite {
            gyroscope,
            block_accelerometer: accelerometer(
                &self.block_accelerometer,
                suite.block_accelerometer,
                "sensors.block_accelerometer",
            )?,
            ground_accelerometer: accelerometer(
                &self.ground_accelerometer,
                suite.ground_accelerometer,
                "sensors.ground_accelerometer",
            )?,
            encoder: part(self.encoder.as_ref(), suite.encoder, "sensors.encoder", key)?,
        })
    }

    /// Seed of everything drawn.
    pub fn seed(&self) -> u64 {
        self.seed.unwrap_or(SEED)
    }
}

/// A table that changes a preset.
pub trait Change {
    /// Parameters of a part.
    type Part: Copy + 'static;
    /// Parts by name.
    const PRESETS: &'static [Preset<Self::Part>];

    /// Name of the preset that the table starts from.
    fn preset(&self) -> Option<&str>;
    /// `start` with the table's keys; `place` is the table's own key.
    ///
    /// # Errors
    /// [`SceneError`] names the key.
    fn change(&self, start: Self::Part, place: &str, key: &KeyOf<'_>) -> Result<Self::Part, SceneError>;
}

fn part<T: Change>(given: Option<&NameOr<T>>, start: T::Part, place: &str, key: &KeyOf<'_>) -> Result<T::Part, SceneError> {
    match given {
        None => Ok(start),
        Some(NameOr::Name(name)) => find(T::PRESETS, name, place, key),
        Some(NameOr::Table(table)) => {
            let start = match table.preset() {
                Some(name) => find(T::PRESETS, name, &format!("{place}.preset"), key)?,
                None => start,
            };
            table.change(start, place, key)
        }
    }
}

fn find<P: Copy>(presets: &'static [Preset<P>], name: &str, place: &str, key: &KeyOf<'_>) -> Result<P, SceneError> {
    preset::find(presets, name).ok_or_else(|| {
        let known: Vec<String> = preset::names(presets).map(|name| format!("\"{name}\"")).collect();
        key(place).outside(format!("\"{name}\""), &format!("one of {}", known.join(", ")))
    })
}
