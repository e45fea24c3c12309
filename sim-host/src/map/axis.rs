//! How an axis of a map is called.

use sprag_shared::block::Geometry;

use crate::scene::Scene;

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
