//! The ground motion of a scene: its `[[ground]]` and `[[vertical]]` tables, read and summed.

use std::borrow::Cow;
use std::path::Path;

use super::Scene;
use super::error::{KeyPath, SceneError};
use super::ground::{Direction, GivenRecord, GroundError, GroundTable, Motion};
use super::schema::SceneFile;
use super::support::SupportRecordTable;
use crate::ground_motion::oscillator::Beside;
use crate::ground_motion::{Component, GroundMotion};
use crate::record::{Record, RecordSummary};

const NEEDS_RECORD: &str = "a record from the command line needs a [[ground]] table with motion = \"record\"";

/// How the ground moves, in both directions, and a support on it.
#[derive(Clone, Debug, Default)]
pub struct GroundMotions {
    /// ü_g.
    pub horizontal: GroundMotion,
    /// v̈_g, positive upwards, if the scene has one; its segments are those of the horizontal motion.
    pub vertical: Option<GroundMotion>,
    /// ü_s − ü_g, for a device whose support has a motion of its own ([`GroundMotions::of_device`]); its segments are those of the others.
    pub support: Option<GroundMotion>,
    /// The motions beside supports that have records of their own.
    supported: Vec<(SupportRecordTable, Beside)>,
    /// The records that were read for it, the horizontal ones first, those of supports last.
    pub records: Vec<RecordSummary>,
}

impl GroundMotions {
    /// Of motions with the same segments, without records.
    pub fn of(horizontal: GroundMotion, vertical: Option<GroundMotion>) -> GroundMotions {
        GroundMotions { horizontal, vertical, ..GroundMotions::default() }
    }

    /// Those of device number `index` of `scene`, whose support may move on its own; None where its support has a record that is not one
    /// beside this ground.
    pub fn of_device(&self, scene: &Scene, index: usize) -> Option<Cow<'_, GroundMotions>> {
        let moves = scene.devices.get(index).is_some_and(|device| device.drivetrain.support.given_apart);
        let Some(table) = scene.file.device.get(index).filter(|_| moves) else { return Some(Cow::Borrowed(self)) };
        let beside = match (table.support_oscillator(), &table.support_record) {
            (Some(oscillator), _) => oscillator.beside(&self.horizontal, self.vertical.as_ref()),
            (None, record) => self.supported.iter().find(|(known, _)| Some(known) == record.as_ref())?.1.clone(),
        };
        let Beside { horizontal, vertical, support } = beside;
        Some(Cow::Owned(GroundMotions { horizontal, vertical, support: Some(support), ..GroundMotions::default() }))
    }
}

impl Scene {
    /// Reads the records and sums the motions.
    ///
    /// # Errors
    /// [`GroundError`] names the file and what is wrong with it, or the instant at which the vertical motion would take the
    /// ground away from under the block (1 + v̈_g/g ≤ 0).
    pub fn ground_motions(&self) -> Result<GroundMotions, GroundError> {
        let mut records = Vec::new();
        let level = self.components(Direction::Horizontal, &mut records)?;
        if self.file.vertical.is_empty() {
            let supported = self.supported(&level, None, &mut records)?;
            let horizontal = GroundMotion::sum(&level);
            return Ok(GroundMotions { horizontal, supported, records, ..GroundMotions::default() });
        }
        let up = self.components(Direction::Vertical, &mut records)?;
        let supported = self.supported(&level, Some(&up), &mut records)?;
        let [horizontal, vertical] = GroundMotion::aligned(&level, &up);
        let (lowest, time) = vertical.lowest();
        if 1.0 + lowest <= 0.0 {
            let [weight, time] = [1.0 + lowest, time].map(|value| (value * 1e4).round() / 1e4);
            let reason = format!(
                "the ground would fall away from the block (1 + v̈_g/g = {weight} at {time} s); lower an amplitude or a scale"
            );
            return Err(self.key("vertical").conflict(&reason).into());
        }
        Ok(GroundMotions { horizontal, vertical: Some(vertical), supported, records, ..GroundMotions::default() })
    }

    fn supported(
        &self,
        horizontal: &[Component],
        vertical: Option<&[Component]>,
        records: &mut Vec<RecordSummary>,
    ) -> Result<Vec<(SupportRecordTable, Beside)>, GroundError> {
        let of = |(table, support): (SupportRecordTable, Component)| (table, Beside::recorded(horizontal, vertical, &support));
        Ok(self.support_records(records)?.into_iter().map(of).collect())
    }

    /// Takes the records of its motions into memory that are not there yet, as `read` reads their files: what is made of the scene reads
    /// none of them again.
    ///
    /// # Errors
    /// The first of `read`.
    pub fn take_records<E>(&mut self, read: impl Fn(&GroundTable) -> Result<Record, E>) -> Result<(), E> {
        let supports: Vec<GroundTable> = self.file.support_records().collect();
        let motions = self.file.ground.iter().chain(&self.file.vertical).chain(&supports);
        let mut given = self.given.to_vec();
        for motion in motions {
            let Some(file) = motion.file.clone().filter(|_| !given.iter().any(|given| given.is_of(motion))) else { continue };
            given.push(GivenRecord { file, options: Some(motion.read_options()), record: read(motion)? });
        }
        self.given = given.into();
        Ok(())
    }

    /// What its record files hold.
    ///
    /// # Errors
    /// [`GroundError`] names the file that cannot be read.
    pub fn records(&self) -> Result<Vec<RecordSummary>, GroundError> {
        let mut records = Vec::new();
        self.components(Direction::Horizontal, &mut records)?;
        self.components(Direction::Vertical, &mut records)?;
        self.support_records(&mut records)?;
        Ok(records)
    }

    /// The only record that shakes the block, and the only one that lifts it at the same time, if any does, before they are scaled; none where
    /// anything else moves the ground.
    ///
    /// # Errors
    /// As of [`Scene::ground_motions`].
    pub fn only_records(&self) -> Result<Option<(Record, Option<Record>)>, GroundError> {
        let read = |table: &GroundTable, name: &str, direction| {
            table.record(self, direction, &|key| self.key(&format!("{name}.0.{key}")))
        };
        let is_record = |table: &GroundTable| table.motion == Motion::Record;
        match (&self.file.ground[..], &self.file.vertical[..]) {
            ([level], []) if is_record(level) => Ok(Some((read(level, "ground", Direction::Horizontal)?, None))),
            ([level], [up]) if is_record(level) && is_record(up) && level.start_s == up.start_s => {
                let level = read(level, "ground", Direction::Horizontal)?;
                Ok(Some((level, Some(read(up, "vertical", Direction::Vertical)?))))
            }
            _ => Ok(None),
        }
    }

    /// The horizontal one of [`Scene::ground_motions`].
    ///
    /// # Errors
    /// The errors of [`Scene::ground_motions`].
    pub fn ground_motion(&self) -> Result<GroundMotion, GroundError> {
        Ok(self.ground_motions()?.horizontal)
    }

    /// Puts `file` in the place of the scene's record.
    ///
    /// # Errors
    /// [`SceneError::Missing`] when the scene has no `[[ground]]` table of motion "record"; a conflict where a support has a record of its
    /// own, which belongs to the other.
    pub fn use_record(&mut self, file: &Path) -> Result<(), SceneError> {
        self.refuse_support_records("another record of the ground has no motion of the support beside it")?;
        let missing = self.key("ground").missing(NEEDS_RECORD);
        replace_record(&mut self.file.ground, file).ok_or(missing)
    }

    /// Puts `file` in the place of the scene's vertical record.
    ///
    /// # Errors
    /// [`SceneError::Missing`] when the scene has no `[[vertical]]` table of motion "record".
    pub fn use_vertical_record(&mut self, file: &Path) -> Result<(), SceneError> {
        let missing = self.key("vertical").missing("--record-vertical needs a [[vertical]] table with motion = \"record\"");
        replace_record(&mut self.file.vertical, file).ok_or(missing)
    }

    fn components(&self, direction: Direction, records: &mut Vec<RecordSummary>) -> Result<Vec<Component>, GroundError> {
        let (name, tables) = self.file.motions(direction);
        let components = tables.iter().enumerate().map(|(index, table)| {
            let key = |key: &str| self.key(&format!("{name}.{index}.{key}"));
            table.component(self, direction, &key, records)
        });
        components.collect()
    }

    /// The place of `key`, for messages.
    pub fn key(&self, key: &str) -> KeyPath {
        KeyPath { origin: self.origin.clone(), key: key.to_owned() }
    }
}

impl SceneFile {
    /// The key and the tables of its motions in `direction`.
    pub fn motions(&self, direction: Direction) -> (&'static str, &[GroundTable]) {
        match direction {
            Direction::Horizontal => ("ground", &self.ground),
            Direction::Vertical => ("vertical", &self.vertical),
        }
    }
}

fn replace_record(tables: &mut [GroundTable], file: &Path) -> Option<()> {
    let table = tables.iter_mut().find(|table| table.motion == Motion::Record)?;
    table.file = Some(file.to_owned());
    table.of_command_line = true;
    Some(())
}
