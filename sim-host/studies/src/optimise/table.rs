//! `[optimise]`: the keys of a study file for the choice of a device.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_with::skip_serializing_none;
use sprag_sim::scene::SceneError;
use sprag_sim::scene::map::{AxisTable, ScaleName};
use sprag_sim::scene::schema::KeyOf;

use super::mount::MountEntry;
use super::pulse::PulseTable;
use super::setting::SettingTable;

/// Most mass ratios of the first grid.
pub const MOST_CELLS: usize = 1000;

/// Most laws, and most mounts.
pub const MOST_CHOICES: usize = 32;

/// Most specimens of a robust study.
pub const MOST_SPECIMENS: u32 = 1000;

/// Largest mass ratio, as for any device.
pub const LARGEST_MASS_RATIO: f64 = 10_000.0;

/// Two laws without a device of the scene.
const EXAMPLE_LAWS: [&str; 2] = ["inerter", "clutched-pair"];

/// Two delays, s.
const EXAMPLE_DELAYS: [f64; 2] = [0.01, 0.02];

/// `[optimise]`.
#[skip_serializing_none]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct OptimiseTable {
    /// Structure of the study that gets the device, by name; needed where there are several.
    #[schemars(example = &"taller")]
    pub structure: Option<String>,
    /// Mass ratios to choose from, in equal factors.
    pub mass_ratio: MassRatioTable,
    /// Clutch laws: devices of the scene by name, or "inerter", "clutched-pair", "rigid", "overrunning", and "controller:" with the law
    /// of a controller; all devices of the scene with an inerter without the key.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = MOST_CHOICES), example = EXAMPLE_LAWS)]
    pub laws: Vec<String>,
    /// Mounts to choose from; those that the laws have in the scene without the key.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = MOST_CHOICES))]
    pub mounts: Vec<MountEntry>,
    /// Settings of clutches and controllers to choose from.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub setting: Vec<SettingTable>,
    /// Delays by which the clutches of the chosen device are made later, rising: what is left of its advantage is the delay budget.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(inner(range(max = 10.0)), transform = crate::cloud::study_file::each_above_zero, length(max = 100), example = EXAMPLE_DELAYS)]
    pub delays_s: Vec<f64>,
    /// Pulses, beside or in the place of records: the keys of a `[[ground]]`, each with a list of values.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub pulse: Vec<PulseTable>,
    /// Largest |F|/(mg) of the device on its support; that of the scene's `[checks]` without the key.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 1e6))]
    pub largest_force_ratio: Option<f64>,
    /// Largest travel of the terminals to one side, over the motions in which the block stands; that of the scene's `[checks]` without the
    /// key.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 1e4))]
    pub largest_stroke_m: Option<f64>,
    /// Largest bending stress at the root of a gear tooth; that of the scene's `checks.gear` without the key, which it needs.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 1e5))]
    pub largest_tooth_stress_mpa: Option<f64>,
    /// Largest energy of the coils of both clutches over a motion; that of the scene's `checks.coil` without the key, which it needs.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 1e9))]
    pub largest_coil_energy_j: Option<f64>,
    /// Share of the motions that must respect a limit.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub limit_quantile: f64,
    /// Tries every design under a scatter of block and controller; the table turns it on.
    pub robust: Option<RobustTable>,
    /// Whether force, tooth stress and coil energy count under motions that overturn the block, until it lies down.
    pub force_of_overturned: bool,
}

/// `mass_ratio = { from, to, cells }`, in equal factors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MassRatioTable {
    /// Least mass ratio.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = LARGEST_MASS_RATIO))]
    pub from: f64,
    /// Largest mass ratio, above `from`.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = LARGEST_MASS_RATIO))]
    pub to: f64,
    /// Mass ratios of the first grid, both ends included.
    #[serde(default = "cells")]
    #[schemars(range(min = 2, max = MOST_CELLS))]
    pub cells: usize,
}

/// `[optimise.robust]`. Widths are relative: factors are uniform between 1 − width and 1 + width.
#[skip_serializing_none]
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RobustTable {
    /// Specimens of block and controller, the same for every design; each meets every motion.
    #[schemars(range(min = 1, max = MOST_SPECIMENS))]
    pub samples: u32,
    /// Seed of the specimens.
    pub seed: u64,
    /// Quantile over the specimens of the number of motions that overturn, which is made small; the mean without the key.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub quantile: Option<f64>,
    /// Half-width of the scatter of the restitution η, relative.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub restitution: f64,
    /// Half-width of the scatter of the slenderness α that a controller believes in, relative.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub slenderness_belief: f64,
    /// Half-width of the scatter of the size R that a controller believes in, relative.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub size_belief: f64,
    /// Half-width of the scatter of the mass ratio σ that a controller believes in, relative.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub mass_ratio_belief: f64,
    /// Half-width of the scatter of the restitution η that a controller believes in, relative.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub restitution_belief: f64,
}

impl Default for RobustTable {
    fn default() -> Self {
        RobustTable {
            samples: 8,
            seed: 1,
            quantile: None,
            restitution: 0.05,
            slenderness_belief: 0.0,
            size_belief: 0.0,
            mass_ratio_belief: 0.0,
            restitution_belief: 0.0,
        }
    }
}

fn cells() -> usize {
    12
}

impl Default for MassRatioTable {
    fn default() -> Self {
        MassRatioTable { from: 0.05, to: 2.0, cells: cells() }
    }
}

impl Default for OptimiseTable {
    fn default() -> Self {
        OptimiseTable {
            structure: None,
            mass_ratio: MassRatioTable::default(),
            laws: Vec::new(),
            mounts: Vec::new(),
            setting: Vec::new(),
            delays_s: Vec::new(),
            pulse: Vec::new(),
            largest_force_ratio: None,
            largest_stroke_m: None,
            largest_tooth_stress_mpa: None,
            largest_coil_energy_j: None,
            limit_quantile: 1.0,
            robust: None,
            force_of_overturned: true,
        }
    }
}

impl OptimiseTable {
    /// Refuses values outside their ranges; `key` makes the place of a key of this table. Laws, mounts and the structure are checked
    /// where they are resolved.
    ///
    /// # Errors
    /// [`SceneError`] names the key, its value and its range.
    pub(super) fn check(&self, key: &KeyOf<'_>) -> Result<(), SceneError> {
        let MassRatioTable { from, to, .. } = self.mass_ratio;
        key("mass_ratio.to").require(to, to > from, "above `from`, to 10000")?;
        if let Some(index) = (1..self.delays_s.len()).find(|&index| self.delays_s[index] <= self.delays_s[index - 1]) {
            return Err(key(&format!("delays_s.{index}")).range(self.delays_s[index], "above the delay before it"));
        }
        Ok(())
    }
}

impl MassRatioTable {
    /// The first grid: `cells` mass ratios in equal factors, the ends exact.
    pub fn grid(&self) -> Vec<f64> {
        let MassRatioTable { from, to, cells } = *self;
        let axis = AxisTable { key: String::new(), from, to, cells, scale: ScaleName::Logarithmic };
        (0..cells).map(|index| axis.value(index)).collect()
    }
}
