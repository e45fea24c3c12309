//! `[checks]`: what a device demands of its support and its gears.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_with::skip_serializing_none;
use sprag_shared::observers::coil_use::CoilUse;
use sprag_shared::observers::counted_swing::CountedSwing;
use sprag_shared::structure::Structure;

use super::device::SceneDevice;
use super::error::SceneError;
use super::schema::KeyOf;

/// `[checks]`; the table turns the checks on.
#[skip_serializing_none]
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChecksTable {
    /// Available coefficient of friction under the block; a warning above. Without it the demand is only reported.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 10.0))]
    pub friction_coefficient: Option<f64>,
    /// Mesh of rack and first pinion; needs `block.mass_kg`.
    pub gear: Option<GearTable>,
    /// Coil of each clutch of a clutched pair: the energy that both take is reported.
    pub coil: Option<CoilTable>,
    /// Force of both flywheels on their support over the block's weight; a warning above.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 1e6))]
    pub largest_force_ratio: Option<f64>,
    /// Travel of the terminals; a warning above.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 1e4))]
    pub largest_stroke_m: Option<f64>,
}

/// A spur gear.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GearTable {
    /// Module of rack and pinion.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 100.0))]
    pub module_mm: f64,
    /// Face width of rack and pinion.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 1e4))]
    pub face_width_mm: f64,
    /// Teeth of the pinion.
    #[schemars(range(min = 12, max = 10_000))]
    pub teeth: u32,
    /// Allowable bending stress at the root of a tooth; a warning above.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 1e5))]
    pub allowable_stress_mpa: f64,
}

/// The coil of a clutch that a current engages.
#[skip_serializing_none]
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CoilTable {
    /// Power of a coil while its clutch is engaged.
    #[schemars(range(min = 0.0, max = 1e5))]
    pub holding_power_w: f64,
    /// Energy that it takes to engage a clutch once, beside the power that holds it.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e5))]
    pub closing_energy_j: f64,
    /// Largest energy of both coils over a motion; a warning above.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 1e9))]
    pub largest_energy_j: Option<f64>,
}

impl CoilTable {
    /// What the coils, of which each is this one, take for what was `used`: holding power × time engaged + energy of the closings, J.
    pub fn energy_j(&self, used: &CoilUse) -> f64 {
        self.holding_power_w * used.engaged_s + self.closing_energy_j * f64::from(used.closings)
    }
}

impl ChecksTable {
    /// Who looks at the coils of `device` on a `loaded` block, which works at rest too where it is `carried`; nobody where no coil is given, or
    /// none holds a clutch.
    pub(crate) fn coil_use(&self, device: &SceneDevice, loaded: &Structure, carried: bool) -> Option<CoilUse> {
        let looks = self.coil.is_some() && device.takes_commands();
        looks.then(|| CoilUse::of(carried, CountedSwing::of(&loaded.block)))
    }

    /// # Errors
    /// [`SceneError`] names the key.
    pub(super) fn check(&self, block_mass: Option<f64>, key: &KeyOf<'_>) -> Result<(), SceneError> {
        if self.gear.is_some() && block_mass.is_none() {
            return Err(key("checks.gear").conflict("a stress needs a force in N, and so block.mass_kg"));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energy_is_power_times_time_and_a_share_for_each_closing() {
        let coil = CoilTable { holding_power_w: 24.0, closing_energy_j: 5.0, largest_energy_j: None };
        let mut used = CoilUse::default();
        used.hold([true, false], 0.3);
        used.hold([false, true], 1.0);
        assert!((coil.energy_j(&used) - (24.0 * 1.3 + 10.0)).abs() < 1e-12);
    }
}
