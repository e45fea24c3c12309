//! Lists of devices under one pulse.

use std::f64::consts::PI;
use std::path::Path;

use sprag_shared::math;
use sprag_shared::structure::block::GRAVITY;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::Scene;
use sprag_sim::simulation::demand::Impulses;
use sprag_sim::simulation::{DeviceRun, simulate};

use super::asked::Asked;
use super::basis::Basis;
use super::largest::Largest;
use super::page::page;
use super::parts::Item;
use super::study::{PartsList, Problem};
use super::subject::Subject;
use super::table::figures;
use crate::sensitivity::motion::StudyMotion;

const CORNERS: &str = "mount = 'base-corners', pulley_ratio = 3.0";
const CENTRE: &str = "mount = 'centre-of-mass'";

/// A pier of 10 t with one device, of `kind` and with `keys`, and with `overrides`.
fn pier(kind: &str, keys: &str, overrides: &[&str]) -> Scene {
    let text = format!(
        "block = {{ size_m = 2.0, slenderness_deg = 10.0, mass_kg = 1e4 }}\n\
         device = [{{ kind = '{kind}', mass_ratio = 0.5, {keys} }}]\n\
         ground = [{{ motion = 'sine', amplitude_ratio = 2.0, frequency_ratio = 4.0 }}]"
    );
    let overrides: Vec<String> = overrides.iter().map(|&item| item.to_owned()).collect();
    Scene::parse_with(&text, "scene", &overrides).unwrap()
}

/// The list of the only device of `scene`, and its page.
fn designed(scene: &Scene) -> (PartsList, String) {
    let motions = [StudyMotion::own(scene).unwrap().unwrap()];
    let problem = Problem::new(scene, &[], Basis::default()).unwrap();
    let mut findings = problem.solve(&motions, &Interrupt::default(), &|_| (), &|| ()).unwrap();
    let page = page(&problem, &findings, motions.len(), 0);
    (findings.lists.remove(0), page)
}

/// A delay is compared with none: nothing else may differ.
#[test]
fn later_clutches_move_by_the_kinematics_of_the_scene() {
    for kinematics in ["paper", "consistent"] {
        let scene = pier("clutched-pair", &format!("kinematics = '{kinematics}'"), &[]);
        let subject = Subject::new(&scene, 0).unwrap();
        let late = subject.later(0.01).unwrap();
        assert_eq!(late.scene.devices[0].device, scene.devices[0].device, "{kinematics}");
        assert_eq!(late.scene.devices[0].drivetrain.actuation.engagement_delay, 0.01);
    }
}

/// Forces of single flywheels are not known there, and no force is not no rocking.
#[test]
fn a_block_on_a_foundation_is_refused_by_name() {
    let soft = pier("inerter", CENTRE, &["block.foundation={ vertical_frequency_hz = 10.0, damping_ratio = 0.3 }"]);
    let refused = Problem::new(&soft, &[], Basis::default()).unwrap_err().to_string();
    assert!(refused.contains("block.foundation") && refused.contains("rigid ground"), "{refused}");
}

fn item<'a>(list: &'a PartsList, part: &str, quantity: &str) -> Option<&'a Item> {
    list.items.iter().find(|item| (item.part, item.quantity) == (part, quantity))
}

fn chosen(list: &PartsList, part: &str, quantity: &str) -> Option<f64> {
    item(list, part, quantity)?.chosen
}

/// Figure 3a: each corner has an inerter or a pair of its own, whose rack only rises.
#[test]
fn a_device_at_the_base_corners_is_there_twice() {
    for (kind, of_a_set) in [("inerter", 1), ("clutched-pair", 2)] {
        let (list, page) = designed(&pier(kind, CORNERS, &[]));
        assert_eq!((list.sets, list.flywheels), (2, 2 * of_a_set), "{kind}");
        assert_eq!(chosen(&list, "all parts", "sets, one at each base corner"), Some(2.0));
        assert!(page.contains("buy this list twice"), "{page}");
        let rises = chosen(&list, "rack", "travel upwards").unwrap();
        let teeth = (rises / (1e-3 * PI * list.pinion.module_mm)).ceil() + 4.0;
        assert_eq!(chosen(&list, "rack", "teeth"), Some(teeth));

        let (list, page) = designed(&pier(kind, CENTRE, &[]));
        assert_eq!((list.sets, list.flywheels), (1, of_a_set), "{kind}");
        assert!(!page.contains("twice"), "{page}");
        let to_each_side = chosen(&list, "rack", "travel to each side").unwrap();
        let teeth = (2.0 * to_each_side / (1e-3 * PI * list.pinion.module_mm)).ceil() + 4.0;
        assert_eq!(chosen(&list, "rack", "teeth"), Some(teeth));
    }
}

/// Runs know the block's travel against the ground, of which a support of its own motion may have far more.
#[test]
fn no_rack_is_chosen_on_a_support_of_its_own_motion() {
    let of_rack = [("travel to each side", true), ("teeth", false), ("toothed length", false)];
    for keys in ["support_frequency_hz = 5.0, support_damping_ratio = 0.05", "support_amplification = 1.2"] {
        let (list, page) = designed(&pier("clutched-pair", keys, &[]));
        for (quantity, is_known_of_the_block) in of_rack {
            let found = item(&list, "rack", quantity).unwrap();
            assert!(found.chosen.is_none() && found.needed.is_some() == is_known_of_the_block, "{found:?}");
        }
        let rim = item(&list, "flywheel, each", "stress at the rim").unwrap();
        assert!(list.on_support && rim.margin.is_none() && chosen(&list, "support", "force").is_some());
        assert!(page.contains("travel and speed of the rack and speed, energy and stress of its flywheels"), "{page}");
        for untrue in ["Speed does not limit it", "teeth more than its travel", "J of heat"] {
            assert!(!page.contains(untrue), "{page}");
        }
    }
    let (list, page) = designed(&pier("clutched-pair", CENTRE, &[]));
    assert!(of_rack.iter().all(|(quantity, _)| chosen(&list, "rack", quantity).is_some()) && page.contains("J of heat"));
    assert!(!list.on_support && !page.contains("support of its own motion"), "{page}");
}

/// Behind a rack of the constant speed v it would reach 2v: ẇ = ω²(vt − ∫w dt) gives w = v(1 − cos ωt), and up to four times the energy.
#[test]
fn a_spring_throws_its_flywheel_beyond_the_rack() {
    let energy = |clutch: &str| {
        let late = "flywheel = { brake_deceleration_m_s2 = 'instant' }, actuation = { engagement_delay_s = 0.15 }";
        let (list, page) = designed(&pier("clutched-pair", &format!("{late}, {clutch}"), &[]));
        let rack = list.asked[0].unwrap().rack_speed.value;
        assert_eq!(page.contains("J of heat"), clutch.contains("capacity"), "{page}");
        list.flywheel.energy_j / (0.5 * list.inertance_kg * rack * rack)
    };
    let thrown = energy("clutch = { stiffness_ratio = 3000, damping_ratio = 0.02 }");
    assert!((1.5..4.0).contains(&thrown), "{thrown}");
    assert!((energy("clutch = { capacity_ratio = 10 }") - 1.0).abs() < 1e-12);
}

/// Plates that are late and slip let the block move otherwise than ideal clutches: sensors and coils have to do for both.
#[test]
fn sensors_and_coils_are_those_of_both_runs() {
    let (list, _) = designed(&pier("clutched-pair", CENTRE, &[]));
    let (built, asked) = (list.built.as_ref().unwrap(), list.asked[0].unwrap());
    let of_chosen = |largest: &Option<Largest>| largest.as_ref().unwrap().value;
    let mut larger = 0;
    for (part, first, chosen, unit) in [
        ("gyroscope", asked.rate.value, of_chosen(&built.rate_rad_s), PI / 180.0),
        ("accelerometers", asked.acceleration().value, of_chosen(&built.acceleration_m_s2), GRAVITY),
        ("coils, both", asked.coils.unwrap().engaged_s, of_chosen(&built.coils_engaged_s), 1.0),
    ] {
        let item = list.items.iter().find(|item| item.part == part).unwrap();
        assert!((item.needed.unwrap() * unit / first.max(chosen) - 1.0).abs() < 1e-12, "{item:?}");
        assert_eq!(item.chosen_clutches, chosen > first, "{item:?}");
        larger += usize::from(item.chosen_clutches);
    }
    assert!(larger > 0, "the chosen clutches ask for more of one of them: {built:?}");
}

/// A service factor above 1 lets clutches slip later than anything was asked for: who buys a weaker support finds it broken first.
#[test]
fn a_support_bears_what_a_clutch_that_was_not_tried_passes_on() {
    for keys in [CORNERS, "engagement = 'overrunning'", "clutch = { stiffness_ratio = 1e4 }"] {
        let (list, _) = designed(&pier("clutched-pair", keys, &[]));
        let support = item(&list, "support", "force").unwrap();
        assert!(list.built.is_none() && support.needed.unwrap() < list.pinion.load_n, "{keys}: {support:?}");
        assert!(support.chosen.unwrap() >= list.pinion.load_n, "{keys}: {support:?} {:?}", list.pinion);
    }
}

/// Without losses at impacts the toe needs most friction between them, where plates that are late pull harder than ideal clutches.
#[test]
fn friction_and_shock_are_those_of_both_runs() {
    let (list, page) = designed(&pier("clutched-pair", CENTRE, &["device.0.mass_ratio=1.0", "block.restitution=1.0"]));
    let (built, asked) = (list.built.as_ref().unwrap(), list.asked[0].unwrap());
    let with_chosen = built.friction_needed.unwrap();
    assert!(with_chosen > 1.1 * asked.friction_needed.unwrap(), "{built:?}");
    assert!(list.friction_needed == Some(with_chosen) && page.contains(&figures(with_chosen)), "{page}");
    let jump = built.jump_m_s.as_ref().unwrap();
    assert_eq!(list.jump.as_ref().unwrap().value, jump.value.max(asked.jump.value));
    assert!(jump.chosen_clutches && list.contact_lost >= built.contact_lost);
}

/// An impact that keeps all of θ̇ turns the velocity of the centre of mass from down to up: by 2 R sin α |θ̇|, and θ̇² = 2 p² (cos(α − θ₀) − cos α)
/// after a release from θ₀.
#[test]
fn an_impact_jolts_upwards_too() {
    let text = "block = { size_m = 2.0, slenderness_deg = 20.0, mass_kg = 1e4, restitution = 1.0, initial_rotation_ratio = 0.5 }
        device = [{ kind = 'none' }]
        ground = [{ motion = 'sine', amplitude_ratio = 1e-12, frequency_ratio = 4.0 }]
        output = { interval_s = 0.01 }";
    let scene = Scene::parse(text, "scene").unwrap();
    let ground = scene.ground_motions().unwrap();
    let run = simulate(&scene, &ground, &Interrupt::default()).unwrap().remove(0);
    let slenderness = 20.0_f64.to_radians();
    let square = 2.0 * 0.75 * GRAVITY / 2.0 * (math::cos(0.5 * slenderness) - math::cos(slenderness));
    let jump = 2.0 * 2.0 * math::sin(slenderness) * math::square_root(square);
    let found = Asked::of(&scene, &ground, &run).jump.value;
    assert!((found / jump - 1.0).abs() < 1e-9, "{found} {jump}");
}

/// A rigid clutch that closes at speed pushes the toe sideways with little on it, or pulls it up.
#[test]
fn jolts_count_for_friction_and_contact() {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/near_fault.toml"));
    let rigid = ["block.mass_kg=1e4", "device.2.engagement=rigid"].map(str::to_owned);
    let scene = Scene::load(path, &rigid).unwrap();
    let motion = StudyMotion::own(&scene).unwrap().unwrap();
    let subject = Subject::new(&scene, 2).unwrap().watched(None);
    let run = simulate(&subject.scene, &motion.ground, &Interrupt::default()).unwrap().remove(0);
    let asked = Asked::of(&subject.scene, &motion.ground, &run);
    let (impact, jolt) = (run.impulses.impact_friction_needed.unwrap(), run.impulses.jolt_friction_needed.unwrap());
    // No friction holds a toe that a jolt pulls up.
    assert!(jolt > impact && asked.friction_needed.is_none(), "{asked:?} {:?}", run.impulses);
    let pressed = DeviceRun { impulses: Impulses { jolt_pull_m_s: None, ..run.impulses }, ..run.clone() };
    let pressed = Asked::of(&subject.scene, &motion.ground, &pressed);
    assert_eq!((pressed.friction_needed, pressed.contact_lost), (Some(jolt), false));
    let elsewhere = run.checks.as_ref().unwrap().contact_lost_time_s;
    assert!(elsewhere.is_none() && run.impulses.jolt_pull_m_s.unwrap() > 0.0 && asked.contact_lost, "{asked:?}");
}

/// |H|/V has no largest value where V goes through 0.
#[test]
fn a_toe_that_leaves_the_ground_is_not_given_a_friction() {
    let (list, page) = designed(&pier("inerter", CORNERS, &["ground.0.amplitude_ratio=10", "ground.0.frequency_ratio=9"]));
    assert_eq!((list.friction_needed, list.contact_lost), (None, 1));
    assert!(!page.contains("needs a coefficient of friction"), "{page}");
    assert!(page.contains("Under 1 motion the toe would leave the ground: no coefficient of friction is enough"), "{page}");
}

/// A light flywheel beside one whose force no standard gear bears.
#[test]
fn a_device_without_a_list_leaves_the_others_theirs() {
    let solve = |overrides: &[&str]| {
        let overrides: Vec<String> = overrides.iter().map(|&item| item.to_owned()).collect();
        let text = "block = { size_m = 2.0, slenderness_deg = 10.0, mass_kg = 1e4 }
            device = [{ kind = 'inerter', name = 'light', mass_ratio = 1e-3 }, { kind = 'inerter', name = 'heavy', mass_ratio = 5.0 }]
            ground = [{ motion = 'sine', amplitude_ratio = 2.0, frequency_ratio = 4.0 }]";
        let scene = Scene::parse_with(text, "scene", &overrides).unwrap();
        let motions = [StudyMotion::own(&scene).unwrap().unwrap()];
        let basis = Basis { allowable_stress_mpa: 0.1, ..Basis::default() };
        Problem::new(&scene, &[], basis).unwrap().solve(&motions, &Interrupt::default(), &|_| (), &|| ())
    };
    let findings = solve(&[]).unwrap();
    let names: Vec<&str> = findings.lists.iter().map(|list| list.device.as_str()).collect();
    assert_eq!((names, findings.left_out.len()), (vec!["light"], 1));
    let reason = &findings.left_out[0];
    assert!(reason.starts_with("heavy: a load of ") && reason.contains("times the service factor"), "{reason}");
    assert!(["--teeth", "--face-width", "--allowable-stress"].iter().all(|option| reason.contains(option)), "{reason}");
    // Nothing is left where no device has a list.
    let refused = solve(&["ground.0.amplitude_ratio=0.5"]).unwrap_err().to_string();
    assert!(refused.starts_with("light: no motion lifts the block"), "{refused}");
}

#[test]
fn a_demand_beyond_the_limits_of_the_scene_is_named() {
    let keys = ["checks.largest_force_ratio", "checks.largest_stroke_m", "checks.coil.largest_energy_j"];
    let named = |limit: &str| {
        let checks = format!(
            "checks={{ largest_force_ratio = {limit}, largest_stroke_m = {limit}, \
             coil = {{ holding_power_w = 10.0, largest_energy_j = {limit} }} }}"
        );
        let (list, page) = designed(&pier("clutched-pair", CENTRE, &[&checks]));
        let force = figures(item(&list, "support", "force").unwrap().needed.unwrap());
        (
            keys.map(|key| page.contains(&format!("that {key} of the scene allows"))),
            page.contains(&format!("force of {force} N is more")),
        )
    };
    assert_eq!((named("1e-3"), named("1e3")), (([true; 3], true), ([false; 3], false)));
}
