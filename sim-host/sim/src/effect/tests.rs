use std::path::Path;

use super::explanation::{Effects, Explanation};
use super::*;

const ALL: &str = include_str!("../../../../tests/fuzz/seeds/scene/effects.toml");
/// What a scene with those cannot have.
const BASES: [&str; 2] = [
    include_str!("../../../../tests/fuzz/seeds/scene/sliding.toml"),
    include_str!("../../../../tests/fuzz/seeds/scene/foundation.toml"),
];

#[test]
fn every_effect_is_complete_and_has_a_name_of_its_own() {
    for (index, effect) in EFFECTS.into_iter().enumerate() {
        let Effect { name, summary, equation, source, keys, .. } = effect;
        assert!(!summary.is_empty() && !equation.is_empty() && !source.is_empty() && !keys.is_empty(), "{name}");
        assert_eq!(effect.described_keys().count(), keys.len(), "{name} has a key that no scene has");
        assert!(EFFECTS[..index].iter().all(|other| other.name != *name), "{name}");
        assert_eq!(find(name).unwrap().name, *name);
    }
    assert!(find("magic").is_none());
}

#[test]
fn every_key_beyond_the_ideal_device_belongs_to_an_effect() {
    let known: Vec<&str> = EFFECTS.into_iter().flat_map(|effect| effect.keys).copied().collect();
    let tables = [
        "device.N.clutch.",
        "device.N.flywheel.",
        "device.N.rack.",
        "device.N.actuation.",
        "device.N.weight.",
        "device.N.support",
        "device.N.inertance_corner",
        "checks.",
    ];
    for key in keys(SceneFile::schema()).into_iter().filter(|key| !key.is_table) {
        let belongs = known.contains(&key.path.as_str());
        assert!(belongs || !tables.iter().any(|table| key.path.starts_with(table)), "{} belongs to no effect", key.path);
    }
}

#[test]
fn an_ideal_scene_turns_nothing_on_and_one_of_everything_turns_all_on() {
    let near_fault = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/near_fault.toml"));
    let ideal = Scene::load(near_fault, &[]).unwrap();
    assert!(Effects::of_scene(&ideal).on.is_empty());
    for index in 0..ideal.devices.len() {
        assert!(Effects::of_device(&ideal, index).on.is_empty());
        let text = text_of(&Explanation::of(&ideal, index));
        assert!(text.contains("ideal: the device's state follows from the block's"), "{text}");
    }
    let scene = Scene::parse_with(ALL, "scene", &["block.geometry=slender"]).unwrap();
    let scenes: Vec<Scene> = BASES.iter().map(|text| Scene::parse(text, "scene").unwrap()).chain([scene]).collect();
    let devices = scenes.iter().flat_map(|scene| (0..scene.devices.len()).flat_map(|index| Effects::of_device(scene, index).on));
    let on: Vec<_> = scenes.iter().flat_map(|scene| Effects::of_scene(scene).on).chain(devices).collect();
    for effect in EFFECTS {
        let setting = on.iter().find(|setting| setting.effect.name == effect.name);
        let setting = setting.unwrap_or_else(|| panic!("{} is never on", effect.name));
        assert!(setting.keys.contains(" = ") || effect.name == "vertical", "{}: {}", effect.name, setting.keys);
    }
}

#[test]
fn on_feet_the_equation_is_that_of_feet() {
    let [_, foundation] = BASES.map(|text| Scene::parse(text, "scene").unwrap());
    let text = text_of(&Explanation::of(&foundation, 0));
    assert!(text.contains("ÿ = φ₁ + φ₂") && text.contains("no impact") && !text.contains("λ θ̈ ="), "{text}");
    assert!(text.contains("the paper's kinematics leave nσ out of the θ̇² term"), "{text}");
}

#[test]
fn on_feet_a_restitution_that_is_given_has_no_effect() {
    let scene = |overrides: &[&str]| Scene::parse_with(BASES[1], "scene", overrides).unwrap();
    let says = "block.restitution: on a foundation nothing hits\n";
    let given = scene(&["block.restitution=0.8"]);
    assert!(Effects::of_scene(&given).on.iter().all(|setting| setting.effect.name != "impact"));
    assert!(text_of(&Explanation::of(&given, 0)).contains(says));
    assert!(!text_of(&Explanation::of(&scene(&["block.restitution=0.85"]), 0)).contains(says));
}

fn text_of(explanation: &Explanation) -> String {
    explanation.sections.iter().flat_map(|section| &section.lines).map(|line| format!("{line}\n")).collect()
}

fn explained(index: usize, overrides: &[&str]) -> String {
    text_of(&Explanation::of(&Scene::parse_with(ALL, "scene", overrides).unwrap(), index))
}

#[test]
fn the_equation_has_what_the_scene_asks_for() {
    let bracket = "−(g/R) [ (1 + v̈_g/g) sin δ + (ü_g/g) cos δ ]";
    for (index, equation) in [
        (0, format!("(λ + σ ℓ²) θ̈ + σ ℓ ℓ′ θ̇² = {bracket} − ℓ (F_b + F_r)/(m R)\n")),
        (1, format!("(λ + κ σ ℓ² + μ_g ℓ²) θ̈ + (κ σ + μ_g) ℓ ℓ′ θ̇² = {bracket} − μ_g ℓ ü_g/R\n")),
        (2, format!("(λ + κ σ ℓ²) θ̈ + κ σ ℓ ℓ′ θ̇² = {bracket} − ℓ F_b/(m R)\n")),
        (3, format!("(λ + κ σ ℓ²) θ̈ + κ σ ℓ ℓ′ θ̇² = {bracket} − ℓ (F₁ + F₂)/(m R)\n")),
        (4, format!("λ θ̈ = {bracket} − ℓ (F₁ + F₂ + F_r)/(m R)\n")),
    ] {
        let text = explained(index, &[]);
        assert!(text.starts_with(&equation), "{index}: {text}");
    }
    let slender = explained(2, &["block.geometry=slender", "vertical=[]"]);
    assert!(slender.starts_with("(λ + κ σ ℓ²) θ̈ = −(g/R) [ δ + ü_g/g ] − ℓ F_b/(m R)\n"), "{slender}");
}

#[test]
fn an_explanation_has_the_numbers_of_the_scene() {
    for (index, words) in [
        (
            0,
            &["λ = 1.3309", "alone: R = 2 m,  α = 10°", "σ = m_r/m = 0.4902", "c = 0.1 1/s", "stands still", "Runge-Kutta 4"][..],
        ),
        (1, &["μ_g = 0.005", "stopped at once", "exchange momentum", "with no flywheel"]),
        (2, &["nobody commands it", "c = 0.2 1/s", "run on"]),
        (3, &["F_c = 0.2 m g", "engages 0.01 s after", "capacity rises over 0.02 s", "probability 0.1; seed 7", "plates slip"]),
        (4, &["K/m = 3677.5 1/s²", "z₀ = ±0.00025 m", "F_c = 0.20394 m g", "exponential midpoint, step 0.001 s"]),
        (5, &["K/m = 250 1/s²", "no backlash", "device with memory"]),
    ] {
        let text = explained(index, &[]);
        for word in words {
            assert!(text.contains(word), "{index} must say `{word}`: {text}");
        }
    }
}

#[test]
fn an_uplift_names_the_friction_that_holds_the_block() {
    let near_fault = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/near_fault.toml"));
    let uplift = |settings: &[&str]| {
        let settings =
            ["flywheel.dry_deceleration_m_s2=0.05"].iter().chain(settings).map(|setting| format!("device.2.{setting}"));
        let scene = Scene::load(near_fault, &settings.collect::<Vec<_>>()).unwrap();
        let text = text_of(&Explanation::of(&scene, 2));
        text.lines().find(|line| line.contains("uplifts from rest")).unwrap().to_owned()
    };
    for held in [&[][..], &["clutch.capacity_ratio=0.1"], &["engagement=\"overrunning\""]] {
        assert!(uplift(held).contains("+ σ d ℓ"), "{held:?}");
    }
    assert!(uplift(&["clutch.capacity_ratio=0.001"]).contains("+ F_c ℓ"));
    for free in ["actuation.engagement_delay_s=0.01", "clutch={stiffness_ratio=1e3, capacity_ratio=0.1}"] {
        assert!(!uplift(&[free]).contains(" + "), "{free}");
    }
}

#[test]
fn bearings_hold_a_block_by_a_flywheel_that_sticks() {
    let near_fault = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/near_fault.toml"));
    let held_by = |device: usize, settings: &[&str]| {
        let settings: Vec<String> = settings.iter().map(|setting| format!("device.{device}.{setting}")).collect();
        let text = text_of(&Explanation::of(&Scene::load(near_fault, &settings).unwrap(), device));
        let line = text.lines().find_map(|line| line.split_once(" may hold the block"));
        line.map(|(before, _)| before.to_owned())
    };
    let [bearings, rack] = ["flywheel.dry_deceleration_m_s2=0.05", "rack.dry_friction_ratio=0.01"];
    let slips = "inertance_corner_hz=4";
    let springs = "clutch.stiffness_ratio=1e3";
    for (device, settings, held) in [
        (1, &[bearings][..], Some("bearings")),
        (1, &[], None),
        (1, &[bearings, slips], None),
        (1, &[bearings, rack, slips], Some("the rack")),
        (2, &[bearings, "engagement=\"rigid\"", rack], Some("rack and bearings")),
        (2, &[bearings, slips], None),
        (2, &[bearings, springs], None),
        (2, &[bearings, rack, springs], Some("the rack")),
    ] {
        let expected = held.map(|of| format!("dry friction of {of}"));
        assert_eq!(held_by(device, settings), expected, "{device} {settings:?}");
    }
}
