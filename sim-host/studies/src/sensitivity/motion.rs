//! The ground motions of a study: the scene's own, and each record in its place.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use sprag_ensemble::shaken::Samples;
use sprag_sim::record::RecordSummary;
use sprag_sim::scene::ground::{GroundError, Motion};
use sprag_sim::scene::motions::GroundMotions;
use sprag_sim::scene::{Scene, SceneError};
use sprag_sim::side_by_side::Shaking;

use super::variants::VERTICAL_RATIO;
use crate::cloud::folder::shown;
use crate::cloud::record_name::{Unnamed, names, same_file};

/// A ground motion, with and without a vertical one.
#[derive(Debug)]
pub struct StudyMotion {
    /// The scene's own, and not a record in its place.
    pub own: bool,
    /// Name in tables.
    pub name: String,
    /// Ground motion of the scene.
    pub ground: GroundMotions,
    /// With a vertical motion beside it, or why there is none.
    pub with_vertical: Result<GroundMotions, String>,
    /// The records that were read for both.
    pub records: Vec<RecordSummary>,
    /// The same for lanes, where the motion is one record.
    samples: Option<(Samples, f64)>,
    vertical_samples: Option<(Samples, f64)>,
}

/// A record in the place of the scene's.
#[derive(Clone, Debug)]
pub struct RecordFiles {
    /// The horizontal component.
    pub horizontal: PathBuf,
    /// The vertical one of the same station, if there is one.
    pub vertical: Option<PathBuf>,
}

impl RecordFiles {
    /// The horizontal components `files`, without vertical ones.
    pub fn horizontal(files: &[PathBuf]) -> Vec<RecordFiles> {
        files.iter().map(|file| RecordFiles { horizontal: file.clone(), vertical: None }).collect()
    }

    /// Those of `records` that are not named before, each with its [name](names) in tables: that of its file, and of the vertical one where the
    /// same file is there with another or none.
    pub fn named(records: &[RecordFiles]) -> Vec<(String, &RecordFiles)> {
        let mut seen = BTreeSet::new();
        let files = |record: &RecordFiles| (same_file(&record.horizontal), record.vertical.as_deref().map(same_file));
        let new = |record: &&RecordFiles| seen.insert(files(record));
        let once: Vec<&RecordFiles> = records.iter().filter(new).collect();
        let unnamed: Vec<Unnamed> = once.iter().map(|record| record.unnamed(same_file(&record.horizontal))).collect();
        names(&unnamed).into_iter().zip(once).collect()
    }

    /// For a name; its horizontal component is known as `file`.
    pub fn unnamed(&self, file: PathBuf) -> Unnamed {
        Unnamed { short: self.stem(), path: self.horizontal.clone(), file, part: self.vertical.as_deref().map(shown) }
    }

    fn stem(&self) -> String {
        self.horizontal.file_stem().unwrap_or_default().to_string_lossy().into_owned()
    }
}

impl StudyMotion {
    /// The scene's own motion; `None` when it is a record that the scene does not name.
    ///
    /// # Errors
    /// The errors of [`Scene::ground_motions`].
    pub fn own(scene: &Scene) -> Result<Option<StudyMotion>, GroundError> {
        if scene.file.ground.iter().any(|table| table.motion == Motion::Record && table.file.is_none()) {
            return Ok(None);
        }
        StudyMotion::of(scene, "own motion".to_owned(), true, None).map(Some)
    }

    /// Whether records may take the place of the scene's.
    ///
    /// # Errors
    /// [`SceneError::Conflict`] for a scene with a vertical motion.
    pub fn may_be_replaced(scene: &Scene) -> Result<(), SceneError> {
        if scene.file.vertical.is_empty() {
            return Ok(());
        }
        Err(scene.key("vertical").conflict("does not belong to the records; leave out [[vertical]] or --records"))
    }

    /// `record` in the place of the scene's.
    ///
    /// # Errors
    /// [`GroundError`] names the file, or says that the scene has no record to replace.
    pub fn record(scene: &Scene, record: &RecordFiles) -> Result<StudyMotion, GroundError> {
        let mut scene = scene.clone();
        scene.use_record(&record.horizontal)?;
        StudyMotion::of(&scene, record.stem(), false, record.vertical.as_deref())
    }

    fn of(scene: &Scene, name: String, own: bool, vertical: Option<&Path>) -> Result<StudyMotion, GroundError> {
        let ground = scene.ground_motions()?;
        let both = with_vertical(scene, vertical);
        let mut samples = None;
        let mut vertical_samples = None;
        if let Some((level, up)) = both.only_records().ok().flatten() {
            samples = scene.file.vertical.is_empty().then(|| (Samples::from(&level), scene.file.ground[0].scale));
            vertical_samples = up.map(|up| (Samples::from(&up), both.file.vertical[0].scale));
        }
        let with_vertical = match both.ground_motions() {
            Ok(ground) => Ok(ground),
            Err(error @ GroundError::Record { .. }) => return Err(error),
            Err(GroundError::Scene(error)) => Err(error.to_string()),
        };
        let mut records = ground.records.clone();
        if let (Some(_), Ok(both)) = (vertical, &with_vertical) {
            records.clone_from(&both.records);
        }
        Ok(StudyMotion { own, name, ground, with_vertical, records, samples, vertical_samples })
    }

    /// As lanes take it, with the vertical motion or without; none where there is none.
    pub fn shaking(&self, vertical: bool) -> Option<Shaking<'_>> {
        fn of((samples, factor): &(Samples, f64)) -> (&Samples, f64) {
            (samples, *factor)
        }
        Some(match (&self.samples, &self.vertical_samples) {
            (Some(level), Some(up)) if vertical => Shaking::Record { level: of(level), vertical: Some(of(up)) },
            (Some(level), _) if !vertical => Shaking::Record { level: of(level), vertical: None },
            _ if vertical => Shaking::Any(self.with_vertical.as_ref().ok()?),
            _ => Shaking::Any(&self.ground),
        })
    }
}

/// `scene` with `record` as its vertical motion, or else the horizontal one times [`VERTICAL_RATIO`].
pub fn with_vertical(scene: &Scene, record: Option<&Path>) -> Scene {
    let mut scene = scene.clone();
    let uplift = scene.uplift_threshold();
    scene.file.vertical.clone_from(&scene.file.ground);
    for table in &mut scene.file.vertical {
        // Amplitudes over the uplift threshold are for horizontal motions only.
        table.amplitude_g = table.amplitude_ratio.take().map(|ratio| ratio * uplift).or(table.amplitude_g);
        if record.is_none() {
            table.scale *= VERTICAL_RATIO;
        }
    }
    if let Some(record) = record {
        scene.file.vertical.retain(|table| table.motion == Motion::Record);
        scene.file.vertical.truncate(1);
        for table in &mut scene.file.vertical {
            (table.file, table.of_command_line) = (Some(record.to_owned()), true);
            table.component = None;
        }
    }
    scene
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_of_one_name_are_distinguished_and_count_once() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for inside in ["one", "other"] {
            std::fs::create_dir(at(inside)).unwrap();
            std::fs::write(at(inside).join("a.csv"), "").unwrap();
        }
        let of = |name: &str, vertical: Option<&str>| RecordFiles { horizontal: at(name), vertical: vertical.map(at) };
        let again = of("other/../one/a.csv", None);
        let records = [of("one/a.csv", None), again, of("other/a.csv", None), of("b.csv", Some("v.csv")), of("b.csv", None)];
        let named = RecordFiles::named(&records[..4]);
        let names: Vec<&str> = named.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, [&shown(&at("one/a.csv")), &shown(&at("other/a.csv")), "b"]);
        // Another vertical component makes another motion.
        let named = RecordFiles::named(&records[3..]);
        let names: Vec<&str> = named.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, [&*format!("b, {}", shown(&at("v.csv"))), "b"]);
    }
}
