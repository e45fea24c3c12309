//! The flywheels' own equations and the rules at engagement, uplift, impact and rest, as text with a scene's numbers.

use sprag_shared::math;
use sprag_shared::structure::block::{GRAVITY, Geometry};
use sprag_shared::structure::device::DeviceKind;
use sprag_shared::structure::drivetrain::{Actuation, Delay, Engagement};
use sprag_shared::structure::restitution::{Restitution, momentum_balance};

use super::explanation::Subject;
use super::number::number;

/// What moves the flywheels.
pub(super) fn flywheels(subject: &Subject<'_>) -> Vec<String> {
    let drivetrain = &subject.device.drivetrain;
    let losses = &drivetrain.flywheel;
    let rack = if drivetrain.support.moves() { "w = R ℓ θ̇ − n ∫ (ü_s − ü_g) dt" } else { "w = R ℓ θ̇" };
    let mut lines = Vec::new();
    let own = match (subject.device.device.kind, drivetrain.engagement) {
        (DeviceKind::ClutchedPair, Engagement::Ideal) => {
            lines.push(format!("an engaged flywheel moves with the rack, {rack}; a released one stops at once"));
            false
        }
        (DeviceKind::ClutchedPair, Engagement::Elastic { .. } | Engagement::Viscous { .. }) => {
            lines.push("ẇᵢ = Fᵢ/m_r − c wᵢ − (d + b) sgn wᵢ,  wᵢ the speed of a rack that would move with flywheel i".to_owned());
            true
        }
        (DeviceKind::ClutchedPair, Engagement::Rigid | Engagement::Overrunning | Engagement::Friction { .. }) => {
            lines.push("a locked flywheel moves with the rack, wᵢ = R ℓ θ̇; any other by".to_owned());
            lines.push("ẇᵢ = Fᵢ/m_r − c wᵢ − (d + b) sgn wᵢ,  wᵢ the speed of a rack that would move with flywheel i".to_owned());
            true
        }
        (DeviceKind::Inerter, Engagement::Viscous { .. }) => {
            lines.push("ẇ₁ = F₁/m_r − c w₁ − d sgn w₁,  w₁ the speed of a rack that would move with the flywheel".to_owned());
            false
        }
        (DeviceKind::None | DeviceKind::Inerter, _) => {
            lines.push(format!("the flywheel always moves with the rack, {rack}"));
            false
        }
    };
    if own {
        lines.push(format!(
            "c = {} 1/s,  d = {} m/s²,  b = {} while released, else 0",
            number(losses.viscous_rate),
            number(losses.dry_deceleration),
            if losses.brake_deceleration.is_infinite() {
                "∞ (stopped at once)".to_owned()
            } else {
                format!("{} m/s²", number(losses.brake_deceleration))
            }
        ));
    } else if losses.viscous_rate != 0.0 || losses.dry_deceleration != 0.0 {
        lines.push(format!("c = {} 1/s,  d = {} m/s²", number(losses.viscous_rate), number(losses.dry_deceleration)));
    }
    lines.extend(clutch(subject));
    if losses.drag_rate != 0.0 {
        lines.push(format!(
            "drag of open clutches: Fᵢ = c_d m_r (R ℓ θ̇ − wᵢ) while released,  c_d = {} 1/s",
            number(losses.drag_rate)
        ));
    }
    lines
}

/// What a clutch with properties does.
fn clutch(subject: &Subject<'_>) -> Vec<String> {
    let bound = |capacity_ratio: f64| format!("F_c = {} m g", number(subject.per_mass(capacity_ratio)));
    match subject.device.drivetrain.engagement {
        Engagement::Friction { capacity_ratio } => vec![format!(
            "clutch: sticks (wᵢ = R ℓ θ̇) while |Fᵢ| ≤ F_c, else Fᵢ = F_c sgn(R ℓ θ̇ − wᵢ),  {}",
            bound(capacity_ratio)
        )],
        Engagement::Elastic { stiffness, damping, backlash, capacity_ratio } => {
            let mut lines = vec![format!(
                "clutch: Fᵢ = K (zᵢ − z₀) + C żᵢ,  żᵢ = R ℓ θ̇ − wᵢ,  K/m = {} 1/s²,  C/m = {} 1/s",
                number(subject.per_mass(stiffness)),
                number(subject.per_mass(damping))
            )];
            if backlash > 0.0 {
                lines.push(format!(
                    "z₀ = ±{} m, the contact on either side of the backlash; between them Fᵢ = 0",
                    number(backlash / 2.0)
                ));
            } else {
                lines.push("z₀ = 0: no backlash".to_owned());
            }
            if capacity_ratio.is_finite() {
                lines.push(format!("plates in series slip at |Fᵢ| = F_c,  {}", bound(capacity_ratio)));
            }
            lines
        }
        Engagement::Viscous { corner_frequency } => {
            let number_of = if subject.device.device.kind == DeviceKind::Inerter { "₁" } else { "ᵢ" };
            vec![format!(
                "viscous slip: F{number_of} = 2π f_c m_r (R ℓ θ̇ − w{number_of}) while engaged,  f_c = {} Hz",
                number(corner_frequency)
            )]
        }
        Engagement::Ideal | Engagement::Rigid | Engagement::Overrunning => Vec::new(),
    }
}

/// When flywheels engage, and what that costs.
pub(super) fn engagement(subject: &Subject<'_>) -> Vec<String> {
    if subject.device.device.kind == DeviceKind::Inerter {
        return vec!["always engaged: a single inerter has no clutch".to_owned()];
    }
    let drivetrain = &subject.device.drivetrain;
    let turns = "the first flywheel works on positive motion, the second on negative";
    let start = match drivetrain.engagement {
        Engagement::Overrunning => {
            return vec![
                format!("nobody commands it; {turns}"),
                "a flywheel holds while it resists, lets go when it would drive the block, and holds again when the block catches up"
                    .to_owned(),
            ];
        }
        Engagement::Ideal => "a stopped flywheel takes on the rack's speed without a loss of momentum",
        Engagement::Rigid => {
            "block and flywheel exchange momentum: (λ + (K + σ) ℓ²) θ̇⁺ = (λ + K ℓ²) θ̇⁻ + σ ℓ w/R, K already locked"
        }
        Engagement::Friction { .. } => "plates slip until flywheel and rack have one speed: no jump",
        Engagement::Viscous { .. } => "the force starts with the difference of the speeds: no jump",
        Engagement::Elastic { .. } => "the spring starts without twist, in the middle of the backlash: no jump",
    };
    let mut lines = vec![format!("commanded while acceleration and velocity of the terminals have one sign (Eq. 10); {turns}")];
    lines.push(start.to_owned());
    let Actuation { engagement_delay, release_delay, delay, rise_time, time_constant, dwell, miss_probability, miss_seed } =
        drivetrain.actuation;
    if drivetrain.actuation != Actuation::default() {
        let mut parts = Vec::new();
        for (value, text) in [
            (engagement_delay, "engages {} s after the command"),
            (release_delay, "releases {} s after the command"),
            (rise_time, "capacity rises over {} s"),
            (time_constant, "capacity rises with a time constant of {} s"),
            (dwell, "stays as it is for {} s after moving"),
            (miss_probability, "misses an engagement with probability {}"),
        ] {
            if value != 0.0 {
                parts.push(text.replace("{}", &number(value)));
            }
        }
        if delay == Delay::Transport {
            parts.push("every command arrives, however short".to_owned());
        }
        if miss_probability != 0.0 {
            parts.push(format!("seed {miss_seed}"));
        }
        lines.push(parts.join("; "));
    }
    lines
}

/// Uplift, impact and rest.
pub(super) fn impact(subject: &Subject<'_>) -> Vec<String> {
    if subject.scene.file.block.foundation.is_some() {
        return vec![
            "a foot lifts where its force ends, k c + c ċ = 0, and presses again when it has come down: no impact, no rest"
                .to_owned(),
        ];
    }
    let drivetrain = &subject.device.drivetrain;
    let mut lines = vec![uplift(subject)];
    // An inerter on a support that amplifies the ground has that in its threshold.
    let flywheel = match subject.device.device.kind {
        DeviceKind::ClutchedPair if drivetrain.support.moves() => Some("an engaged flywheel"),
        DeviceKind::Inerter if drivetrain.support.given_apart => Some("the flywheel"),
        _ => None,
    };
    lines.extend(flywheel.map(|flywheel| format!("{flywheel} takes σ n ℓ (ü_s − ü_g) off that push")));
    lines.push(format!("impact at θ = 0: θ̇⁺ = η θ̇⁻,  {}", restitution(subject)));
    let scatter = subject.loaded.restitution_scatter;
    if scatter.is_on() {
        let (deviation, seed) = (number(scatter.deviation), scatter.seed);
        lines.push(format!(
            "each impact draws its own η: normal about that with standard deviation {deviation}, 0 < η ≤ 1; seed {seed}"
        ));
    }
    if let Some(friction) = subject.scene.file.block.friction_coefficient {
        let friction = number(friction);
        lines.push(format!("slides from rest when |ü_g| > μ g (with v̈_g: μ (g + v̈_g)), if μ < tan α,  μ = {friction}"));
        lines.push("while it rocks the toe slips where |H| > μ V, and sticks again at ẋ = 0 where |H| ≤ μ V".to_owned());
        lines.push("an impact whose impulses need more than μ slides: P_x = −μ d P_y,  d = sgn ẋ after it".to_owned());
    }
    if subject.device.device.kind == DeviceKind::ClutchedPair || matches!(drivetrain.engagement, Engagement::Viscous { .. }) {
        let at_impact = match drivetrain.engagement {
            Engagement::Ideal => None,
            Engagement::Rigid => Some("a locked flywheel stays locked and changes its speed with the rack; others keep theirs"),
            Engagement::Overrunning => Some("the block slows down at once and its flywheels run on"),
            Engagement::Friction { .. } => {
                Some("no plate holds against an impulse: flywheels keep their speed and the plates slip")
            }
            Engagement::Viscous { .. } => Some("no dashpot passes an impulse on: flywheels keep their speed"),
            Engagement::Elastic { .. } => Some("springs keep their twist and flywheels their speed"),
        };
        lines.extend(at_impact.map(|text| format!("at an impact {text}")));
    }
    // Bearings hold by a flywheel that sticks to the rack, which none behind a spring or a dashpot does.
    let sticks = !matches!(drivetrain.engagement, Engagement::Elastic { .. } | Engagement::Viscous { .. });
    let of = match (drivetrain.rack.dry_ratio != 0.0, sticks && drivetrain.flywheel.dry_deceleration != 0.0) {
        (true, true) => Some("rack and bearings"),
        (true, false) => Some("the rack"),
        (false, true) => Some("bearings"),
        (false, false) => None,
    };
    lines.extend(of.map(|of| format!("dry friction of {of} may hold the block where its velocity is 0")));
    lines.push("rest: where impacts accumulate while the ground stays below the uplift threshold".to_owned());
    lines
}

/// The threshold at which weight and friction no longer hold a standing block.
fn uplift(subject: &Subject<'_>) -> String {
    let (structure, drivetrain) = (&subject.loaded, &subject.device.drivetrain);
    let (block, geometry) = (&structure.block, structure.geometry);
    let weight = if subject.has_vertical() { "(g + v̈_g)" } else { "g" };
    let threshold = geometry.uplift_threshold(block.slenderness());
    let slope = if geometry == Geometry::Full { "tan α" } else { "α" };
    // A pair's flywheel is taken on as the block goes: at once without a delay, and a spring that is not wound up yet holds nothing.
    let load = 1.0 + drivetrain.rack.load_friction;
    let meshed = if load == 1.0 { " + σ d ℓ" } else { " + (1 + μ_m) σ d ℓ" };
    let friction = load * structure.device.mass_ratio * drivetrain.flywheel.dry_deceleration / GRAVITY;
    let (bearing, term) = match (structure.device.kind, drivetrain.engagement) {
        (DeviceKind::None, _) | (_, Engagement::Elastic { .. } | Engagement::Viscous { .. }) => (0.0, ""),
        (DeviceKind::Inerter, _) => (friction, meshed),
        (DeviceKind::ClutchedPair, _) if drivetrain.actuation.engagement_delay > 0.0 => (0.0, ""),
        (DeviceKind::ClutchedPair, Engagement::Friction { capacity_ratio }) if subject.per_mass(capacity_ratio) < friction => {
            (subject.per_mass(capacity_ratio), " + F_c ℓ")
        }
        (DeviceKind::ClutchedPair, _) => (friction, meshed),
    };
    let dry = subject.per_mass(drivetrain.rack.dry_ratio) + bearing;
    let guided = subject.per_mass(drivetrain.rack.guided_mass_ratio);
    // A pair's clutches are open.
    let permanent = if structure.device.kind == DeviceKind::Inerter { structure.device.mass_ratio } else { 0.0 };
    let beyond = drivetrain.support.amplification - 1.0;
    let supported = permanent * structure.device.mount.support_ratio().unwrap_or(0.0) * beyond;
    if dry == 0.0 && guided == 0.0 && supported == 0.0 {
        return format!("uplifts from rest when |ü_g| > {weight} {slope},  {slope} = {}", number(threshold));
    }
    let (sin, cos) = match geometry {
        Geometry::Full => ("sin α", "cos α"),
        Geometry::Slender => ("α", "1"),
    };
    let pushes = [(guided, " + μ_g ℓ"), (supported, " − σ n (f − 1) ℓ")];
    let more: String = pushes.iter().filter(|(value, _)| *value != 0.0).map(|(_, term)| *term).collect();
    let push = match (more.as_str(), supported == 0.0) {
        ("", _) => format!("{cos} |ü_g|"),
        (more, true) => format!("({cos}{more}) |ü_g|"),
        (more, false) => format!("|{cos}{more}| |ü_g|"),
    };
    let terms = [(drivetrain.rack.dry_ratio, " + μ_r g ℓ"), (bearing, term)];
    let hold: String = terms.iter().filter(|(value, _)| *value != 0.0).map(|(_, term)| *term).collect();
    let lever = structure.device.mount.lever_at(block, geometry, 0.0).unwrap_or(0.0);
    let moments = match geometry {
        Geometry::Full => math::sin_cos(block.slenderness()),
        Geometry::Slender => (block.slenderness(), 1.0),
    };
    let value = (moments.0 + lever * dry) / (moments.1 + lever * (guided - supported)).abs();
    let quiet = if subject.has_vertical() { " while v̈_g = 0" } else { "" };
    format!("uplifts from rest when {push} > {weight} {sin}{hold}: above {} g{quiet}", number(value))
}

fn restitution(subject: &Subject<'_>) -> String {
    let structure = &subject.loaded;
    let eta =
        |value: Result<f64, _>| value.map_or_else(|_: sprag_shared::structure::error::ParameterError| "-".to_owned(), number);
    match structure.restitution {
        Restitution::Constant(value) => format!("η = {} as given", number(value)),
        Restitution::Geometric => format!("η = 1 − 2 sin²α/λ = {}", eta(structure.restitution())),
        Restitution::MomentumBalance => {
            let with = |count: f64| {
                let device = &structure.device;
                eta(momentum_balance(&structure.block, structure.geometry, &device.mount, count * device.mass_ratio))
            };
            match (structure.device.kind, subject.device.drivetrain.engagement) {
                (DeviceKind::Inerter, Engagement::Viscous { .. }) => {
                    format!("η by moment of momentum without the flywheel = {}", with(0.0))
                }
                (DeviceKind::ClutchedPair, Engagement::Rigid) => {
                    format!("η by moment of momentum with what is locked: {} with no flywheel, {} with one", with(0.0), with(1.0))
                }
                _ => format!("η by moment of momentum with what stays engaged = {}", eta(structure.restitution())),
            }
        }
    }
}
