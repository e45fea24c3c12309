//! A scene of any kind within the ranges that docs/scenes.md gives, as TOML.

use std::fmt::Write;

use super::draw::Draw;

/// Most devices of a scene: the time of an input is better spent on another one.
const MOST_DEVICES: usize = 2;

/// The text of a scene; contradictions between keys are left in, for the reader to refuse.
pub fn text(draw: &mut Draw<'_>) -> String {
    let mut text = String::new();
    let elastic = block_and_devices(draw, &mut text);
    for _ in 0..1 + draw.below(2) {
        text.push_str("[[ground]]\n");
        let amplitude = ["amplitude_ratio", "amplitude_g"][draw.below(2)];
        motion(draw, amplitude, 1e-3, if amplitude == "amplitude_g" { 1e3 } else { 1e6 }, &mut text);
    }
    if draw.seldom(4) {
        text.push_str("[[vertical]]\n");
        motion(draw, "amplitude_g", 1e-3, 1.0, &mut text);
    }
    accuracy(draw, elastic, &mut text);
    let rest_speed = if draw.seldom(4) { draw.number(1e-12, 1e-2) } else { 1e-6 };
    let _ = writeln!(text, "[run]\nfree_time_ratio = {:?}\nrest_speed_ratio = {rest_speed:?}", draw.number_or_zero(1e-3, 1e2));
    if draw.seldom(2) {
        text.push_str("[output]\nenergy = true\n[checks]\nfriction_coefficient = 0.5\nlargest_stroke_m = 0.3\n");
    }
    text
}

/// Whether a device may have an elastic clutch.
fn block_and_devices(draw: &mut Draw<'_>, text: &mut String) -> bool {
    text.push_str("[block]\n");
    let _ = match draw.below(2) {
        0 => writeln!(text, "size_m = {:?}", draw.number(1e-3, 1e4)),
        _ => writeln!(text, "frequency_parameter_1_s = {:?}", draw.number(1e-2, 1e3)),
    };
    // Without a loss at impacts the smallest motion lasts for ever, in millions of impacts; so do those words of a very slender block.
    let (restitution, slenderest) = match draw.below(8) {
        0 => ("\"geometric\"".to_owned(), 1.0),
        1 => ("\"momentum-balance\"".to_owned(), 1.0),
        2 => ("0.0".to_owned(), 1e-9),
        3 => ("0.999".to_owned(), 1e-9),
        _ => (format!("{:?}", draw.number(0.1, 0.999)), 1e-9),
    };
    let slenderness = if draw.seldom(4) { draw.number(slenderest, 89.999_999) } else { draw.number(1.0, 45.0) };
    let _ =
        writeln!(text, "slenderness_deg = {slenderness:?}\nrestitution = {restitution}\nmass_kg = {:?}", draw.number(1e-3, 1e9));
    let _ = writeln!(text, "geometry = \"{}\"", draw.one(&["full", "slender"]));
    if draw.seldom(4) {
        let _ = writeln!(text, "inertia_ratio = {:?}", draw.number(1.0, 4.0));
    }
    if draw.seldom(3) {
        let _ = writeln!(text, "initial_rotation_ratio = {:?}", 2.0 * draw.share());
        let _ = writeln!(text, "initial_velocity_ratio = {:?}", 2.0 * draw.share());
    }
    (0..1 + draw.below(MOST_DEVICES)).fold(false, |elastic, _| device(draw, text) || elastic)
}

fn device(draw: &mut Draw<'_>, text: &mut String) -> bool {
    let kind = draw.one(&["none", "inerter", "clutched-pair", "clutched-pair", "clutched-pair"]);
    let _ = writeln!(text, "[[device]]\nkind = \"{kind}\"");
    if kind == "none" {
        return false;
    }
    let _ = writeln!(text, "mass_ratio = {:?}", draw.number_or_zero(1e-6, 1e4));
    let _ = match draw.below(6) {
        0 => writeln!(text, "mount = \"tying-point\"\nmount_height_m = {:?}", draw.number(1e-3, 1e4)),
        1 => writeln!(text, "mount = \"base-corners\"\npulley_ratio = {:?}", draw.number(1e-2, 1e2)),
        2 => writeln!(text, "kinematics = \"consistent\""),
        _ => Ok(()),
    };
    if draw.seldom(4) {
        let _ = writeln!(
            text,
            "rack = {{ viscous_1_s = {:?}, dry_friction_ratio = {:?} }}",
            draw.number_or_zero(1e-6, 1e3),
            draw.number_or_zero(1e-6, 10.0)
        );
    }
    if draw.seldom(4) {
        let seats = draw.one(&["", ", flywheels_on = \"block\"", ", rack_on = \"block\""]);
        let _ = writeln!(
            text,
            "weight = {{ flywheels_ratio = {:?}, rack_ratio = {:?}{seats} }}",
            draw.number_or_zero(1e-6, 10.0),
            draw.number_or_zero(1e-6, 10.0)
        );
    }
    if draw.seldom(4) {
        let _ = match draw.below(2) {
            0 => writeln!(text, "support_amplification = {:?}", 10.0 * draw.share()),
            _ => writeln!(
                text,
                "support_frequency_hz = {:?}\nsupport_damping_ratio = {:?}",
                draw.number(0.1, 1e3),
                draw.number(0.005, 0.9)
            ),
        };
    }
    let clutch = if kind == "inerter" { 0 } else { draw.below(7) };
    let brake = match draw.below(3) {
        _ if clutch < 2 || clutch == 3 => "0.0".to_owned(),
        0 => "0.0".to_owned(),
        1 => "\"instant\"".to_owned(),
        _ => format!("{:?}", draw.number(1e-3, 1e9)),
    };
    if draw.seldom(2) {
        let (viscous, dry) = (draw.number_or_zero(1e-6, 1e6), draw.number_or_zero(1e-6, 1e6));
        let _ = write!(
            text,
            "flywheel = {{ viscous_rate_1_s = {viscous:?}, dry_deceleration_m_s2 = {dry:?}, brake_deceleration_m_s2 = {brake}"
        );
        if clutch == 2 && !brake.starts_with('"') {
            let _ = write!(text, ", drag_rate_1_s = {:?}", draw.number_or_zero(1e-6, 1e3));
        }
        text.push_str(" }\n");
    }
    let capacity = draw.number(1e-6, 1e6);
    let _ = match clutch {
        2 => writeln!(text, "engagement = \"rigid\""),
        3 => writeln!(text, "engagement = \"overrunning\""),
        4 => writeln!(text, "clutch = {{ capacity_ratio = {capacity:?} }}"),
        5 => {
            let (stiffness, damping) = (draw.number(1e-3, 1e9), draw.number_or_zero(1e-6, 1e2));
            let _ = write!(
                text,
                "clutch = {{ stiffness_ratio = {stiffness:?}, damping_ratio = {damping:?}, backlash_m = {:?}",
                draw.number_or_zero(1e-6, 1.0)
            );
            if draw.seldom(2) {
                let _ = write!(text, ", capacity_ratio = {capacity:?}");
            }
            writeln!(text, " }}")
        }
        6 => writeln!(text, "inertance_corner_hz = {:?}", draw.number(1e-3, 1e3)),
        _ => Ok(()),
    };
    if kind == "clutched-pair" && clutch != 3 && draw.seldom(2) {
        // Shorter ones make a clutch chatter for as long as it is allowed to.
        let times = [(); 3].map(|()| draw.number_or_zero(1e-3, 10.0));
        let _ = write!(
            text,
            "actuation = {{ engagement_delay_s = {:?}, release_delay_s = {:?}, dwell_s = {:?}",
            times[0], times[1], times[2]
        );
        let _ = write!(text, ", miss_probability = {:?}, miss_seed = {}", draw.number_or_zero(1e-3, 1.0), draw.below(256));
        if clutch == 4 {
            let _ = write!(text, ", rise_time_s = {:?}", draw.number_or_zero(1e-6, 10.0));
        }
        text.push_str(" }\n");
    }
    clutch == 5
}

fn motion(draw: &mut Draw<'_>, amplitude: &str, low: f64, high: f64, text: &mut String) {
    let kind = draw.one(&["sine", "cosine", "half-sine", "ricker", "rectangular", "mavroeidis-papageorgiou"]);
    let _ = writeln!(text, "motion = \"{kind}\"\nscale = {:?}", if draw.seldom(2) { -1.0 } else { 1.0 });
    // Half of them within what a block is likely to survive.
    let size =
        if draw.seldom(2) { draw.number(low, high) } else { draw.number(0.5 * high.min(1.0), 8.0 * high.min(1.0)).min(high) };
    let _ = match kind {
        "rectangular" => writeln!(text, "{amplitude} = {size:?}\nduration_ratio = {:?}", draw.number(1e-6, 1e2)),
        "mavroeidis-papageorgiou" => {
            let (oscillations, phase) = (draw.number(1.001, 10.0), 360.0 * draw.share());
            writeln!(
                text,
                "velocity_amplitude_m_s = {:?}\noscillations = {oscillations:?}\nphase_deg = {phase:?}",
                size.min(100.0)
            )
        }
        _ => writeln!(text, "{amplitude} = {size:?}"),
    };
    if kind != "rectangular" {
        let _ = writeln!(text, "frequency_ratio = {:?}", draw.number(1e-2, 1e4));
    }
    if draw.seldom(3) {
        let _ = writeln!(text, "start_s = {:?}", draw.number(1e-6, 10.0));
    }
}

fn accuracy(draw: &mut Draw<'_>, elastic: bool, text: &mut String) {
    let methods: &[&str] = if elastic {
        &["taylor", "exponential-midpoint", "runge-kutta-4", "taylor"]
    } else {
        &["taylor", "taylor", "runge-kutta-4", "semi-implicit-euler"]
    };
    let method = draw.one(methods);
    let _ = writeln!(text, "[accuracy]\nmethod = \"{method}\"");
    if method == "taylor" && !draw.seldom(4) {
        if draw.seldom(4) {
            let _ = writeln!(text, "tolerance = {:?}", draw.number(1e-20, 1e-2));
        }
        return;
    }
    let _ = writeln!(text, "step_ratio = {:?}", draw.number(1e-5, 1.0));
    let _ = writeln!(text, "precision = \"{}\"", draw.one(&["f64", "f32"]));
    if draw.seldom(4) && method != "taylor" {
        text.push_str("events = \"step-end\"\n");
    }
}
