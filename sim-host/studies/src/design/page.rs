//! `design.md`: the page that a designer hands on: a table, the reasons, the limits.

use sprag_shared::structure::block::GRAVITY;

use super::basis::{DISC_THICKNESS_RATIO, STEEL_KG_M3, UNDERCUT_TEETH};
use super::late::DELAYS_S;
use super::sensors::SHARE;
use super::study::{Findings, PartsList, Problem};
use super::subject::is_tried_with_brakes;
use super::table::{figures, lines};

/// Duration of a contact at an impact, s, by which the shock on a sensor is estimated: the default of `controller.shock_s`.
const CONTACT_S: f64 = 1e-3;

/// max |θ|/α below which a share of it is a strict tolerance.
const SMALL_ROTATION: f64 = 0.1;

/// Most names of motions in a line.
const MOST_NAMES: usize = 5;

/// The page on `findings` under `motions` motions, of which `unreadable` others could not be read.
pub fn page(problem: &Problem<'_>, findings: &Findings, motions: usize, unreadable: usize) -> String {
    let scene = problem.scene;
    let title = if scene.file.title.is_empty() { "Device" } else { &scene.file.title };
    let block = &scene.block;
    let mut page = format!("# {title}: parts list\n\n");
    page += &format!(
        "Block of R = {} m, α = {}°, {} kg, under {motions} motion{}.\n",
        figures(block.size()),
        figures(block.slenderness().to_degrees()),
        figures(problem.mass_kg()),
        if motions == 1 { "" } else { "s" }
    );
    if unreadable > 0 {
        let records = if unreadable == 1 { "1 record" } else { &format!("{unreadable} records") };
        page += &format!("\n**{records} could not be read, and none of that is in the list.**\n");
    }
    for list in &findings.lists {
        page += &of_device(problem, list);
    }
    page + &limits(problem, findings)
}

/// What the runs came to, in a line or two.
pub fn verdict(list: &PartsList) -> String {
    let outcome = match list.overturned_by.len() {
        0 => format!("With {} no motion of {} overturns the block", list.device, list.motions),
        1 => format!("With {} 1 motion of {} overturns the block ({})", list.device, list.motions, list.overturned_by[0]),
        count => format!(
            "With {} {count} motions of {} overturn the block ({})",
            list.device,
            list.motions,
            names(&list.overturned_by)
        ),
    };
    let rotation = list.largest_rotation.as_ref();
    let rotation =
        rotation.map(|rotation| format!("; where it stands, it tilts to {:.3} α at most ({})", rotation.value, rotation.motion));
    format!("{outcome}{}.", rotation.unwrap_or_default())
}

fn names(all: &[String]) -> String {
    let shown = all[..all.len().min(MOST_NAMES)].join(", ");
    if all.len() > MOST_NAMES { format!("{shown} and {} more", all.len() - MOST_NAMES) } else { shown }
}

fn of_device(problem: &Problem<'_>, list: &PartsList) -> String {
    let mut text = format!("\n## {}\n\n{}\n", list.device, verdict(list));
    if !list.overturned_by.is_empty() {
        text += "Parts are sized for the time before the fall.\n";
    }
    if list.sets > 1 {
        text += "One set of parts stands at each base corner and works while its corner is up, so that its rack only rises: buy this list twice.\n";
    }
    text += &format!("\n{}", lines(list).markdown());
    if let Some(sensors) = &list.sensors {
        let suites = sensors.suites.join(", ");
        let suites = if suites.is_empty() { "none".to_owned() } else { suites };
        text += &format!("\nSensors that Sprag knows and that suffice, as they are configured there: {suites}.\n");
    }
    text + &reasons(problem, list)
}

fn reasons(problem: &Problem<'_>, list: &PartsList) -> String {
    let (basis, pinion, disc) = (&problem.basis, &list.pinion, &list.flywheel);
    let mut text = "\n### Why\n\n".to_owned();
    let mut reason = |line: String| text += &format!("- {line}\n");
    reason(if list.on_support {
        format!("Support: the largest over the motions times {}, then the next number of R10 of ISO 3.", basis.margin)
    } else {
        format!(
            "Support and rack: the largest over the motions times {}, then the next number of R10 (force) and R20 (travel) of ISO 3. The rack has \
             four teeth more than its travel.",
            basis.margin
        )
    });
    let load = match pinion.clutch_torque_n_m {
        Some(torque) => format!(
            "the {} N at which the clutch of {} N m slips, so that it slips before a tooth breaks",
            figures(pinion.load_n),
            figures(torque)
        ),
        None => format!("the largest force times {}, {} N", basis.service_factor, figures(pinion.load_n)),
    };
    reason(format!(
        "Pinion: the smallest module of ISO 54 (first choice) whose teeth bear {load}: F/(b m Y) ≤ {} MPa by Lewis, Y = 0.484 − 2.87/z, z = {}, \
         b = {} m.",
        basis.allowable_stress_mpa, basis.teeth, basis.face_width_modules
    ));
    if pinion.clutch_torque_n_m.is_some() {
        reason(format!(
            "Clutch: the largest force of one flywheel times the pitch radius, {} N m with a service factor of {}; the next torque of R10.",
            figures(pinion.torque_needed_n_m),
            basis.service_factor
        ));
    }
    let speed = if list.on_support {
        "Its speed is not known"
    } else if disc.rim_stress_mpa < 0.1 * basis.allowable_stress_mpa {
        "Speed does not limit it"
    } else {
        "Speed matters"
    };
    reason(format!(
        "Flywheel: J = m_r ρ² for an inertance of {} kg (Eq. 9), a solid steel disc ({STEEL_KG_M3} kg/m³) no thicker than {DISC_THICKNESS_RATIO} of its \
         radius with a diameter of R20. The stress at the rim is ρ_s v², the hoop stress of a thin ring, more than anywhere in a disc. {speed}.",
        figures(list.inertance_kg)
    ));
    if let Some(delay) = &list.delay {
        let [_, .., last] = DELAYS_S;
        let lost = match (delay.lost_at_s, delay.lost()) {
            (Some(at), Some(late)) if late.newly_overturned > 0 => {
                format!("at {} ms it overturns under {} more", figures(1e3 * at), motions(late.newly_overturned))
            }
            (Some(at), Some(late)) if late.failed > 0 => {
                format!("at {} ms {} could not be followed", figures(1e3 * at), motions(late.failed))
            }
            (Some(at), _) => format!("at {} ms the largest rotation grows by more", figures(1e3 * at)),
            (None, _) => format!("{} ms is the longest that was tried", figures(1e3 * last)),
        };
        reason(format!(
            "Delay: engagement and release are both later by it, from a command to full torque{}. Up to {} ms nothing more overturns and the largest \
             rotation grows by no more than {} %; {lost}.{}",
            if list.controlled { ", beyond what controller and scene have" } else { "" },
            figures(1e3 * delay.delay_s),
            figures(100.0 * basis.tolerance),
            if list.largest_rotation.as_ref().is_some_and(|rotation| rotation.value < SMALL_ROTATION) {
                " The block hardly tilts: a larger --tolerance would do."
            } else {
                ""
            }
        ));
        reason(format!(
            "Sensors: what they read times {}, the next usual full scale; the specific force at the centre of mass is a bound. {}",
            basis.margin,
            if list.controlled {
                "How quick they are is not asked here: those of the scene were in the runs.".to_owned()
            } else {
                format!(
                    "Filter, sampling and reading together get {} % of the delay, of which filter (bandwidth) and sampling (rate) may have half each; \
                     coil and controller get the rest.",
                    figures(100.0 * SHARE)
                )
            }
        ));
    }
    text + &built(problem, list)
}

fn motions(count: usize) -> String {
    if count == 1 { "1 motion".to_owned() } else { format!("{count} motions") }
}

/// What the chosen clutches came to.
fn built(problem: &Problem<'_>, list: &PartsList) -> String {
    let Some(built) = &list.built else {
        let of_scene = |capacity: f64| {
            let [scene, chosen] = [capacity, list.pinion.load_n].map(|force| figures(1e-3 * force));
            format!(
                "- The clutch of the scene slips at {scene} kN and limits what is needed here; the chosen one slips at {chosen} kN, which the chosen support bears. To try that, give it as \
                 clutch.capacity_n.\n"
            )
        };
        return list.scene_capacity_n.map_or_else(String::new, of_scene);
    };
    let overturned = match (built.overturned, built.newly_overturned) {
        (0, _) => "none overturns the block".to_owned(),
        (count, 0) => format!("{} overturn it, as they do above", motions(count)),
        (count, newly) => format!("{} overturn it, {newly} of them newly", motions(count)),
    };
    let [capacity, both] = [1.0, 2.0].map(|clutches| figures(1e-3 * clutches * built.capacity_n));
    let mut text = format!(
        "\n### Tried with the chosen clutches\n\nPlates that slip at {capacity} kN, {} ms late, under the same motions: {overturned}.",
        figures(1e3 * built.delay_s)
    );
    if let (Some(after), Some(before)) = (built.largest_rotation, &list.largest_rotation) {
        text += &format!(" Where it stands above it tilts to {after:.3} α, in the place of {:.3} α.", before.value);
    }
    if let Some(support) = &built.support_n {
        text += &format!(
            " The support bears {} kN: a clutch that engages late slips, and pulls with all it has; two can pull with {both} kN. The list has the \
             larger demand of both runs.",
            figures(1e-3 * support.value)
        );
    }
    if problem.scene.devices.iter().any(|device| device.name == list.device && is_tried_with_brakes(device)) {
        text += " A released flywheel stops at once, as that of the ideal clutch: each needs a brake, which the list does not have. With flywheels that \
                 coast the block may overturn where it stands here: try them with engagement = \"rigid\".";
    }
    if built.failed > 0 {
        text += &format!(" {} could not be followed.", motions(built.failed));
    }
    text + "\n"
}

/// What `list` needs beyond the limits of the scene's `[checks]`, in a line each.
fn beyond_checks(problem: &Problem<'_>, list: &PartsList) -> Vec<String> {
    let Some(checks) = &problem.scene.file.checks else { return Vec::new() };
    let force_n = checks.largest_force_ratio.map(|ratio| ratio * problem.mass_kg() * GRAVITY);
    let energy_j = checks.coil.and_then(|coil| coil.largest_energy_j);
    let beyond = |(part, unit, key, limit): (&str, &str, &str, Option<f64>)| {
        let item = list.items.iter().find(|item| (item.part, item.unit) == (part, unit))?;
        let (needed, limit) = item.needed.zip(limit).filter(|(needed, limit)| needed > limit)?;
        let [needed, allowed] = [needed, limit].map(figures);
        Some(format!(
            "{}, {part}: {} of {needed} {unit} is more than the {allowed} {unit} that {key} of the scene allows.",
            list.device, item.quantity
        ))
    };
    [
        ("support", "N", "checks.largest_force_ratio", force_n),
        ("rack", "m", "checks.largest_stroke_m", checks.largest_stroke_m),
        ("coils, both", "J", "checks.coil.largest_energy_j", energy_j),
    ]
    .into_iter()
    .filter_map(beyond)
    .collect()
}

fn limits(problem: &Problem<'_>, findings: &Findings) -> String {
    let mut text = "\n## Limits\n\n".to_owned();
    let mut limit = |line: String| text += &format!("- {line}\n");
    findings.lists.iter().flat_map(|list| beyond_checks(problem, list)).for_each(&mut limit);
    if problem.basis.teeth < UNDERCUT_TEETH {
        limit(format!("A pinion of {} teeth is undercut: it needs a profile shift.", problem.basis.teeth));
    }
    limit("Teeth are checked for bending alone: not for pitting, speed, shafts, keys and bearings, nor the rack's guides. The inertia of pinion, shaft and clutch is left out.".to_owned());
    let has_springs = |list: &PartsList| list.asked.iter().flatten().any(|asked| asked.located.flywheel_speed.is_some());
    let is_heated = |list: &&PartsList| list.pinion.clutch_torque_n_m.is_some() && !list.on_support && !has_springs(list);
    let heat = findings.lists.iter().filter(is_heated).map(|list| list.flywheel.energy_j);
    let heat = heat.reduce(f64::max).map_or_else(String::new, |heat| {
        format!(" A closing that brings a flywheel to its largest speed makes {} J of heat.", figures(heat))
    });
    limit(format!(
        "Clutches are sized by torque: wear and drag of an open clutch are left out.{heat} Coils are sized by time; their power follows from the clutch that is bought."
    ));
    limit("One stage from rack to flywheel. A train of two needs a smaller disc and has a faster one.".to_owned());
    if findings.lists.iter().any(|list| list.on_support) {
        limit(
            "On a support of its own motion travel and speed of the rack and speed, energy and stress of its flywheels are those of the block against \
             the ground: what the support moves on its own is not in them, and no rack is chosen."
                .to_owned(),
        );
    }
    let friction = findings.lists.iter().filter_map(|list| list.friction_needed).reduce(f64::max);
    let lost = findings.lists.iter().map(|list| list.contact_lost).max().unwrap_or(0);
    if let Some(friction) = friction {
        limit(format!(
            "The block neither slides nor hops here; that needs a coefficient of friction of {} under it{}.",
            figures(friction),
            if lost > 0 { " where its toe stays on the ground" } else { "" }
        ));
    }
    if lost > 0 {
        limit(format!(
            "Under {} the toe would leave the ground: no coefficient of friction is enough, and from there on the numbers do not hold.",
            motions(lost)
        ));
    }
    let of_sensors = findings.lists.iter().filter(|list| list.sensors.is_some());
    if let Some(jump) = of_sensors.filter_map(|list| list.jump.as_ref()).map(|jump| jump.value).reduce(f64::max) {
        let shock = std::f64::consts::FRAC_PI_2 * jump / CONTACT_S / GRAVITY;
        limit(format!(
            "The ranges of sensors do not cover the shock of an impact ({} g at the centre of mass if the contact lasts 1 ms): readings saturate for so long.",
            figures(shock)
        ));
    }
    limit(
        "What is not among the motions is not in the list. Margins are on what was computed, and say nothing of other motions."
            .to_owned(),
    );
    for line in findings.left_out.iter().chain(&findings.failed) {
        limit(format!("Not known: {line}."));
    }
    text
}
