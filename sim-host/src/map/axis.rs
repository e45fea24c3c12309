//! How an axis of a map is called, and what is on none.

use sprag_shared::block::Geometry;

use crate::scene::Scene;
use crate::scene::ground::Motion;
use crate::scene::map::MapTable;

/// The symbol of the scene's `key`, with its unit, in the markup of axis titles; the key itself where the field has no symbol for it.
pub fn title(scene: &Scene, key: &str) -> String {
    let parts: Vec<&str> = key.split('.').collect();
    let threshold = match scene.geometry() {
        Geometry::Full => "(*g* tan α)",
        Geometry::Slender => "(*g*α)",
    };
    match parts[..] {
        ["ground", _, "frequency_ratio"] => "ω_g/*p*".to_owned(),
        ["ground", _, "frequency_hz"] => "*f*_g (Hz)".to_owned(),
        ["ground", _, "amplitude_ratio"] => format!("*a*_g/{threshold}"),
        ["ground", _, "amplitude_g"] => "*a*_g (g)".to_owned(),
        ["ground", _, "amplitude_m_s2"] => "*a*_g (m/s²)".to_owned(),
        ["ground", _, "scale"] => "scale of the ground motion".to_owned(),
        ["block", "slenderness_deg"] => "α (°)".to_owned(),
        ["block", "size_m"] => "*R* (m)".to_owned(),
        ["block", "frequency_parameter_1_s"] => "*p* (1/s)".to_owned(),
        ["block", "restitution"] => "η".to_owned(),
        ["block", "inertia_ratio"] => "λ".to_owned(),
        ["device", index, "mass_ratio"] => {
            // Of several devices with inerters, which.
            let devices = &scene.devices;
            let several = devices.iter().filter(|device| device.device.mass_ratio > 0.0).count() > 1;
            match index.parse::<usize>().ok().and_then(|index| devices.get(index)).filter(|_| several) {
                Some(device) => format!("σ of {}", device.name),
                None => "σ".to_owned(),
            }
        }
        _ => key.to_owned(),
    }
}

/// The pulse of a scene that has no other motion, with those of its values that no axis of `map` sets, for headings; empty otherwise.
pub fn pulse(scene: &Scene, map: &MapTable) -> String {
    let [ground] = &scene.file.ground[..] else { return String::new() };
    let mut text = match ground.motion {
        Motion::Sine => "one-cycle sine".to_owned(),
        Motion::Cosine => "one-cycle cosine".to_owned(),
        _ => return String::new(),
    };
    let axes: Vec<&str> = [Some(&map.x), map.y.as_ref()].into_iter().flatten().map(|axis| axis.key.as_str()).collect();
    let threshold = match scene.geometry() {
        Geometry::Full => "g tan α",
        Geometry::Slender => "gα",
    };
    // In words: headings have no subscripts.
    let amplitude = ground.amplitude_ratio.map(|ratio| format!(", amplitude {} {threshold}", ground.scale * ratio));
    let frequency = ground.frequency_ratio.map(|ratio| format!(", circular frequency {ratio} p"));
    for (key, words) in [("ground.0.amplitude_ratio", amplitude), ("ground.0.frequency_ratio", frequency)] {
        if let Some(words) = words.filter(|_| !axes.contains(&key)) {
            text += &words;
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_heading_names_the_pulse_and_what_is_on_no_axis() {
        let pulse = |motion: &str, y: &str| {
            let x = "x = { key = 'ground.0.frequency_ratio', from = 1, to = 2, cells = 2 }";
            let text = format!(
                "block = {{ size_m = 2.0, slenderness_deg = 10.0 }}
                 device = [{{ kind = 'none' }}]
                 ground = [{{ motion = '{motion}', amplitude_ratio = 4.0, frequency_ratio = 3.0, scale = 2.0 }}]
                 [map]\n{x}\n{y}"
            );
            let scene = Scene::parse(&text, "scene").unwrap();
            super::pulse(&scene, scene.file.map.as_ref().unwrap())
        };
        assert_eq!(pulse("cosine", ""), "one-cycle cosine, amplitude 8 g tan α");
        assert_eq!(pulse("sine", "y = { key = 'ground.0.amplitude_ratio', from = 1, to = 2, cells = 2 }"), "one-cycle sine");
        assert_eq!(pulse("half-sine", ""), "");
    }
}
