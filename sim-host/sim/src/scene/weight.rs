//! `weight` of a `[[device]]`: the gravitational mass of flywheels and rack, and what it rides on.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_with::skip_serializing_none;
use sprag_shared::math;
use sprag_shared::structure::added_mass::AddedMass;
use sprag_shared::structure::block::Block;
use sprag_shared::structure::device::Device;
use sprag_shared::structure::mount::Mount;

use super::drivetrain::either;
use super::error::SceneError;
use super::schema::KeyOf;

/// The keys of the flywheels' mass.
const FLYWHEELS: [&str; 2] = ["weight.flywheels_ratio", "weight.flywheels_kg"];

/// The keys of the rack's.
const RACK: [&str; 2] = ["weight.rack_ratio", "weight.rack_kg"];

/// What something rides on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Seat {
    /// The ground, or whatever the device leans on.
    #[default]
    Support,
    /// The block, at the mount.
    Block,
}

/// `weight`. Masses are those of all flywheels, with gears and housing, and of the rack.
#[skip_serializing_none]
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WeightTable {
    /// Mass of all flywheels, gears and housing over the block's; or give `flywheels_kg`.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub flywheels_ratio: Option<f64>,
    /// Mass of all flywheels, gears and housing; or give `flywheels_ratio`.
    #[schemars(range(min = 0.0))]
    pub flywheels_kg: Option<f64>,
    /// What flywheels, gears and housing ride on.
    #[serde(default)]
    pub flywheels_on: Seat,
    /// Mass of the rack over the block's; or give `rack_kg`.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub rack_ratio: Option<f64>,
    /// Mass of the rack; or give `rack_ratio`.
    #[schemars(range(min = 0.0))]
    pub rack_kg: Option<f64>,
    /// What the rack rides on.
    #[serde(default)]
    pub rack_on: Seat,
}

impl WeightTable {
    /// Keys of masses that stand still on the support, and so add nothing to the motion.
    pub fn standing(&self) -> Vec<&'static str> {
        let flywheels = [(FLYWHEELS[0], self.flywheels_ratio), (FLYWHEELS[1], self.flywheels_kg)];
        let rack = [(RACK[0], self.rack_ratio), (RACK[1], self.rack_kg)];
        let stands = |on_support: bool, masses: [(&'static str, Option<f64>); 2]| {
            masses.into_iter().filter(move |(_, mass)| on_support && mass.is_some_and(|mass| mass > 0.0)).map(|(name, _)| name)
        };
        let rack_stands = self.rack_on == Seat::Support && self.flywheels_on == Seat::Block;
        stands(self.flywheels_on == Seat::Support, flywheels).chain(stands(rack_stands, rack)).collect()
    }

    /// What rides on the block, and the mass ratio of a rack that moves along on guides of the support. What stands still adds
    /// nothing to either.
    ///
    /// # Errors
    /// [`SceneError`] names the key.
    pub(super) fn resolve(
        &self,
        device: &Device,
        block: &Block,
        block_mass: Option<f64>,
        key: &KeyOf<'_>,
    ) -> Result<(AddedMass, f64), SceneError> {
        let mass = |names: [&str; 2], ratio: Option<f64>, kg: Option<f64>, seat: Seat| {
            let given = either(key, (names[0], ratio), (names[1], kg), block_mass, 1.0)?;
            if given.is_none() && seat == Seat::Block {
                return Err(key(names[0]).missing("the mass of what rides on the block, as a ratio or in kg"));
            }
            let value = given.unwrap_or(0.0);
            let name = if kg.is_some() { format!("{} over block.mass_kg", names[1]) } else { names[0].to_owned() };
            key(&name).require(value, (0.0..=10.0).contains(&value), "from 0 to 10")
        };
        if self.flywheels_on == Seat::Block && self.rack_on == Seat::Block {
            let reason = "rack and flywheels both ride on the block, so nothing turns the flywheels: put one on the support";
            return Err(key("weight.rack_on").conflict(reason));
        }
        let flywheels = mass(FLYWHEELS, self.flywheels_ratio, self.flywheels_kg, self.flywheels_on)?;
        let rack = mass(RACK, self.rack_ratio, self.rack_kg, self.rack_on)?;
        let height = match device.mount {
            Mount::CentreOfMass => block.size() * math::cos(block.slenderness()),
            Mount::TyingPoint { height, .. } => height,
            Mount::BaseCorners { .. } => 0.0,
        };
        let on_block = |mass_ratio: f64| if mass_ratio > 0.0 { AddedMass { mass_ratio, height } } else { AddedMass::NONE };
        match (self.flywheels_on, self.rack_on) {
            (Seat::Block, _) => Ok((on_block(flywheels), 0.0)),
            (Seat::Support, Seat::Block) => Ok((on_block(rack), 0.0)),
            (Seat::Support, Seat::Support) => {
                if rack > 0.0
                    && let Mount::BaseCorners { .. } = device.mount
                {
                    let reason = "a vertical rack hangs on the block and not on guides: put it on the block with weight.rack_on";
                    return Err(key(if self.rack_kg.is_some() { RACK[1] } else { RACK[0] }).conflict(reason));
                }
                Ok((AddedMass::NONE, rack))
            }
        }
    }
}
