//! Effects on what is reported: checks of demands, and the energy ledger. The motion stays as it is.

use super::Effect;

/// Demands on support, gears and coils.
pub const CHECKS: Effect = Effect {
    name: "checks",
    summary: "demands on friction, support, stroke and gear teeth, and what coils take, with warnings above given limits",
    equation: &[
        "toe, horizontal device: H = ü_g/g + (R/g) (cos δ θ̈ + sin δ θ̇²) + n F,  V = 1 + v̈_g/g + (R/g) (sin δ θ̈ − cos δ θ̇²)",
        "vertical device: s n F in V instead;  no sliding while |H|/V stays below the friction available",
        "impact: friction needed as in `sprag effects impact`;  jolt of a rigid clutch: H = (cos δ − n λ/ℓ) m R Δθ̇,  V = sin δ m R Δθ̇",
        "force on the support: F₁ + F₂ of both flywheels",
        "coils: holding power × time engaged of both clutches + closing energy × closings",
        "gear: σ_b = F_t/(b m Y),  Y = 0.484 − 2.87/z; first mesh F_t = F of one flywheel, others with the train",
    ],
    source: "equilibrium and momentum of the block; Lewis 1893 for the bending stress of teeth",
    keys: &[
        "checks.friction_coefficient",
        "checks.gear.module_mm",
        "checks.gear.face_width_mm",
        "checks.gear.teeth",
        "checks.gear.allowable_stress_mpa",
        "checks.coil.holding_power_w",
        "checks.coil.closing_energy_j",
        "checks.coil.largest_energy_j",
        "checks.largest_force_ratio",
        "checks.largest_stroke_m",
    ],
    is_on: |scene, _| scene.file.checks.is_some(),
};

/// Where the energy goes.
pub const ENERGY: Effect = Effect {
    name: "energy",
    summary: "an energy ledger: kinetic, potential, stored, given by the ground, lost at impacts and in the device; plotted",
    equation: &["initial + input of the ground + created = kinetic + potential + stored + Σ dissipated"],
    source: "energy balance of block and device",
    keys: &["output.energy"],
    is_on: |scene, _| scene.file.output.energy,
};
