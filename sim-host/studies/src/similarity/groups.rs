//! The dimensionless groups of a scene (Eq. 20-23).

use std::f64::consts::TAU;

use serde::Serialize;
use sprag_shared::math;
use sprag_shared::structure::block::{GRAVITY, Geometry};
use sprag_shared::structure::error::ParameterError;
use sprag_sim::scene::Scene;
use sprag_sim::scene::ground::{Direction, GroundError, GroundTable, Motion};

use super::keys::{self, Scales};
use crate::cloud::measure::{BlockScales, Measure, MeasuredRecord};

/// Relative difference up to which two groups count as equal.
pub const SAME: f64 = 1e-9;

/// A dimensionless group.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Group {
    /// Its symbol; with the number of the ground motion or the name of the device where it belongs to one.
    pub name: String,
    /// Its value; none where it has no meaning, such as the factor of a support that has a record of its own.
    pub value: Option<f64>,
}

impl Group {
    fn new(name: String, value: impl Into<Option<f64>>) -> Group {
        Group { name, value: value.into() }
    }

    /// Whether the two are the same group with the same value.
    pub fn equals(&self, other: &Group) -> bool {
        let close = |(a, b): (f64, f64)| (a - b).abs() <= SAME * a.abs().max(b.abs());
        self.name == other.name && self.value.zip(other.value).map_or(self.value == other.value, close)
    }
}

/// Why a scene's groups cannot be had.
#[derive(Debug, thiserror::Error)]
pub enum GroupsError {
    /// A restitution that the block cannot have.
    #[error("{0}")]
    Block(#[from] ParameterError),
    /// A record that cannot be read.
    #[error("{0}")]
    Ground(#[from] GroundError),
}

/// The groups of `scene`: those of every motion of the ground, then those of every device. Slender blocks with an ideal device know σ, ℓ and λ as
/// σℓ²/λ alone; for all others λ and ℓ are groups too, and so is α where other keys of the block are set.
///
/// # Errors
/// [`GroupsError`] for a restitution that the block cannot have, or a record that cannot be read.
pub fn groups(scene: &Scene) -> Result<Vec<Group>, GroupsError> {
    let p = scene.block.frequency_parameter();
    let scales = Scales::of(scene);
    let mut groups = Vec::new();
    for direction in [Direction::Horizontal, Direction::Vertical] {
        let (place, tables) = scene.file.motions(direction);
        for (index, table) in tables.iter().enumerate() {
            groups.extend(of_motion(scene, direction, (place, index), table)?);
        }
    }
    for index in 0..scene.devices.len() {
        let structure = scene.structure(index);
        let of = |symbol: &str| format!("{symbol} of {}", structure_name(scene, index));
        groups.push(Group::new(of("η"), structure.restitution()?));
        let (device, table) = (structure.device, &scene.file.device[index]);
        let (lambda, lever) = (scene.block.inertia_ratio(), device.mount.slender_lever_squared(&scene.block)?);
        groups.push(Group::new(of("σℓ²/λ"), device.mass_ratio * lever / lambda));
        let beyond = scales.groups(&json(table), &keys::OF_DEVICE);
        let alone = scene.geometry() == Geometry::Slender && beyond.is_empty() && table.support_key().is_none();
        if !alone {
            groups.push(Group::new(of("λ"), lambda));
            if device.mass_ratio > 0.0 {
                groups.push(Group::new(of("ℓ"), math::square_root(lever)));
            }
        }
        groups.extend(beyond.into_iter().map(|(key, value)| Group::new(of(&key), value)));
        if let Some(wall) = table.support_oscillator() {
            groups.push(Group::new(of("ω_s/p"), wall.frequency_hz * TAU / p));
            groups.push(Group::new(of("ζ_s"), wall.damping_ratio));
        } else if table.support_key().is_some() {
            // Of a record it has no value.
            groups.push(Group::new(of("ü_s/ü_g"), table.support_amplification));
        }
    }
    let of_block = scales.groups(&json(&scene.file.block), &keys::OF_BLOCK);
    if of_block.iter().any(|(_, value)| value.is_some()) {
        groups.push(Group::new("α".to_owned(), scene.block.slenderness()));
    }
    groups.extend(of_block.into_iter().map(|(key, value)| Group::new(format!("block.{key}"), value)));
    groups.push(Group::new("θ(0)/α".to_owned(), scene.file.block.initial_rotation_ratio));
    groups.push(Group::new("θ̇(0)/(pα)".to_owned(), scene.file.block.initial_velocity_ratio));
    Ok(groups)
}

/// A table of a scene by its keys.
fn json(table: &impl Serialize) -> serde_json::Value {
    // Tables of a scene have names for keys, and numbers, words and tables for values.
    serde_json::to_value(table).unwrap_or_default()
}

/// What stays of a device's name when its numbers change: its place and kind.
fn structure_name(scene: &Scene, index: usize) -> String {
    format!("device {index} ({})", scene.file.device[index].kind.name())
}

/// The groups of one motion; a record has those of its peaks. A vertical motion is one in g.
fn of_motion(
    scene: &Scene,
    direction: Direction,
    (place, index): (&str, usize),
    table: &GroundTable,
) -> Result<Vec<Group>, GroupsError> {
    let (threshold, unit) = match (direction, scene.geometry()) {
        (Direction::Vertical, _) => (1.0, "g"),
        (_, Geometry::Slender) => (scene.uplift_threshold(), "(gα)"),
        _ => (scene.uplift_threshold(), "(g tan α)"),
    };
    let p = scene.block.frequency_parameter();
    let group = |symbol: &str, value| Group::new(format!("{symbol} of {place} {index} ({})", table.kind()), value);
    let mut groups = if table.motion == Motion::Record {
        let key = |key: &str| scene.key(&format!("{place}.{index}.{key}"));
        let record = MeasuredRecord::from(table.record(scene, direction, &key)?);
        let scales = BlockScales { frequency_parameter_1_s: p, uplift_threshold_m_s2: threshold * GRAVITY };
        let of = |measure: Measure| measure.of(&record, 1.0, scales);
        vec![
            group(&Measure::Frequency.formula(false), of(Measure::Frequency)),
            group(&format!("PGA/{unit}"), of(Measure::Pga) * table.scale),
        ]
    } else {
        vec![group("ω_g/p", frequency(table, p)), group(&format!("a_g/{unit}"), amplitude(table, p, threshold))]
    };
    if let Some(oscillations) = table.oscillations {
        groups.extend([group("γ", oscillations), group("ν", table.phase_deg.unwrap_or_default())]);
    }
    groups.push(group("p × start", table.start_s * p));
    Ok(groups)
}

/// ω_g/p of a pulse; of a rectangular one by the half sine of its length.
fn frequency(table: &GroundTable, p: f64) -> f64 {
    let duration = || table.duration_ratio.unwrap_or_else(|| table.duration_s.unwrap_or_default() * p);
    let hertz = table.frequency_hz.map(|hertz| hertz * TAU / p);
    table.frequency_ratio.or(hertz).unwrap_or_else(|| 0.5 * TAU / duration())
}

/// a_g of a pulse over `threshold` (in g).
fn amplitude(table: &GroundTable, p: f64, threshold: f64) -> f64 {
    let rate = || table.frequency_hz.map_or_else(|| frequency(table, p) * p, |hertz| hertz * TAU);
    // a_g = A ω: the velocity amplitude of a near-fault pulse with its frequency.
    let of_velocity = || table.velocity_amplitude_m_s.unwrap_or_default() * rate();
    let in_g = || table.amplitude_g.unwrap_or_else(|| table.amplitude_m_s2.unwrap_or_else(of_velocity) / GRAVITY);
    table.amplitude_ratio.unwrap_or_else(|| in_g() / threshold) * table.scale
}

/// Names of the groups that two blocks do not have in common with the same value.
pub fn unequal<'a>(first: &'a [Group], other: &'a [Group]) -> Vec<&'a str> {
    let same = |group: &&Group| !first.iter().any(|known| known.equals(group));
    let mut names: Vec<&str> = other.iter().filter(same).map(|group| group.name.as_str()).collect();
    let missing = first.iter().filter(|group| other.iter().all(|known| known.name != group.name));
    names.extend(missing.map(|group| group.name.as_str()));
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same wall is another one to another block; so is a wall to a block without one.
    #[test]
    fn supports_have_groups() {
        let of = |size: f64, support: &str| {
            let text = format!(
                "block = {{ size_m = {size}, slenderness_deg = 10.0 }}\n\
                 device = [{{ kind = 'inerter', mass_ratio = 0.5{support} }}]\n\
                 ground = [{{ motion = 'sine', amplitude_ratio = 2.0, frequency_ratio = 3.0 }}]"
            );
            groups(&Scene::parse(&text, "scene").unwrap()).unwrap()
        };
        let wall = |hertz: f64| format!(", support_frequency_hz = {hertz}, support_damping_ratio = 0.05");
        let names = |one: &[Group], other: &[Group]| unequal(one, other).join(", ");
        let first = of(2.0, &wall(5.0));
        assert_eq!(names(&first, &of(2.0, &wall(5.0))), "");
        assert_eq!(names(&first, &of(8.0, &wall(5.0))), "ω_s/p of device 0 (inerter)");
        assert_eq!(names(&first, &of(8.0, &wall(2.5))), "");
        let factor = of(2.0, ", support_amplification = 1.2");
        assert_eq!(names(&factor, &of(2.0, ", support_amplification = 1.3")), "ü_s/ü_g of device 0 (inerter)");
        for (one, other) in [(&factor, &of(2.0, "")), (&of(2.0, ""), &factor)] {
            assert_eq!(names(one, other), "ü_s/ü_g of device 0 (inerter)");
        }
    }

    /// A slender block with an ideal pair knows σℓ²/λ alone; one with more to it each key by itself.
    #[test]
    fn whatever_differs_of_block_and_device_is_named() {
        let of_p = |p: f64, block: &str, device: &str| {
            let text = format!(
                "block = {{ frequency_parameter_1_s = {p}, geometry = 'slender', {block} }}\n\
                 device = [{{ kind = 'clutched-pair', {device} }}]\n\
                 ground = [{{ motion = 'sine', amplitude_ratio = 2.0, frequency_ratio = 3.0 }}]"
            );
            groups(&Scene::parse(&text, "scene").unwrap()).unwrap()
        };
        let of = |block: &str, device: &str| of_p(2.0, block, device);
        let names = |one: &[Group], other: &[Group]| unequal(one, other).join(", ").replace(" of device 0 (clutched-pair)", "");
        let at_10 = "slenderness_deg = 10.0";
        let first = of(at_10, "mass_ratio = 0.5");
        assert_eq!(names(&first, &of(&format!("{at_10}, inertia_ratio = 2.0"), "mass_ratio = 0.75")), "");
        assert_eq!(names(&first, &of(&format!("{at_10}, inertia_ratio = 2.0"), "mass_ratio = 0.5")), "σℓ²/λ");
        let corners = |device: &str| of(at_10, &format!("mount = 'base-corners', pulley_ratio = 2.0, {device}"));
        assert_eq!(names(&first, &corners("mass_ratio = 0.5")), "σℓ²/λ");
        let lever = 4.0 * 10_f64.to_radians();
        assert_eq!(names(&first, &corners(&format!("mass_ratio = {}", 0.5 / (lever * lever)))), "");

        // The same delay is another one to a block that is twice as large, and the same capacity to one that is more slender.
        let late = |p: f64, delay: f64| {
            let device = format!("mass_ratio = 0.5, actuation = {{ engagement_delay_s = {delay} }}");
            of_p(p, at_10, &device)
        };
        assert_eq!(names(&late(2.0, 0.02), &late(1.0, 0.02)), "actuation.engagement_delay_s");
        assert_eq!(names(&late(2.0, 0.02), &late(1.0, 0.04)), "");
        let plates = |slenderness: f64, capacity: f64| {
            let device = format!("mass_ratio = 0.5, clutch = {{ capacity_ratio = {capacity} }}");
            of(&format!("slenderness_deg = {slenderness}"), &device)
        };
        assert_eq!(names(&plates(10.0, 0.1), &plates(5.0, 0.1)), "clutch.capacity_ratio");
        assert_eq!(names(&plates(10.0, 0.1), &plates(5.0, 0.05)), "");
        assert_eq!(names(&plates(10.0, 0.1), &plates(10.0, 0.2)), "clutch.capacity_ratio");
        assert!(names(&first, &plates(10.0, 0.1)).contains("clutch.capacity_ratio"));
        let friction = |ratio: f64| of(at_10, &format!("mass_ratio = 0.5, rack = {{ dry_friction_ratio = {ratio} }}"));
        assert_eq!(names(&friction(0.01), &friction(0.02)), "rack.dry_friction_ratio");
    }

    fn scene(block: &str, ground: &str) -> Scene {
        let text = format!(
            "block = {{ {block}, geometry = 'slender' }}\n\
             device = [{{ kind = 'clutched-pair', mass_ratio = 0.5 }}]\n\
             ground = [{{ motion = 'sine', {ground} }}]"
        );
        Scene::parse(&text, "scene").unwrap()
    }

    /// One pulse in g and Hz has the groups of the same one in ratios.
    #[test]
    fn groups_do_not_depend_on_units() {
        let ratios = scene("size_m = 2.0, slenderness_deg = 10.0", "amplitude_ratio = 1.5, frequency_ratio = 4.0");
        let p = ratios.block.frequency_parameter();
        let g = 1.5 * ratios.uplift_threshold();
        let others = format!("amplitude_g = {g}, frequency_hz = {}", 4.0 * p / TAU);
        let units = scene("size_m = 2.0, slenderness_deg = 10.0", &others);
        let (ratios, units) = (groups(&ratios).unwrap(), groups(&units).unwrap());
        assert_eq!(ratios.len(), units.len());
        assert!(ratios.iter().zip(&units).all(|(a, b)| a.equals(b)), "{ratios:?} {units:?}");
    }

    /// Equal in g and Hz is not equal in ratios once the block is another one.
    #[test]
    fn another_block_under_the_same_pulse_is_reported() {
        let of = |size: f64| {
            let scene = scene(&format!("size_m = {size}, slenderness_deg = 10.0"), "amplitude_g = 0.3, frequency_hz = 1.0");
            groups(&scene).unwrap()
        };
        let (small, large) = (of(1.0), of(4.0));
        let different: Vec<&str> = small.iter().zip(&large).filter(|(a, b)| !a.equals(b)).map(|(a, _)| a.name.as_str()).collect();
        assert_eq!(different, ["ω_g/p of ground 0 (sine)"]);
    }

    /// A record has groups too: another factor, another block and another motion are each told, and the same one is not.
    #[test]
    fn records_have_groups_of_their_peaks() {
        let of = |block: &str, ground: &str| {
            let text = format!(
                "block = {{ {block}, slenderness_deg = 10.0 }}\ndevice = [{{ kind = 'none' }}]\n\
                 ground = [{{ motion = 'record', file = 'near_fault.csv', {ground} }}]\n\
                 vertical = [{{ motion = 'sine', amplitude_g = 0.1, frequency_ratio = 3.0 }}]"
            );
            let mut scene = Scene::parse(&text, "scene").unwrap();
            scene.folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes").into();
            groups(&scene).unwrap()
        };
        let first = of("size_m = 2.0", "scale = 1.0");
        for (block, ground, names) in [
            ("size_m = 2.0", "scale = 1.0", &[][..]),
            ("size_m = 2.0", "scale = 1.5", &["PGA/(g tan α) of ground 0 (record)"]),
            ("size_m = 2.0", "scale = -1.0", &["PGA/(g tan α) of ground 0 (record)"]),
            ("size_m = 8.0", "scale = 1.0", &["PGA/(p PGV) of ground 0 (record)"]),
            ("size_m = 2.0", "resample_to_s = 0.1", &["PGA/(p PGV) of ground 0 (record)", "PGA/(g tan α) of ground 0 (record)"]),
        ] {
            assert_eq!(unequal(&first, &of(block, ground)), names, "{block}, {ground}");
        }
    }

    /// Every number of a near-fault pulse and of a vertical motion is one of a group, and so is the kind of a pulse.
    #[test]
    fn groups_tell_one_motion_from_another() {
        let of = |ground: &str, vertical: &str| {
            let text = format!(
                "block = {{ size_m = 2.0, slenderness_deg = 10.0 }}\ndevice = [{{ kind = 'none' }}]\n\
                 ground = [{{ {ground} }}]\nvertical = [{{ motion = 'sine', frequency_hz = 2.0, {vertical} }}]"
            );
            groups(&Scene::parse(&text, "scene").unwrap()).unwrap()
        };
        let pulse = |numbers: &str| format!("motion = 'mavroeidis-papageorgiou', {numbers}");
        let near_fault = pulse("velocity_amplitude_m_s = 0.5, frequency_ratio = 2.0, oscillations = 2.0, phase_deg = 30.0");
        let first = of(&near_fault, "amplitude_g = 0.1");
        for (ground, vertical, expected) in [
            (near_fault.replace("0.5", "0.6"), "amplitude_g = 0.1", "a_g/(g tan α) of ground 0 (mavroeidis-papageorgiou)"),
            (
                near_fault.replace("oscillations = 2", "oscillations = 3"),
                "amplitude_g = 0.1",
                "γ of ground 0 (mavroeidis-papageorgiou)",
            ),
            (near_fault.replace("30.0", "60.0"), "amplitude_g = 0.1", "ν of ground 0 (mavroeidis-papageorgiou)"),
            (near_fault.clone(), "amplitude_g = 0.2", "a_g/g of vertical 0 (sine)"),
        ] {
            assert_eq!(unequal(&first, &of(&ground, vertical)), [expected]);
        }
        let of_kind =
            |kind: &str| of(&format!("motion = '{kind}', amplitude_ratio = 2.0, frequency_ratio = 3.0"), "amplitude_g = 0.1");
        assert!(unequal(&of_kind("sine"), &of_kind("cosine")).contains(&"ω_g/p of ground 0 (cosine)"));
    }
}
