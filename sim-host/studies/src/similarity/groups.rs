//! The dimensionless groups of a scene (Eq. 20-23).

use std::f64::consts::TAU;

use serde::Serialize;
use sprag_shared::structure::block::{GRAVITY, Geometry};
use sprag_shared::structure::error::ParameterError;
use sprag_sim::scene::Scene;
use sprag_sim::scene::ground::{GroundTable, Motion};

/// Relative difference up to which two groups count as equal.
pub const SAME: f64 = 1e-9;

/// A dimensionless group.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Group {
    /// Its symbol; with the number of the ground motion or the name of the device where it belongs to one.
    pub name: String,
    /// Its value; none where it has no meaning, such as the frequency of a record.
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

/// The groups of `scene`: those of every pulse, then those of every device.
///
/// # Errors
/// [`ParameterError`] for a restitution that the block cannot have.
pub fn groups(scene: &Scene) -> Result<Vec<Group>, ParameterError> {
    let (p, threshold) = (scene.block.frequency_parameter(), scene.uplift_threshold());
    let tangent = if scene.geometry() == Geometry::Slender { "α" } else { " tan α" };
    let mut groups = Vec::new();
    for (index, table) in scene.file.ground.iter().enumerate() {
        let of = |symbol: &str| format!("{symbol} of ground {index}");
        groups.push(Group::new(of("ω_g/p"), frequency(table, p)));
        groups.push(Group::new(of(&format!("a_g/(g{tangent})")), amplitude(table, threshold)));
        groups.push(Group::new(of("p × start"), table.start_s * p));
    }
    for index in 0..scene.devices.len() {
        let structure = scene.structure(index);
        let of = |symbol: &str| format!("{symbol} of {}", structure_name(scene, index));
        groups.push(Group::new(of("η"), structure.restitution()?));
        groups.push(Group::new(of("σ"), structure.device.mass_ratio));
        let table = &scene.file.device[index];
        if let Some(wall) = table.support_oscillator() {
            groups.push(Group::new(of("ω_s/p"), wall.frequency_hz * TAU / p));
            groups.push(Group::new(of("ζ_s"), wall.damping_ratio));
        } else if table.support_key().is_some() {
            // Of a record it has no value.
            groups.push(Group::new(of("ü_s/ü_g"), table.support_amplification));
        }
    }
    groups.push(Group::new("θ(0)/α".to_owned(), scene.file.block.initial_rotation_ratio));
    groups.push(Group::new("θ̇(0)/(pα)".to_owned(), scene.file.block.initial_velocity_ratio));
    Ok(groups)
}

/// What stays of a device's name when its numbers change: its place and kind.
fn structure_name(scene: &Scene, index: usize) -> String {
    format!("device {index} ({})", scene.file.device[index].kind.name())
}

fn frequency(table: &GroundTable, p: f64) -> Option<f64> {
    match (table.frequency_ratio, table.frequency_hz, table.duration_ratio, table.duration_s) {
        (Some(ratio), ..) => Some(ratio),
        (_, Some(hertz), ..) => Some(hertz * TAU / p),
        // A rectangular pulse, by the half sine of its length.
        (.., Some(ratio), _) => Some(0.5 * TAU / ratio),
        (.., Some(seconds)) => Some(0.5 * TAU / (seconds * p)),
        _ => None,
    }
}

fn amplitude(table: &GroundTable, threshold: f64) -> Option<f64> {
    let ratio = match (table.amplitude_ratio, table.amplitude_g, table.amplitude_m_s2) {
        (Some(ratio), ..) => ratio,
        (_, Some(g), _) => g / threshold,
        (.., Some(m_s2)) => m_s2 / GRAVITY / threshold,
        _ if table.motion == Motion::Record => return None,
        _ => {
            // A = v ω: the pulse's velocity amplitude with its frequency.
            let speed = table.velocity_amplitude_m_s?;
            let rate = table.frequency_hz? * TAU;
            speed * rate / GRAVITY / threshold
        }
    };
    Some(ratio * table.scale)
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
        assert_eq!(different, ["ω_g/p of ground 0"]);
    }
}
