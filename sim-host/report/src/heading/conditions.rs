//! What holds in a scene, or in all scenes of a picture: block, mass ratio and ground motion, for the line below its title.

use sprag_sim::effect::number::true_minus;
use sprag_sim::scene::Scene;
use sprag_sim::scene::ground::{GroundTable, Motion};
use sprag_sim::scene::schema::{GeometryName, RestitutionValue};

use super::quantity::threshold;
use crate::plot::literal;

/// Most devices whose mass ratios are given one by one.
const MOST_MASS_RATIOS: usize = 3;

/// A thing and what is known of it, in the markup of axis titles.
#[derive(Clone, Debug, PartialEq)]
struct Phrase {
    name: String,
    values: Vec<String>,
}

/// What holds in `scene`.
pub fn of_scene(scene: &Scene) -> Vec<String> {
    of_scenes(&[scene])
}

/// What holds of the blocks of all `scenes`, whatever their devices and the ground motions.
pub fn of_blocks(scenes: &[&Scene]) -> Vec<String> {
    let mut blocks = scenes.iter().map(|scene| block(scene));
    let Some(mut common) = blocks.next() else { return Vec::new() };
    blocks.for_each(|other| common.values.retain(|value| other.values.contains(value)));
    common.parts().collect()
}

/// What holds in every one of `scenes`, which differ in numbers only.
pub fn of_scenes(scenes: &[&Scene]) -> Vec<String> {
    let Some((first, others)) = scenes.split_first() else { return Vec::new() };
    let (mut block, mut grounds) = (block(first), grounds(first));
    let mut ratios = mass_ratios(first);
    let mut inerters: Vec<bool> = ratios.iter().map(|ratio| ratio.1.is_some()).collect();
    for other in others {
        let of_other = self::grounds(other);
        for (own, other) in grounds.iter_mut().zip(&of_other).chain([(&mut block, &self::block(other))]) {
            own.values.retain(|value| other.values.contains(value));
        }
        let of_other = mass_ratios(other);
        for ((own, other), inerter) in ratios.iter_mut().zip(of_other).zip(&mut inerters) {
            *inerter |= other.1.is_some();
            if *own != other {
                own.1 = None;
            }
        }
    }
    // Where σ is zero in one scene, a device has one all the same.
    block.values.extend(of_mass_ratios(&ratios, inerters.into_iter().filter(|inerter| *inerter).count()));
    let mut conditions: Vec<String> = block.parts().collect();
    if let [_] = &grounds[..] {
        conditions.extend(grounds.into_iter().flat_map(Phrase::parts));
    } else {
        // Whose values they are can be seen of several.
        conditions.extend((!grounds.is_empty()).then(|| grounds.iter().map(Phrase::joined).collect::<Vec<_>>().join(" + ")));
    }
    conditions
}

impl Phrase {
    fn parts(self) -> impl Iterator<Item = String> {
        std::iter::once(self.name).filter(|name| !name.is_empty()).chain(self.values)
    }

    fn joined(&self) -> String {
        if self.values.is_empty() { self.name.clone() } else { format!("{} ({})", self.name, self.values.join(", ")) }
    }
}

fn block(scene: &Scene) -> Phrase {
    let file = &scene.file;
    let block = &file.block;
    let slender = block.geometry == GeometryName::Slender;
    let mut values = Vec::new();
    values.extend(block.size_m.map(|size| format!("*R* = {} m", number(size))));
    let in_seconds = |ground: &GroundTable| ground.frequency_ratio.is_none() && ground.duration_ratio.is_none();
    let timed = file.ground.is_empty() || file.ground.iter().chain(&file.vertical).any(in_seconds);
    values.extend(block.frequency_parameter_1_s.filter(|_| timed).map(|p| format!("*p* = {} 1/s", number(p))));
    values.push(format!("α = {}°", number(block.slenderness_deg)));
    if block.inertia_ratio != sprag_shared::structure::block::RECTANGLE_INERTIA_RATIO {
        values.push(format!("λ = {}", number(block.inertia_ratio)));
    }
    values.push(match &block.restitution {
        RestitutionValue::Number(eta) => format!("η = {}", number(*eta)),
        RestitutionValue::Word(word) => format!("{} restitution", literal(word)),
    });
    let scatter = block.scatter();
    if scatter.is_on() {
        values.push(format!("scatter of η = {}", number(scatter.deviation)));
    }
    values.extend(block.foundation.map(|foundation| format!("f_v = {} Hz", number(foundation.vertical_frequency_hz))));
    values.extend(block.friction_coefficient.map(|friction| format!("μ = {}", number(friction))));
    let start = [(block.initial_rotation_ratio, "θ(0)", "α"), (block.initial_velocity_ratio, "θ'(0)", "*p*α")];
    for (value, symbol, unit) in start.into_iter().filter(|start| start.0 != 0.0) {
        values.push(format!("{symbol} = {} {unit}", number(value)));
    }
    Phrase { name: if slender { "slender block" } else { "" }.to_owned(), values }
}

/// Names of the devices, and σ of those that have one.
fn mass_ratios(scene: &Scene) -> Vec<(&str, Option<f64>)> {
    let ratio = |ratio: f64| (ratio > 0.0).then_some(ratio);
    scene.devices.iter().map(|device| (device.name.as_str(), ratio(device.device.mass_ratio))).collect()
}

/// One σ that all devices with one share, or that of each; none where they are many, or their names say it.
fn of_mass_ratios(ratios: &[(&str, Option<f64>)], inerters: usize) -> Vec<String> {
    let known: Vec<(&str, f64)> = ratios.iter().filter_map(|(name, ratio)| Some((*name, (*ratio)?))).collect();
    match &known[..] {
        [(_, first), others @ ..] if known.len() == inerters && others.iter().all(|other| other.1 == *first) => {
            vec![format!("σ = {}", number(*first))]
        }
        known if known.len() > MOST_MASS_RATIOS || known.iter().any(|(name, _)| name.contains('σ')) => Vec::new(),
        known => known.iter().map(|(name, ratio)| format!("σ of {} = {}", literal(name), number(*ratio))).collect(),
    }
}

/// The motions.
fn grounds(scene: &Scene) -> Vec<Phrase> {
    let horizontal = scene.file.ground.iter().map(|ground| motion(scene, ground, ""));
    let vertical = scene.file.vertical.iter().map(|ground| motion(scene, ground, "vertical "));
    horizontal.chain(vertical).collect()
}

/// A motion with its values; `which` stands before its name.
fn motion(scene: &Scene, ground: &GroundTable, which: &str) -> Phrase {
    let name = match ground.motion {
        Motion::Sine => "one-cycle sine".to_owned(),
        Motion::Cosine => "one-cycle cosine".to_owned(),
        Motion::HalfSine => "half-sine pulse".to_owned(),
        Motion::Rectangular => "rectangular pulse".to_owned(),
        Motion::Ricker => "Ricker wavelet".to_owned(),
        Motion::MavroeidisPapageorgiou => "Mavroeidis-Papageorgiou pulse".to_owned(),
        Motion::Record => match ground.file.as_ref().and_then(|file| file.file_name()) {
            Some(file) => format!("record {}", literal(&file.to_string_lossy())),
            None => "record".to_owned(),
        },
    };
    let scaled = |value: f64| number(ground.scale * value);
    let mut values = Vec::new();
    values.extend(ground.amplitude_ratio.map(|ratio| format!("*a*_g = {} {}", scaled(ratio), threshold(scene))));
    values.extend(ground.amplitude_g.map(|g| format!("*a*_g = {} g", scaled(g))));
    values.extend(ground.amplitude_m_s2.map(|m_s2| format!("*a*_g = {} m/s²", scaled(m_s2))));
    values.extend(ground.velocity_amplitude_m_s.map(|m_s| format!("*A* = {} m/s", scaled(m_s))));
    values.extend(ground.frequency_ratio.map(|ratio| format!("ω_g = {} *p*", number(ratio))));
    values.extend(ground.frequency_hz.map(|hertz| format!("*f*_g = {} Hz", number(hertz))));
    values.extend(ground.duration_s.map(|seconds| format!("*t*_d = {} s", number(seconds))));
    values.extend(ground.duration_ratio.map(|ratio| format!("*t*_d = {}/*p*", number(ratio))));
    values.extend(ground.oscillations.map(|gamma| format!("γ = {}", number(gamma))));
    values.extend(ground.phase_deg.map(|degrees| format!("ν = {}°", number(degrees))));
    if ground.motion == Motion::Record && ground.scale != 1.0 {
        values.push(format!("scale {}", number(ground.scale)));
    }
    if ground.start_s != 0.0 {
        values.push(format!("from *t* = {} s", number(ground.start_s)));
    }
    Phrase { name: format!("{which}{name}"), values }
}

/// `value` to six digits at most, with a true minus sign.
fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    let size = rounded.abs();
    let text = if size != 0.0 && !(1e-4..1e7).contains(&size) { format!("{rounded:e}") } else { format!("{rounded}") };
    true_minus(&text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(ground: &str, change: &str) -> Scene {
        let text = format!(
            "block = {{ size_m = 2.0, slenderness_deg = 10.0 }}
             device = [{{ kind = 'none' }}, {{ kind = 'inerter', mass_ratio = 0.5 }}, {{ kind = 'clutched-pair', mass_ratio = 0.5 }}]
             ground = [{ground}]"
        );
        let changes: &[&str] = if change.is_empty() { &[] } else { &[change] };
        Scene::parse_with(&text, "scene", changes).unwrap()
    }

    const SINE: &str = "{ motion = 'sine', amplitude_ratio = 4.0, frequency_ratio = 3.0, scale = 2.0 }";

    #[test]
    fn a_scene_is_its_block_its_mass_ratio_and_its_motion() {
        let expected = ["*R* = 2 m", "α = 10°", "η = 0.85", "σ = 0.5", "one-cycle sine", "*a*_g = 8 *g* tan α", "ω_g = 3 *p*"];
        assert_eq!(of_scene(&scene(SINE, "")), expected);
        let slender = of_scene(&scene(SINE, "block.geometry=slender"));
        assert!(slender[0] == "slender block" && slender.contains(&"*a*_g = 8 *g*α".to_owned()));
        assert!(of_scene(&scene(SINE, "device.1.mass_ratio=1")).contains(&"σ of clutched pair = 0.5".to_owned()));
        assert!(of_scene(&scene("", "block.initial_rotation_ratio=0.9")).contains(&"θ(0) = 0.9 α".to_owned()));
    }

    #[test]
    fn every_motion_has_a_name() {
        let frequency = "amplitude_g = 0.5, frequency_hz = 1.5";
        for (ground, expected) in [
            (format!("{{ motion = 'cosine', {frequency} }}"), "one-cycle cosine"),
            (format!("{{ motion = 'half-sine', {frequency} }}"), "half-sine pulse"),
            (format!("{{ motion = 'ricker', {frequency} }}"), "Ricker wavelet"),
            ("{ motion = 'rectangular', amplitude_m_s2 = 2.0, duration_s = 0.3 }".to_owned(), "rectangular pulse"),
            (
                "{ motion = 'mavroeidis-papageorgiou', velocity_amplitude_m_s = 0.5, frequency_hz = 1.0, oscillations = 1.5 }"
                    .to_owned(),
                "Mavroeidis-Papageorgiou pulse",
            ),
            ("{ motion = 'record', file = 'folder/near_fault.csv', scale = 1.5 }".to_owned(), "record near\\_fault.csv"),
        ] {
            let conditions = of_scene(&scene(&ground, ""));
            assert!(conditions.contains(&expected.to_owned()), "{conditions:?}");
        }
        let sum = of_scene(&scene(&format!("{SINE}, {{ motion = 'ricker', {frequency} }}"), ""));
        let last = sum.last().unwrap();
        assert!(last.starts_with("one-cycle sine (*a*_g = 8") && last.contains(") + Ricker wavelet (*a*_g = 0.5 g"), "{last}");
    }

    #[test]
    fn a_mass_ratio_that_is_zero_in_one_scene_leaves_those_of_the_others_theirs() {
        for values in [["0.0", "1.0"], ["1.0", "0.0"]] {
            let scenes = values.map(|value| scene(SINE, &format!("device.1.mass_ratio={value}")));
            let all = of_scenes(&scenes.each_ref());
            let ratios: Vec<&String> = all.iter().filter(|condition| condition.contains('σ')).collect();
            assert_eq!(ratios, ["σ of clutched pair = 0.5"]);
        }
    }

    #[test]
    fn what_differs_between_scenes_is_left_out() {
        for (key, symbol) in [
            ("block.slenderness_deg", "α = "),
            ("block.size_m", "*R*"),
            ("block.restitution", "η"),
            ("ground.0.frequency_ratio", "ω_g"),
            ("ground.0.amplitude_ratio", "*a*_g"),
            ("ground.0.scale", "*a*_g"),
            ("device.2.mass_ratio", "σ of clutched"),
            ("device.2.mass_ratio", "σ ="),
        ] {
            let scenes = ["0.5", "0.7"].map(|value| scene(SINE, &format!("{key}={value}")));
            let all = of_scenes(&scenes.each_ref());
            assert!(all.iter().all(|condition| !condition.contains(symbol)), "{key}: {all:?}");
            assert!(all.contains(&"one-cycle sine".to_owned()), "{key}: {all:?}");
            assert!(all.len() + 1 >= of_scene(&scenes[0]).len(), "{key}: {all:?}");
        }
        assert!(of_scenes(&[]).is_empty());
    }
}
