//! Random devices: every coupling, mount, loss, delay and weight that go together.

use std::fmt::Write;

use crate::block::GRAVITY;
use crate::random::Random;

/// What a device is tied to.
#[derive(Clone, Copy, Debug)]
pub struct Site {
    /// Height of the centre of mass, m.
    pub height: f64,
    /// The block's mass (kg), where values are absolute.
    pub mass: Option<f64>,
}

impl Site {
    /// A key as a ratio, or as a number of `unit` (m/s², 1) times the mass.
    fn key(self, name: &str, absolute: &str, ratio: f64, unit: f64) -> String {
        match self.mass {
            None => format!("{name} = {ratio}"),
            Some(mass) => format!("{absolute} = {}", ratio * mass * unit),
        }
    }
}

/// Writes a `[[device]]` table. Returns its family.
pub fn write(text: &mut String, random: &mut Random, site: Site) -> &'static str {
    let family = random.pick(&[
        "none",
        "inerter",
        "ideal",
        "ideal",
        "rigid",
        "rigid",
        "overrunning",
        "plates",
        "plates",
        "plates",
        "elastic",
        "elastic",
    ]);
    let start = text.len();
    text.push_str("\n[[device]]\n");
    if family == "none" {
        text.push_str("kind = \"none\"\n");
        return family;
    }
    let memory = matches!(family, "rigid" | "overrunning" | "plates" | "elastic");
    let kind = if family == "inerter" { "inerter" } else { "clutched-pair" };
    let _ = writeln!(text, "kind = \"{kind}\"\n{}", site.key("mass_ratio", "inertance_kg", random.between(0.1, 1.2), 1.0));
    // An ideal pair with delays needs a horizontal mount too.
    let actuated = family != "inerter" && family != "overrunning" && random.chance(0.35);
    let corners = mount(text, random, site.height, !memory && !actuated);
    if memory || random.chance(0.4) {
        text.push_str("kinematics = \"consistent\"\n");
    }
    let mut capacity = false;
    match family {
        "rigid" | "overrunning" => drop(writeln!(text, "engagement = \"{family}\"")),
        "plates" => {
            capacity = true;
            let key = site.key("capacity_ratio", "capacity_n", random.logarithmic(0.01, 0.3), GRAVITY);
            let _ = writeln!(text, "clutch = {{ {key} }}");
        }
        "elastic" => {
            let mut keys = vec![format!("stiffness_ratio = {}", random.logarithmic(300.0, 3e4))];
            if random.chance(0.7) {
                keys.push(format!("damping_ratio = {}", random.between(0.05, 0.4)));
            }
            if random.chance(0.5) {
                keys.push(format!("backlash_m = {}", random.logarithmic(1e-4, 5e-3)));
            }
            if random.chance(0.5) {
                capacity = true;
                keys.push(site.key("capacity_ratio", "capacity_n", random.logarithmic(0.03, 0.3), GRAVITY));
            }
            let _ = writeln!(text, "clutch = {{ {} }}", keys.join(", "));
        }
        _ => {}
    }
    flywheel(text, random, family);
    if random.chance(0.25) {
        let mut keys = Vec::new();
        if random.chance(0.6) {
            keys.push(site.key("viscous_1_s", "viscous_n_s_m", random.logarithmic(0.01, 0.3), 1.0));
        }
        if random.chance(0.6) {
            keys.push(site.key("dry_friction_ratio", "dry_friction_n", random.logarithmic(0.001, 0.02), GRAVITY));
        }
        let _ = writeln!(text, "rack = {{ {} }}", keys.join(", "));
    }
    if actuated {
        actuation(text, random, capacity);
    }
    if random.chance(0.2) {
        weight(text, random, corners, site);
    }
    let loses = ["flywheel = {", "rack = {"].iter().any(|table| text[start..].contains(table));
    if !memory && !corners && !loses {
        // Draws of its own, so that all others stay what they were.
        let mut own = *random;
        own = Random::new(own.next_u64());
        if own.chance(0.5) {
            let _ = writeln!(text, "support_amplification = {}", own.between(-0.5, 2.5));
        }
    }
    if matches!(family, "inerter" | "ideal" | "rigid") && !text[start..].contains("support_amplification") {
        let mut own = *random;
        own = Random::new(own.next_u64().rotate_left(32));
        if own.chance(0.3) {
            load_friction(text, start, own.logarithmic(0.01, 0.95));
        } else if family != "ideal" && !corners && own.chance(0.4) {
            slip(text, start, own.logarithmic(0.05, 50.0));
        }
    }
    let undragged = ["load_friction", "inertance_corner_hz", "\"instant\""].iter().any(|word| text[start..].contains(word));
    let late = ["engagement_delay_s", "release_delay_s"].iter().any(|delay| text[start..].contains(delay));
    // Without a delay Eq. 10 may engage and release at one instant of a turn a flywheel that drag has turned the wrong way.
    if matches!(family, "rigid" | "plates") && late && !undragged {
        let mut own = *random;
        own = Random::new(own.next_u64().rotate_left(16));
        if own.chance(0.6) {
            drag(text, start, own.logarithmic(0.02, 20.0));
        }
    }
    family
}

/// Friction of the mesh, in the device's table from `start` on.
fn load_friction(text: &mut String, start: usize, value: f64) {
    let device = text.split_off(start);
    match device.split_once("rack = { ") {
        // A table may have no key yet.
        Some((before, after)) => {
            let comma = if after.starts_with(' ') { "" } else { ", " };
            let _ = write!(text, "{before}rack = {{ load_friction = {value}{comma}{after}");
        }
        None => drop(writeln!(text, "{device}rack = {{ load_friction = {value} }}")),
    }
}

/// Drag of open clutches, in the device's table from `start` on.
fn drag(text: &mut String, start: usize, rate: f64) {
    let device = text.split_off(start);
    match device.split_once("flywheel = { ") {
        Some((before, after)) => drop(write!(text, "{before}flywheel = {{ drag_rate_1_s = {rate}, {after}")),
        None => drop(writeln!(text, "{device}flywheel = {{ drag_rate_1_s = {rate} }}")),
    }
}

/// Viscous slip in the place of a clutch that locks.
fn slip(text: &mut String, start: usize, corner: f64) {
    let device = text.split_off(start).replace("engagement = \"rigid\"\n", "");
    let _ = writeln!(text, "{device}inertance_corner_hz = {corner}");
}

fn mount(text: &mut String, random: &mut Random, height: f64, corners: bool) -> bool {
    match random.next_u64() % 10 {
        0..=5 => false,
        6 | 7 if corners => {
            let _ = writeln!(text, "mount = \"base-corners\"\npulley_ratio = {}", random.between(0.5, 3.0));
            true
        }
        _ => {
            let _ = writeln!(
                text,
                "mount = \"tying-point\"\nmount_height_m = {}\npulley_ratio = {}",
                height * random.between(0.5, 2.0),
                random.between(0.5, 1.5)
            );
            false
        }
    }
}

fn flywheel(text: &mut String, random: &mut Random, family: &str) {
    let mut keys = Vec::new();
    if random.chance(0.3) {
        keys.push(format!("viscous_rate_1_s = {}", random.logarithmic(0.01, 1.0)));
    }
    if random.chance(0.35) {
        keys.push(format!("dry_deceleration_m_s2 = {}", random.logarithmic(0.005, 0.3)));
    }
    if matches!(family, "rigid" | "plates" | "elastic") && random.chance(0.5) {
        keys.push(match random.chance(0.4) {
            true => "brake_deceleration_m_s2 = \"instant\"".to_owned(),
            false => format!("brake_deceleration_m_s2 = {}", random.logarithmic(0.3, 20.0)),
        });
    }
    if !keys.is_empty() {
        let _ = writeln!(text, "flywheel = {{ {} }}", keys.join(", "));
    }
}

fn actuation(text: &mut String, random: &mut Random, capacity: bool) {
    let mut keys = Vec::new();
    if random.chance(0.7) {
        keys.push(format!("engagement_delay_s = {}", random.logarithmic(0.002, 0.06)));
    }
    if random.chance(0.7) {
        keys.push(format!("release_delay_s = {}", random.logarithmic(0.002, 0.06)));
    }
    if !keys.is_empty() && random.chance(0.3) {
        keys.push("delay = \"transport\"".to_owned());
    }
    if random.chance(0.25) {
        keys.push(format!("dwell_s = {}", random.logarithmic(0.01, 0.15)));
    }
    if random.chance(0.2) {
        keys.push(format!("miss_probability = {}", random.between(0.05, 0.6)));
        keys.push(format!("miss_seed = {}", random.next_u64() % 1000));
    }
    if capacity && random.chance(0.5) {
        let time = random.logarithmic(0.005, 0.12);
        // Half of them by what has been drawn, so that all others stay what they were.
        keys.push(if time.to_bits().is_multiple_of(2) {
            format!("rise_time_s = {time}")
        } else {
            format!("time_constant_s = {time}")
        });
    }
    if keys.is_empty() {
        keys.push("engagement_delay_s = 0.01".to_owned());
    }
    let _ = writeln!(text, "actuation = {{ {} }}", keys.join(", "));
}

fn weight(text: &mut String, random: &mut Random, corners: bool, site: Site) {
    let ratio = random.logarithmic(0.003, 0.1);
    let rack = site.key("rack_ratio", "rack_kg", ratio, 1.0);
    let flywheels = site.key("flywheels_ratio", "flywheels_kg", ratio, 1.0);
    let _ = match random.next_u64() % 3 {
        0 => writeln!(text, "weight = {{ {flywheels}, flywheels_on = \"block\" }}"),
        1 if !corners => writeln!(text, "weight = {{ {rack} }}"),
        _ => writeln!(text, "weight = {{ {rack}, rack_on = \"block\" }}"),
    };
}
