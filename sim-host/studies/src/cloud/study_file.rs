//! The keys of a study file, as TOML has them.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::measure::Measure;
use crate::optimise::table::OptimiseTable;

/// A study file.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StudyFile {
    /// Heading of tables and pictures.
    #[serde(default)]
    pub title: String,
    /// Scene file with block, devices and restitution, relative to the study; without one the pier of the paper's Section 6.2.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scene: Option<PathBuf>,
    /// Record files and folders of them, relative to the study.
    #[serde(default)]
    pub records: Vec<RecordEntry>,
    /// `[record]`: what record files do not say themselves.
    #[serde(default)]
    pub record: RecordTable,
    /// `[[structure]]`: changes of the scene, each a structure of its own.
    #[serde(default)]
    pub structure: Vec<StructureTable>,
    /// Factors on every record.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<Vec<f64>>,
    /// `[stripes]`: levels that every record is scaled to, in the place of factors.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stripes: Option<StripesTable>,
    /// Measures that are ranked.
    #[serde(default = "all_measures")]
    pub measures: Vec<Measure>,
    /// `[demand]`.
    #[serde(default)]
    pub demand: DemandTable,
    /// `[fragility]`.
    #[serde(default)]
    pub fragility: FragilityTable,
    /// `[bootstrap]`.
    #[serde(default)]
    pub bootstrap: BootstrapTable,
    /// `[optimise]`, for `sprag optimise`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub optimise: Option<OptimiseTable>,
}

fn all_measures() -> Vec<Measure> {
    Measure::ALL.to_vec()
}

/// An entry of `records`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "a record is a path, or { file = \"…\" } with units, time_step_s or component")]
pub enum RecordEntry {
    /// A file or a folder.
    Path(PathBuf),
    /// One of which more is known than of the others.
    Described(DescribedRecord),
}

/// A file or folder of which more is known than of the others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DescribedRecord {
    /// The file or folder.
    pub file: PathBuf,
    /// As in [`RecordTable`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub units: Option<String>,
    /// As in [`RecordTable`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_step_s: Option<f64>,
    /// As in [`RecordTable`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub component: Option<String>,
}

/// `[record]`: as the options of `sprag record`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordTable {
    /// Units of files that do not state theirs: g, m/s2, cm/s2 (gal), mm/s2, in/s2 or ft/s2.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub units: Option<String>,
    /// Time step of files that do not state theirs, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_step_s: Option<f64>,
    /// Component of files with several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub component: Option<String>,
    /// Time step to resample to, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub resample_to_s: Option<f64>,
}

/// `[[structure]]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StructureTable {
    /// In tables and above pictures.
    pub name: String,
    /// Keys of the scene and their values, as of `--set`.
    #[serde(default)]
    pub set: BTreeMap<String, toml::Value>,
}

/// `[stripes]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StripesTable {
    /// What the levels are of.
    pub measure: Measure,
    /// Its levels.
    pub levels: Vec<f64>,
}

/// `[demand]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DemandTable {
    /// IM of the power laws.
    #[serde(default = "uniform_duration")]
    pub measure: Measure,
    /// Structures whose demands are fitted; all by default.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub structures: Vec<String>,
}

fn uniform_duration() -> Measure {
    Measure::UniformDuration
}

impl Default for DemandTable {
    fn default() -> Self {
        DemandTable { measure: uniform_duration(), structures: Vec::new() }
    }
}

/// `[fragility]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FragilityTable {
    /// IM of the curves.
    #[serde(default = "pgv")]
    pub measure: Measure,
    /// Structures whose fragilities are fitted; all by default.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub structures: Vec<String>,
}

fn pgv() -> Measure {
    Measure::Pgv
}

impl Default for FragilityTable {
    fn default() -> Self {
        FragilityTable { measure: pgv(), structures: Vec::new() }
    }
}

/// `[bootstrap]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BootstrapTable {
    /// Resamples of every fragility.
    pub resamples: u32,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Level of all bands, of the power laws too.
    pub level: f64,
}

impl Default for BootstrapTable {
    fn default() -> Self {
        BootstrapTable { resamples: 1000, seed: 1, level: 0.95 }
    }
}
