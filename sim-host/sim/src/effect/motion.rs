//! The equation of motion that results from a scene, as text with its numbers.

use sprag_shared::structure::block::{GRAVITY, Geometry};
use sprag_shared::structure::device::{DeviceKind, KinematicsKind};
use sprag_shared::structure::drivetrain::{Engagement, FlywheelLosses};
use sprag_shared::structure::mount::Mount;

use super::block::FOUNDATION;
use super::explanation::Subject;
use super::number::number;

/// Lines: the equation, what its letters are, and their numbers.
pub(super) fn motion(subject: &Subject<'_>) -> Vec<String> {
    if subject.scene.file.block.foundation.is_some() {
        let equation = FOUNDATION.equation.iter().map(|line| (*line).to_owned());
        return equation.chain(["δ = α − |θ|,  s = sgn θ".to_owned()]).chain(numbers(subject)).collect();
    }
    let mut lines = vec![format!("{} = {}", inertia(subject), forces(subject)), "δ = α s − θ,  s = sgn θ".to_owned()];
    lines.extend(resistance(subject));
    if subject.has_inerter() {
        lines.push(lever(subject));
    }
    lines.extend(numbers(subject));
    lines
}

/// The flywheels that can be locked to the rack, and so share its inertia: how their sum is written.
fn locked(subject: &Subject<'_>) -> Option<&'static str> {
    match (subject.device.device.kind, subject.device.drivetrain.engagement) {
        (DeviceKind::None, _) | (_, Engagement::Elastic { .. } | Engagement::Viscous { .. }) => None,
        (DeviceKind::Inerter, _) => Some("σ"),
        (DeviceKind::ClutchedPair, _) => Some("κ σ"),
    }
}

/// The left-hand side.
fn inertia(subject: &Subject<'_>) -> String {
    let guided = (subject.device.drivetrain.rack.guided_mass_ratio != 0.0).then_some("μ_g");
    let moving: Vec<&str> = locked(subject).into_iter().chain(guided).collect();
    if moving.is_empty() {
        return "λ θ̈".to_owned();
    }
    let squared: Vec<String> = moving.iter().map(|part| format!("{part} ℓ²")).collect();
    let mut text = format!("(λ + {}) θ̈", squared.join(" + "));
    if subject.device.device.kinematics == KinematicsKind::Consistent && subject.loaded.geometry == Geometry::Full {
        let sum = if let [only] = moving.as_slice() { (*only).to_owned() } else { format!("({})", moving.join(" + ")) };
        text += &format!(" + {sum} ℓ ℓ′ θ̇²");
    }
    text
}

/// The right-hand side.
fn forces(subject: &Subject<'_>) -> String {
    let weight = if subject.has_vertical() { "(1 + v̈_g/g) " } else { "" };
    let mut text = match subject.loaded.geometry {
        Geometry::Full => format!("−(g/R) [ {weight}sin δ + (ü_g/g) cos δ ]"),
        Geometry::Slender => format!("−(g/R) [ {weight}δ + ü_g/g ]"),
    };
    let drivetrain = &subject.device.drivetrain;
    let mut sum = Vec::new();
    match (subject.device.device.kind, drivetrain.engagement) {
        (DeviceKind::Inerter, Engagement::Viscous { .. }) => sum.push("F₁"),
        (_, Engagement::Friction { .. } | Engagement::Elastic { .. } | Engagement::Viscous { .. }) => sum.push("F₁ + F₂"),
        (_, Engagement::Rigid) if drivetrain.flywheel.drag_rate != 0.0 => sum.push("F₁ + F₂"),
        (_, Engagement::Ideal | Engagement::Rigid | Engagement::Overrunning) => {}
    }
    if has_bearing(&drivetrain.flywheel) && locked(subject).is_some() {
        sum.push("F_b");
    }
    if drivetrain.rack.viscous != 0.0 || drivetrain.rack.dry_ratio != 0.0 {
        sum.push("F_r");
    }
    if drivetrain.rack.load_friction != 0.0 {
        sum.push("F_m");
    }
    match sum.as_slice() {
        [] => {}
        [only] if !only.contains('+') => text += &format!(" − ℓ {only}/(m R)"),
        _ => text += &format!(" − ℓ ({})/(m R)", sum.join(" + ")),
    }
    if drivetrain.rack.guided_mass_ratio != 0.0 {
        text += " − μ_g ℓ ü_g/R";
    }
    if let (true, Some(locked)) = (moves(subject), locked(subject)) {
        let against = if subject.device.drivetrain.support.given_apart { "(ü_s − ü_g)" } else { "(f − 1) ü_g" };
        text += &format!(" + {locked} ℓ n {against}/R");
    }
    text
}

/// The support moves on its own.
fn moves(subject: &Subject<'_>) -> bool {
    subject.device.drivetrain.support.moves()
}

fn has_bearing(flywheel: &FlywheelLosses) -> bool {
    flywheel.viscous_rate != 0.0 || flywheel.dry_deceleration != 0.0
}

/// What κ and the forces are.
fn resistance(subject: &Subject<'_>) -> Vec<String> {
    let drivetrain = &subject.device.drivetrain;
    let mut lines = Vec::new();
    if subject.device.device.kind == DeviceKind::ClutchedPair {
        match drivetrain.engagement {
            Engagement::Ideal => lines.push("κ = 1 while a flywheel is engaged, else 0".to_owned()),
            Engagement::Rigid if drivetrain.flywheel.drag_rate != 0.0 => {
                lines.push("κ: how many flywheels are locked to the rack;  Fᵢ: of open clutches".to_owned());
            }
            Engagement::Friction { .. } if drivetrain.flywheel.drag_rate != 0.0 => {
                lines.push("κ: how many flywheels stick to the rack;  Fᵢ: of slipping plates and of open clutches".to_owned());
            }
            Engagement::Rigid | Engagement::Overrunning => lines.push("κ: how many flywheels are locked to the rack".to_owned()),
            Engagement::Friction { .. } => {
                lines.push("κ: how many flywheels stick to the rack;  Fᵢ: of slipping plates".to_owned())
            }
            Engagement::Elastic { .. } | Engagement::Viscous { .. } => {
                lines.push("Fᵢ: force of clutch i on the rack".to_owned());
            }
        }
    }
    if has_bearing(&drivetrain.flywheel)
        && let Some(sum) = locked(subject)
    {
        let sum = sum.trim_end_matches('σ');
        lines.push(format!("F_b = {sum}m_r (c R ℓ θ̇ + d sgn(ℓ θ̇)): bearings of flywheels that move with the rack"));
    }
    let rack = &drivetrain.rack;
    if rack.viscous != 0.0 || rack.dry_ratio != 0.0 {
        lines.push(format!(
            "F_r = m (c_r R ℓ θ̇ + μ_r g sgn(ℓ θ̇)),  c_r = {} 1/s,  μ_r = {}",
            number(subject.per_mass(rack.viscous)),
            number(subject.per_mass(rack.dry_ratio))
        ));
    }
    if rack.load_friction != 0.0 {
        lines.push(format!(
            "F_m = μ_m |F| sgn(ℓ θ̇),  F = m_r (ẍ + c ẋ + d sgn ẋ) of each locked flywheel,  μ_m = {}",
            number(rack.load_friction)
        ));
    }
    if rack.guided_mass_ratio != 0.0 {
        let ratio = number(subject.per_mass(rack.guided_mass_ratio));
        lines.push(format!("μ_g = {ratio}: mass over m of a rack on guides of the support"));
    }
    if moves(subject) {
        let support = match subject.scene.file.device[subject.index].support_oscillator() {
            Some(wall) => format!(
                "ü_s = −2ζω ż − ω² z of a support with z̈ + 2ζω ż + ω² z = −ü_g,  ω = 2π {} Hz,  ζ = {}",
                number(wall.frequency_hz),
                number(wall.damping_ratio)
            ),
            None if drivetrain.support.given_apart => "ü_s: the record of the support".to_owned(),
            None => {
                format!(
                    "f = ü_s/ü_g = {}: the support's acceleration over the ground's",
                    number(drivetrain.support.amplification)
                )
            }
        };
        let pulley = number(subject.loaded.device.mount.support_ratio().unwrap_or(0.0));
        lines.push(format!("{support},  n = {pulley}: the pulley's ratio"));
    }
    lines
}

fn lever(subject: &Subject<'_>) -> String {
    let structure = &subject.loaded;
    let (block, mount) = (&structure.block, &structure.device.mount);
    let text = match (structure.geometry, mount) {
        (Geometry::Slender, _) => mount.lever_at(block, Geometry::Slender, 0.0).map(|lever| format!("ℓ = {}", number(lever))),
        (Geometry::Full, Mount::CentreOfMass) => Ok("ℓ = cos δ".to_owned()),
        (Geometry::Full, _) => mount.lever(block).map(|constants| {
            format!("ℓ = A cos δ + s B sin δ,  A = {},  B = {}", number(constants.along), number(constants.across))
        }),
    };
    // A scene has been checked, and so has a lever.
    text.unwrap_or_default() + ":  travel of the terminals is R ∫ ℓ dθ"
}

fn numbers(subject: &Subject<'_>) -> Vec<String> {
    let block = &subject.loaded.block;
    let mut with = vec![
        format!("R = {} m", number(block.size())),
        format!("α = {}°", number(block.slenderness().to_degrees())),
        format!("λ = {}", number(block.inertia_ratio())),
        format!("g/R = {} 1/s²", number(GRAVITY / block.size())),
        format!("p = √(g/(λR)) = {} 1/s", number(block.frequency_parameter())),
    ];
    if subject.has_inerter() {
        with.push(format!("σ = m_r/m = {}", number(subject.loaded.device.mass_ratio)));
    }
    let mut lines = vec![format!("with {}", with.join(",  "))];
    let added_mass = &subject.device.added_mass;
    if !added_mass.is_none() {
        let bare = &subject.scene.block;
        lines.push(format!(
            "of the block with what rides on it, {} of its mass at {} m; alone: R = {} m,  α = {}°,  λ = {},  σ = {}",
            number(added_mass.mass_ratio),
            number(added_mass.height),
            number(bare.size()),
            number(bare.slenderness().to_degrees()),
            number(bare.inertia_ratio()),
            number(subject.device.device.mass_ratio)
        ));
    }
    lines
}
