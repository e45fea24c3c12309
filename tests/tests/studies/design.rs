//! Parts lists by the library: what is sized is what a simulation asks for, and every size follows from it.

use sprag_shared::structure::block::GRAVITY;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::Scene;
use sprag_sim::simulation::{DeviceRun, simulate};
use sprag_studies::design::basis::Basis;
use sprag_studies::design::error::DesignError;
use sprag_studies::design::page::page;
use sprag_studies::design::parts::Item;
use sprag_studies::design::study::{Findings, PartsList, Problem};
use sprag_studies::sensitivity::motion::{RecordFiles, StudyMotion};
use sprag_tests::pulse_records::sine_pulses;

/// A pier of 10 t under whatever pulse, with two flywheels.
const PAIR: &str = "kind = 'clutched-pair'\nmass_ratio = 0.5\n";

fn scene(device: &str, more: &[&str]) -> Scene {
    let text = format!(
        "[block]\nsize_m = 2\nslenderness_deg = 10\nmass_kg = 1e4\n[[device]]\n{device}[[ground]]\nmotion = 'record'\n[run]\nfree_time_s = 3\n"
    );
    Scene::parse_with(&text, "scene.toml", more).unwrap()
}

/// Pulses that rock the pier, of which one overturns it bare.
fn motions(scene: &Scene) -> Vec<StudyMotion> {
    let folder = sine_pulses(&[0.25, 0.4], &[0.7, 1.2]);
    let mut files: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|file| file.unwrap().path()).collect();
    files.sort();
    let read = |horizontal| StudyMotion::record(scene, &RecordFiles { horizontal, vertical: None }).unwrap();
    files.into_iter().map(read).collect()
}

fn solved(scene: &Scene, basis: Basis) -> Result<Findings, DesignError> {
    let problem = Problem::new(scene, &[], basis)?;
    problem.solve(&motions(scene), &Interrupt::default(), &|_| (), &|| ())
}

fn list(scene: &Scene, basis: Basis) -> PartsList {
    solved(scene, basis).unwrap().lists.remove(0)
}

fn item<'a>(list: &'a PartsList, part: &str, quantity: &str) -> &'a Item {
    let found = list.items.iter().find(|item| (item.part, item.quantity) == (part, quantity));
    found.unwrap_or_else(|| panic!("{part}, {quantity}: {:?}", list.items))
}

/// The runs of the only device of `scene` under each motion.
fn runs(scene: &Scene) -> Vec<DeviceRun> {
    let run = |motion: &StudyMotion| simulate(scene, &motion.ground, &Interrupt::default()).unwrap().remove(0);
    motions(scene).iter().map(run).collect()
}

#[test]
fn what_is_needed_is_what_simulations_report() {
    let scene = scene("kind = 'inerter'\nmass_ratio = 0.5\n", &["checks.largest_stroke_m=9"]);
    let list = list(&scene, Basis::default());
    let runs = runs(&scene);
    let largest = |of: &dyn Fn(&DeviceRun) -> f64| runs.iter().map(of).fold(0.0, f64::max);
    let force = 1e4 * GRAVITY * largest(&|run| run.checks.as_ref().unwrap().force_ratio.unwrap());
    let travel = largest(&|run| run.checks.as_ref().unwrap().stroke_m.unwrap());
    assert_eq!(list.overturned_by.len(), runs.iter().filter(|run| run.outcome.overturned()).count());
    assert!((item(&list, "support", "force").needed.unwrap() / force - 1.0).abs() < 1e-12);
    assert!((item(&list, "rack", "travel to each side").needed.unwrap() / travel - 1.0).abs() < 1e-12);
    // Without a clutch teeth bear the force itself, times the service factor: F/(b m Y), with Y = 0.484 - 2.87/20.
    let (module, width) = (list.pinion.module_mm, list.pinion.face_width_mm);
    let stress = 1.5 * force / (module * width * 0.3405);
    assert!((list.pinion.stress_mpa / stress - 1.0).abs() < 1e-12 && stress <= 200.0);
    let smaller = module - 1.0;
    assert!(1.5 * force / (10.0 * smaller * smaller * 0.3405) > 200.0, "a module 1 mm smaller is too small: {module}");
    // J = m_r ρ² with ρ = m z/2.
    let radius = 0.5e-3 * module * 20.0;
    assert!((list.flywheel.inertia_kg_m2 / (5000.0 * radius * radius) - 1.0).abs() < 1e-12);
    let without = |part: &str| list.items.iter().all(|item| item.part != part);
    assert!(without("clutch, each") && without("coil") && without("gyroscope") && list.delay.is_none(), "nothing to command");
    assert!(list.items.iter().filter_map(|item| item.margin).all(|margin| margin >= 1.0));
}

#[test]
fn twice_the_mass_asks_twice_of_everything_at_the_same_gear() {
    let one = list(&scene(PAIR, &[]), Basis::default());
    // Twice the force on a steel twice as strong leaves the gear as it is.
    let strong = Basis { allowable_stress_mpa: 400.0, ..Basis::default() };
    let two = list(&scene(PAIR, &["block.mass_kg=2e4"]), strong);
    assert_eq!(one.pinion.module_mm, two.pinion.module_mm);
    for (part, quantity) in [("clutch, each", "torque"), ("support", "force")] {
        let [one, two] = [&one, &two].map(|list| item(list, part, quantity));
        // R10 repeats with its third number, but for its rounding: 1.25 of 1.6 to 2.5 of 3.15.
        let chosen = two.chosen.unwrap() / one.chosen.unwrap();
        assert!((chosen / 2.0 - 1.0).abs() < 0.02, "{part}: {chosen}");
        if part != "support" {
            assert!((two.needed.unwrap() / one.needed.unwrap() - 2.0).abs() < 1e-9, "{part}");
        }
    }
    assert!((two.flywheel.inertia_kg_m2 / one.flywheel.inertia_kg_m2 - 2.0).abs() < 1e-12);
    assert_eq!(one.delay, two.delay, "a delay has no mass");
}

#[test]
fn the_clutch_slips_before_a_tooth_breaks_and_holds_what_is_asked() {
    let list = list(&scene(PAIR, &[]), Basis::default());
    let torque = item(&list, "clutch, each", "torque");
    assert!(torque.margin.unwrap() >= 1.5 * (1.0 - 1e-9) && torque.margin.unwrap() < 1.5 * 1.3, "{torque:?}");
    let slip = torque.chosen.unwrap() / list.pinion.radius_m;
    assert!((list.pinion.load_n / slip - 1.0).abs() < 1e-12 && list.pinion.stress_mpa <= 200.0);
    let built = list.built.as_ref().unwrap();
    assert!((built.capacity_n / slip - 1.0).abs() < 1e-12);
    // Two clutches pull with no more than both have.
    assert!(built.support_n.as_ref().unwrap().value <= 2.0 * slip * (1.0 + 1e-9));
    let chosen = item(&list, "support", "force");
    assert!(chosen.needed.unwrap() >= built.support_n.as_ref().unwrap().value);
}

/// A clutch of the scene's own limits the force, and that of the list slips later: its support bears it.
#[test]
fn the_support_is_no_weaker_than_the_clutch() {
    let plates = "kind = 'clutched-pair'\nmass_ratio = 0.5\nclutch = { capacity_ratio = 0.05 }\n\
                  flywheel = { brake_deceleration_m_s2 = 'instant' }\n";
    let list = list(&scene(plates, &[]), Basis::default());
    let slip = item(&list, "clutch, each", "torque").chosen.unwrap() / list.pinion.radius_m;
    let support = item(&list, "support", "force");
    assert!(support.chosen.unwrap() >= slip && support.needed.unwrap() < slip, "{slip} {support:?}");
}

#[test]
fn the_delay_allowed_keeps_the_tolerance_and_the_next_does_not() {
    let list = list(&scene(PAIR, &[]), Basis::default());
    let delay = list.delay.as_ref().unwrap();
    let late = |delay: f64| {
        let key = format!("device.0.actuation={{ engagement_delay_s = {delay}, release_delay_s = {delay} }}");
        runs(&scene(PAIR, &[&key]))
    };
    let before = runs(&scene(PAIR, &[]));
    let stands = |run: &&DeviceRun| !run.outcome.overturned();
    let largest = before.iter().filter_map(|run| run.peak_rotation).fold(0.0, f64::max);
    let is_within = |late: Vec<DeviceRun>| {
        let of_those_that_stood = late.iter().zip(&before).filter(|(_, before)| stands(before)).map(|(late, _)| late);
        of_those_that_stood.clone().all(|run| stands(&run))
            && of_those_that_stood.filter_map(|run| run.peak_rotation).all(|peak| peak <= 1.05 * largest * (1.0 + 1e-9))
    };
    assert!(is_within(late(delay.delay_s)), "{delay:?}");
    assert!(delay.lost_at_s.is_some_and(|lost| lost > delay.delay_s && !is_within(late(lost))), "{delay:?}");
    assert!(delay.tried.is_sorted_by(|one, other| one.delay_s < other.delay_s));
    let generous = list_of_tolerance(1.0);
    assert!(generous >= delay.delay_s, "{generous}");
    let sum = ["coil", "sensors"].map(|part| item(&list, part, "delay, at most").chosen.unwrap());
    assert!((sum[0] + sum[1] - delay.delay_s).abs() < 1e-12);
}

fn list_of_tolerance(tolerance: f64) -> f64 {
    list(&scene(PAIR, &[]), Basis { tolerance, ..Basis::default() }).delay.unwrap().delay_s
}

#[test]
fn clutches_that_nobody_commands_have_a_torque_and_no_coil() {
    let list = list(&scene(PAIR, &["device.0.engagement=overrunning"]), Basis::default());
    assert!(list.pinion.clutch_torque_n_m.is_some() && list.delay.is_none() && list.sensors.is_none());
    // Nothing is lost by a delay where all is lost without one.
    let felled = solved(&scene(PAIR, &["ground.0.scale=9"]), Basis::default()).unwrap();
    assert!(felled.lists[0].delay.is_none() && felled.left_out[0].contains("every motion overturns"), "{:?}", felled.left_out);
    assert!(felled.lists[0].overturned_by.len() == 4 && felled.lists[0].built.is_none());
    // A mount that takes no delay is said, and the rest is there.
    let findings = solved(&scene(PAIR, &["device.0.mount=base-corners", "device.0.pulley_ratio=3"]), Basis::default()).unwrap();
    assert!(findings.lists[0].delay.is_none() && findings.left_out[0].contains("horizontal mount"), "{:?}", findings.left_out);
}

#[test]
fn a_controller_drives_the_clutches_where_the_scene_has_one() {
    let controlled = ["controller.rate_hz=500", "controller.law=resisting", "controller.sensors.suite=adis16470"];
    let list = list(&scene(PAIR, &controlled), Basis::default());
    assert!(list.controlled && list.delay.is_some());
    let sensors = list.sensors.as_ref().unwrap();
    assert!(sensors.delay_s.is_none() && sensors.suites.contains(&"adis16470"), "sensors were in the runs: {sensors:?}");
    let held = item(&list, "coils, both", "time engaged").needed.unwrap();
    assert!(held > 0.0 && held < 20.0, "{held}");
}

#[test]
fn the_page_has_its_sections() {
    let scene = scene(PAIR, &[]);
    let motions = motions(&scene);
    let problem = Problem::new(&scene, &[], Basis::default()).unwrap();
    let findings = problem.solve(&motions, &Interrupt::default(), &|_| (), &|| ()).unwrap();
    let page = page(&problem, &findings, motions.len(), 0);
    let sections = ["# Device: parts list", "### Why", "### Tried with the chosen clutches", "## Limits"];
    for words in sections.into_iter().chain(["| pinion", "stops at once", "ISO 54"]) {
        assert!(page.contains(words), "{words}: {page}");
    }
    assert!(page.lines().count() < 70, "one page");
}

#[test]
fn what_cannot_be_sized_is_refused_by_name() {
    let refused = |scene: &Scene, basis: Basis| solved(scene, basis).unwrap_err().to_string();
    let weak = refused(&scene(PAIR, &["ground.0.scale=0.01"]), Basis::default());
    assert!(weak.contains("clutched pair") && weak.contains("no motion lifts"), "{weak}");
    let none = refused(&scene("kind = 'none'\n", &[]), Basis::default());
    assert!(none.contains("no device has a flywheel"), "{none}");
    let massless = refused(&scene(PAIR, &["block.mass_kg="]), Basis::default());
    assert!(massless.contains("block.mass_kg is missing"), "{massless}");
    let soft = refused(&scene(PAIR, &[]), Basis { allowable_stress_mpa: 0.01, ..Basis::default() });
    assert!(soft.contains("0.01 MPa"), "{soft}");
}
