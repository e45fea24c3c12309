//! Effects of where a device is attached and what it weighs: mount, kinematics, weight, rack.

use sprag_shared::structure::added_mass::AddedMass;
use sprag_shared::structure::device::{DeviceKind, KinematicsKind};
use sprag_shared::structure::mount::Mount;

use super::{Effect, EffectKey, settings};

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
    keys: &[
        EffectKey {
            key: "device.N.mount",
            default: "\"centre-of-mass\"",
            range: "\"centre-of-mass\", \"tying-point\" or \"base-corners\"",
        },
        EffectKey { key: "device.N.mount_height_m", default: "-", range: "above 0 m; tying point only" },
        EffectKey { key: "device.N.pulley_ratio", default: "1", range: "above 0; tying point and base corners" },
    ],
    of_device: true,
    is_on: |scene, index| {
        let mount = scene.devices[index].device.mount;
        (mount != Mount::CentreOfMass).then(|| settings(scene, index, MOUNT.keys))
    },
};

/// The θ̇² term.
pub const KINEMATICS: Effect = Effect {
    name: "kinematics",
    summary: "the acceleration of the terminals with its θ̇² term, which conserves energy",
    equation: &["paper:      ü = R ℓ θ̈", "consistent: ü = R (ℓ θ̈ + ℓ′ θ̇²)"],
    source: "Eq. 11 of the paper leaves the θ̇² term out; with it, by differentiating the travel twice",
    keys: &[EffectKey { key: "device.N.kinematics", default: "\"paper\"", range: "\"paper\" or \"consistent\"" }],
    of_device: true,
    is_on: |scene, index| {
        let kinematics = scene.devices[index].device.kinematics;
        (kinematics == KinematicsKind::Consistent).then(|| settings(scene, index, KINEMATICS.keys))
    },
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
        EffectKey { key: "device.N.weight.flywheels_ratio", default: "-", range: "from 0 to 10, of the block's mass" },
        EffectKey { key: "device.N.weight.flywheels_kg", default: "-", range: "the same in kg; needs block.mass_kg" },
        EffectKey { key: "device.N.weight.flywheels_on", default: "\"support\"", range: "\"support\" or \"block\"" },
        EffectKey { key: "device.N.weight.rack_ratio", default: "-", range: "from 0 to 10, of the block's mass" },
        EffectKey { key: "device.N.weight.rack_kg", default: "-", range: "the same in kg; needs block.mass_kg" },
        EffectKey { key: "device.N.weight.rack_on", default: "\"support\"", range: "\"support\" or \"block\", not both there" },
    ],
    of_device: true,
    is_on: |scene, index| {
        let device = &scene.devices[index];
        let on = device.added_mass != AddedMass::NONE || device.drivetrain.rack.guided_mass_ratio != 0.0;
        on.then(|| settings(scene, index, WEIGHT.keys))
    },
};

/// Friction of the rack.
pub const RACK: Effect = Effect {
    name: "rack",
    summary: "viscous and dry friction that the rack meets, whatever the clutch does",
    equation: &["F_r = m (c_r ẋ + μ_r g sgn ẋ),  ẋ = R ℓ θ̇"],
    source: "Coulomb and viscous friction",
    keys: &[
        EffectKey { key: "device.N.rack.viscous_1_s", default: "-", range: "from 0 to 1000 1/s, per block mass" },
        EffectKey { key: "device.N.rack.viscous_n_s_m", default: "-", range: "the same in N s/m; needs block.mass_kg" },
        EffectKey { key: "device.N.rack.dry_friction_ratio", default: "-", range: "from 0 to 10, of the block's weight" },
        EffectKey { key: "device.N.rack.dry_friction_n", default: "-", range: "the same in N; needs block.mass_kg" },
    ],
    of_device: true,
    is_on: |scene, index| {
        let device = &scene.devices[index];
        let rack = device.drivetrain.rack;
        let on = device.device.kind != DeviceKind::None && (rack.viscous != 0.0 || rack.dry_ratio != 0.0);
        on.then(|| settings(scene, index, RACK.keys))
    },
};
