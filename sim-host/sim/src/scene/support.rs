//! The support of a device: keys `support_amplification`, `support_frequency_hz` with `support_damping_ratio`, and `support_record`.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_with::skip_serializing_none;
use sprag_shared::structure::device::Device;
use sprag_shared::structure::drivetrain::{Drivetrain, Support};
use sprag_shared::structure::mount::Mount;

use super::Scene;
use super::device::DeviceTable;
use super::error::SceneError;
use super::ground::{Direction, GroundError, GroundTable, Motion};
use super::schema::{KeyOf, SceneFile};
use crate::ground_motion::Component;
use crate::ground_motion::oscillator::Oscillator;
use crate::record::{RecordSummary, TIME_STEP_RANGE_S};

/// A recorded motion of the support itself, horizontal; it starts with the ground, and after it the support keeps its speed.
#[skip_serializing_none]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SupportRecordTable {
    /// File of the record, relative to the scene.
    #[schemars(example = &"wall.csv")]
    pub file: PathBuf,
    /// Units of a record that does not state its own: g, m/s2, cm/s2 (gal), mm/s2, in/s2 or ft/s2.
    #[schemars(example = &"g")]
    pub units: Option<String>,
    /// Time step of a record that does not state its own.
    #[schemars(range(min = TIME_STEP_RANGE_S.0, max = TIME_STEP_RANGE_S.1))]
    pub time_step_s: Option<f64>,
    /// Component of a record file with several.
    #[schemars(example = &"NS")]
    pub component: Option<String>,
    /// Time step to which the record is resampled linearly.
    #[schemars(range(min = TIME_STEP_RANGE_S.0, max = TIME_STEP_RANGE_S.1))]
    pub resample_to_s: Option<f64>,
    /// Factor on the record.
    #[serde(default = "one")]
    #[schemars(range(min = -1e3, max = 1e3))]
    pub scale: f64,
}

fn one() -> f64 {
    1.0
}

impl SupportRecordTable {
    /// As a motion that starts at `start_s`.
    pub fn table(&self, start_s: f64) -> GroundTable {
        GroundTable {
            file: Some(self.file.clone()),
            units: self.units.clone(),
            time_step_s: self.time_step_s,
            component: self.component.clone(),
            resample_to_s: self.resample_to_s,
            scale: self.scale,
            start_s,
            ..GroundTable::of(Motion::Record)
        }
    }
}

impl DeviceTable {
    /// The key that makes the support move otherwise than the ground, if one does.
    pub fn support_key(&self) -> Option<&'static str> {
        [
            ("support_record", self.support_record.is_some()),
            ("support_frequency_hz", self.support_frequency_hz.is_some()),
            ("support_amplification", self.support_amplification.is_some_and(|factor| factor != 1.0)),
        ]
        .into_iter()
        .find_map(|(name, is_on)| is_on.then_some(name))
    }

    /// The support as an oscillator, if it is one.
    pub fn support_oscillator(&self) -> Option<Oscillator> {
        let (frequency_hz, damping_ratio) = self.support_frequency_hz.zip(self.support_damping_ratio)?;
        Some(Oscillator { frequency_hz, damping_ratio })
    }

    /// Where it moves on its own, the device is ideal and without friction.
    pub(super) fn support(&self, drivetrain: &Drivetrain, device: &Device, key: &KeyOf<'_>) -> Result<Support, SceneError> {
        match (self.support_frequency_hz, self.support_damping_ratio) {
            (Some(_), None) => {
                return Err(key("support_damping_ratio").missing("a support of a frequency of its own needs its damping"));
            }
            (None, Some(_)) => {
                return Err(key("support_frequency_hz").missing("a damping ratio needs the frequency that it belongs to"));
            }
            _ => {}
        }
        let given = [
            ("support_amplification", self.support_amplification.is_some()),
            ("support_frequency_hz", self.support_frequency_hz.is_some()),
            ("support_record", self.support_record.is_some()),
        ];
        let mut given = given.iter().filter_map(|(name, is_given)| is_given.then_some(*name));
        if let (Some(first), Some(second)) = (given.next(), given.next()) {
            return Err(key(second).conflict(&format!("the support moves in one way: give only one of {first} and {second}")));
        }
        let Some(name) = self.support_key() else { return Ok(Support::default()) };
        let refused = |reason: &str| Err(key(name).conflict(reason));
        let support = self.support_amplification.map_or(Support::MOVING, Support::amplified);
        if let Mount::BaseCorners { .. } = device.mount {
            return refused("a support that moves horizontally does not move vertical devices at the base corners");
        }
        let ideal = Drivetrain::default();
        let moved = [
            ("engagement, clutch or inertance_corner_hz", drivetrain.engagement != ideal.engagement),
            ("flywheel", drivetrain.flywheel != ideal.flywheel),
            ("rack", drivetrain.rack != ideal.rack),
        ];
        match moved.iter().find(|(_, is_on)| *is_on) {
            Some((name, _)) => refused(&format!(
                "only ideal devices without friction are modelled on a support of its own motion, and not {name}"
            )),
            None => Ok(support),
        }
    }
}

impl SceneFile {
    /// The records of supports, as motions of the ground are said.
    pub fn support_records(&self) -> impl Iterator<Item = GroundTable> {
        self.device.iter().filter_map(|device| Some(device.support_record.as_ref()?.table(0.0)))
    }
}

impl Scene {
    /// The records that supports have of their own, each with its motion; what was read goes to `records`.
    pub(super) fn support_records(
        &self,
        records: &mut Vec<RecordSummary>,
    ) -> Result<Vec<(SupportRecordTable, Component)>, GroundError> {
        let mut found = Vec::new();
        for (index, device) in self.file.device.iter().enumerate() {
            let Some(record) = &device.support_record else { continue };
            let key = |key: &str| self.key(&format!("device.{index}.support_record.{key}"));
            let start_s = self.file.ground.first().map_or(0.0, |table| table.start_s);
            found.push((record.clone(), record.table(start_s).component(self, Direction::Horizontal, &key, records)?));
        }
        Ok(found)
    }

    /// # Errors
    /// [`SceneError`] for a record of a support that would not start with the ground.
    pub(super) fn check_support_records(&self) -> Result<(), SceneError> {
        for (index, device) in self.file.device.iter().enumerate() {
            let Some(record) = &device.support_record else { continue };
            let name = format!("device.{index}.support_record");
            if self.file.ground.len() != 1 {
                let reason = "a record of the support starts with the ground, and needs one [[ground]] table to start with";
                return Err(self.key(&name).conflict(reason));
            }
            record.table(0.0).check(Direction::Horizontal, &|key| self.key(&format!("{name}.{key}")))?;
        }
        Ok(())
    }

    /// The device whose support has a record of its own, which belongs to the scene's ground alone.
    ///
    /// # Errors
    /// [`SceneError`] names it.
    pub fn refuse_support_records(&self, reason: &str) -> Result<(), SceneError> {
        match self.file.device.iter().position(|device| device.support_record.is_some()) {
            Some(index) => Err(self.key(&format!("device.{index}.support_record")).conflict(reason)),
            None => Ok(()),
        }
    }
}
