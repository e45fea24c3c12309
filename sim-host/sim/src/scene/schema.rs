//! The keys of a scene file, as TOML has them.

use serde::{Deserialize, Serialize};
use sprag_shared::structure::block::{Block, GRAVITY, Geometry, RECTANGLE_INERTIA_RATIO};
use sprag_shared::structure::{REST_SPEED, Restitution};

pub use super::accuracy::{AccuracyTable, EventTreatment, MethodName, Precision};
use super::checks::ChecksTable;
use super::controller::ControllerTable;
pub use super::device::{DeviceTable, Kind, KinematicsName, MountName};
use super::error::{Key, SceneError};
use super::ground::GroundTable;
use super::map::MapTable;

/// Default of `run.free_time_ratio`, in 1/p.
pub const FREE_TIME_RATIO: f64 = 20.0;

/// Makes the [`Key`] of a name.
pub type KeyOf<'a> = dyn Fn(&str) -> Key + 'a;

/// A scene file.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// Heading of pictures.
    #[serde(default)]
    pub title: String,
    /// `[block]`.
    pub block: BlockTable,
    /// `[[device]]`, one run each.
    #[serde(default)]
    pub device: Vec<DeviceTable>,
    /// `[[ground]]`, summed.
    #[serde(default)]
    pub ground: Vec<GroundTable>,
    /// `[[vertical]]`, summed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub vertical: Vec<GroundTable>,
    /// `[run]`.
    #[serde(default)]
    pub run: RunTable,
    /// `[accuracy]`.
    #[serde(default)]
    pub accuracy: AccuracyTable,
    /// `[checks]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub checks: Option<ChecksTable>,
    /// `[controller]`, for closed loops.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub controller: Option<ControllerTable>,
    /// `[map]`, for overturning maps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub map: Option<MapTable>,
    /// `[output]`.
    #[serde(default)]
    pub output: OutputTable,
}

/// `[block]`.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BlockTable {
    /// R, m; or give `frequency_parameter_1_s`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub size_m: Option<f64>,
    /// p, 1/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frequency_parameter_1_s: Option<f64>,
    /// α, degrees.
    pub slenderness_deg: f64,
    /// λ = I_O/(mR²).
    #[serde(default = "rectangle")]
    pub inertia_ratio: f64,
    /// m, kg; needed by inertances in kg.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_kg: Option<f64>,
    /// Full or slender.
    #[serde(default)]
    pub geometry: GeometryName,
    /// η, "geometric" or "momentum-balance".
    #[serde(default = "paper_restitution")]
    pub restitution: RestitutionValue,
    /// θ(0)/α.
    #[serde(default)]
    pub initial_rotation_ratio: f64,
    /// θ̇(0)/(pα).
    #[serde(default)]
    pub initial_velocity_ratio: f64,
}

fn rectangle() -> f64 {
    RECTANGLE_INERTIA_RATIO
}

/// η of the paper's examples.
fn paper_restitution() -> RestitutionValue {
    RestitutionValue::Number(0.85)
}

/// Full or slender.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GeometryName {
    /// Eq. 15-16.
    #[default]
    Full,
    /// Eq. 17-18.
    Slender,
}

impl From<GeometryName> for Geometry {
    fn from(name: GeometryName) -> Geometry {
        match name {
            GeometryName::Full => Geometry::Full,
            GeometryName::Slender => Geometry::Slender,
        }
    }
}

/// A number or a word.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "restitution must be a number from 0 to 1, \"geometric\" or \"momentum-balance\"")]
pub enum RestitutionValue {
    /// η.
    Number(f64),
    /// "geometric" or "momentum-balance".
    Word(String),
}

impl BlockTable {
    /// The block.
    ///
    /// # Errors
    /// [`SceneError`] names the key.
    pub fn block(&self, key: &KeyOf<'_>) -> Result<Block, SceneError> {
        let degrees = self.slenderness_deg;
        key("block.slenderness_deg").require(degrees, degrees > 0.0 && degrees < 90.0, "above 0 and below 90 degrees")?;
        let ratio =
            key("block.inertia_ratio").require(self.inertia_ratio, (1.0..=4.0).contains(&self.inertia_ratio), "from 1 to 4")?;
        let size = match (self.size_m, self.frequency_parameter_1_s) {
            (Some(size), None) => key("block.size_m").require(size, (1e-3..=1e4).contains(&size), "from 0.001 to 10000 m")?,
            (None, Some(p)) => {
                key("block.frequency_parameter_1_s").require(p, (1e-2..=1e3).contains(&p), "from 0.01 to 1000 1/s")?;
                GRAVITY / (ratio * p * p)
            }
            (None, None) => return Err(key("block.size_m").missing("size_m or frequency_parameter_1_s")),
            _ => {
                return Err(key("block.size_m")
                    .conflict("give only one of size_m and frequency_parameter_1_s; --set KEY= leaves a key out"));
            }
        };
        if let Some(mass) = self.mass_kg {
            key("block.mass_kg").require(mass, mass > 0.0, "above 0 kg")?;
        }
        let (rotation, velocity) = (self.initial_rotation_ratio, self.initial_velocity_ratio);
        key("block.initial_rotation_ratio").require(rotation, rotation.abs() <= 10.0, "from -10 to 10")?;
        key("block.initial_velocity_ratio").require(velocity, velocity.abs() <= 100.0, "from -100 to 100")?;
        Block::new(size, degrees.to_radians(), ratio).map_err(|error| key("block").parameter(&error))
    }

    /// How it takes impacts.
    ///
    /// # Errors
    /// [`SceneError`] for a number outside 0 to 1 or an unknown word.
    pub fn restitution(&self, key: &KeyOf<'_>) -> Result<Restitution, SceneError> {
        match &self.restitution {
            RestitutionValue::Number(eta) => {
                key("block.restitution").require(*eta, (0.0..=1.0).contains(eta), "from 0 to 1")?;
                Ok(Restitution::Constant(*eta))
            }
            RestitutionValue::Word(word) if word == "geometric" => Ok(Restitution::Geometric),
            RestitutionValue::Word(word) if word == "momentum-balance" => Ok(Restitution::MomentumBalance),
            RestitutionValue::Word(word) => Err(SceneError::Range {
                origin: key("").origin,
                key: "block.restitution".to_owned(),
                value: format!("{word:?}"),
                range: "a number from 0 to 1, \"geometric\" or \"momentum-balance\"".to_owned(),
            }),
        }
    }
}

/// `[run]`.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunTable {
    /// Time after the ground motion, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub free_time_s: Option<f64>,
    /// The same in 1/p.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub free_time_ratio: Option<f64>,
    /// θ̇/(pα) below which an impact may end in rest.
    #[serde(default = "rest_speed")]
    pub rest_speed_ratio: f64,
}

fn rest_speed() -> f64 {
    REST_SPEED
}

impl Default for RunTable {
    fn default() -> Self {
        RunTable { free_time_s: None, free_time_ratio: None, rest_speed_ratio: REST_SPEED }
    }
}

impl RunTable {
    /// # Errors
    /// [`SceneError`] names the key.
    pub(super) fn check(&self, key: &KeyOf<'_>) -> Result<(), SceneError> {
        if self.free_time_s.is_some() && self.free_time_ratio.is_some() {
            return Err(key("run.free_time_s").conflict("give only one of free_time_s and free_time_ratio"));
        }
        for (name, value) in [("run.free_time_s", self.free_time_s), ("run.free_time_ratio", self.free_time_ratio)] {
            if let Some(time) = value {
                key(name).require(time, (0.0..=1e5).contains(&time), "from 0 to 100000")?;
            }
        }
        Ok(())
    }
}

/// The time axis of pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TimeAxisName {
    /// s.
    #[default]
    Seconds,
    /// p t.
    FrequencyParameter,
}

/// `[output]`.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OutputTable {
    /// Time between samples of the history, s; by default 1/2000 of the run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interval_s: Option<f64>,
    /// Seconds or p t.
    #[serde(default)]
    pub time_axis: TimeAxisName,
    /// The energy ledger, plotted.
    #[serde(default)]
    pub energy: bool,
}

impl OutputTable {
    /// # Errors
    /// [`SceneError`] names the key.
    pub(super) fn check(&self, key: &KeyOf<'_>) -> Result<(), SceneError> {
        if let Some(interval) = self.interval_s {
            key("output.interval_s").require(interval, (1e-6..=10.0).contains(&interval), "from 1e-6 to 10 s")?;
        }
        Ok(())
    }
}
