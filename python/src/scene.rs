//! Scenes, and the tables that they are made of.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Deserialize;
use sprag_sim::keys::Described;
use sprag_sim::scene::checks::ChecksTable;
use sprag_sim::scene::controller::ControllerTable;
use sprag_sim::scene::ground::{GivenRecord, GroundTable};
use sprag_sim::scene::schema::{AccuracyTable, BlockTable, DeviceTable, OutputTable, RunTable, SceneFile};
use sprag_sim::scene::{Scene as SimScene, document, overrides, text_of};
use toml::Table;

use crate::errors::{Raise as _, range, refused};
use crate::record::Record;
use crate::value::{table, value};

/// A block, its devices, the ground motion and how accurately to follow them, every value within its range.
#[pyclass(frozen, module = "sprag._core")]
pub struct Scene {
    pub(crate) scene: SimScene,
    /// As it was written.
    pub(crate) table: Table,
    records: Named,
}

/// Records in memory, and what the scene calls them.
pub type Named = Vec<(String, Py<Record>)>;

/// The records, called what the scene calls them.
pub fn records(py: Python<'_>, named: &Named) -> Vec<sprag_sim::record::Record> {
    let called = |(name, record): &(String, Py<Record>)| sprag_sim::record::Record {
        name: name.clone(),
        ..record.bind(py).get().record.clone()
    };
    named.iter().map(called).collect()
}

impl Scene {
    fn of(py: Python<'_>, table: Table, read: SimScene, folder: PathBuf, records: Named) -> Scene {
        let given: Arc<[_]> = self::records(py, &records).into_iter().map(GivenRecord::from).collect();
        Scene { scene: SimScene { folder, given, ..read }, table, records }
    }
}

#[pymethods]
impl Scene {
    /// Of the keys in `keys`; `file` of a motion names one of `records` before a file of `folder`.
    #[new]
    #[pyo3(signature = (keys, *, records = Vec::new(), folder = PathBuf::new(), origin = "scene"))]
    fn new(keys: &Bound<'_, PyDict>, records: Named, folder: PathBuf, origin: &str) -> PyResult<Scene> {
        let table = table(keys)?;
        let read = SimScene::of_table(table.clone(), origin).map_err(|error| error.raise())?;
        Ok(Scene::of(keys.py(), table, read, folder, records))
    }

    /// Of a TOML text.
    #[staticmethod]
    #[pyo3(signature = (text, *, records = Vec::new(), folder = PathBuf::new(), origin = "scene"))]
    fn parse(py: Python<'_>, text: &str, records: Named, folder: PathBuf, origin: &str) -> PyResult<Scene> {
        let read = SimScene::parse(text, origin).map_err(|error| error.raise())?;
        let table = document::table(text, origin).map_err(|error| error.raise())?;
        Ok(Scene::of(py, table, read, folder, records))
    }

    /// Of a TOML file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Scene> {
        let text = text_of(&path).map_err(|error| error.raise())?;
        let folder = path.parent().map(PathBuf::from).unwrap_or_default();
        Scene::parse(py, &text, Vec::new(), folder, &path.display().to_string())
    }

    /// With `value` for the key with dots, and `records` in the place of its own; None leaves the key out.
    fn set(&self, py: Python<'_>, key: &str, value: &Bound<'_, PyAny>, records: Named) -> PyResult<Scene> {
        let mut table = self.table.clone();
        let origin = &self.scene.origin;
        overrides::apply(&mut table, &change(key, value)?, origin).map_err(|error| error.raise())?;
        let read = SimScene::of_table(table.clone(), origin).map_err(|error| error.raise())?;
        Ok(Scene::of(py, table, read, self.scene.folder.clone(), records))
    }

    /// As TOML.
    fn text(&self) -> PyResult<String> {
        toml::to_string(&self.table).map_err(refused)
    }

    /// With defaults filled in, as JSON, by which scenes are compared.
    fn resolved(&self) -> PyResult<String> {
        serde_json::to_string(&self.scene.file).map_err(refused)
    }

    /// The keys as they were written, as JSON.
    fn written(&self) -> PyResult<String> {
        serde_json::to_string(&self.table).map_err(refused)
    }

    /// Its name in messages.
    #[getter]
    fn origin(&self) -> &str {
        &self.scene.origin
    }

    /// Folder that record files are relative to.
    #[getter]
    fn folder(&self) -> PathBuf {
        self.scene.folder.clone()
    }

    /// Records in memory, by what the scene calls them.
    #[getter]
    fn records(&self, py: Python<'_>) -> Named {
        self.records.iter().map(|(name, record)| (name.clone(), record.clone_ref(py))).collect()
    }

    /// Names of the devices.
    #[getter]
    fn devices(&self) -> Vec<String> {
        self.scene.devices.iter().map(|device| device.name.clone()).collect()
    }

    /// What looks like a mistake, a line each.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.scene.warnings()
    }

    /// R, m.
    #[getter]
    fn size_m(&self) -> f64 {
        self.scene.block.size()
    }

    /// α, rad.
    #[getter]
    fn slenderness_rad(&self) -> f64 {
        self.scene.block.slenderness()
    }

    /// p, 1/s.
    #[getter]
    fn frequency_parameter_1_s(&self) -> f64 {
        self.scene.block.frequency_parameter()
    }

    /// tan α, or α of the slender model.
    #[getter]
    fn uplift_threshold_g(&self) -> f64 {
        self.scene.uplift_threshold()
    }
}

/// KEY=VALUE, as the command line has a change of a scene; None leaves the key out.
///
/// # Errors
/// `InputError` for what is no key.
#[pyfunction]
pub fn change(key: &str, value: &Bound<'_, PyAny>) -> PyResult<String> {
    if key.split('.').any(str::is_empty) || key.contains(|c: char| c == '=' || c.is_whitespace()) {
        return Err(range("key", format_args!("{key:?}"), "a key such as block.size_m"));
    }
    let value = if value.is_none() { String::new() } else { self::value(value)?.to_string() };
    Ok(format!("{key}={value}"))
}

/// The unit that the name of a key ends in; None where its value has none.
#[pyfunction]
pub fn unit(key: &str) -> Option<&'static str> {
    sprag_sim::keys::unit::unit(key)
}

/// Tables of a scene that can be read on their own.
macro_rules! parts {
    ($($name:literal: $part:ident($table:ty) = $($key:literal)/+;)*) => {
        $(
            #[derive(Deserialize)]
            #[serde(transparent)]
            struct $part(#[expect(dead_code, reason = "only whether it can be read matters")] $table);

            impl Described for $part {
                fn schema() -> &'static serde_json::Value {
                    &SceneFile::schema()["properties"]$([$key])+
                }
            }
        )*

        /// Refuses keys of the table `name` of a scene that it does not have, and values of another kind or outside their ranges.
        ///
        /// # Errors
        /// `InputError` names the key.
        #[pyfunction]
        pub fn check_table(name: &str, keys: &Bound<'_, PyDict>) -> PyResult<()> {
            let keys = table(keys)?;
            let read = match name {
                $($name => document::from_table::<$part>(keys, name).map(drop),)*
                _ => return Err(range("name", name, concat!("one of", $(" ", $name),*))),
            };
            read.map_err(|error| error.raise())
        }
    };
}

parts! {
    "block": Block(BlockTable) = "block";
    "device": Device(DeviceTable) = "device"/"items";
    "ground": Ground(GroundTable) = "ground"/"items";
    "run": Run(RunTable) = "run";
    "accuracy": Accuracy(AccuracyTable) = "accuracy";
    "checks": Checks(ChecksTable) = "checks";
    "controller": Controller(ControllerTable) = "controller";
    "output": Output(OutputTable) = "output";
}
