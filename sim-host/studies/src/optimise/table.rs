//! `[optimise]`: the keys of a study file for the choice of a device.

use serde::{Deserialize, Serialize};
use sprag_sim::scene::SceneError;
use sprag_sim::scene::map::{AxisTable, ScaleName};
use sprag_sim::scene::schema::KeyOf;

use super::mount::MountEntry;

/// Most mass ratios of the first grid.
pub const MOST_CELLS: usize = 1000;

/// Most laws, and most mounts.
pub const MOST_CHOICES: usize = 32;

/// Largest mass ratio, as for any device.
pub const LARGEST_MASS_RATIO: f64 = 10_000.0;

/// `[optimise]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct OptimiseTable {
    /// The structure of the study that gets the device; needed where there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub structure: Option<String>,
    /// Mass ratios to choose from.
    pub mass_ratio: MassRatioTable,
    /// Clutch laws: devices of the scene by name, or "inerter", "clutched-pair", "rigid", "overrunning". All devices of the scene
    /// that have an inerter by default.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub laws: Vec<String>,
    /// Mounts; those that the laws have in the scene by default.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub mounts: Vec<MountEntry>,
    /// Largest |F|/(mg) of the device; that of the scene's `[checks]` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_force_ratio: Option<f64>,
    /// Largest travel of the terminals to one side (m), over the motions in which the block stands; that of the scene's `[checks]` by
    /// default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_stroke_m: Option<f64>,
    /// Share of the motions that must respect a limit.
    pub limit_quantile: f64,
    /// Whether the force counts under motions that overturn the block, until it lies down.
    pub force_of_overturned: bool,
}

/// `mass_ratio = { from, to, cells }`, in equal factors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MassRatioTable {
    /// The least.
    pub from: f64,
    /// The largest.
    pub to: f64,
    /// How many at first, with both ends.
    #[serde(default = "cells")]
    pub cells: usize,
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
            largest_force_ratio: None,
            largest_stroke_m: None,
            limit_quantile: 1.0,
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
        let MassRatioTable { from, to, cells } = self.mass_ratio;
        let allowed = from > 0.0 && from <= LARGEST_MASS_RATIO;
        key("mass_ratio.from").require(from, allowed, "above 0, to 10000")?;
        key("mass_ratio.to").require(to, to > from && to <= LARGEST_MASS_RATIO, "above `from`, to 10000")?;
        key("mass_ratio.cells").require(cells as f64, (2..=MOST_CELLS).contains(&cells), "from 2 to 1000")?;
        for (name, count) in [("laws", self.laws.len()), ("mounts", self.mounts.len())] {
            if count > MOST_CHOICES {
                return Err(key(name).range(count as f64, "a list of at most 32"));
            }
        }
        let limits = [
            ("largest_force_ratio", self.largest_force_ratio, 1e6, "above 0, to 1e6"),
            ("largest_stroke_m", self.largest_stroke_m, 1e4, "above 0, to 10000 m"),
        ];
        for (name, limit, most, range) in limits {
            if let Some(limit) = limit {
                key(name).require(limit, limit > 0.0 && limit <= most, range)?;
            }
        }
        let share = self.limit_quantile;
        key("limit_quantile").require(share, (0.0..=1.0).contains(&share), "from 0 to 1")?;
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
