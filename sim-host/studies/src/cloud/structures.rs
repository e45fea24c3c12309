//! The structures of a study: its scene, changed as each of them says.

use std::path::Path;

use serde::Serialize;
use sprag_sim::keys::Described;
use sprag_sim::scene::error::KeyPath;
use sprag_sim::scene::ground::Motion;
use sprag_sim::scene::schema::SceneFile;
use sprag_sim::scene::{Scene, SceneError};

use super::measure::BlockScales;
use super::study::StudyError;
use super::study_file::StudyFile;

/// The scene of a study that names none.
const PIER: &str = include_str!("../../../../scenes/record.toml");

/// Most structures of a study.
pub const MOST_STRUCTURES: usize = 64;

/// A structure of a study.
#[derive(Clone, Debug, Serialize)]
pub struct StudyStructure {
    /// Name of the structure.
    pub name: String,
    /// What its measures are relative to.
    #[serde(flatten)]
    pub scales: BlockScales,
    /// Scene as resolved.
    #[serde(rename = "scene", serialize_with = "file_of")]
    pub scene: Scene,
}

fn file_of<S: serde::Serializer>(scene: &Scene, serializer: S) -> Result<S::Ok, S::Error> {
    SceneFile::serialize(&scene.file, serializer)
}

/// The structures of `file`, a study called `origin` in `folder`; `overrides` win over what each of them sets.
///
/// # Errors
/// [`StudyError`] names the scene, the structure and what its scene may be, or what of `overrides` would make structures the same.
pub(super) fn structures(
    file: &StudyFile,
    origin: &str,
    folder: &Path,
    overrides: &[String],
) -> Result<Vec<StudyStructure>, StudyError> {
    let key = |key: &str| KeyPath { origin: origin.to_owned(), key: key.to_owned() };
    let load = |overrides: &[String]| match &file.scene {
        Some(path) => Scene::load(&folder.join(path), overrides),
        None => Scene::parse_with(PIER, "the scene of a study that names none", overrides),
    };
    let given = || overrides.iter().filter_map(|item| Some(item.split_once('=')?.0.trim()));
    let of_study = |given: &&str| SceneFile::stranger(given.split('.').next().unwrap_or_default()).is_some();
    if let Some(given) = given().find(of_study) {
        return Err(key(&format!("--set {given}")).conflict("a key of the study itself; change it there").into());
    }
    let base = load(overrides)?;
    if file.structure.is_empty() {
        let name = if base.file.title.is_empty() { "scene".to_owned() } else { base.file.title.clone() };
        return Ok(vec![structure(name, base)?]);
    }
    for given in given() {
        let of_structures = || file.structure.iter().map(|table| table.set.get(given));
        if of_structures().any(|value| Some(value) != of_structures().next()) {
            let setting = file.structure.iter().filter(|table| table.set.contains_key(given));
            let names: Vec<String> = setting.map(|table| format!("{:?}", table.name)).collect();
            let reason = format!("structures differ in it, as set by {}; change it in the study", names.join(", "));
            return Err(key(&format!("--set {given}")).conflict(&reason).into());
        }
    }
    let mut structures: Vec<StudyStructure> = Vec::new();
    for (index, table) in file.structure.iter().enumerate() {
        if table.name.is_empty() || structures.iter().any(|other| other.name == table.name) {
            let reason = "each structure needs a name of its own";
            return Err(key(&format!("structure.{index}.name")).conflict(reason).into());
        }
        let own = table.set.iter().map(|(key, value)| format!("{key}={value}"));
        let all: Vec<String> = own.chain(overrides.iter().cloned()).collect();
        let of_structure = |error| StudyError::Structure { origin: origin.to_owned(), index, error: Box::new(error) };
        let scene = load(&all).map_err(of_structure)?;
        structures.push(structure(table.name.clone(), scene).map_err(of_structure)?);
    }
    Ok(structures)
}

/// A structure, if the records of a study can be its ground motion.
fn structure(name: String, scene: Scene) -> Result<StudyStructure, SceneError> {
    let key = |key: &str| KeyPath { origin: scene.origin.clone(), key: key.to_owned() };
    let ground = &scene.file.ground;
    if ground.len() != 1 || ground[0].motion != Motion::Record {
        let reason = "a study shakes by its records: the scene needs one [[ground]] table, with motion = \"record\"";
        return Err(key("ground").conflict(reason));
    }
    if ground[0].scale != 1.0 {
        return Err(key("ground.0.scale").conflict("factors on records belong into the study"));
    }
    if !scene.file.vertical.is_empty() {
        return Err(key("vertical").conflict("the records of a study are horizontal"));
    }
    Ok(StudyStructure { name, scales: BlockScales::of(&scene), scene })
}
