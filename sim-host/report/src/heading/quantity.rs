//! The name, symbol and unit of every numeric key of a scene, for axes.

use sprag_shared::structure::block::Geometry;
use sprag_sim::scene::Scene;

use crate::plot::literal;

/// A key of a scene as pictures write it.
struct Quantity {
    /// Key, with `N` for numbers of tables; `ground` stands for `vertical` too.
    key: &'static str,
    /// What it is, in words; `#` is the number of a flywheel.
    name: &'static str,
    /// Symbol, in the markup of axis titles; empty where the field has none. `@` is the acceleration at which the block uplifts.
    symbol: &'static str,
    /// Unit; empty for a ratio.
    unit: &'static str,
}

const fn quantity(key: &'static str, name: &'static str, symbol: &'static str, unit: &'static str) -> Quantity {
    Quantity { key, name, symbol, unit }
}

/// Section by section, as in docs/scenes.md; `[controller]` and its sensors go by the words of their keys.
const QUANTITIES: [Quantity; 80] = [
    quantity("block.size_m", "size", "*R*", "m"),
    quantity("block.frequency_parameter_1_s", "frequency parameter", "*p*", "1/s"),
    quantity("block.slenderness_deg", "slenderness", "α", "°"),
    quantity("block.inertia_ratio", "inertia ratio", "λ", ""),
    quantity("block.mass_kg", "mass", "*m*", "kg"),
    quantity("block.restitution", "coefficient of restitution", "η", ""),
    quantity("block.restitution_scatter", "standard deviation of η", "", ""),
    quantity("block.restitution_seed", "seed of the impacts", "", ""),
    quantity("block.foundation.vertical_frequency_hz", "vertical frequency on the foundation", "f_v", "Hz"),
    quantity("block.foundation.damping_ratio", "damping ratio of the foundation", "ζ", ""),
    quantity("block.friction_coefficient", "coefficient of friction under the block", "μ", ""),
    quantity("block.initial_rotation_ratio", "initial rotation", "θ(0)/α", ""),
    quantity("block.initial_velocity_ratio", "initial velocity", "θ'(0)/(*p*α)", ""),
    quantity("device.N.mass_ratio", "mass ratio", "σ", ""),
    quantity("device.N.inertance_kg", "inertance", "*m*_r", "kg"),
    quantity("device.N.flywheels.N.mass_kg", "mass of flywheel #", "", "kg"),
    quantity("device.N.flywheels.N.radius_m", "radius of flywheel #", "", "m"),
    quantity("device.N.flywheels.N.pinion_radius_m", "pinion radius of flywheel #", "", "m"),
    quantity("device.N.mount_height_m", "height of the tying point", "", "m"),
    quantity("device.N.pulley_ratio", "pulley ratio", "", ""),
    quantity("device.N.flywheel.viscous_rate_1_s", "viscous rate of the flywheels", "", "1/s"),
    quantity("device.N.flywheel.dry_deceleration_m_s2", "dry deceleration of the flywheels", "", "m/s²"),
    quantity("device.N.flywheel.brake_deceleration_m_s2", "brake deceleration", "", "m/s²"),
    quantity("device.N.flywheel.drag_rate_1_s", "drag rate of open clutches", "", "1/s"),
    quantity("device.N.clutch.capacity_ratio", "clutch capacity", "*F*/(*mg*)", ""),
    quantity("device.N.clutch.capacity_n", "clutch capacity", "*F*", "N"),
    quantity("device.N.clutch.stiffness_ratio", "clutch stiffness", "*K*/(*mp*²)", ""),
    quantity("device.N.clutch.stiffness_n_m", "clutch stiffness", "*K*", "N/m"),
    quantity("device.N.clutch.damping_ratio", "clutch damping ratio", "ζ", ""),
    quantity("device.N.clutch.damping_n_s_m", "clutch damping", "*C*", "N s/m"),
    quantity("device.N.clutch.backlash_m", "backlash", "", "m"),
    quantity("device.N.rack.viscous_1_s", "viscous friction of the rack over mass", "", "1/s"),
    quantity("device.N.rack.viscous_n_s_m", "viscous friction of the rack", "", "N s/m"),
    quantity("device.N.rack.dry_friction_ratio", "dry friction of the rack", "*F*/(*mg*)", ""),
    quantity("device.N.rack.dry_friction_n", "dry friction of the rack", "*F*", "N"),
    quantity("device.N.rack.load_friction", "friction of the rack over load", "μ", ""),
    quantity("device.N.actuation.engagement_delay_s", "engagement delay", "", "s"),
    quantity("device.N.actuation.release_delay_s", "release delay", "", "s"),
    quantity("device.N.actuation.rise_time_s", "rise time", "", "s"),
    quantity("device.N.actuation.time_constant_s", "time constant of the capacity", "", "s"),
    quantity("device.N.actuation.dwell_s", "dwell", "", "s"),
    quantity("device.N.actuation.miss_probability", "probability of a missed engagement", "", ""),
    quantity("device.N.actuation.miss_seed", "seed of missed engagements", "", ""),
    quantity("device.N.inertance_corner_hz", "corner frequency of the inertance", "", "Hz"),
    quantity("device.N.weight.flywheels_ratio", "mass of the flywheels over that of the block", "", ""),
    quantity("device.N.weight.flywheels_kg", "mass of the flywheels", "", "kg"),
    quantity("device.N.weight.rack_ratio", "mass of the rack over that of the block", "", ""),
    quantity("device.N.weight.rack_kg", "mass of the rack", "", "kg"),
    quantity("device.N.support_amplification", "acceleration of the support over the ground's", "", ""),
    quantity("device.N.support_frequency_hz", "frequency of the support", "*f*_s", "Hz"),
    quantity("device.N.support_damping_ratio", "damping ratio of the support", "ζ", ""),
    quantity("device.N.support_record.time_step_s", "time step of the support's record", "", "s"),
    quantity("device.N.support_record.resample_to_s", "time step of the support's resampled record", "", "s"),
    quantity("device.N.support_record.scale", "scale of the support's record", "", ""),
    quantity("ground.N.amplitude_ratio", "amplitude", "*a*_g/@", ""),
    quantity("ground.N.amplitude_g", "amplitude", "*a*_g", "g"),
    quantity("ground.N.amplitude_m_s2", "amplitude", "*a*_g", "m/s²"),
    quantity("ground.N.velocity_amplitude_m_s", "velocity amplitude", "*A*", "m/s"),
    quantity("ground.N.frequency_ratio", "circular frequency", "ω_g/*p*", ""),
    quantity("ground.N.frequency_hz", "frequency", "*f*_g", "Hz"),
    quantity("ground.N.duration_s", "duration", "*t*_d", "s"),
    quantity("ground.N.duration_ratio", "duration", "*p* *t*_d", ""),
    quantity("ground.N.oscillations", "oscillations", "γ", ""),
    quantity("ground.N.phase_deg", "phase", "ν", "°"),
    quantity("ground.N.time_step_s", "time step of the record", "", "s"),
    quantity("ground.N.resample_to_s", "time step of the resampled record", "", "s"),
    quantity("ground.N.scale", "scale of the motion", "", ""),
    quantity("ground.N.start_s", "start of the motion", "", "s"),
    quantity("run.free_time_s", "free time", "*t*", "s"),
    quantity("run.free_time_ratio", "free time", "*p* *t*", ""),
    quantity("run.rest_speed_ratio", "rest speed", "θ'/(*p*α)", ""),
    quantity("accuracy.level", "relative error of the peak rotation", "", ""),
    quantity("accuracy.tolerance", "tolerance", "", ""),
    quantity("accuracy.step_s", "step", "Δ*t*", "s"),
    quantity("accuracy.step_ratio", "step", "*p*Δ*t*", ""),
    quantity("output.interval_s", "time between samples", "", "s"),
    quantity("checks.friction_coefficient", "coefficient of friction", "μ", ""),
    quantity("checks.largest_force_ratio", "largest force", "*F*/(*mg*)", ""),
    quantity("checks.largest_stroke_m", "largest stroke", "", "m"),
    quantity("checks.gear.teeth", "teeth of the pinion", "", ""),
];

/// Units by the ends of keys, longer ones before those that they end in.
const UNITS: [(&str, &str); 26] = [
    ("_deg_s_rthz", "°/s/√Hz"),
    ("_deg_s_rts", "°/s/√s"),
    ("_ug_rthz", "µg/√Hz"),
    ("_mg_rts", "mg/√s"),
    ("_n_s_m", "N s/m"),
    ("_deg_s", "°/s"),
    ("_m_s2", "m/s²"),
    ("_1_s2", "1/s²"),
    ("_1_s", "1/s"),
    ("_m_s", "m/s"),
    ("_n_m", "N/m"),
    ("_deg", "°"),
    ("_mpa", "MPa"),
    ("_hz", "Hz"),
    ("_kg", "kg"),
    ("_mm", "mm"),
    ("_mg", "mg"),
    ("_ms", "ms"),
    ("_us", "µs"),
    ("_ns", "ns"),
    ("_n", "N"),
    ("_w", "W"),
    ("_j", "J"),
    ("_m", "m"),
    ("_s", "s"),
    ("_g", "g"),
];

/// The acceleration at which the block of `scene` uplifts, in the markup of axis titles.
pub(super) fn threshold(scene: &Scene) -> &'static str {
    match scene.geometry() {
        Geometry::Full => "*g* tan α",
        Geometry::Slender => "*g*α",
    }
}

/// The title of an axis that sets `key` of `scene`: name, symbol, which of several devices or motions, and unit, in the markup of axis
/// titles.
pub fn axis_title(scene: &Scene, key: &str) -> String {
    let parts: Vec<&str> = key.split('.').collect();
    let known = QUANTITIES.iter().find(|quantity| is_key(quantity.key, &parts));
    let (words, unit) = match known {
        Some(known) => {
            let number = parts.get(3).and_then(|part| part.parse::<usize>().ok()).map_or(0, |index| index + 1);
            let mut words = known.name.replace('#', &number.to_string());
            if !known.symbol.is_empty() {
                words = format!("{words} {}", known.symbol.replace('@', &format!("({})", threshold(scene))));
            }
            (words, known.unit)
        }
        None => words_of(&parts),
    };
    let unit = if unit.is_empty() { String::new() } else { format!(" ({unit})") };
    format!("{words}{}{unit}", owner(scene, &parts))
}

/// Whether `parts` are a key of the kind of `pattern`.
fn is_key(pattern: &str, parts: &[&str]) -> bool {
    let same = |(pattern, part): (&str, &&str)| match pattern {
        "N" => part.parse::<usize>().is_ok(),
        "ground" => ["ground", "vertical"].contains(part),
        pattern => pattern == *part,
    };
    pattern.split('.').count() == parts.len() && pattern.split('.').zip(parts).all(same)
}

/// The words of a key that has no name of its own, and its unit: those of its last two parts.
fn words_of(parts: &[&str]) -> (String, &'static str) {
    let last = parts.last().copied().unwrap_or_default();
    let (name, unit) = UNITS
        .into_iter()
        .find_map(|(ending, unit)| Some((last.strip_suffix(ending)?, unit)))
        .filter(|(name, _)| !name.is_empty())
        .unwrap_or((last, ""));
    let table = parts.len().checked_sub(2).filter(|place| *place > 0).map(|place| parts[place]);
    let table = table.filter(|table| table.parse::<usize>().is_err());
    let words: Vec<String> = table.into_iter().chain([name]).map(|part| literal(&part.replace('_', " "))).collect();
    (words.join(" "), unit)
}

/// Whose quantity it is: which of several devices or motions that it may belong to; empty where there is one only.
fn owner(scene: &Scene, parts: &[&str]) -> String {
    let index = parts.get(1).and_then(|part| part.parse::<usize>().ok());
    match (parts.first().copied(), index) {
        (Some("device"), Some(index)) => {
            let several = scene.devices.iter().filter(|device| device.device.mass_ratio > 0.0).count() > 1;
            let device = scene.devices.get(index).filter(|_| several);
            device.map(|device| format!(" of {}", literal(&device.name))).unwrap_or_default()
        }
        (Some("ground"), Some(index)) if scene.file.ground.len() > 1 => format!(" of motion {}", index + 1),
        (Some("vertical"), Some(index)) if scene.file.vertical.len() > 1 => format!(" of vertical motion {}", index + 1),
        (Some("vertical"), _) => " of the vertical motion".to_owned(),
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use sprag_sim::keys::Described;
    use sprag_sim::keys::list::keys;
    use sprag_sim::scene::SceneError;
    use sprag_sim::scene::schema::SceneFile;

    const SCENE: &str = "
        block = { size_m = 2.0, slenderness_deg = 10.0, mass_kg = 100.0 }
        device = [{ kind = 'inerter', mass_ratio = 0.5 }, { kind = 'clutched-pair', name = 'soft_pair', mass_ratio = 0.5 }]
        ground = [{ motion = 'sine', amplitude_ratio = 2.0, frequency_ratio = 3.0 }]
    ";

    fn title(key: &str) -> String {
        axis_title(&Scene::parse(SCENE, "scene").unwrap(), key)
    }

    #[test]
    fn names_symbols_owners_and_units_make_a_title() {
        assert_eq!(title("block.slenderness_deg"), "slenderness α (°)");
        assert_eq!(title("ground.0.amplitude_ratio"), "amplitude *a*_g/(*g* tan α)");
        assert_eq!(title("device.0.mass_ratio"), "mass ratio σ of inerter");
        assert_eq!(title("device.1.actuation.engagement_delay_s"), "engagement delay of soft\\_pair (s)");
        assert_eq!(title("device.1.flywheels.2.radius_m"), "radius of flywheel 3 of soft\\_pair (m)");
        assert_eq!(title("vertical.0.amplitude_g"), "amplitude *a*_g of the vertical motion (g)");
        assert_eq!(title("controller.sensors.gyroscope.noise_density_deg_s_rthz"), "gyroscope noise density (°/s/√Hz)");
        assert_eq!(title("checks.gear.allowable_stress_mpa"), "gear allowable stress (MPa)");
    }

    /// Whether an axis may set `key`: a scene takes a number there, if perhaps another one, or not together with others.
    fn takes_a_number(key: &str) -> bool {
        let text = SCENE.replace("kind = 'inerter'", "kind = 'clutched-pair'") + "\nchecks = {}\n";
        let refused = |value: &str| match Scene::parse_with(&text, "scene", &[format!("{key}={value}")]) {
            Ok(_) => false,
            // No such key, or one of another kind: other errors are about the number.
            Err(SceneError::Conflict { key, .. }) => key.starts_with("--set "),
            Err(SceneError::Range { range, .. }) => range.starts_with('"'),
            Err(error) => matches!(error, SceneError::Syntax { .. }),
        };
        !refused("1.5") || !refused("1")
    }

    #[test]
    fn every_numeric_key_has_a_title_without_stray_underscores() {
        let numbered = |path: &str| path.replace("device.N.", "device.1.").replace('N', "0");
        let of_scene =
            keys(SceneFile::schema()).into_iter().map(|key| numbered(&key.path)).filter(|key| !key.starts_with("map."));
        let keys: BTreeSet<String> = of_scene.chain(QUANTITIES.iter().map(|quantity| numbered(quantity.key))).collect();
        let numeric: Vec<&String> = keys.iter().filter(|key| takes_a_number(key)).collect();
        assert!(numeric.len() > 70, "{numeric:?}");
        for key in numeric {
            let title = title(key);
            let markup = ["*a*_g", "*f*_g", "*f*_s", "ω_g", "*m*_r", "*t*_d", "\\_"]
                .into_iter()
                .fold(title.clone(), |title, known| title.replace(known, ""));
            assert!(!markup.contains('_') && !markup.is_empty(), "{key}: {title}");
            let known = QUANTITIES.iter().any(|quantity| is_key(quantity.key, &key.split('.').collect::<Vec<_>>()));
            let by_words = ["controller", "checks.gear", "checks.coil"].iter().any(|section| key.starts_with(section));
            assert!(known || by_words, "{key} goes by its words: {title}");
        }
    }

    #[test]
    fn a_motion_of_several_is_numbered() {
        let text = SCENE.replace("ground = [", "ground = [{ motion = 'sine', amplitude_g = 1.0, frequency_hz = 1.0 }, ");
        let scene = Scene::parse(&text, "scene").unwrap();
        assert_eq!(axis_title(&scene, "ground.1.frequency_ratio"), "circular frequency ω_g/*p* of motion 2");
    }
}
