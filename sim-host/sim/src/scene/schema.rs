//! The keys of a scene file, as TOML has them.

use std::sync::LazyLock;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_with::skip_serializing_none;
use sprag_shared::structure::block::{Block, GRAVITY, Geometry, RECTANGLE_INERTIA_RATIO};
use sprag_shared::structure::{Base, REST_SPEED, Restitution, RestitutionScatter};

pub use super::accuracy::{AccuracyTable, EventTreatment, MethodName, Precision};
use super::checks::ChecksTable;
use super::controller::ControllerTable;
pub use super::device::{DeviceTable, Kind, KinematicsName, MountName};
use super::error::{KeyPath, SceneError};
use super::foundation::FoundationTable;
use super::ground::GroundTable;
use super::map::MapTable;
use crate::keys::{Described, schema_of};

/// Default of `run.free_time_ratio`, in 1/p.
pub const FREE_TIME_RATIO: f64 = 20.0;

/// Makes the [`KeyPath`] of a name.
pub type KeyOf<'a> = dyn Fn(&str) -> KeyPath + 'a;

/// A scene file.
#[skip_serializing_none]
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "Sprag scene")]
pub struct SceneFile {
    /// Title of pictures and tables.
    #[serde(default)]
    pub title: String,
    /// The block that rocks.
    pub block: BlockTable,
    /// Devices, one run each.
    #[serde(default)]
    #[schemars(length(min = 1, max = super::MOST_DEVICES))]
    pub device: Vec<DeviceTable>,
    /// Horizontal ground motions, which are summed.
    #[serde(default)]
    pub ground: Vec<GroundTable>,
    /// Vertical ground motions, positive upwards, which are summed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub vertical: Vec<GroundTable>,
    /// How long the motion is followed.
    #[serde(default)]
    pub run: RunTable,
    /// How accurately the motion is followed.
    #[serde(default)]
    pub accuracy: AccuracyTable,
    /// Checks of what a device demands of its support and gears; the table turns them on.
    pub checks: Option<ChecksTable>,
    /// Controller of the clutches, for `sprag loop`.
    pub controller: Option<ControllerTable>,
    /// Axes of an overturning map, for `sprag map`.
    pub map: Option<MapTable>,
    /// What is written.
    #[serde(default)]
    pub output: OutputTable,
}

impl Described for SceneFile {
    fn schema() -> &'static serde_json::Value {
        static SCHEMA: LazyLock<serde_json::Value> = LazyLock::new(schema_of::<SceneFile>);
        &SCHEMA
    }

    fn stranger(key: &str) -> Option<&'static str> {
        let of_study = "scene records record structure scale stripes measures demand fragility bootstrap optimise";
        let whose = "a key of studies, which `sprag cloud` and `sprag optimise` take, and none of scenes";
        of_study.split(' ').any(|name| name == key).then_some(whose)
    }
}

/// `[block]`.
#[skip_serializing_none]
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BlockTable {
    /// Size R, from a toe to the centre of mass; or give `frequency_parameter_1_s`.
    #[schemars(range(min = 1e-3, max = 1e4))]
    pub size_m: Option<f64>,
    /// Frequency parameter p = √(g/(λR)); or give `size_m`.
    #[schemars(range(min = 1e-2, max = 1e3))]
    pub frequency_parameter_1_s: Option<f64>,
    /// Slenderness α, the angle between the vertical and the line from a toe to the centre of mass.
    #[schemars(extend("exclusiveMinimum" = 0.0, "exclusiveMaximum" = 90.0))]
    pub slenderness_deg: f64,
    /// Moment of inertia about a toe, λ = I_O/(mR²); 4/3 of a rectangle.
    #[serde(default = "rectangle")]
    #[schemars(range(min = 1.0, max = 4.0))]
    pub inertia_ratio: f64,
    /// Mass m; needed by values in kg, N, N/m and N s/m.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub mass_kg: Option<f64>,
    /// Equation of motion.
    #[serde(default)]
    pub geometry: GeometryName,
    /// Ratio η of the angular velocities after and before an impact, or where it comes from.
    #[serde(default = "paper_restitution")]
    pub restitution: RestitutionValue,
    /// Standard deviation of η from impact to impact: normal about `restitution`, truncated to 0 < η ≤ 1.
    #[schemars(range(min = 0.0, max = 0.5), extend("default" = 0.0))]
    pub restitution_scatter: Option<f64>,
    /// Seed of what impacts draw; of several specimens that of the first.
    #[schemars(extend("default" = 0))]
    pub restitution_seed: Option<u64>,
    /// Coefficient of friction μ under a block without a device, static and kinetic; without it the base never slides.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 10.0))]
    pub friction_coefficient: Option<f64>,
    /// Compliant base: a spring and a dashpot under each toe; rigid ground without it.
    pub foundation: Option<FoundationTable>,
    /// Rotation at the start, θ/α.
    #[serde(default)]
    #[schemars(range(min = -10.0, max = 10.0))]
    pub initial_rotation_ratio: f64,
    /// Angular velocity at the start, θ̇/(pα).
    #[serde(default)]
    #[schemars(range(min = -100.0, max = 100.0))]
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum GeometryName {
    /// The exact block, Eq. 15-16.
    #[default]
    Full,
    /// Its linearisation for small angles, Eq. 17-18.
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "restitution must be a number from 0 to 1, \"geometric\" or \"momentum-balance\"")]
pub enum RestitutionValue {
    /// η.
    Number(#[schemars(range(min = 0.0, max = 1.0))] f64),
    /// By the geometry of the block, 1 − 2 sin²α/λ, or by the moment of momentum with what stays engaged.
    #[schemars(extend("enum" = ["geometric", "momentum-balance"]))]
    Word(String),
}

impl BlockTable {
    /// The block.
    ///
    /// # Errors
    /// [`SceneError`] names the key.
    pub fn block(&self, key: &KeyOf<'_>) -> Result<Block, SceneError> {
        let ratio = self.inertia_ratio;
        let size = match (self.size_m, self.frequency_parameter_1_s) {
            (Some(size), None) => size,
            (None, Some(p)) => GRAVITY / (ratio * p * p),
            (None, None) => return Err(key("block.size_m").missing("size_m or frequency_parameter_1_s")),
            _ => {
                return Err(key("block.size_m")
                    .conflict("give only one of size_m and frequency_parameter_1_s; --set KEY= leaves a key out"));
            }
        };
        Block::new(size, self.slenderness_deg.to_radians(), ratio).map_err(|error| key("block").parameter(&error))
    }

    /// How it takes impacts.
    ///
    /// # Errors
    /// [`SceneError`] for an unknown word.
    pub fn restitution(&self, key: &KeyOf<'_>) -> Result<Restitution, SceneError> {
        match &self.restitution {
            RestitutionValue::Number(eta) => Ok(Restitution::Constant(*eta)),
            RestitutionValue::Word(word) if word == "geometric" => Ok(Restitution::Geometric),
            RestitutionValue::Word(word) if word == "momentum-balance" => Ok(Restitution::MomentumBalance),
            RestitutionValue::Word(word) => Err(key("block.restitution")
                .outside(format!("{word:?}"), "a number from 0 to 1, \"geometric\" or \"momentum-balance\"")),
        }
    }
}

impl BlockTable {
    /// How impacts differ. A seed of nothing is no effect.
    pub fn scatter(&self) -> RestitutionScatter {
        match self.restitution_scatter.unwrap_or(0.0) {
            0.0 => RestitutionScatter::NONE,
            deviation => RestitutionScatter { deviation, seed: self.restitution_seed.unwrap_or(0) },
        }
    }

    /// What the block stands on.
    pub fn base(&self) -> Base {
        match (self.foundation, self.friction_coefficient) {
            (Some(foundation), _) => Base::Compliant(foundation.into()),
            (None, Some(friction)) => Base::Friction(friction),
            (None, None) => Base::Rigid,
        }
    }
}

/// `[run]`.
#[skip_serializing_none]
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RunTable {
    /// Time after the ground motion; or give `free_time_ratio`.
    #[schemars(range(min = 0.0, max = 1e5))]
    pub free_time_s: Option<f64>,
    /// Time after the ground motion, in 1/p; or give `free_time_s`.
    #[schemars(range(min = 0.0, max = 1e5), extend("default" = FREE_TIME_RATIO))]
    pub free_time_ratio: Option<f64>,
    /// Angular velocity θ̇/(pα) below which an impact may end in rest.
    #[serde(default = "rest_speed")]
    #[schemars(range(min = 1e-12, max = 1e-2))]
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
        Ok(())
    }
}

/// The time axis of pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TimeAxisName {
    /// t, s.
    #[default]
    Seconds,
    /// p t.
    FrequencyParameter,
}

/// `[output]`.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OutputTable {
    /// Time between samples of the history and of the energy ledger; 1/2000 of the run without the key.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-6, max = 10.0))]
    pub interval_s: Option<f64>,
    /// Time axis of pictures.
    #[serde(default)]
    pub time_axis: TimeAxisName,
    /// Whether the energy ledger is kept and plotted.
    #[serde(default)]
    pub energy: bool,
}
