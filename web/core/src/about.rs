//! What a scene says before it is run: its block, its devices, its keys.

use serde::Serialize;
use serde_json::Value;
use sprag_sim::keys::list::keys as keys_of;
use sprag_sim::keys::unit::unit;
use sprag_sim::keys::{Described as _, Key};
use sprag_sim::record::intensity::Intensity;
use sprag_sim::record::{ReadOptions, Record};
use sprag_sim::scene::Scene;
use sprag_sim::scene::map::MapTable;
use sprag_sim::scene::schema::SceneFile;

use crate::scene::{File, PageError};

/// What a scene says of itself.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub struct About<'a> {
    title: &'a str,
    devices: Vec<Device<'a>>,
    size_m: f64,
    slenderness_rad: f64,
    frequency_parameter1_s: f64,
    restitution: Option<f64>,
    uplift_threshold_g: f64,
    warnings: Vec<String>,
    has_controller: bool,
    map: Option<&'a MapTable>,
    resolved: &'a SceneFile,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Device<'a> {
    name: &'a str,
    kind: Value,
    mass_ratio: f64,
}

impl About<'_> {
    /// Of a scene.
    pub fn of(scene: &Scene) -> About<'_> {
        let device = |(index, device): (usize, &sprag_sim::scene::SceneDevice)| Device {
            name: scene.devices[index].name.as_str(),
            kind: serde_json::to_value(scene.file.device[index].kind).unwrap_or_default(),
            mass_ratio: device.device.mass_ratio,
        };
        About {
            title: &scene.file.title,
            devices: scene.devices.iter().enumerate().map(device).collect(),
            size_m: scene.block.size(),
            slenderness_rad: scene.block.slenderness(),
            frequency_parameter1_s: scene.block.frequency_parameter(),
            restitution: scene.structure(0).restitution().ok(),
            uplift_threshold_g: scene.uplift_threshold(),
            warnings: scene.warnings(),
            has_controller: scene.file.controller.is_some(),
            map: scene.file.map.as_ref(),
            resolved: &scene.file,
        }
    }
}

/// A numeric key of a scene.
#[derive(Serialize)]
pub struct NumericKey {
    key: String,
    value: Option<f64>,
    unit: &'static str,
    range: String,
    description: String,
}

/// The numeric keys of a scene; those of lists once for each of their tables.
pub fn keys(scene: &Scene) -> Vec<NumericKey> {
    let resolved = serde_json::to_value(&scene.file).unwrap_or_default();
    let numeric = |key: &Key| {
        let shown = key.default.as_ref().or(key.example.as_ref());
        !key.is_list && !key.of_list_below && shown.is_some_and(|value| value.is_float() || value.is_integer())
    };
    let all = keys_of(SceneFile::schema());
    let tables = |list: &str| resolved[list].as_array().map_or(0, Vec::len);
    all.iter()
        .filter(|key| numeric(key) && !key.path.starts_with("map."))
        .flat_map(|key| match key.path.split_once(".N.") {
            None => vec![(key, key.path.clone())],
            Some((list, rest)) => (0..tables(list)).map(|index| (key, format!("{list}.{index}.{rest}"))).collect(),
        })
        .map(|(key, path)| NumericKey {
            value: resolved.pointer(&format!("/{}", path.replace('.', "/"))).and_then(Value::as_f64),
            unit: unit(&path).unwrap_or_default(),
            range: key.range.clone(),
            description: key.meaning.clone(),
            key: path,
        })
        .collect()
}

/// What a record says of itself, and its intensity.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub struct RecordAbout {
    name: String,
    format: &'static str,
    units: String,
    time_step_s: f64,
    duration_s: f64,
    samples: usize,
    #[serde(rename = "pgaMS2")]
    pga: f64,
    #[serde(rename = "pgvMS")]
    pgv: f64,
    #[serde(rename = "ariasMS")]
    arias: f64,
    warnings: Vec<String>,
}

/// Reads a record.
///
/// # Errors
/// [`PageError`] for units that do not exist and a file that is no record.
pub fn record(file: &File, units: Option<&str>, time_step_s: Option<f64>) -> Result<RecordAbout, PageError> {
    let units = units
        .map(str::parse)
        .transpose()
        .map_err(|_| PageError::Unknown(units.unwrap_or_default().to_owned(), sprag_sim::record::Units::ALLOWED.to_owned()))?;
    let record = Record::parse(&file.name, &file.bytes, &ReadOptions { units, time_step_s, ..ReadOptions::default() })?;
    let intensity = Intensity::of(&record);
    Ok(RecordAbout {
        format: record.format.name(),
        units: record.units.to_string(),
        time_step_s: record.time_step_s,
        duration_s: record.duration_s(),
        samples: record.acceleration_m_s2.len(),
        pga: intensity.pga_m_s2,
        pgv: intensity.pgv_m_s,
        arias: intensity.arias_m_s,
        warnings: record.warnings.iter().map(ToString::to_string).collect(),
        name: record.name,
    })
}
