//! Blocks whose devices have friction: the last bounces, which are summed in closed form, and the force of clutches that drag.

use sprag_shared::math;
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::structure::block::{GRAVITY, RECTANGLE_INERTIA_RATIO};

use super::{DeviceRun, runs_of, simulate};
use crate::interrupt::Interrupt;
use crate::scene::Scene;
use crate::side_by_side::{Shaking, Subject, followed};

const SLENDERNESS_DEG: f64 = 15.0;

/// A block of R = 1 m that is let go, with `device`.
fn run(device: &str, rest_speed_ratio: f64) -> DeviceRun {
    started("initial_rotation_ratio = 0.5", device, rest_speed_ratio)
}

fn started(start: &str, device: &str, rest_speed_ratio: f64) -> DeviceRun {
    let text = format!(
        "block = {{ size_m = 1.0, slenderness_deg = {SLENDERNESS_DEG}, restitution = 0.9, {start} }}
        device = [{{ mass_ratio = 1.0, {device} }}]
        run = {{ free_time_s = 20.0, rest_speed_ratio = {rest_speed_ratio:e} }}"
    );
    runs_of(&text).remove(0)
}

/// The impacts of all `runs` of `device` are as many as those of the first, but for so many, and their ends lie as near to its end.
fn end_alike<const N: usize>(device: &str, runs: [DeviceRun; N], (more, apart): (u32, f64)) {
    for run in &runs[1..] {
        let [(impacts, end), (counted, exact)] = [run, &runs[0]].map(|run| (run.impacts, run.end_time_s));
        assert!(impacts.abs_diff(counted) <= more, "{device}: {impacts} and {counted} impacts");
        assert!((end / exact - 1.0).abs() < apart, "{device}: ends at {end} and {exact}");
    }
}

const INERTER: &str = "kind = 'inerter', kinematics = 'consistent'";

#[test]
fn the_rest_threshold_does_not_show_beside_dry_friction() {
    for device in [
        format!("{INERTER}, rack = {{ dry_friction_ratio = 0.1 }}"),
        format!("{INERTER}, flywheel = {{ dry_deceleration_m_s2 = 1.0 }}"),
        format!("{INERTER}, flywheel = {{ dry_deceleration_m_s2 = 1.5 }}, rack = {{ load_friction = 0.5 }}"),
        "kind = 'clutched-pair', engagement = 'rigid', flywheel = { brake_deceleration_m_s2 = 'instant' }, rack = { dry_friction_ratio = 0.1 }"
            .to_owned(),
    ] {
        end_alike(&device, [1e-12, 1e-6, 1e-4, 1e-2].map(|speed| run(&device, speed)), (0, 2e-3));
    }
}

/// Swings as short as the summed ones make weak plates slip, and leave behind what hangs on a spring.
#[test]
fn the_rest_threshold_does_not_show_beside_clutches() {
    for device in [
        "kind = 'clutched-pair', clutch = { capacity_ratio = 0.02 }, flywheel = { brake_deceleration_m_s2 = 'instant' }",
        "kind = 'clutched-pair', clutch = { stiffness_ratio = 100, damping_ratio = 0.2 }, flywheel = { brake_deceleration_m_s2 = 'instant' }",
    ] {
        end_alike(device, [1e-9, 1e-6, 1e-4].map(|speed| run(device, speed)), (1, 2e-4));
    }
}

/// Swings that are shorter than what delays the clutches find them as they are: neither the end nor the largest acceleration is that of clutches that
/// follow every swing.
#[test]
fn the_rest_threshold_does_not_show_beside_late_clutches() {
    for (engagement, actuation) in [
        ("", "engagement_delay_s = 0.05, release_delay_s = 0.06"),
        ("", "release_delay_s = 0.05"),
        ("", "engagement_delay_s = 0.05"),
        ("", "dwell_s = 0.08"),
        ("", "release_delay_s = 0.05, delay = 'transport'"),
        (
            "engagement = 'rigid', flywheel = { brake_deceleration_m_s2 = 'instant' }, ",
            "engagement_delay_s = 0.05, release_delay_s = 0.06",
        ),
    ] {
        let device = format!("kind = 'clutched-pair', {engagement}actuation = {{ {actuation} }}");
        let [followed, summed @ ..] = [1e-12, 1e-9, 1e-6, 1e-4].map(|speed| run(&device, speed));
        for run in summed {
            let [(end, peak), (exact, largest)] = [&run, &followed].map(|run| (run.end_time_s, run.peak_acceleration.unwrap()));
            assert!((end / exact - 1.0).abs() < 2e-5, "{device}: ends at {end} and {exact}");
            assert!((peak / largest - 1.0).abs() < 1e-3, "{device}: {peak} and {largest}");
        }
    }
}

/// By momentum balance a flywheel that is locked through an impact changes what the impact takes, in the last bounces as before them.
#[test]
fn the_last_bounces_take_what_impacts_with_flywheels_do() {
    for device in [
        "kind = 'inerter', rack = { dry_friction_ratio = 0.001 }",
        "kind = 'clutched-pair', engagement = 'rigid', flywheel = { brake_deceleration_m_s2 = 'instant' }",
    ] {
        let runs = [1e-12, 1e-6, 1e-4].map(|speed| {
            let text = format!(
                "block = {{ size_m = 1.0, slenderness_deg = {SLENDERNESS_DEG}, restitution = 'momentum-balance', initial_rotation_ratio = 0.5 }}
                device = [{{ mass_ratio = 1.0, {device} }}]
                run = {{ free_time_s = 40.0, rest_speed_ratio = {speed:e} }}"
            );
            runs_of(&text).remove(0)
        });
        end_alike(device, runs, (0, 5e-6));
    }
}

/// A block that sets out so slowly that its rates are constant is at rest after v (1/a₁ + 1/√(a₁a₂))/(1 − η √(a₂/a₁)), with a₁ as it rises
/// and a₂ as it falls. The bearings of the last inerter slow its flywheel down faster than the weight does the block, so that the rack
/// drives it outward too.
#[test]
fn the_last_bounces_end_in_closed_form() {
    let alpha = SLENDERNESS_DEG.to_radians();
    let (weight, lever) = (GRAVITY * math::sin(alpha), math::cos(alpha));
    for (rack, bearings, mesh, drives) in
        [(0.1, 0.0, 0.0, true), (0.0, 1.0, 0.0, true), (0.0, 0.0, 0.5, true), (0.05, 0.6, 0.3, true), (0.0, 2.0, 0.2, false)]
    {
        let device = format!(
            "{INERTER}, flywheel = {{ dry_deceleration_m_s2 = {bearings} }}, rack = {{ dry_friction_ratio = {rack}, load_friction = {mesh} }}"
        );
        let rate = |way: f64, load: f64| {
            (weight + way * (rack * GRAVITY + load * bearings) * lever) / (RECTANGLE_INERTIA_RATIO + load * lever * lever)
        };
        let (rises, falls) = (rate(1.0, if drives { 1.0 - mesh } else { 1.0 + mesh }), rate(-1.0, 1.0 + mesh));
        let speed = 1e-5 * math::square_root(GRAVITY / RECTANGLE_INERTIA_RATIO) * alpha;
        let swing = speed * (1.0 / rises + 1.0 / math::square_root(rises * falls));
        let expected = swing / (1.0 - 0.9 * math::square_root(falls / rises));
        let found = started("initial_velocity_ratio = 1e-5", &device, 1e-2).end_time_s;
        assert!((found / expected - 1.0).abs() < 1e-4, "{device}: {found} and {expected}");
    }
}

/// Outward the flywheel drives the rack, so that the friction μ of the mesh takes from the bearings what it adds inward:
/// (λ + (1 − μ) σ ℓ²) θ̈ = g sin α/R + (1 − μ) σ d ℓ/R at θ = 0, which is the largest of the last swings.
#[test]
fn the_peak_acceleration_of_the_last_bounces_has_the_friction_of_the_way_out() {
    let (mesh, drag) = (0.5, 0.8);
    let device = format!("{INERTER}, flywheel = {{ dry_deceleration_m_s2 = {drag} }}, rack = {{ load_friction = {mesh} }}");
    let alpha = SLENDERNESS_DEG.to_radians();
    let (sine, lever) = (math::sin(alpha), math::cos(alpha));
    let inertia = RECTANGLE_INERTIA_RATIO + (1.0 - mesh) * lever * lever;
    let largest = (GRAVITY * sine + (1.0 - mesh) * drag * lever) / inertia / (GRAVITY / RECTANGLE_INERTIA_RATIO * alpha);
    for speed in [1e-9, 1e-4] {
        let found = run(&device, speed).peak_acceleration.unwrap();
        assert!((found / largest - 1.0).abs() < 3e-3, "{found} for {largest}");
    }
}

/// A clutch that never closes passes the force by which it drags, whether or not somebody looks at the other forces.
#[test]
fn the_force_on_the_support_has_the_drag_of_open_clutches() {
    let found = ["", "checks = {}\n"].map(|checks| {
        let text = format!(
            "{checks}block = {{ size_m = 2.0, slenderness_deg = 10.0 }}
            ground = [{{ motion = 'sine', amplitude_ratio = 2.0, frequency_ratio = 4.0 }}]
            run = {{ free_time_s = 4.0 }}
            device = [{{ kind = 'clutched-pair', mass_ratio = 0.5, engagement = 'rigid', actuation = {{ engagement_delay_s = 10.0 }},
                flywheel = {{ brake_deceleration_m_s2 = 20.0, drag_rate_1_s = 5.0 }} }}]"
        );
        runs_of(&text).remove(0).peak_force_ratio.unwrap()
    });
    assert!(found[0] == found[1] && (found[0] / 0.208_49 - 1.0).abs() < 1e-4, "{found:?}");
}

/// Bearings that could hold much more give what a block that stands needs of them, ü_g/g − tan α, and share it with the rack by what each could
/// hold.
#[test]
fn clutches_that_hold_a_block_down_press_as_statics_says() {
    let clutches = [
        ("engagement = 'rigid'", ", brake_deceleration_m_s2 = 0"),
        ("engagement = 'overrunning'", ""),
        ("clutch = { capacity_ratio = 0.6 }", ", brake_deceleration_m_s2 = 0"),
    ];
    let bearings = 0.5 * 10.0 / GRAVITY;
    for ((clutch, brake), amplitude) in clutches.into_iter().flat_map(|clutch| [1.2, 2.0].map(|amplitude| (clutch, amplitude))) {
        for rack in [0.0, 0.05] {
            let text = format!(
                "block = {{ size_m = 1.0, slenderness_deg = {SLENDERNESS_DEG} }}
                ground = [{{ motion = 'sine', amplitude_ratio = {amplitude}, frequency_ratio = 3.0 }}]
                run = {{ free_time_s = 2.0 }}
                device = [{{ kind = 'clutched-pair', mass_ratio = 0.5, {clutch}, rack = {{ dry_friction_ratio = {rack} }},
                    flywheel = {{ dry_deceleration_m_s2 = 10.0{brake} }} }}]"
            );
            let run = runs_of(&text).remove(0);
            assert_eq!(run.outcome, Outcome::NoRocking, "{text}");
            let push = (amplitude - 1.0) * math::tan(SLENDERNESS_DEG.to_radians());
            // A commanded clutch is open until the push overcomes the rack.
            let needed = if push > rack { push * bearings / (bearings + rack) } else { 0.0 };
            let force = run.peak_force_ratio.unwrap();
            assert!((force - needed).abs() < 1e-6, "{text}: {force} and {needed}");
        }
    }
}

/// Bearings hold a flywheel at 0 while plates slip, by the speed of the rack alone: they stop slipping where the block turns, at one instant.
#[test]
fn a_turn_over_a_held_flywheel_is_a_turn_at_any_step() {
    for (block, device, ground) in [
        (
            "size_m = 2.391, slenderness_deg = 6.329, restitution = 0.92",
            "mass_ratio = 1.804, clutch = { capacity_ratio = 0.4069 }, flywheel = { dry_deceleration_m_s2 = 1.504 },
            actuation = { engagement_delay_s = 0.0106, release_delay_s = 0.0255, time_constant_s = 0.0652 }",
            "motion = 'sine', amplitude_ratio = 4.867, frequency_ratio = 3.612",
        ),
        (
            "size_m = 4.201, slenderness_deg = 20.663, restitution = 0.874",
            "mass_ratio = 0.533, clutch = { capacity_ratio = 0.0267 }, flywheel = { dry_deceleration_m_s2 = 0.369 },
            actuation = { engagement_delay_s = 0.0197, release_delay_s = 0.0238, rise_time_s = 0.0287 }",
            "motion = 'cosine', amplitude_ratio = -1.156, frequency_ratio = 3.108",
        ),
        (
            "size_m = 2.554, slenderness_deg = 9.103, restitution = 0.797",
            "mass_ratio = 2.15, clutch = { capacity_ratio = 0.6499 }, flywheel = { dry_deceleration_m_s2 = 2.102 },
            actuation = { engagement_delay_s = 0.0315, release_delay_s = 0.047, time_constant_s = 0.0838 }",
            "motion = 'sine', amplitude_ratio = 1.115, frequency_ratio = 1.058",
        ),
    ] {
        let peak = |accuracy: &str| {
            let text = format!(
                "block = {{ {block} }}
                device = [{{ kind = 'clutched-pair', {device} }}]
                ground = [{{ {ground} }}]
                run = {{ free_time_ratio = 8 }}
                accuracy = {{ {accuracy} }}"
            );
            runs_of(&text).remove(0).peak_rotation.unwrap()
        };
        let found = peak("");
        for accuracy in ["tolerance = 1e-12", "tolerance = 1e-17"] {
            assert!((peak(accuracy) / found - 1.0).abs() < 1e-8, "{block} {accuracy}: {} {found}", peak(accuracy));
        }
        for step in [1e-3, 5e-4, 3.1e-4, 1e-4] {
            let stepped = peak(&format!("method = 'runge-kutta-4', step_ratio = {step}"));
            assert!((stepped / found - 1.0).abs() < 1e-3, "{block} {step}: {stepped} {found}");
        }
    }
}

/// A block that bearings hold on its base where its weight does not: the ground pushes it with 1.1 g tan α at most.
fn held_down(checks: &str) -> String {
    format!(
        "block = {{ size_m = 1.0, slenderness_deg = {SLENDERNESS_DEG} }}
        device = [{{ kind = 'clutched-pair', mass_ratio = 1.0, clutch.capacity_ratio = 0.5, flywheel.dry_deceleration_m_s2 = 4.0 }}]
        ground = [{{ motion = 'sine', amplitude_g = {}, frequency_hz = 1.0 }}]
        run = {{ free_time_s = 0.5 }}
        {checks}",
        1.1 * math::tan(SLENDERNESS_DEG.to_radians())
    )
}

const COIL: &str = "checks = { coil = { holding_power_w = 24, closing_energy_j = 5 } }";

/// They hold as long as |ü_g| is above g tan α, twice for (π − 2 arcsin 1/1.1)/(2π) s, with what the weight leaves.
#[test]
fn a_history_shows_the_clutches_that_hold_a_standing_block() {
    let run = runs_of(&held_down(COIL)).remove(0);
    let tangent = math::tan(SLENDERNESS_DEG.to_radians());
    assert_eq!(run.outcome, Outcome::NoRocking);
    for sample in &run.history.samples {
        let beyond = sample.ground_m_s2 / GRAVITY / tangent;
        let (engaged, holds) = match beyond.abs() {
            // Where they switch a sample is on either side.
            near if (near - 1.0).abs() < 1e-9 => continue,
            below if below < 1.0 => (0, 0.0),
            // A push towards θ > 0 is for the first to resist.
            above => (if beyond < 0.0 { 1 } else { 2 }, (above - 1.0) * tangent),
        };
        assert_eq!(sample.engaged, engaged, "{sample:?}");
        assert!((sample.transferred_force_ratio().abs() - holds).abs() < 1e-6, "{sample:?}");
    }
    let coils = run.checks.as_ref().unwrap().coils.unwrap();
    assert_eq!((run.clutch_switches, coils.closings), (4, 2));
    let shown: f64 = run.history.engagements().iter().map(|(start, end, _)| end - start).sum();
    let above = 1.0 - std::f64::consts::FRAC_2_PI * math::asin(1.0 / 1.1);
    for held in [shown, coils.engaged_s] {
        assert!((held - above).abs() < 1e-6, "{held} and {above}");
    }
}

/// What a history shows is what the coils take, but for bounces that a rest stands for.
#[test]
fn a_history_shows_what_coils_take_of_a_standing_block_too() {
    for text in [
        "block = { size_m = 0.762, slenderness_deg = 17.06 }
        device = [{ kind = 'clutched-pair', mass_ratio = 1.226, clutch.capacity_ratio = 0.3052,
            flywheel = { viscous_rate_1_s = 5.761, dry_deceleration_m_s2 = 1.941, brake_deceleration_m_s2 = 'instant' } }]
        ground = [{ motion = 'mavroeidis-papageorgiou', velocity_amplitude_m_s = 0.7584, frequency_hz = 2.059,
            oscillations = 2.4814, phase_deg = 50.1, start_s = 1.27 }]",
        // It falls back on its base, and its clutch stays engaged.
        "block = { size_m = 0.997, slenderness_deg = 17.17, restitution = 1e-9 }
        device = [{ kind = 'clutched-pair', mass_ratio = 1.492, clutch.capacity_ratio = 0.125,
            flywheel = { viscous_rate_1_s = 2.283, dry_deceleration_m_s2 = 1.224 } }]
        ground = [{ motion = 'mavroeidis-papageorgiou', velocity_amplitude_m_s = 0.8174, frequency_hz = 1.042,
            oscillations = 2.2593, phase_deg = 250.7, start_s = 0.3 }]",
    ] {
        let run = runs_of(&format!("{text}\nrun = {{ free_time_s = 0.0 }}\n{COIL}")).remove(0);
        let coils = run.checks.as_ref().unwrap().coils.unwrap();
        let engaged = run.history.samples.iter().map(|sample| sample.engaged);
        let pairs = engaged.clone().zip(engaged.skip(1));
        let closings: u32 = pairs.clone().map(|(before, after)| (after & !before).count_ones()).sum();
        let switches = pairs.filter(|(before, after)| before != after).count();
        assert_eq!((closings, switches), (coils.closings, run.clutch_switches as usize), "{text}");
        let engagements = run.history.engagements();
        let shown: f64 = engagements.iter().map(|(start, end, which)| (end - start) * f64::from(which.count_ones())).sum();
        assert!((shown - coils.engaged_s).abs() < 1e-9, "{text}: {shown} and {}", coils.engaged_s);
    }
}

/// m (ü_g − g tan α) over mg.
#[test]
fn lanes_see_the_force_of_clutches_that_hold_a_standing_block() {
    let scene = Scene::parse(&held_down(""), "scene").unwrap();
    let ground = scene.ground_motions().unwrap();
    let run = simulate(&scene, &ground, &Interrupt::default()).unwrap().remove(0);
    let subject = Subject::watched(scene);
    let lanes = followed(&[(&subject, Shaking::Any(&ground))]).remove(0).expect("lanes take it").demand.unwrap();
    let needed = 0.1 * math::tan(SLENDERNESS_DEG.to_radians());
    for force in [lanes.force_ratio, run.peak_force_ratio.unwrap()] {
        assert!((force / needed - 1.0).abs() < 1e-6, "{force} and {needed}");
    }
}
