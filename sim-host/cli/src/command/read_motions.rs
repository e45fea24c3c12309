//! The motions that devices of a scene are run under: the scene's own, and records in its place.

use sprag_report::progress::Progress;
use sprag_sim::record::RecordSummary;
use sprag_sim::scene::error::KeyPath;
use sprag_sim::scene::ground::{GroundError, Motion};
use sprag_sim::scene::{Scene, SceneError};
use sprag_studies::sensitivity::motion::{RecordFiles, StudyMotion};

/// Motions that were read.
pub struct ReadMotions {
    /// The scene's own, then the records that could be read.
    pub motions: Vec<StudyMotion>,
    /// Records that could not, in a line each.
    pub errors: Vec<String>,
}

impl ReadMotions {
    /// The own motion of `scene`, and each of `records` in its place once; what else was `unreadable` is among the errors.
    ///
    /// # Errors
    /// A scene that has no record to replace, or none of its own without any of `records`, one whose `[[vertical]]` does not belong to them, and
    /// where nothing could be read.
    pub fn of(scene: &Scene, records: &[RecordFiles], unreadable: &[String]) -> anyhow::Result<ReadMotions> {
        if !records.is_empty() {
            StudyMotion::may_be_replaced(scene)?;
        }
        if let (Some(first), true) = (records.first(), scene.file.ground.iter().all(|table| table.motion != Motion::Record)) {
            scene.clone().use_record(&first.horizontal)?;
        }
        // A folder without a record is named below, with what it lacks.
        if unreadable.is_empty() {
            require_files(scene, records)?;
        }
        let reading = Progress::uncounted("reading records");
        let mut read = ReadMotions { motions: StudyMotion::own(scene)?.into_iter().collect(), errors: unreadable.to_vec() };
        for (name, record) in RecordFiles::named(records) {
            match StudyMotion::record(scene, record) {
                Ok(mut motion) => {
                    motion.name = name;
                    read.motions.push(motion);
                }
                Err(error @ GroundError::Record { .. }) => read.errors.push(error.to_string()),
                Err(error) => return Err(error.into()),
            }
        }
        reading.finish();
        if read.motions.is_empty() {
            let first = read.errors.first().cloned().unwrap_or_default();
            anyhow::bail!("{}: no ground motion could be read; {first}", scene.origin);
        }
        Ok(read)
    }

    /// What the record files of the motions hold.
    pub fn records(&self) -> Vec<RecordSummary> {
        self.motions.iter().flat_map(|motion| motion.records.iter().cloned()).collect()
    }
}

/// Refuses a scene that names no file for a record, where none takes its place.
fn require_files(scene: &Scene, records: &[RecordFiles]) -> Result<(), SceneError> {
    let of = [
        ("ground", &scene.file.ground, "a record file here, or --records FILE…"),
        ("vertical", &scene.file.vertical, "a record file here"),
    ];
    for (name, tables, needed) in of {
        let without = tables.iter().position(|table| table.motion == Motion::Record && table.file.is_none());
        if let (Some(index), true) = (without, records.is_empty()) {
            return Err(KeyPath { origin: scene.origin.clone(), key: format!("{name}.{index}.file") }.missing(needed));
        }
    }
    Ok(())
}
