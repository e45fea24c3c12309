//! `[block.foundation]`: the compliant base of a block, and what it cannot go with.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::foundation::Foundation;
use sprag_shared::structure::mount::Mount;

use super::error::SceneError;
use super::schema::{KeyOf, MethodName, SceneFile};
use super::{Scene, SceneDevice};

/// Why no controller drives the clutches of a device on a foundation.
const CONTROLLED: &str = "a controller follows a block on rigid ground";

/// A spring and a dashpot under each toe.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FoundationTable {
    /// Natural frequency of the block moving up and down on both feet, √(2k/m)/2π. Impacts end: the dashpots take what `block.restitution` took.
    #[schemars(range(min = 0.5, max = 1000.0))]
    pub vertical_frequency_hz: f64,
    /// Damping ratio of that motion, c/√(2km).
    #[schemars(range(min = 0.0, max = 2.0))]
    pub damping_ratio: f64,
}

impl From<FoundationTable> for Foundation {
    fn from(table: FoundationTable) -> Foundation {
        Foundation { vertical_frequency: table.vertical_frequency_hz, damping_ratio: table.damping_ratio }
    }
}

/// Refuses what the compliant base of `file` contradicts.
///
/// # Errors
/// [`SceneError`] names the key and the reason.
pub(super) fn check(file: &SceneFile, devices: &[SceneDevice], key: &KeyOf<'_>) -> Result<(), SceneError> {
    let refuse = |name: &str, reason: &str| Err(key(name).conflict(reason));
    let name = "block.foundation";
    if file.block.friction_coefficient.is_some() {
        return refuse(name, "a block slides on rigid ground only: without block.friction_coefficient");
    }
    if Geometry::from(file.block.geometry) == Geometry::Slender {
        return refuse(name, "a block on a foundation has the exact geometry: block.geometry = \"full\"");
    }
    if file.block.scatter().is_on() {
        return refuse(name, "a block on a foundation has no impacts that could scatter (block.restitution_scatter)");
    }
    for (index, device) in devices.iter().enumerate() {
        if !device.is_ideal() || device.device.mount != Mount::CentreOfMass {
            let what = format!(
                "device.{index} is not an ideal one at the centre of mass, the only kind that is followed on a foundation"
            );
            return refuse(name, &what);
        }
        if !device.added_mass.is_none() {
            let what = format!("a block on a foundation carries no mass of its device (device.{index}.weight)");
            return refuse(name, &what);
        }
    }
    if file.checks.is_some() {
        return refuse("checks", "the checks are those of a block on rigid ground, and block.foundation gives");
    }
    if file.output.energy {
        return refuse("output.energy", "the ledger has no entry for a foundation that gives (block.foundation)");
    }
    if file.controller.is_some() {
        return refuse(name, CONTROLLED);
    }
    let in_steps = "a block on a foundation is followed by Runge-Kutta steps";
    if file.accuracy.level.is_some() {
        return refuse("accuracy.level", &format!("{in_steps}: give accuracy.step_s"));
    }
    let stepped = file.accuracy.step_s.is_some() || file.accuracy.step_ratio.is_some();
    if stepped && file.accuracy.method == MethodName::Taylor {
        return refuse("accuracy.method", &format!("{in_steps}: with a step give runge-kutta-4"));
    }
    Ok(())
}

impl Scene {
    /// Refuses a closed loop over a block on a foundation, which a scene without a `[controller]` may have.
    ///
    /// # Errors
    /// [`SceneError`] names the key.
    pub fn check_loop_base(&self) -> Result<(), SceneError> {
        match self.file.block.foundation {
            Some(_) => Err(self.key("block.foundation").conflict(CONTROLLED)),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::Scene;

    #[test]
    fn the_weight_of_a_device_on_a_foundation_is_refused_as_what_it_is() {
        let scene = |on: &str| {
            let text = format!(
                "device = [{{ kind = 'inerter', mass_ratio = 0.5, weight = {{ flywheels_ratio = 0.1, flywheels_on = '{on}' }} }}]
                ground = [{{ motion = 'sine', amplitude_g = 0.4, frequency_hz = 1.3 }}]
                [block]
                size_m = 2.0
                slenderness_deg = 12.0
                foundation = {{ vertical_frequency_hz = 10.0, damping_ratio = 0.3 }}"
            );
            Scene::parse(&text, "scene").map(drop).map_err(|error| error.to_string())
        };
        assert_eq!(scene("support"), Ok(()));
        assert_eq!(
            scene("block").unwrap_err(),
            "scene: block.foundation: a block on a foundation carries no mass of its device (device.0.weight)"
        );
    }
}
