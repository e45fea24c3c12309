//! Values of a scene that are allowed and yet unlikely to be meant: other units, mostly.

use sprag_shared::math;
use sprag_shared::structure::block::{Block, Geometry};
use sprag_shared::structure::drivetrain::Engagement;
use sprag_shared::structure::error::Number;
use sprag_shared::structure::mount::Mount;

use super::Scene;
use super::device::{DeviceTable, Kind, SceneDevice};
use crate::effect::number::number;

/// Slenderness below which it looks like radians, degrees.
const MOST_SLENDER_DEG: f64 = 1.0;

/// Slenderness above which a block hardly rocks, degrees.
const LEAST_SLENDER_DEG: f64 = 60.0;

/// Sizes that structures have, m.
const SIZES_M: core::ops::RangeInclusive<f64> = 0.01..=50.0;

/// Mean densities that blocks as deep as wide may have, kg/m³; walls and hollow ones included.
const DENSITIES: core::ops::RangeInclusive<f64> = 5.0..=1e6;

/// Mass ratio above which it looks like an inertance.
const LARGEST_MASS_RATIO: f64 = 100.0;

/// By which a height given in a few digits may miss the top of the block.
const ROUNDING: f64 = 1e-3;

impl Scene {
    /// What looks like a mistake although it is allowed, in a line each: `FILE: KEY is VALUE: why`.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = self.of_block();
        for (index, (table, device)) in self.file.device.iter().zip(&self.devices).enumerate() {
            let of_device = [self.of_mount(device), self.of_mass_ratio(table, device), of_coasting(table, device, index)];
            let named = |(name, reason): (String, String)| format!("{}: device.{index}.{name}{reason}", self.origin);
            warnings.extend(of_device.into_iter().flatten().map(named));
        }
        warnings
    }

    fn of_block(&self) -> Vec<String> {
        let (table, block) = (&self.file.block, &self.block);
        let mut lines = Vec::new();
        let mut warn = |name: &str, value: f64, reason: String| {
            lines.push(format!("{}: block.{name} is {}: {reason}", self.origin, Number(value)));
        };
        let degrees = table.slenderness_deg;
        if degrees < MOST_SLENDER_DEG {
            let meant = number(degrees.to_degrees());
            warn("slenderness_deg", degrees, format!("that is degrees; {} rad would be {meant} degrees", Number(degrees)));
        } else if degrees > LEAST_SLENDER_DEG {
            let wide = number(math::tan(block.slenderness()));
            let threshold = number(Geometry::Full.uplift_threshold(block.slenderness()));
            let reason = format!("a block {wide} times as wide as high, which rocks only above {threshold} g");
            warn("slenderness_deg", degrees, reason);
        }
        let size = block.size();
        if !SIZES_M.contains(&size) {
            let meters = number(size);
            match table.frequency_parameter_1_s {
                Some(p) => warn("frequency_parameter_1_s", p, format!("that makes R = {meters} m")),
                None if size > 1.0 => {
                    warn(
                        "size_m",
                        size,
                        format!("R = {meters} m is large for a structure; in mm it would be {} m", number(size / 1e3)),
                    );
                }
                None => warn("size_m", size, format!("R = {meters} m is small for a structure; sizes are in m")),
            }
        }
        if let Some(mass) = table.mass_kg {
            let density = mass / volume_if_as_deep_as_wide(block);
            if !DENSITIES.contains(&density) {
                let density = number(density);
                warn("mass_kg", mass, format!("a block of this size, as deep as wide, would have a density of {density} kg/m³"));
            }
        }
        lines
    }

    fn of_mount(&self, device: &SceneDevice) -> Option<(String, String)> {
        let Mount::TyingPoint { height, .. } = device.device.mount else { return None };
        Some(("mount_height_m".to_owned(), self.above_the_block(height)?))
    }

    /// What to say behind the key of a `height` above the block (m).
    pub fn above_the_block(&self, height: f64) -> Option<String> {
        let top = 2.0 * self.block.size() * math::cos(self.block.slenderness());
        (height > top * (1.0 + ROUNDING))
            .then(|| format!(" is {}: above the block, whose top is at 2R cos α = {} m", Number(height), number(top)))
    }

    /// An inertance far above the mass.
    fn of_mass_ratio(&self, table: &DeviceTable, device: &SceneDevice) -> Option<(String, String)> {
        let ratio = device.device.mass_ratio;
        if ratio <= LARGEST_MASS_RATIO {
            return None;
        }
        Some(match (table.mass_ratio, table.inertance_kg) {
            (Some(_), _) => {
                let reason =
                    format!(" is {}: inertance over the block's mass; an inertance in kg is inertance_kg", Number(ratio));
                ("mass_ratio".to_owned(), reason)
            }
            (None, Some(inertance)) => {
                let reason = format!(" is {}: {} times block.mass_kg", Number(inertance), number(ratio));
                ("inertance_kg".to_owned(), reason)
            }
            (None, None) => ("flywheels".to_owned(), format!(": their inertance is {} times block.mass_kg", number(ratio))),
        })
    }
}

/// Released flywheels that spin on for ever because nothing is said of what slows them down.
fn of_coasting(table: &DeviceTable, device: &SceneDevice, index: usize) -> Option<(String, String)> {
    let engagement = device.drivetrain.engagement;
    if table.kind != Kind::ClutchedPair || table.flywheel.is_some() {
        return None;
    }
    let (key, given) = match engagement {
        Engagement::Ideal => return None,
        Engagement::Rigid => ("engagement", "is \"rigid\""),
        Engagement::Overrunning => ("engagement", "is \"overrunning\""),
        Engagement::Friction { .. } | Engagement::Elastic { .. } => ("clutch", "is given"),
        Engagement::Viscous { .. } => ("inertance_corner_hz", "is given"),
    };
    let cure = if engagement == Engagement::Overrunning {
        format!("set device.{index}.flywheel.viscous_rate_1_s or dry_deceleration_m_s2")
    } else {
        format!("set device.{index}.flywheel.brake_deceleration_m_s2 to m/s², \"instant\", or 0 if they shall coast")
    };
    let reason = "released flywheels spin on for ever, and those of the ideal clutch stop at once";
    Some((key.to_owned(), format!(" {given}: {reason}; {cure}")))
}

/// m³.
fn volume_if_as_deep_as_wide(block: &Block) -> f64 {
    let (sin, cos) = math::sin_cos(block.slenderness());
    let (width, height) = (2.0 * block.size() * sin, 2.0 * block.size() * cos);
    width * width * height
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = "[block]\nsize_m = 2.0\nslenderness_deg = 10.0\nmass_kg = 2500.0\n\
        [[device]]\nkind = \"clutched-pair\"\nmass_ratio = 0.5\n[[ground]]\nmotion = \"sine\"\namplitude_g = 0.3\nfrequency_hz = 1.0\n";

    fn warnings(changes: &[&str]) -> Vec<String> {
        Scene::parse_with(SCENE, "a.toml", changes).unwrap_or_else(|error| panic!("{error}")).warnings()
    }

    #[test]
    fn each_unlikely_value_has_one_line_with_its_key_and_value() {
        for (change, start) in [
            ("block.slenderness_deg=0.24", "a.toml: block.slenderness_deg is 0.24: "),
            ("block.slenderness_deg=89.999999999", "a.toml: block.slenderness_deg is 89.999999999: "),
            ("block.size_m=1100", "a.toml: block.size_m is 1100: "),
            ("block.size_m=0.002", "a.toml: block.size_m is 0.002: "),
            ("block.mass_kg=2.5", "a.toml: block.mass_kg is 2.5: "),
            ("device.0.mass_ratio=250", "a.toml: device.0.mass_ratio is 250: "),
            ("device.0={kind=\"inerter\",inertance_kg=1e6}", "a.toml: device.0.inertance_kg is 1000000: "),
            (
                "device.0={kind=\"inerter\",mass_ratio=1,mount=\"tying-point\",mount_height_m=100}",
                "a.toml: device.0.mount_height_m is 100: above the block, whose top is at 2R cos α = 3.9392 m",
            ),
            ("device.0.engagement=rigid", "a.toml: device.0.engagement is \"rigid\": "),
            ("device.0.engagement=overrunning", "a.toml: device.0.engagement is \"overrunning\": "),
            ("device.0.clutch.capacity_ratio=0.1", "a.toml: device.0.clutch is given: "),
            ("device.0.inertance_corner_hz=4", "a.toml: device.0.inertance_corner_hz is given: "),
        ] {
            let found: Vec<String> = match change.starts_with("block.s") {
                // The mass is that of another size.
                true => warnings(&[change]).into_iter().filter(|line| !line.contains("mass_kg")).collect(),
                false => warnings(&[change]),
            };
            assert!(found.len() == 1 && found[0].starts_with(start), "{change}: {found:?}");
        }
        assert_eq!(warnings(&[]), Vec::<String>::new());
        assert_eq!(warnings(&["device.0.support_amplification=1.2"]), Vec::<String>::new());
    }

    #[test]
    fn a_brake_or_an_explicit_coast_silences_the_warning_that_flywheels_spin_on() {
        for flywheel in ["{brake_deceleration_m_s2=\"instant\"}", "{brake_deceleration_m_s2=0}", "{viscous_rate_1_s=0.05}"] {
            let changes = ["device.0.clutch.capacity_ratio=0.1".to_owned(), format!("device.0.flywheel={flywheel}")];
            assert_eq!(warnings(&changes.each_ref().map(String::as_str)), Vec::<String>::new(), "{flywheel}");
        }
        assert!(warnings(&["device.0.actuation={engagement_delay_s=0.02}"]).is_empty(), "its flywheels stop at once");
    }

    #[test]
    fn scenes_that_ship_are_as_they_are_meant() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes");
        let mut scenes = 0;
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            // Studies stand beside scenes, and are none.
            let Ok(scene) = Scene::load(&path, &[]) else { continue };
            assert_eq!(scene.warnings(), Vec::<String>::new());
            scenes += 1;
        }
        assert!(scenes > 10);
    }
}
