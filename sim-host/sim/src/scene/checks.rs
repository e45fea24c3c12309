//! `[checks]`: what a device demands of its support and its gears.

use serde::{Deserialize, Serialize};

use super::error::SceneError;
use super::schema::KeyOf;

/// `[checks]`; the table turns the checks on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChecksTable {
    /// Available coefficient of friction under the block; without one the demand is only reported.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction_coefficient: Option<f64>,
    /// The mesh of rack and first pinion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gear: Option<GearTable>,
    /// |F|/(mg) at the support above which a warning is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_force_ratio: Option<f64>,
    /// Travel of the terminals, m, above which a warning is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_stroke_m: Option<f64>,
}

/// A spur gear.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GearTable {
    /// Module, mm.
    pub module_mm: f64,
    /// Face width, mm.
    pub face_width_mm: f64,
    /// Teeth of the pinion.
    pub teeth: u32,
    /// Allowable bending stress at the root of a tooth, MPa.
    pub allowable_stress_mpa: f64,
}

impl ChecksTable {
    /// # Errors
    /// [`SceneError`] names the key.
    pub(super) fn check(&self, block_mass: Option<f64>, key: &KeyOf<'_>) -> Result<(), SceneError> {
        let above_zero = |name: &str, value: Option<f64>, most: f64, range: &str| match value {
            Some(value) => key(name).require(value, value > 0.0 && value <= most, range).map(|_| ()),
            None => Ok(()),
        };
        above_zero("checks.friction_coefficient", self.friction_coefficient, 10.0, "above 0, to 10")?;
        above_zero("checks.largest_force_ratio", self.largest_force_ratio, 1e6, "above 0, to 1e6")?;
        above_zero("checks.largest_stroke_m", self.largest_stroke_m, 1e4, "above 0, to 10000 m")?;
        let Some(gear) = &self.gear else {
            return Ok(());
        };
        above_zero("checks.gear.module_mm", Some(gear.module_mm), 100.0, "above 0, to 100 mm")?;
        above_zero("checks.gear.face_width_mm", Some(gear.face_width_mm), 1e4, "above 0, to 10000 mm")?;
        let teeth = f64::from(gear.teeth);
        key("checks.gear.teeth").require(teeth, (12.0..=10_000.0).contains(&teeth), "from 12 to 10000")?;
        above_zero("checks.gear.allowable_stress_mpa", Some(gear.allowable_stress_mpa), 1e5, "above 0, to 100000 MPa")?;
        if block_mass.is_none() {
            return Err(key("checks.gear").conflict("a stress needs a force in N, and so block.mass_kg"));
        }
        Ok(())
    }
}
