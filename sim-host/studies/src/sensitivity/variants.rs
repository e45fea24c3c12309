//! The effects that a study of sensitivity turns on, each at a stated, typical value.

use sprag_sim::scene::device::{DeviceTable, Kind};

/// One change of a scene.
#[derive(Clone, Copy, Debug)]
pub struct Variant {
    /// The effect's name in [`sprag_sim::effect::EFFECTS`]; "together" for several.
    pub effect: &'static str,
    /// What it is set to, for tables and pictures: everything that is turned on, and whether a fraction is one of the block's mass or weight.
    pub name: &'static str,
    /// The kinds of devices that it is for.
    pub kinds: &'static [Kind],
    /// `KEY=VALUE`, as for `--set`, of single values: a table of the scene keeps what else it has. `N` is the number of the device.
    pub changes: &'static [&'static str],
    /// Further ones, for a clutched pair.
    pub of_pair: &'static [&'static str],
    /// The ground moves vertically too.
    pub vertical: bool,
    /// The scene has no device but the one that it is for, which is number 0 then.
    pub alone: bool,
}

/// Vertical over horizontal acceleration where there is no vertical record: the ratio that codes take.
pub const VERTICAL_RATIO: f64 = 2.0 / 3.0;

const EVERY: &[Kind] = &[Kind::None, Kind::Inerter, Kind::ClutchedPair];
const BARE: &[Kind] = &[Kind::None];
const INERTERS: &[Kind] = &[Kind::Inerter, Kind::ClutchedPair];
const PAIR: &[Kind] = &[Kind::ClutchedPair];

const fn variant(effect: &'static str, name: &'static str, kinds: &'static [Kind], changes: &'static [&'static str]) -> Variant {
    Variant { effect, name, kinds, changes, of_pair: &[], vertical: false, alone: false }
}

/// All of them, in the order of the registry of effects.
///
/// - Losses ("bearings"): 0.05 m/s² at the rack, with a mass ratio of 0.5 a force of 0.0025 m g, is a train of gears with seals (plain rolling
///   bearings have a tenth of it); 0.05 1/s is windage, a flywheel that coasts for 20 s. A brake of 10 m/s² stops one from 1 m/s
///   within 0.1 s.
/// - Clutches: a tenth of the block's weight is about the largest force of the ideal device, a fiftieth makes it slip. 1e4 m p²
///   is a mode of shaft and flywheel at 140 p for a mass ratio of 0.5, 10 % its damping with gears and lubricant, 1 mm the play
///   of coarse gears after years. Released flywheels stop at once, as the ideal ones do, so that the clutch alone differs.
/// - Scatter: 0.02 is a fifth of what separates the restitution of the block's geometry from the paper's; one seed of many.
/// - Sliding: 0.4 is the lower end of what steel or stone has on concrete (0.4 to 0.6).
/// - Foundation: 10 Hz is the vertical frequency of a footing on medium sand, 5 Hz on soft clay; radiation into the soil damps it by 0.2 to 0.5.
/// - Support: a wall whose own frequency is 2.5 times that of the motion amplifies it by 1/(1 - 0.4²) = 1.19; base-slab averaging and
///   embedment of a building reduce it by as much (FEMA 440).
///   5 Hz is the first mode of a stiff wall or braced frame of one storey, 2 Hz that of an open steel frame; 5 % and 2 % are the damping
///   that codes take for concrete and for steel that stays elastic.
/// - Rack: 0.01 of the weight and 0.05 1/s are rolling guides and their seals.
/// - Slip: an inerter that was built and tested below 5 Hz lost inertance with frequency (Madhamshetty and Manimala 2018); the corner is a choice:
///   at 2 Hz a tenth is gone, 1/√(1 + (2/4)²) = 0.894.
/// - Load friction: 0.05 is a choice, a mesh of rack and pinion with an efficiency of 95 %, below the 98 % of good spur gears.
/// - Coil: the torque of particle and friction clutches has time constants of about 0.1 s.
/// - Delays: 20 ms is a fast electromagnetic clutch with its driver, 50 ms an ordinary one; every tenth engagement missed is a
///   poor sensor.
/// - Weight: a flywheel of 0.02 of the block's mass and seven times its pinion's radius has a mass ratio of 0.5; the rack has
///   half of that mass.
pub const VARIANTS: [Variant; 33] = [
    variant("geometry", "slender", EVERY, &["block.geometry=slender"]),
    Variant { vertical: true, ..variant("vertical", "vertical ground motion", EVERY, &[]) },
    variant("impact", "geometric restitution", EVERY, &["block.restitution=geometric"]),
    variant("impact", "momentum balance", EVERY, &["block.restitution=momentum-balance"]),
    variant(
        "scatter",
        "η scatters by 0.02 from impact to impact",
        EVERY,
        &["block.restitution_scatter=0.02", "block.restitution_seed=1"],
    ),
    Variant {
        alone: true,
        ..variant(
            "foundation",
            "vertical frequency 10 Hz, ζ = 0.3",
            EVERY,
            &["block.foundation.vertical_frequency_hz=10", "block.foundation.damping_ratio=0.3"],
        )
    },
    Variant {
        alone: true,
        ..variant(
            "foundation",
            "vertical frequency 5 Hz, ζ = 0.3",
            EVERY,
            &["block.foundation.vertical_frequency_hz=5", "block.foundation.damping_ratio=0.3"],
        )
    },
    Variant { alone: true, ..variant("sliding", "μ = 0.4", BARE, &["block.friction_coefficient=0.4"]) },
    variant("support", "amplifies the ground by 20 %", INERTERS, &["device.N.support_amplification=1.2"]),
    variant("support", "reduces the ground by 20 %", INERTERS, &["device.N.support_amplification=0.8"]),
    variant(
        "support",
        "wall of 5 Hz, 5 % damping",
        INERTERS,
        &["device.N.support_frequency_hz=5", "device.N.support_damping_ratio=0.05"],
    ),
    variant(
        "support",
        "frame of 2 Hz, 2 % damping",
        INERTERS,
        &["device.N.support_frequency_hz=2", "device.N.support_damping_ratio=0.02"],
    ),
    variant("kinematics", "consistent", INERTERS, &["device.N.kinematics=consistent"]),
    variant("weight", "guided rack, 0.01 × block mass", INERTERS, &["device.N.weight.rack_ratio=0.01"]),
    variant(
        "weight",
        "flywheels on the block, 0.02 × its mass",
        INERTERS,
        &["device.N.weight.flywheels_ratio=0.02", "device.N.weight.flywheels_on=block"],
    ),
    variant("rack", "dry friction, 0.01 × block weight", INERTERS, &["device.N.rack.dry_friction_ratio=0.01"]),
    variant("rack", "viscous 0.05 1/s", INERTERS, &["device.N.rack.viscous_1_s=0.05"]),
    variant("rack", "mesh friction, 0.05 × force", INERTERS, &["device.N.rack.load_friction=0.05"]),
    variant(
        "engagement",
        "rigid, bearings, brake 10 m/s²",
        PAIR,
        &[
            "device.N.engagement=rigid",
            "device.N.flywheel.viscous_rate_1_s=0.05",
            "device.N.flywheel.dry_deceleration_m_s2=0.05",
            "device.N.flywheel.brake_deceleration_m_s2=10",
        ],
    ),
    variant(
        "engagement",
        "rigid, bearings, instant brake",
        PAIR,
        &[
            "device.N.engagement=rigid",
            "device.N.flywheel.viscous_rate_1_s=0.05",
            "device.N.flywheel.dry_deceleration_m_s2=0.05",
            "device.N.flywheel.brake_deceleration_m_s2=instant",
        ],
    ),
    variant(
        "engagement",
        "overrunning, bearings, no brake",
        PAIR,
        &[
            "device.N.engagement=overrunning",
            "device.N.flywheel.viscous_rate_1_s=0.05",
            "device.N.flywheel.dry_deceleration_m_s2=0.05",
            NO_BRAKE,
        ],
    ),
    // Open wet clutches drag with a few per cent of what they pass: for σ = 0.5 this is 2 % of a tenth of the block's weight at 0.4 m/s.
    variant(
        "engagement",
        "rigid, drag 0.1 1/s, 1 ms to engage, no brake",
        PAIR,
        &[
            "device.N.engagement=rigid",
            "device.N.flywheel.drag_rate_1_s=0.1",
            "device.N.actuation.engagement_delay_s=0.001",
            NO_BRAKE,
        ],
    ),
    variant("clutch", "capacity 0.1 × block weight, instant brake", PAIR, &["device.N.clutch.capacity_ratio=0.1", INSTANT_BRAKE]),
    variant(
        "clutch",
        "capacity 0.02 × block weight, instant brake",
        PAIR,
        &["device.N.clutch.capacity_ratio=0.02", INSTANT_BRAKE],
    ),
    variant(
        "clutch",
        "elastic, K = 1e4 m p², ζ = 0.1, instant brake",
        PAIR,
        &["device.N.clutch.stiffness_ratio=1e4", "device.N.clutch.damping_ratio=0.1", INSTANT_BRAKE],
    ),
    variant(
        "clutch",
        "K = 1e4 m p², ζ = 0.1, 1 mm backlash, instant brake",
        PAIR,
        &[
            "device.N.clutch.stiffness_ratio=1e4",
            "device.N.clutch.damping_ratio=0.1",
            "device.N.clutch.backlash_m=0.001",
            INSTANT_BRAKE,
        ],
    ),
    Variant {
        of_pair: &[INSTANT_BRAKE],
        ..variant("slip", "inertance corner at 4 Hz", INERTERS, &["device.N.inertance_corner_hz=4"])
    },
    variant(
        "actuation",
        "coil of 0.1 s, capacity 0.1 × block weight, instant brake",
        PAIR,
        &["device.N.clutch.capacity_ratio=0.1", INSTANT_BRAKE, "device.N.actuation.time_constant_s=0.1"],
    ),
    variant(
        "actuation",
        "delays of 20 ms",
        PAIR,
        &["device.N.actuation.engagement_delay_s=0.02", "device.N.actuation.release_delay_s=0.02"],
    ),
    variant(
        "actuation",
        "delays of 50 ms",
        PAIR,
        &["device.N.actuation.engagement_delay_s=0.05", "device.N.actuation.release_delay_s=0.05"],
    ),
    variant("actuation", "1 in 10 engagements missed", PAIR, &["device.N.actuation.miss_probability=0.1"]),
    variant(
        "flywheel",
        "bearings 0.05 m/s², 0.05 1/s",
        INERTERS,
        &["device.N.flywheel.viscous_rate_1_s=0.05", "device.N.flywheel.dry_deceleration_m_s2=0.05"],
    ),
    Variant {
        of_pair: &[
            "device.N.clutch.capacity_ratio=0.1",
            "device.N.flywheel.viscous_rate_1_s=0.05",
            "device.N.flywheel.dry_deceleration_m_s2=0.05",
            "device.N.flywheel.brake_deceleration_m_s2=10",
            "device.N.actuation.engagement_delay_s=0.02",
            "device.N.actuation.release_delay_s=0.02",
        ],
        ..variant(
            "together",
            "a realistic device",
            INERTERS,
            &[
                "device.N.kinematics=consistent",
                "block.restitution=geometric",
                "device.N.flywheel.viscous_rate_1_s=0.05",
                "device.N.flywheel.dry_deceleration_m_s2=0.05",
                "device.N.rack.dry_friction_ratio=0.01",
                "device.N.rack.viscous_1_s=0.05",
                "device.N.weight.flywheels_ratio=0.02",
                "device.N.weight.rack_ratio=0.01",
            ],
        )
    },
];

/// Released flywheels coast, those of a scene with brakes too.
const NO_BRAKE: &str = "device.N.flywheel.brake_deceleration_m_s2=0";

/// As the ideal clutch has it.
const INSTANT_BRAKE: &str = "device.N.flywheel.brake_deceleration_m_s2=instant";

impl Variant {
    /// Its `KEY=VALUE` for device number `index` of `kind`; `None` if it is not for that kind.
    pub fn overrides(&self, index: usize, kind: Kind) -> Option<Vec<String>> {
        let of_pair = if kind == Kind::ClutchedPair { self.of_pair } else { &[] };
        let changes = self.changes.iter().chain(of_pair);
        self.kinds.contains(&kind).then(|| changes.map(|change| change.replacen(".N.", &format!(".{index}."), 1)).collect())
    }

    /// `KEY=VALUE` that leave a scene with the devices of `table` only, for a variant that is for one device `alone`.
    ///
    /// # Errors
    /// In words.
    pub fn isolated(&self, table: &DeviceTable) -> Result<Option<String>, String> {
        if !self.alone {
            return Ok(None);
        }
        let device = toml::Value::try_from([table]).map_err(|error| error.to_string())?;
        Ok(Some(format!("device={device}")))
    }

    /// Effect and name in one.
    pub fn label(&self) -> String {
        format!("{}: {}", self.effect, self.name)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use sprag_sim::effect;
    use sprag_sim::effect::explanation::Effects;
    use sprag_sim::scene::Scene;

    #[test]
    fn every_variant_turns_its_effect_on_and_nothing_else_but_what_it_needs() {
        let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/near_fault.toml"));
        let base = Scene::load(path, &[]).unwrap();
        for variant in &VARIANTS {
            for (index, table) in base.file.device.iter().enumerate() {
                let Some(mut overrides) = variant.overrides(index, table.kind) else {
                    continue;
                };
                let isolated = variant.isolated(table).unwrap();
                let index = if isolated.is_some() { 0 } else { index };
                overrides.splice(0..0, isolated);
                let scene = Scene::load(path, &overrides).unwrap_or_else(|error| panic!("{}: {error}", variant.label()));
                if variant.effect == "together" || variant.vertical {
                    continue;
                }
                let effect = effect::find(variant.effect).unwrap();
                assert!((effect.is_on)(&scene, index), "{}", variant.label());
                let on = Effects::of_scene(&scene).on.into_iter().chain(Effects::of_device(&scene, index).on);
                let others: Vec<_> = on.map(|setting| setting.effect.name).filter(|name| *name != variant.effect).collect();
                // Flywheels with a speed of their own bring the consistent kinematics with them, a coil needs the plates that it presses, and
                // a clutch that drags needs a delay.
                let needed = [("coil", "clutch"), ("drag", "actuation")];
                let needed = needed.into_iter().filter(|(word, _)| variant.name.contains(word)).map(|(_, effect)| effect);
                let brought: Vec<_> = ["flywheel", "kinematics"].into_iter().chain(needed).collect();
                assert!(others.iter().all(|name| brought.contains(name)), "{}: {others:?}", variant.label());
            }
        }
    }

    #[test]
    fn a_label_says_all_that_its_variant_sets_and_no_mass_reads_as_metres() {
        let said = [
            ("brake_deceleration_m_s2=10", "brake 10 m/s²"),
            ("brake_deceleration_m_s2=0", "no brake"),
            ("brake_deceleration_m_s2=instant", "instant brake"),
            ("viscous_rate_1_s", "bearings"),
            ("capacity_ratio=0.1", "capacity 0.1 × block weight"),
            ("capacity_ratio=0.02", "capacity 0.02 × block weight"),
            ("stiffness_ratio=1e4", "K = 1e4 m p²"),
            ("damping_ratio=0.1", "ζ = 0.1"),
            ("backlash_m=0.001", "1 mm backlash"),
            ("rack_ratio=0.01", "0.01 × block mass"),
            ("flywheels_ratio=0.02", "flywheels"),
            ("flywheels_on=block", "on the block"),
            ("dry_friction_ratio=0.01", "0.01 × block weight"),
            ("drag_rate_1_s=0.1", "drag 0.1 1/s"),
            ("engagement_delay_s=0.001", "1 ms to engage"),
            ("engagement=rigid", "rigid"),
            ("engagement=overrunning", "overrunning"),
        ];
        // What is together is listed key by key beside the table.
        for variant in VARIANTS.iter().filter(|variant| variant.effect != "together") {
            let changes = variant.changes.join("; ");
            for (_, words) in said.iter().filter(|(key, _)| changes.contains(key)) {
                assert!(variant.name.contains(words), "{}: {changes}", variant.name);
            }
            let reads_as_metres = variant.name.contains(" m g") || variant.name.ends_with(" m") || variant.name.contains(" m on");
            assert!(!reads_as_metres, "{}", variant.name);
        }
    }

    #[test]
    fn names_distinguish_variants() {
        let labels: std::collections::BTreeSet<String> = VARIANTS.iter().map(Variant::label).collect();
        assert_eq!(labels.len(), VARIANTS.len());
    }
}
