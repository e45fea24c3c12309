//! The motions of a study under which every design is tried: all records, each as often as it is scaled.

use sprag_sim::scene::motions::GroundMotions;

use crate::cloud::records::StudyRecord;
use crate::cloud::runs::scales;
use crate::cloud::structures::StudyStructure;
use crate::cloud::study::Study;

/// A scaled record.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'a> {
    /// The record.
    pub record: &'a StudyRecord,
    /// Factor on it.
    pub factor: f64,
    /// Level that it was scaled to, in a study of stripes.
    pub level: Option<f64>,
    start_s: f64,
}

impl Motion<'_> {
    /// As a ground motion.
    pub fn ground(&self) -> GroundMotions {
        self.record.ground(self.factor, self.start_s)
    }

    /// What it shares its luck with: motions of one earthquake, and one record at several scales, are not independent.
    pub fn group(&self) -> &str {
        self.record.event.as_deref().unwrap_or(&self.record.name)
    }

    /// In messages.
    pub fn name(&self) -> String {
        format!("{} times {}", self.record.name, self.factor)
    }
}

/// Those of `study` for `structure`, by record and scale. Levels that no factor gives go to `left_out`.
pub fn motions<'a>(
    study: &Study,
    structure: &StudyStructure,
    records: &'a [StudyRecord],
    left_out: &mut Vec<String>,
) -> Vec<Motion<'a>> {
    let start_s = structure.scene.file.ground[0].start_s;
    let mut motions = Vec::new();
    for record in records {
        let of_record = scales(study, structure, record, left_out);
        motions.extend(of_record.into_iter().map(|(factor, level)| Motion { record, factor, level, start_s }));
    }
    motions
}
