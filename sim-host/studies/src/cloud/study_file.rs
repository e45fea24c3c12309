//! The keys of a study file, as TOML has them.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::LazyLock;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_with::skip_serializing_none;

use sprag_sim::keys::{Described, schema_of};
use sprag_sim::record::TIME_STEP_RANGE_S;
use sprag_sim::scene::schema::SceneFile;

use super::measure::{LARGEST_FACTOR, Measure};
use crate::optimise::table::OptimiseTable;
use crate::statistics::bootstrap::MOST_RESAMPLES;

/// The one that [`StructureTable`] has as its example.
const EXAMPLE_STRUCTURES: [&str; 1] = ["taller"];

/// Two factors, or two levels.
const EXAMPLE_SCALES: [f64; 2] = [0.5, 1.0];

fn example_changes() -> BTreeMap<&'static str, f64> {
    BTreeMap::from([("block.size_m", 3.0)])
}

/// Has the elements of a list above 0.
pub(crate) fn each_above_zero(schema: &mut schemars::Schema) {
    each_above(0.0, schema);
}

/// Has the elements of a list above 1.
pub(crate) fn each_above_one(schema: &mut schemars::Schema) {
    each_above(1.0, schema);
}

fn each_above(low: f64, schema: &mut schemars::Schema) {
    if let Some(items) = schema.get_mut("items").and_then(serde_json::Value::as_object_mut) {
        items.insert("exclusiveMinimum".to_owned(), low.into());
    }
}

/// A study file.
#[skip_serializing_none]
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "Sprag study")]
pub struct StudyFile {
    /// Title of tables and pictures.
    #[serde(default)]
    pub title: String,
    /// Scene file with block, devices and restitution, relative to the study; the pier of the paper's Section 6.2 without the key.
    #[schemars(example = &"record.toml")]
    pub scene: Option<PathBuf>,
    /// Record files and folders of them, relative to the study; `--records PATH` takes their place.
    #[serde(default)]
    pub records: Vec<RecordEntry>,
    /// What record files do not say themselves.
    #[serde(default)]
    pub record: RecordTable,
    /// Changes of the scene, each a structure of its own; the scene as it is without any.
    #[serde(default)]
    #[schemars(length(max = super::structures::MOST_STRUCTURES))]
    pub structure: Vec<StructureTable>,
    /// Factors on every record; 1 without `scale` and `stripes`.
    #[schemars(inner(range(max = LARGEST_FACTOR)), transform = each_above_zero, length(min = 1, max = super::study::MOST_SCALES), example = EXAMPLE_SCALES)]
    pub scale: Option<Vec<f64>>,
    /// Levels that every record is scaled to, in the place of `scale`.
    pub stripes: Option<StripesTable>,
    /// Measures that are ranked.
    #[serde(default = "all_measures")]
    #[schemars(length(min = 1))]
    pub measures: Vec<Measure>,
    /// Power laws of the demand.
    #[serde(default)]
    pub demand: DemandTable,
    /// Fragility curves.
    #[serde(default)]
    pub fragility: FragilityTable,
    /// Confidence bands.
    #[serde(default)]
    pub bootstrap: BootstrapTable,
    /// Choice of a device, for `sprag optimise`.
    pub optimise: Option<OptimiseTable>,
}

impl StudyFile {
    /// Whether `sprag optimise` has motions without a record.
    pub fn has_pulses(&self) -> bool {
        self.optimise.as_ref().is_some_and(|optimise| !optimise.pulse.is_empty())
    }
}

impl Described for StudyFile {
    fn schema() -> &'static serde_json::Value {
        static SCHEMA: LazyLock<serde_json::Value> = LazyLock::new(schema_of::<StudyFile>);
        &SCHEMA
    }

    fn stranger(key: &str) -> Option<&'static str> {
        let whose =
            "a key of scenes, which `sprag simulate` and `sprag map` take among others; a study names its scene as `scene`";
        SceneFile::schema()["properties"].get(key).map(|_| whose)
    }
}

fn all_measures() -> Vec<Measure> {
    Measure::ALL.to_vec()
}

/// An entry of `records`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a record is a path, or { file = \"…\" } with units, time_step_s, component or event")]
pub enum RecordEntry {
    /// A file or a folder.
    Path(PathBuf),
    /// One of which more is known than of the others.
    Described(DescribedRecord),
}

/// A file or folder of which more is known than of the others.
#[skip_serializing_none]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DescribedRecord {
    /// File or folder.
    pub file: PathBuf,
    /// Units of files that do not state theirs: g, m/s2, cm/s2 (gal), mm/s2, in/s2 or ft/s2.
    #[schemars(example = &"g")]
    pub units: Option<String>,
    /// Time step of files that do not state theirs.
    #[schemars(range(min = TIME_STEP_RANGE_S.0, max = TIME_STEP_RANGE_S.1))]
    pub time_step_s: Option<f64>,
    /// Component of files with several.
    #[schemars(example = &"NS")]
    pub component: Option<String>,
    /// Earthquake of the file, or of all files of the folder, by any name: motions of one earthquake are not independent. The day in the
    /// title of a file without the key.
    #[schemars(example = &"Northridge")]
    pub event: Option<String>,
}

/// `[record]`: as the options of `sprag record`.
#[skip_serializing_none]
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RecordTable {
    /// Units of files that do not state theirs: g, m/s2, cm/s2 (gal), mm/s2, in/s2 or ft/s2.
    #[schemars(example = &"g")]
    pub units: Option<String>,
    /// Time step of files that do not state theirs.
    #[schemars(range(min = TIME_STEP_RANGE_S.0, max = TIME_STEP_RANGE_S.1))]
    pub time_step_s: Option<f64>,
    /// Component of files with several.
    #[schemars(example = &"NS")]
    pub component: Option<String>,
    /// Time step to resample to.
    #[schemars(range(min = TIME_STEP_RANGE_S.0, max = TIME_STEP_RANGE_S.1))]
    pub resample_to_s: Option<f64>,
}

/// `[[structure]]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StructureTable {
    /// Name in tables and above pictures.
    #[schemars(example = &"taller")]
    pub name: String,
    /// Keys of the scene and their values, as of `--set`.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, serde_json::Value>", example = example_changes())]
    pub set: BTreeMap<String, toml::Value>,
}

/// `[stripes]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StripesTable {
    /// Measure of the levels.
    pub measure: Measure,
    /// Levels of the measure.
    #[schemars(inner(range(max = 1e6)), transform = each_above_zero, length(min = 1, max = super::study::MOST_SCALES), example = EXAMPLE_SCALES)]
    pub levels: Vec<f64>,
}

/// `[demand]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DemandTable {
    /// Intensity measure of the power laws.
    pub measure: Measure,
    /// Structures whose demands are fitted, by name; all without the key.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(example = EXAMPLE_STRUCTURES)]
    pub structures: Vec<String>,
}

impl Default for DemandTable {
    fn default() -> Self {
        DemandTable { measure: Measure::UniformDuration, structures: Vec::new() }
    }
}

/// `[fragility]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FragilityTable {
    /// Intensity measure of the fragilities.
    pub measure: Measure,
    /// Structures whose fragilities are fitted, by name; all without the key.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(example = EXAMPLE_STRUCTURES)]
    pub structures: Vec<String>,
}

impl Default for FragilityTable {
    fn default() -> Self {
        FragilityTable { measure: Measure::Pgv, structures: Vec::new() }
    }
}

/// `[bootstrap]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BootstrapTable {
    /// Resamples of every fragility.
    #[schemars(range(min = 1, max = MOST_RESAMPLES))]
    pub resamples: u32,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Level of all bands, of the power laws too.
    #[schemars(extend("exclusiveMinimum" = 0.0, "exclusiveMaximum" = 1.0))]
    pub level: f64,
}

impl Default for BootstrapTable {
    fn default() -> Self {
        BootstrapTable { resamples: 1000, seed: 1, level: 0.95 }
    }
}
