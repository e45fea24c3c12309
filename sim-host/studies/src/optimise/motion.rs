//! The motions of a study under which every design is tried: all records, each as often as it is scaled, and all pulses.

use std::borrow::Cow;
use std::sync::Arc;

use sprag_ensemble::shaken::Samples;
use sprag_sim::scene::motions::GroundMotions;
use sprag_sim::side_by_side;

use super::pulse::Pulse;
use crate::cloud::records::StudyRecord;
use crate::cloud::runs::scales;
use crate::cloud::structures::StudyStructure;
use crate::cloud::study::Study;

/// A motion of the ground.
#[derive(Clone, Debug)]
pub struct Motion<'a> {
    /// As tables print it.
    pub name: String,
    /// What it is.
    pub shaking: Shaking<'a>,
    /// Factor on it.
    pub factor: f64,
    /// Level that it was scaled to, in a study of stripes.
    pub level: Option<f64>,
}

/// What shakes the block.
#[derive(Clone, Debug)]
pub enum Shaking<'a> {
    /// A record.
    Record {
        /// The record.
        record: &'a StudyRecord,
        /// As lanes take it.
        samples: Arc<Samples>,
        /// When it starts, s.
        start_s: f64,
    },
    /// A pulse.
    Pulse(GroundMotions),
}

impl Motion<'_> {
    /// As a ground motion.
    pub fn ground(&self) -> Cow<'_, GroundMotions> {
        match &self.shaking {
            Shaking::Record { record, start_s, .. } => Cow::Owned(record.ground(self.factor, *start_s)),
            Shaking::Pulse(ground) => Cow::Borrowed(ground),
        }
    }

    /// As lanes take it.
    pub fn in_lanes(&self) -> side_by_side::Shaking<'_> {
        match &self.shaking {
            Shaking::Record { samples, .. } => side_by_side::Shaking::Record { level: (samples, self.factor), vertical: None },
            Shaking::Pulse(ground) => side_by_side::Shaking::Any(ground),
        }
    }

    /// The earthquake that it is of, where it is known.
    pub fn event(&self) -> Option<&str> {
        match &self.shaking {
            Shaking::Record { record, .. } => record.event.as_deref(),
            Shaking::Pulse(_) => None,
        }
    }

    /// What it shares its luck with: motions of one earthquake, and one record at several scales, are not independent.
    pub fn group(&self) -> &str {
        self.event().unwrap_or(&self.name)
    }

    /// In messages.
    pub fn scaled_name(&self) -> String {
        match self.shaking {
            Shaking::Record { .. } => format!("{} times {}", self.name, self.factor),
            Shaking::Pulse(_) => self.name.clone(),
        }
    }
}

/// Those of `study` for `structure`: by record and scale, then `pulses`. Levels that no factor gives go to `left_out`.
pub fn motions<'a>(
    study: &Study,
    structure: &StudyStructure,
    records: &'a [StudyRecord],
    pulses: Vec<Pulse>,
    left_out: &mut Vec<String>,
) -> Vec<Motion<'a>> {
    let start_s = structure.scene.file.ground[0].start_s;
    let mut motions = Vec::new();
    for record in records {
        let of_record = scales(study, structure, record, left_out);
        let samples = Arc::new(Samples::from(&record.motion.record));
        let scaled = |(factor, level)| {
            let shaking = Shaking::Record { record, samples: samples.clone(), start_s };
            Motion { name: record.name.clone(), shaking, factor, level }
        };
        motions.extend(of_record.into_iter().map(scaled));
    }
    let of_pulse = |Pulse { name, ground }| Motion { name, shaking: Shaking::Pulse(ground), factor: 1.0, level: None };
    motions.extend(pulses.into_iter().map(of_pulse));
    motions
}
