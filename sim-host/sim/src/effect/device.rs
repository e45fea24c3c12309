//! Effects of where a device is attached and what it weighs: mount, support, kinematics, weight, rack.

use sprag_shared::structure::added_mass::AddedMass;
use sprag_shared::structure::device::{DeviceKind, KinematicsKind};
use sprag_shared::structure::mount::Mount;

use super::Effect;

/// Where the inerter is tied.
pub const MOUNT: Effect = Effect {
    name: "mount",
    summary: "where the inerter is tied to the block, and through what pulley",
    equation: &[
        "travel of the terminals: dx = R ℓ dθ",
        "centre of mass: ℓ = cos δ",
        "others:         ℓ = A cos δ + s B sin δ, A and B from height, corner and pulley ratio n",
    ],
    source: "Figures 3 and 4 of the paper, Eq. 11; other points by the same derivative",
    keys: &["device.N.mount", "device.N.mount_height_m", "device.N.pulley_ratio"],
    is_on: |scene, index| scene.devices[index].device.mount != Mount::CentreOfMass,
};

/// A support that moves on its own.
pub const SUPPORT: Effect = Effect {
    name: "support",
    summary: "a wall or frame that carries the device and moves otherwise than the ground: amplified, as an oscillator, as recorded",
    equation: &[
        "ü_s at the device: f ü_g; of an oscillator of ω and ζ, ü_s = −2ζω ż − ω² z with z̈ + 2ζω ż + ω² z = −ü_g; or a record",
        "the device does not move it: its reaction is small against what the support weighs",
        "a flywheel feels the terminals against the support:",
        "F = m_r (ẍ − n (ü_s − ü_g)),  ẍ relative to the ground",
        "engaged, it adds κ σ ℓ n (ü_s − ü_g)/R to the push of the ground (n: the pulley's ratio);",
        "Eq. 10 at the terminals, also while the block stands: engaged while v̇ v > 0,  v = ẋ − n ∫ (ü_s − ü_g) dt",
    ],
    source: "d'Alembert's force of an inerter between two moving terminals (Smith 2002); oscillator: Nigam and Jennings (1969)",
    keys: &[
        "device.N.support_amplification",
        "device.N.support_frequency_hz",
        "device.N.support_damping_ratio",
        "device.N.support_record.file",
        "device.N.support_record.units",
        "device.N.support_record.time_step_s",
        "device.N.support_record.component",
        "device.N.support_record.resample_to_s",
        "device.N.support_record.scale",
    ],
    is_on: |scene, index| scene.devices[index].drivetrain.support.moves(),
};

/// The θ̇² term.
pub const KINEMATICS: Effect = Effect {
    name: "kinematics",
    summary: "the acceleration of the terminals with its θ̇² term, which conserves energy",
    equation: &["paper:      ü = R ℓ θ̈", "consistent: ü = R (ℓ θ̈ + ℓ′ θ̇²)"],
    source: "Eq. 11 of the paper leaves the θ̇² term out; with it, by differentiating the travel twice",
    keys: &["device.N.kinematics"],
    is_on: |scene, index| scene.devices[index].device.kinematics == KinematicsKind::Consistent,
};

/// Gravitational mass of the device.
pub const WEIGHT: Effect = Effect {
    name: "weight",
    summary: "mass of flywheels and rack: carried by the block, or moved along on guides of the support",
    equation: &[
        "on the block, μ at height z: h' = (h + μ z)/(1 + μ), tan α' = b/h', R'² = b² + h'²,",
        "                             λ' = (λ R² + μ (b² + z²))/((1 + μ) R'²), σ' = σ/(1 + μ)",
        "rack on guides, μ_g:         adds μ_g ℓ² to the inertia and −μ_g ℓ ü_g/R to the push of the ground",
    ],
    source: "composition of centres of mass and parallel-axis theorem",
    keys: &[
        "device.N.weight.flywheels_ratio",
        "device.N.weight.flywheels_kg",
        "device.N.weight.flywheels_on",
        "device.N.weight.rack_ratio",
        "device.N.weight.rack_kg",
        "device.N.weight.rack_on",
    ],
    is_on: |scene, index| {
        let device = &scene.devices[index];
        device.added_mass != AddedMass::NONE || device.drivetrain.rack.guided_mass_ratio != 0.0
    },
};

/// Friction of the rack.
pub const RACK: Effect = Effect {
    name: "rack",
    summary: "viscous and dry friction of the rack, and friction in its mesh that grows with the force of locked flywheels",
    equation: &[
        "F_r = m (c_r ẋ + μ_r g sgn ẋ),  ẋ = R ℓ θ̇",
        "F_m = μ_m |F| sgn ẋ for each locked flywheel, F its force: a share 1/(1 + μ_m) of the power arrives",
        "while the rack drives the flywheel, and 1 − μ_m while the flywheel drives the rack",
    ],
    source: "Coulomb and viscous friction; Wang and Su 2008 for friction of built inerters",
    keys: &[
        "device.N.rack.viscous_1_s",
        "device.N.rack.viscous_n_s_m",
        "device.N.rack.dry_friction_ratio",
        "device.N.rack.dry_friction_n",
        "device.N.rack.load_friction",
    ],
    is_on: |scene, index| {
        let device = &scene.devices[index];
        let rack = device.drivetrain.rack;
        device.device.kind != DeviceKind::None && (rack.viscous != 0.0 || rack.dry_ratio != 0.0 || rack.load_friction != 0.0)
    },
};
