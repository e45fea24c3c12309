//! What the command line says of records: which they are, and what their files do not say themselves.

use std::ops::RangeInclusive;
use std::path::PathBuf;

use clap::Args;
use sprag_sim::record::{Component, ReadOptions, TIME_STEP_RANGE_S, Units};
use sprag_sim::scene::ground::{GroundTable, Motion};
use sprag_sim::scene::{Scene, SceneError};
use sprag_studies::cloud::study_file::RecordTable;

/// Time steps of records, s.
const TIME_STEPS_S: RangeInclusive<f64> = TIME_STEP_RANGE_S.0..=TIME_STEP_RANGE_S.1;

/// What record files do not say themselves.
#[derive(Args, Clone, Debug, Default)]
pub struct ReadArguments {
    /// Units of record files that do not state theirs: g, m/s2, cm/s2 (gal), mm/s2, in/s2 or ft/s2.
    #[arg(long, value_name = "U")]
    pub units: Option<Units>,
    /// Time step in s of record files that do not state theirs, or a stated one with more digits.
    #[arg(long, value_name = "S", value_parser = super::number(TIME_STEPS_S))]
    pub dt: Option<f64>,
    /// Component of record files with several: a name such as x or y, or a number from 1.
    #[arg(long, value_name = "C")]
    pub component: Option<String>,
    /// Resample records linearly to this time step in s, also from unequal steps.
    #[arg(long, value_name = "S", value_parser = super::number(TIME_STEPS_S))]
    pub resample: Option<f64>,
}

/// The records that shake the block of a scene.
#[derive(Args, Clone, Debug, Default)]
pub struct SceneRecordArguments {
    /// Ground motion record, in the place of the scene's; FILE#NAME takes one component of a file with several.
    #[arg(long, value_name = "FILE")]
    pub record: Option<PathBuf>,
    /// The vertical record, in the place of the scene's.
    #[arg(long, value_name = "FILE")]
    pub record_vertical: Option<PathBuf>,
    /// How they are read.
    #[command(flatten)]
    pub reading: ReadArguments,
}

impl ReadArguments {
    /// Options of the reader.
    pub fn options(&self) -> ReadOptions {
        ReadOptions {
            units: self.units,
            time_step_s: self.dt,
            component: self.component.as_deref().map(Component::from),
            resample_to_s: self.resample,
        }
    }

    /// As the keys of a study's `[record]`.
    pub fn table(&self) -> RecordTable {
        RecordTable {
            units: self.units.map(|units| units.to_string()),
            time_step_s: self.dt,
            component: self.component.clone(),
            resample_to_s: self.resample,
        }
    }

    /// Takes what is given before what the scene says of its records. The component is that of the horizontal ones.
    ///
    /// # Errors
    /// [`SceneError::Missing`] when something is given and the scene has no record.
    pub fn apply(&self, scene: &mut Scene) -> Result<(), SceneError> {
        let given = self.table();
        if given == RecordTable::default() {
            return Ok(());
        }
        let is_record = |table: &&mut GroundTable| table.motion == Motion::Record;
        let read = |table: &mut GroundTable| {
            table.units = given.units.clone().or(table.units.take());
            table.time_step_s = given.time_step_s.or(table.time_step_s);
            table.resample_to_s = given.resample_to_s.or(table.resample_to_s);
        };
        let mut records = 0;
        for table in scene.file.ground.iter_mut().filter(is_record) {
            read(table);
            table.component = given.component.clone().or(table.component.take());
            records += 1;
        }
        for table in scene.file.vertical.iter_mut().filter(is_record) {
            read(table);
            records += 1;
        }
        if records == 0 {
            let needed = "--units, --dt, --component and --resample need a [[ground]] table with motion = \"record\"";
            return Err(scene.key("ground").missing(needed));
        }
        Ok(())
    }
}

impl SceneRecordArguments {
    /// Whether anything is.
    pub fn is_given(&self) -> bool {
        self.record.is_some() || self.record_vertical.is_some() || self.reading.table() != RecordTable::default()
    }

    /// Puts the records into the scene.
    ///
    /// # Errors
    /// [`SceneError::Missing`] when the scene has no table for one of them.
    pub fn apply(&self, scene: &mut Scene) -> Result<(), SceneError> {
        if let Some(record) = &self.record {
            scene.use_record(record)?;
        }
        if let Some(record) = &self.record_vertical {
            scene.use_vertical_record(record)?;
        }
        self.reading.apply(scene)
    }
}
