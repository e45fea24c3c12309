use sprag_shared::math;
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::structure::block::{GRAVITY, Geometry};

use super::*;
use crate::interrupt::Interrupt;
use crate::scene::Scene;
use crate::scene::checks::{ChecksTable, GearTable};

/// A block of 2 m and 10° under a cycle of sine of `amplitude`, with a device of σ = 0.5 and what `device` says of it.
fn runs(amplitude: f64, device: &str, more: &str) -> Vec<DeviceRun> {
    let scene = scene(amplitude, device, more);
    simulate(&scene, &scene.ground_motions().unwrap(), &Interrupt::default()).unwrap()
}

fn scene(amplitude: f64, device: &str, more: &str) -> Scene {
    let text = format!(
        "[block]\nsize_m = 2\nslenderness_deg = 10\nrestitution = 0.85\n[[device]]\nmass_ratio = 0.5\n{device}\n[[ground]]\nmotion = \"sine\"\n\
         amplitude_ratio = {amplitude}\nfrequency_ratio = 9\n[run]\nfree_time_s = 2\n{more}"
    );
    Scene::parse(&text, "scene.toml").unwrap()
}

/// The force of a stiff clutch swings fast: a history that is sampled twenty times as finely has larger samples, the located peak stays.
#[test]
fn the_peak_force_lies_between_samples_too() {
    let clutch = "kind = 'clutched-pair'\nclutch = { stiffness_ratio = 1e5, damping_ratio = 0.02 }\nactuation = { engagement_delay_s = 0.02 }";
    let [coarse, fine] = ["0.01", "0.0002"].map(|interval| {
        let run = runs(5.0, clutch, &format!("[output]\ninterval_s = {interval}")).remove(0);
        (run.peak_force_ratio.unwrap(), run.history.peak_force_ratio())
    });
    assert!(fine.1 > 1.02 * coarse.1, "a history of the one must show what that of the other does not: {coarse:?} {fine:?}");
    assert_eq!(coarse.0, fine.0);
    assert!(fine.1 <= fine.0 * (1.0 + 1e-12) && fine.1 > 0.99 * fine.0, "{fine:?}");
}

/// |H|/V has no largest value where V goes through 0, and what steps of one tolerance find of it is not what those of another do.
#[test]
fn a_toe_that_leaves_the_ground_needs_no_number_of_friction() {
    let device = "kind = 'inerter'\nmount = 'base-corners'\npulley_ratio = 3";
    for tolerance in ["1e-10", "1e-13"] {
        let more = format!("[checks]\nfriction_coefficient = 0.6\n[accuracy]\ntolerance = {tolerance}");
        let checks = runs(10.0, device, &more).remove(0).checks.unwrap();
        assert!(checks.smallest_vertical_reaction_ratio.unwrap() < 0.0, "{checks:?}");
        assert_eq!((checks.friction_needed, checks.friction_needed_time_s), (None, None));
        let said = |words: &str| checks.warnings.iter().any(|warning| warning.starts_with(words));
        assert!(said("the toe would leave the ground at 0.2157 s: no coefficient of friction is enough"), "{checks:?}");
        assert!(!said("the toe would slide: "), "{checks:?}");
    }
}

/// A quantile of stresses over motions is to count those that do not rock the block as no stress, not to leave them out.
#[test]
fn a_gear_under_a_block_that_never_rocks_bears_nothing() {
    let gear = GearTable { module_mm: 4.0, face_width_mm: 40.0, teeth: 20, allowable_stress_mpa: 200.0 };
    let stress = |amplitude: f64, gear: Option<GearTable>| {
        let mut scene = scene(amplitude, "kind = 'inerter'", "");
        scene.file.block.mass_kg = Some(1e4);
        scene.file.checks = Some(ChecksTable { gear, ..ChecksTable::default() });
        let run = simulate(&scene, &scene.ground_motions().unwrap(), &Interrupt::default()).unwrap().remove(0);
        run.checks.unwrap().tooth_stress_with_fall_mpa
    };
    assert_eq!((stress(0.5, Some(gear)), stress(0.5, None), stress(5.0, None)), (Some(0.0), None, None));
    assert!(stress(5.0, Some(gear)).unwrap() > 0.0);
}

/// Slipping plates pull with their capacity, and with twice that while a release comes late.
#[test]
fn a_limit_of_the_force_is_one_on_the_support() {
    let clutch = "kind = 'clutched-pair'\nclutch = { capacity_ratio = 0.02 }\nflywheel = { brake_deceleration_m_s2 = 'instant' }\n\
                  actuation = { engagement_delay_s = 0.02, release_delay_s = 0.3 }";
    let run = runs(5.0, clutch, "[checks]\nlargest_force_ratio = 0.03").remove(0);
    let checks = run.checks.unwrap();
    assert!((checks.force_ratio.unwrap() - 0.04).abs() < 1e-9, "{checks:?}");
    assert_eq!(checks.force_ratio, run.peak_force_ratio);
    assert!(checks.warnings.iter().any(|warning| warning.contains("0.0400") && warning.contains("limit is 0.03")), "{checks:?}");
}

/// The travel is that of the block, whatever its support does.
#[test]
fn a_warning_of_the_stroke_on_a_support_of_its_own_says_what_is_not_in_it() {
    for (support, against) in [("", false), ("\nsupport_amplification = 1.2", true)] {
        let checks =
            runs(5.0, &format!("kind = 'inerter'{support}"), "[checks]\nlargest_stroke_m = 1e-6").remove(0).checks.unwrap();
        let warning = checks.warnings.iter().find(|warning| warning.starts_with("the terminals travel ")).unwrap();
        assert_eq!(warning.contains(" m against the ground, without what their support moves; the limit"), against, "{warning}");
    }
}

/// The block alone has no terminals.
#[test]
fn a_block_without_a_device_is_not_warned_of_its_stroke() {
    let text =
        "block = { size_m = 2.0, slenderness_deg = 10.0 }\ndevice = [{ kind = 'none' }]\nchecks = { largest_stroke_m = 1e-6 }
        ground = [{ motion = 'sine', amplitude_ratio = 5.0, frequency_ratio = 9.0 }]";
    let run = runs_of(text).remove(0);
    assert!(run.impulses.impact_friction_needed.is_some() && run.checks.unwrap().warnings.is_empty());
}

/// Plates behind a stiff spring pass no more than their capacity, at a large tolerance too.
#[test]
fn a_spring_passes_no_more_than_its_plates() {
    let clutch = "kind = 'clutched-pair'\nclutch = { capacity_ratio = 0.04, stiffness_ratio = 4000, damping_ratio = 1.5, backlash_m = 0.002 }";
    for tolerance in ["1e-15", "1e-5"] {
        let run = runs(5.0, clutch, &format!("[accuracy]\ntolerance = {tolerance}")).remove(0);
        let force = run.peak_force_ratio.unwrap();
        assert!((force / 0.04 - 1.0).abs() < 1e-6, "{force} at {tolerance}");
    }
}

/// A flywheel behind a spring that closes late passes the rack. Its speed is what its force has done to it, ∫ F g/(σ mg) dt since it was at rest.
#[test]
fn a_flywheel_behind_a_spring_has_a_speed_of_its_own() {
    let device = "kind = 'clutched-pair'\nclutch = { stiffness_ratio = 1000, damping_ratio = 0.02 }
        flywheel = { brake_deceleration_m_s2 = 'instant' }\nactuation = { engagement_delay_s = 0.1 }";
    let run = runs(5.0, device, "[output]\ninterval_s = 0.0002\n[checks]").remove(0);
    let samples = &run.history.samples;
    let largest = [0, 1].map(|wheel| {
        let (mut speed, mut largest) = (0.0, 0.0_f64);
        for pair in samples.windows(2) {
            let engaged = pair.iter().all(|sample| sample.engaged & (1 << wheel) != 0);
            let force = 0.5 * (pair[0].force_ratio[wheel] + pair[1].force_ratio[wheel]);
            speed = if engaged { speed + force * GRAVITY / 0.5 * (pair[1].time_s - pair[0].time_s) } else { 0.0 };
            largest = largest.max(speed.abs());
        }
        largest
    });
    let expected = largest[0].max(largest[1]);
    let found = run.checks.unwrap().located.flywheel_speed.unwrap().value;
    let rack = samples.iter().map(|sample| 2.0 * sample.velocity_rad_s.abs()).fold(0.0, f64::max);
    assert!((found / expected - 1.0).abs() < 1e-3 && found > 1.3 * rack, "{found} {expected} {rack}");
}

/// Holding power times the time for which histories show a clutch engaged, and an energy for each time that one closes.
#[test]
fn coils_take_power_while_they_hold_and_energy_to_close() {
    let rigid = "kind = 'clutched-pair'\nengagement = 'rigid'\nflywheel = { viscous_rate_1_s = 0.1 }";
    let of = |device: &str, coil: &str| {
        runs(5.0, device, &format!("[output]\ninterval_s = 0.0005\n[checks]\ncoil = {{ {coil} }}")).remove(0)
    };
    let energy = |coil: &str| of(rigid, coil).checks.unwrap().coil_energy_j.unwrap();
    let (held, closed) = (energy("holding_power_w = 24"), energy("holding_power_w = 0, closing_energy_j = 5"));
    assert!((energy("holding_power_w = 24, closing_energy_j = 5") - held - closed).abs() < 1e-9);
    let run = of(rigid, "holding_power_w = 24, largest_energy_j = 1");
    assert!(
        run.checks.unwrap().warnings.iter().any(|warning| warning.contains("the coils take") && warning.contains("limit is 1 J"))
    );
    let samples = &run.history.samples;
    let engaged: f64 = samples.windows(2).filter(|pair| pair[0].engaged != 0).map(|pair| pair[1].time_s - pair[0].time_s).sum();
    let closings = samples.windows(2).filter(|pair| pair[1].engaged != 0 && pair[1].engaged != pair[0].engaged).count();
    assert!((held / 24.0 / engaged - 1.0).abs() < 0.01 && engaged > 0.1, "{} {engaged}", held / 24.0);
    assert!(closings > 1 && (closed / 5.0 - closings as f64).abs() < 1e-9, "{closed} {closings}");
    // What no coil holds takes nothing.
    for device in ["kind = 'inerter'", "kind = 'clutched-pair'\nengagement = 'overrunning'"] {
        assert_eq!(of(device, "holding_power_w = 24").checks.unwrap().coil_energy_j, None);
    }
}

/// The clutches of a block that lies down stay engaged for half a second beyond α, which no use of the coils can change any more.
#[test]
fn coils_hold_up_to_the_fall_of_a_block_that_overturns() {
    let run = runs_of(
        "block = { size_m = 2.0, slenderness_deg = 10.0, restitution = 0.85 }
        device = [{ kind = 'clutched-pair', mass_ratio = 0.5 }]
        ground = [{ motion = 'sine', amplitude_ratio = 2.5, frequency_ratio = 1.5 }]
        run = { free_time_s = 5.0 }
        output = { interval_s = 0.0005 }
        checks = { coil = { holding_power_w = 50, largest_energy_j = 60 } }",
    )
    .remove(0);
    assert!(run.outcome.overturned());
    let checks = run.checks.unwrap();
    let samples = &run.history.samples;
    let held = |until: usize| -> f64 {
        let pairs = samples[..until].windows(2).filter(|pair| pair[0].engaged != 0);
        pairs.map(|pair| 50.0 * (pair[1].time_s - pair[0].time_s)).sum()
    };
    let falls = samples.iter().rposition(|sample| sample.rotation_rad.abs() <= run.history.slenderness_rad).unwrap();
    let (before, whole) = (checks.coil_energy_j.unwrap(), checks.coil_energy_with_fall_j.unwrap());
    for (energy, until) in [(before, falls + 1), (whole, samples.len())] {
        assert!((energy / held(until) - 1.0).abs() < 1e-3, "{energy} {}", held(until));
    }
    assert!(whole > 2.0 * before, "{whole} {before}");
    assert!((50.0 * checks.coils.unwrap().engaged_s - before).abs() < 1e-9);
    assert!(!checks.warnings.iter().any(|warning| warning.contains("the coils take")), "{:?}", checks.warnings);
}

/// Bounces are infinitely many, and the threshold decides how many of them are followed.
#[test]
fn the_rest_threshold_does_not_show_in_what_clutches_do() {
    let braked = "flywheel = { brake_deceleration_m_s2 = 'instant' }";
    let built = ["engagement = 'rigid'", "clutch = { capacity_ratio = 0.1 }"].map(|clutch| format!(", {clutch}, {braked}"));
    for more in [""].into_iter().chain(built.iter().map(String::as_str)) {
        let found = ["1e-12", "1e-9", "1e-6", "1e-3"].map(|speed| {
            let run = runs_of(&format!(
                "block = {{ size_m = 2.0, slenderness_deg = 10.0, restitution = 0.85 }}
                device = [{{ kind = 'clutched-pair', mass_ratio = 0.5{more} }}]
                ground = [{{ motion = 'sine', amplitude_ratio = 3.0, frequency_ratio = 6.0 }}]
                run = {{ rest_speed_ratio = {speed} }}
                checks = {{ coil = {{ holding_power_w = 24, closing_energy_j = 5 }} }}"
            ));
            (run[0].checks.as_ref().unwrap().coils.unwrap().closings, run[0].clutch_switches)
        });
        assert!(found[0].0 > 20 && found.iter().all(|counts| *counts == found[0]), "{more}: {found:?}");
    }
}

/// The coils of a block that a ground just above its threshold lifts hold in the bounces that its rest stands for, as in those that are followed.
#[test]
fn coils_hold_in_the_last_bounces() {
    let [exact, finer, usual] = ["1e-12", "1e-8", "1e-6"].map(|speed| {
        let run = runs_of(&format!(
            "block = {{ size_m = 2.0, slenderness_deg = 10.0, restitution = 0.9 }}
            device = [{{ kind = 'clutched-pair', mass_ratio = 1.0 }}]
            ground = [{{ motion = 'sine', amplitude_ratio = 1.0001, frequency_ratio = 2.0 }}]
            run = {{ rest_speed_ratio = {speed} }}
            checks = {{ coil = {{ holding_power_w = 100 }} }}"
        ));
        run[0].checks.as_ref().unwrap().coil_energy_j.unwrap()
    });
    // The ground, so near the threshold, changes their rates as they last.
    for (energy, apart) in [(finer, 1e-5), (usual, 1e-2)] {
        assert!((energy / exact - 1.0).abs() < apart, "{energy} {exact}");
    }
}

/// Which engagements a second pulse finds missed does not hang on how many bounces of the first one are followed, nor does what becomes of it where a
/// flywheel that coasts makes one of them count: a rigid clutch that finds it ahead of the block, or plates that drive the block.
#[test]
fn the_rest_threshold_does_not_show_in_what_clutches_miss() {
    let sine = |amplitude: f64, frequency: f64| {
        format!("{{ motion = 'sine', amplitude_ratio = {amplitude}, frequency_ratio = {frequency}, start_s = START }}")
    };
    let block = "size_m = 2.0, slenderness_deg = 10.0, restitution = 0.85";
    let ideal = [1, 2, 3].map(|seed| (block, "mass_ratio = 0.5".to_owned(), (0.3, seed), (sine(3.0, 6.0), 12.0), 1e-9));
    let rigid = "mass_ratio = 0.5, engagement = 'rigid', flywheel = { dry_deceleration_m_s2 = 0.02 }".to_owned();
    let plates = "mass_ratio = 0.791, weight = { rack_ratio = 0.0779, flywheels_ratio = 0.0241, flywheels_on = 'block' }, \
                  clutch = { capacity_ratio = 0.0343 }";
    let cosine = "{ motion = 'cosine', amplitude_ratio = -3.696, frequency_ratio = 4.598, start_s = START }".to_owned();
    let slender = "size_m = 0.405, slenderness_deg = 3.68, restitution = 0.85";
    let coasting =
        [(block, rigid, (0.6, 8), (sine(4.0, 5.0), 12.0), 1e-9), (slender, plates.to_owned(), (0.21, 166), (cosine, 6.64), 1e-5)];
    for (block, device, (misses, seed), (pulse, later), apart) in ideal.into_iter().chain(coasting) {
        let [exact, others @ ..] = ["1e-12", "1e-9", "1e-6"].map(|speed| {
            let [first, second] = [0.0, later].map(|start| pulse.replace("START", &start.to_string()));
            let text = format!(
                "block = {{ {block} }}
                device = [{{ kind = 'clutched-pair', {device}, actuation = {{ miss_probability = {misses}, miss_seed = {seed} }} }}]
                ground = [{first}, {second}]
                run = {{ rest_speed_ratio = {speed} }}"
            );
            runs_of(&text).remove(0)
        });
        assert!(exact.missed_engagements > 5, "{}", exact.missed_engagements);
        for run in others {
            let counts = |run: &DeviceRun| (run.outcome, run.impacts, run.clutch_switches, run.missed_engagements);
            assert_eq!(counts(&run), counts(&exact), "{device} {seed}");
            let [peak, other] = [&run, &exact].map(|run| run.peak_rotation.unwrap());
            assert!((peak / other - 1.0).abs() < apart, "{device} {seed}: {peak} {other}");
        }
    }
}

/// (1 − η)/(1 + η) (1 + σ)/tan α with what is locked through the impact, without a table of checks.
#[test]
fn every_run_says_what_friction_an_impact_needs() {
    for (device, expected) in [
        ("kind = 'inerter'", 0.689_750),
        ("kind = 'clutched-pair'", 0.459_834),
        ("kind = 'clutched-pair'\nengagement = 'rigid'\nflywheel = { brake_deceleration_m_s2 = 'instant' }", 0.689_750),
        (
            "kind = 'clutched-pair'\nclutch = { capacity_ratio = 0.1 }\nflywheel = { brake_deceleration_m_s2 = 'instant' }",
            0.459_834,
        ),
    ] {
        let run = runs(5.0, device, "").remove(0);
        let needed = run.impulses.impact_friction_needed.unwrap();
        assert!((needed - expected).abs() < 1e-6 && run.checks.is_none(), "{device}: {needed}");
    }
}

/// Below the threshold of uplift the friction needed is that of the ground, and above it at least tan α.
#[test]
fn a_block_that_slides_before_it_rocks_is_warned_of() {
    let threshold = Geometry::Full.uplift_threshold(10_f64.to_radians());
    for (amplitude, needed) in [(0.5, 0.5 * threshold), (0.99, 0.99 * threshold)] {
        let run = runs(amplitude, "kind = 'inerter'", "[checks]\nfriction_coefficient = 0.08").remove(0);
        let checks = run.checks.unwrap();
        assert_eq!(run.outcome, Outcome::NoRocking);
        assert!((checks.friction_needed.unwrap() - needed).abs() < 1e-9, "{checks:?}");
        assert!(checks.warnings.iter().any(|warning| warning.contains("0.08 is there")), "{checks:?}");
    }
    let rocks = runs(1.01, "kind = 'inerter'", "[checks]\nfriction_coefficient = 0.08").remove(0);
    assert!(rocks.checks.unwrap().friction_needed.unwrap() >= threshold - 1e-9);
    assert_eq!(runs(0.5, "kind = 'inerter'", "[checks]").remove(0).checks.unwrap().friction_needed, None);
}

/// Two pulses that nearly cancel push as little as their sum, and a push after a vertical motion is not larger for it.
#[test]
fn a_standing_block_needs_the_friction_of_the_motions_together() {
    let pulse = "motion = 'sine', frequency_hz = 2.0";
    for (more, needed) in [
        (format!("ground = [{{ {pulse}, amplitude_g = 0.2 }}, {{ {pulse}, amplitude_g = -0.15 }}]"), 0.05),
        (
            format!("ground = [{{ {pulse}, amplitude_g = 0.1, start_s = 1.0 }}]\nvertical = [{{ {pulse}, amplitude_g = 0.5 }}]"),
            0.1,
        ),
    ] {
        let text = format!(
            "block = {{ size_m = 2.0, slenderness_deg = 20.0 }}\ndevice = [{{ kind = 'none' }}]\n{more}\nchecks = {{ friction_coefficient = 0.15 }}"
        );
        let checks = runs_of(&text).remove(0).checks.unwrap();
        assert!((checks.friction_needed.unwrap() - needed).abs() < 1e-9 && checks.warnings.is_empty(), "{checks:?}");
    }
}

/// On still ground the clutch of a block that falls closes where θ̈ is 0, at |θ| = α: no part of its blow belongs to what was before the fall.
#[test]
fn rounding_does_not_decide_whether_a_clutch_closes_before_the_fall() {
    for amplitude in [1.5, 1.55, 1.58, 1.6, 1.62] {
        let text = format!(
            "block = {{ size_m = 1.167, slenderness_deg = 49.326, inertia_ratio = 1.976, restitution = 0.768 }}
            device = [{{ kind = 'clutched-pair', mass_ratio = 1.55, clutch = {{ stiffness_ratio = 5272.82, damping_ratio = 1.5 }} }}]
            ground = [{{ motion = 'rectangular', amplitude_ratio = {amplitude}, duration_ratio = 1.409 }}]
            vertical = [{{ motion = 'sine', amplitude_g = -0.288, frequency_ratio = 3.688 }}]
            run = {{ free_time_ratio = 20 }}
            [checks]"
        );
        let run = runs_of(&text).remove(0);
        let checks = run.checks.unwrap();
        let (force, friction) = (checks.force_ratio.unwrap(), checks.friction_needed.unwrap());
        assert_eq!(run.outcome, Outcome::OverturnedWithoutImpact);
        assert!(force < 0.7 && friction < 1.6 && run.peak_force_ratio.unwrap() > 7.0, "{amplitude}: {force} {friction}");
    }
}

/// A block that a ground just above its threshold lifts by next to nothing falls back on its other side with twice that acceleration. Whether such
/// bounces are summed or followed, they ask for the same.
#[test]
fn the_last_bounces_ask_for_what_they_are_followed_with() {
    let demand = |amplitude: f64, device: &str, rest_speed_ratio: f64| {
        let text = format!(
            "block = {{ size_m = 2.0, slenderness_deg = 40.0, restitution = 0.5 }}
            device = [{{ mass_ratio = 0.5, {device} }}]
            ground = [{{ motion = 'half-sine', amplitude_ratio = {amplitude}, frequency_ratio = 3.0 }}]
            run = {{ free_time_ratio = 6.0, rest_speed_ratio = {rest_speed_ratio:e} }}
            [checks]"
        );
        let run = runs_of(&text).remove(0);
        let checks = run.checks.unwrap();
        assert_eq!(checks.force_ratio, run.peak_force_ratio);
        [checks.force_ratio, checks.smallest_vertical_reaction_ratio, checks.friction_needed].map(Option::unwrap)
    };
    let braked = "kind = 'clutched-pair', flywheel = { brake_deceleration_m_s2 = 'instant' }";
    let rigid = format!("{braked}, engagement = 'rigid'");
    for (amplitude, device) in [
        (1.0001, "kind = 'inerter'"),
        (1.0001, "kind = 'inerter', rack = { load_friction = 0.2 }"),
        (1.0001, "kind = 'inerter', inertance_corner_hz = 4"),
        (1.3, "kind = 'inerter', support_amplification = 1.2"),
        (1.0001, "kind = 'clutched-pair'"),
        (1.0001, "kind = 'clutched-pair', mount = 'base-corners', pulley_ratio = 2"),
        (1.1193, "kind = 'clutched-pair', rack = { dry_friction_ratio = 0.1 }"),
        (1.0001, "kind = 'clutched-pair', engagement = 'overrunning'"),
        (1.0001, &format!("{braked}, clutch = {{ capacity_ratio = 0.02 }}")),
        (1.0001, &format!("{braked}, clutch = {{ stiffness_ratio = 100, damping_ratio = 0.2 }}")),
        (1.0001, &format!("{rigid}, actuation = {{ engagement_delay_s = 0.05 }}")),
        (1.0001, &format!("{rigid}, actuation = {{ release_delay_s = 0.05 }}")),
        (1.0001, &format!("{rigid}, actuation = {{ release_delay_s = 0.05 }}, rack = {{ load_friction = 0.2 }}")),
    ] {
        let [summed, followed] = [1e-6, 1e-8].map(|speed| demand(amplitude, device, speed));
        for (a, b) in summed.iter().zip(&followed) {
            assert!((a - b).abs() < 1e-3 * b.abs().max(0.1), "{device}: {summed:?} {followed:?}");
        }
    }
    // The inerter: σ cos α θ̈ R/g with θ̈ = 2 p² sin α/(1 + k cos² α).
    let (k, (sin, cos)) = (0.375, math::sin_cos(40_f64.to_radians()));
    let [force, ..] = demand(1.0001, "kind = 'inerter'", 1e-6);
    assert!((force / (2.0 * k * cos * sin / (1.0 + k * cos * cos)) - 1.0).abs() < 1e-3, "{force}");
}

/// Plates that a delay keeps engaged slip after each impact, both with the whole of what they can pass: 2 F_c on the support, summed or followed.
#[test]
fn late_plates_push_with_what_they_can_in_the_last_bounces() {
    for speed in ["1e-6", "1e-8"] {
        let run = runs_of(&format!(
            "block = {{ size_m = 2.0, slenderness_deg = 20.0, restitution = 0.966 }}
            device = [{{ kind = 'clutched-pair', mass_ratio = 1.0, flywheel = {{ brake_deceleration_m_s2 = 'instant' }}, \
             clutch = {{ capacity_ratio = 0.4 }}, actuation = {{ release_delay_s = 0.004 }} }}]
            ground = [{{ motion = 'sine', amplitude_ratio = 1.0001, frequency_ratio = 10.0 }}]
            run = {{ rest_speed_ratio = {speed} }}
            checks = {{}}"
        ));
        let forces = [run[0].peak_force_ratio, run[0].checks.as_ref().unwrap().force_ratio].map(Option::unwrap);
        assert!(forces.iter().all(|force| (force - 0.8).abs() < 1e-9), "{speed}: {forces:?}");
    }
}

/// A block of 2 m and 10° that friction of `device` holds at `rotation_ratio` of α under `ground`.
fn held(rotation_ratio: f64, device: &str, ground: &str, more: &str) -> DeviceRun {
    let text = format!(
        "[block]\nsize_m = 2\nslenderness_deg = 10\ninitial_rotation_ratio = {rotation_ratio}\n[[device]]\nkind = 'inerter'\n{device}\n\
         [[ground]]\n{ground}\nstart_s = 1\n[run]\nfree_time_s = 1\n[output]\ninterval_s = 0.002\n{more}"
    );
    let scene = Scene::parse(&text, "scene.toml").unwrap();
    let run = simulate(&scene, &scene.ground_motions().unwrap(), &Interrupt::default()).unwrap().remove(0);
    let held = rotation_ratio * 10_f64.to_radians();
    assert!(run.history.samples.iter().all(|sample| (sample.rotation_rad - held).abs() < 1e-12), "it moved");
    run
}

/// While bearings hold a block the support takes tan δ + ü_g/g at the centre of mass, however many waves the ground has until it moves on.
#[test]
fn a_held_block_pushes_hardest_at_the_crest_of_any_wave() {
    for (ground, mesh) in [
        ("motion = 'sine'\namplitude_g = 0.28\nfrequency_hz = 0.5", 0.0),
        ("motion = 'sine'\namplitude_g = 0.28\nfrequency_hz = 0.5", 0.5),
        (
            "motion = 'mavroeidis-papageorgiou'\nvelocity_amplitude_m_s = 0.25\nfrequency_hz = 1.3\noscillations = 90\nphase_deg = 30",
            0.0,
        ),
        ("motion = 'ricker'\namplitude_g = 0.28\nfrequency_hz = 3", 0.5),
    ] {
        let device = format!("mass_ratio = 1\nflywheel = {{ dry_deceleration_m_s2 = 3 }}\nrack = {{ load_friction = {mesh} }}");
        for more in ["", "[checks]"] {
            let run = held(0.95, &device, ground, more);
            let crest = run.history.samples.iter().map(|sample| sample.ground_m_s2).fold(0.0, f64::max);
            let expected = math::tan(0.05 * 10_f64.to_radians()) + crest / GRAVITY;
            let force = run.peak_force_ratio.unwrap();
            assert!(force > expected - 1e-12 && force < expected + 2e-4, "{ground}, {mesh}, {more}: {force} {expected}");
        }
    }
}

/// What holds a block at its centre of mass leaves the toe a reaction through that point: it needs a friction of tan δ, whether bearings or the
/// guides of the rack hold it, alone or both.
#[test]
fn a_held_block_needs_the_friction_of_its_tilt() {
    let ground = "motion = 'sine'\namplitude_g = 0.2\nfrequency_hz = 0.5";
    let expected = math::tan(0.1 * 10_f64.to_radians());
    for (rack, bearings, mesh) in [(0.3, 0.0, 0.0), (0.0, 30.0, 0.0), (0.2, 10.0, 0.0), (0.2, 10.0, 0.5)] {
        let device = format!(
            "mass_ratio = 0.1\nrack = {{ dry_friction_ratio = {rack}, load_friction = {mesh} }}\n\
             flywheel = {{ dry_deceleration_m_s2 = {bearings} }}"
        );
        let needed = held(0.9, &device, ground, "[checks]").checks.unwrap().friction_needed.unwrap();
        assert!((needed - expected).abs() < 1e-9, "{rack}, {bearings}, {mesh}: {needed} {expected}");
    }
}

/// The lever of a pair at the base's corners is zero where a block has fallen to π/2: rounding does not decide whether a clutch closes just before.
#[test]
fn a_lever_that_ends_at_zero_closes_no_clutch() {
    for losses in ["", "flywheel = { viscous_rate_1_s = 1e-6 }"] {
        let text = format!(
            "[block]\nsize_m = 0.367\nslenderness_deg = 9.164\ninertia_ratio = 1.664\nrestitution = 'geometric'\n[run]\nfree_time_ratio = 11.3\n\
             [[device]]\nkind = 'clutched-pair'\nmass_ratio = 0.431\nmount = 'base-corners'\npulley_ratio = 3.987\nkinematics = 'consistent'\n\
             {losses}\n[[ground]]\nmotion = 'rectangular'\namplitude_ratio = 5.59\nduration_ratio = 1.862\n"
        );
        let [close, others @ ..] = ["1e-16", "1e-15", "1e-14", "1e-13"].map(|tolerance| {
            let scene = Scene::parse(&format!("{text}[accuracy]\ntolerance = {tolerance}"), "scene.toml").unwrap();
            let run = simulate(&scene, &scene.ground_motions().unwrap(), &Interrupt::default()).unwrap().remove(0);
            (run.peak_force_ratio.unwrap(), run.clutch_switches)
        });
        for (force, switches) in others {
            assert!((force / close.0 - 1.0).abs() < 1e-9 && switches == close.1, "{losses}: {force} {switches} {close:?}");
        }
        assert!(close.0 < 0.21, "{close:?}");
    }
}

#[test]
fn a_study_does_not_pay_for_what_it_does_not_report() {
    let scene = scene(5.0, "kind = 'inerter'", "");
    let run = simulate_for_study(&scene, &scene.ground_motions().unwrap(), &Interrupt::default()).unwrap().remove(0);
    assert_eq!((run.peak_force_ratio, run.impulses), (None, demand::Impulses::default()));
}
