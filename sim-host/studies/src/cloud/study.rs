//! A study whose every value is within its range: its structures, and how records are scaled.

use std::path::{Path, PathBuf};

use sprag_sim::record::{Component, ReadOptions, Units};
use sprag_sim::scene::error::KeyPath;
use sprag_sim::scene::{Scene, SceneError, document, text_of};

use super::measure::Measure;
use super::structures::{StudyStructure, structures};
use super::study_file::{DescribedRecord, RecordEntry, RecordTable, StudyFile};
use crate::statistics::{Bootstrap, Level};

/// Most factors or levels of a study.
pub const MOST_SCALES: usize = 1000;

/// A study.
#[derive(Clone, Debug)]
pub struct Study {
    /// As written, with defaults filled in.
    pub file: StudyFile,
    /// Where it was read from, for messages.
    pub origin: String,
    /// Folder that its paths are relative to.
    pub folder: PathBuf,
    /// What is shaken.
    pub structures: Vec<StudyStructure>,
    /// Names of the devices, the same for every structure.
    pub devices: Vec<String>,
    /// By how much.
    pub scaling: Scaling,
    /// How bands are found.
    pub bootstrap: Bootstrap,
    /// What record files do not say themselves.
    pub reading: ReadOptions,
}

/// By how much records are scaled.
#[derive(Clone, Debug, PartialEq)]
pub enum Scaling {
    /// Every record by each of these.
    Factors(Vec<f64>),
    /// Every record to each of these levels of a measure.
    Levels(Measure, Vec<f64>),
}

/// A study that cannot be run, in one line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StudyError {
    /// The study file itself, or its scene.
    #[error("{0}")]
    File(#[from] SceneError),
    /// The scene does not take the changes of a structure.
    #[error("{origin}: structure.{index}.set: {error}")]
    Structure {
        /// Study file.
        origin: String,
        /// Number of the structure, from 0.
        index: usize,
        /// Error of the scene.
        error: Box<SceneError>,
    },
}

impl Study {
    /// Reads the study at `path`; `overrides` (`KEY=VALUE`) change the scene of every structure, and `records` take the place of its
    /// own, relative to where the user stands.
    ///
    /// # Errors
    /// [`StudyError`] names the file, the key and what it may be.
    pub fn load(path: &Path, overrides: &[String], records: &[PathBuf]) -> Result<Study, StudyError> {
        let origin = path.display().to_string();
        let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
        Study::parse(&text_of(path)?, &origin, &folder, overrides, records)
    }

    /// [`Study::load`] of `text`, a file called `origin` in `folder`.
    ///
    /// # Errors
    /// The errors of [`Study::load`].
    pub fn parse(
        text: &str,
        origin: &str,
        folder: &Path,
        overrides: &[String],
        records: &[PathBuf],
    ) -> Result<Study, StudyError> {
        let mut file: StudyFile = document::from_text(text, origin)?;
        let key = |key: &str| KeyPath { origin: origin.to_owned(), key: key.to_owned() };
        let mut folder_of_records = folder.to_owned();
        if !records.is_empty() {
            file.records = records.iter().cloned().map(RecordEntry::Path).collect();
            folder_of_records = PathBuf::new();
        }
        for entry in &mut file.records {
            let (RecordEntry::Path(path) | RecordEntry::Described(DescribedRecord { file: path, .. })) = entry;
            // Without a slash at its end, by which a folder would be another study.
            *path = path.components().collect();
        }
        if file.records.is_empty() && !file.has_pulses() {
            return Err(key("records").missing("a list of record files and folders here, or --records PATH…").into());
        }
        let structures = structures(&file, origin, folder, overrides)?;
        let devices: Vec<String> = names(&structures[0].scene);
        for (index, structure) in structures.iter().enumerate() {
            let others = names(&structure.scene);
            if others != devices {
                let [others, devices] = [others, devices].map(|names| names.join(", "));
                let reason =
                    format!("its devices are {others}, those of the first structure {devices}; give them the same names");
                return Err(key(&format!("structure.{index}.set")).conflict(&reason).into());
            }
        }
        let scaling = scaling(&file, &key)?;
        if let (Scaling::Factors(factors), None) = (&scaling, &file.scale) {
            file.scale = Some(factors.clone());
        }
        check_names(&file.demand.structures, &structures, key("demand.structures"))?;
        check_names(&file.fragility.structures, &structures, key("fragility.structures"))?;
        key("measures").once(&file.measures)?;
        let bootstrap = bootstrap(&file, &key)?;
        let reading = reading(&file.record, &structures[0].scene, &key)?;
        let origin = origin.to_owned();
        Ok(Study { file, origin, folder: folder_of_records, structures, devices, scaling, bootstrap, reading })
    }

    /// Takes what is `given` of record files before what the study says of them.
    pub fn apply_record_options(&mut self, given: &RecordTable) {
        let table = &mut self.file.record;
        *table = RecordTable {
            units: given.units.clone().or(table.units.take()),
            time_step_s: given.time_step_s.or(table.time_step_s),
            component: given.component.clone().or(table.component.take()),
            resample_to_s: given.resample_to_s.or(table.resample_to_s),
        };
        self.reading = read_options(table, &self.structures[0].scene);
    }

    /// What looks like a mistake in the scenes of its structures, in a line each ([`Scene::warnings`]).
    pub fn warnings(&self) -> Vec<String> {
        self.structures.iter().flat_map(|structure| structure.scene.warnings()).collect()
    }

    /// Whether the measure titles of `structures` shall be those of the slender model: all of them have it.
    pub fn slender(&self) -> bool {
        self.structures.iter().all(|structure| structure.scene.geometry() == sprag_shared::structure::block::Geometry::Slender)
    }

    /// Whether runs shall say how accurate they are.
    pub fn asks_for_errors(&self) -> bool {
        self.structures.iter().any(|structure| structure.scene.file.accuracy.level.is_some())
    }
}

fn names(scene: &Scene) -> Vec<String> {
    scene.devices.iter().map(|device| device.name.clone()).collect()
}

fn scaling(file: &StudyFile, key: &dyn Fn(&str) -> KeyPath) -> Result<Scaling, SceneError> {
    match (&file.scale, &file.stripes) {
        (Some(_), Some(_)) => Err(key("scale").conflict("give only one of scale and [stripes]")),
        (None, None) => Ok(Scaling::Factors(vec![1.0])),
        (Some(factors), None) => {
            key("scale").once(factors)?;
            Ok(Scaling::Factors(factors.clone()))
        }
        (None, Some(stripes)) => {
            if !stripes.measure.scales() {
                let reason = format!("{} does not change when a record is scaled", stripes.measure.name());
                return Err(key("stripes.measure").conflict(&reason));
            }
            key("stripes.levels").once(&stripes.levels)?;
            Ok(Scaling::Levels(stripes.measure, stripes.levels.clone()))
        }
    }
}

fn check_names(asked: &[String], structures: &[StudyStructure], key: KeyPath) -> Result<(), SceneError> {
    let names: Vec<&str> = structures.iter().map(|structure| structure.name.as_str()).collect();
    match asked.iter().find(|name| !names.contains(&name.as_str())) {
        Some(name) => Err(key.outside(format!("{name:?}"), &format!("among the structures {}", names.join(", ")))),
        None => Ok(()),
    }
}

fn bootstrap(file: &StudyFile, key: &dyn Fn(&str) -> KeyPath) -> Result<Bootstrap, SceneError> {
    let table = file.bootstrap;
    let level = Level::new(table.level).map_err(|_| key("bootstrap.level").range(table.level, "above 0 and below 1"))?;
    Ok(Bootstrap { resamples: table.resamples, seed: table.seed, level })
}

/// What files do not say: from `table`, and else from the scene's own.
///
/// # Errors
/// [`SceneError`] for units or a time step outside their range.
fn reading(table: &RecordTable, scene: &Scene, key: &dyn Fn(&str) -> KeyPath) -> Result<ReadOptions, SceneError> {
    check_units(table.units.as_deref(), "record", key)?;
    Ok(read_options(table, scene))
}

fn read_options(table: &RecordTable, scene: &Scene) -> ReadOptions {
    let own = &scene.file.ground[0];
    ReadOptions {
        units: table.units.as_ref().or(own.units.as_ref()).and_then(|units| units.parse().ok()),
        time_step_s: table.time_step_s.or(own.time_step_s),
        component: table.component.as_deref().or(own.component.as_deref()).map(Component::from),
        resample_to_s: table.resample_to_s.or(own.resample_to_s),
    }
}

/// Units of `table`, if they can be meant.
pub(super) fn check_units(units: Option<&str>, table: &str, key: &dyn Fn(&str) -> KeyPath) -> Result<(), SceneError> {
    if let Some(units) = units.filter(|units| units.parse::<Units>().is_err()) {
        return Err(key(&format!("{table}.units")).outside(format!("{units:?}"), Units::ALLOWED));
    }
    Ok(())
}
