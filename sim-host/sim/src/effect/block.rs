//! Effects on the block: geometry, vertical ground motion, impacts.

use sprag_shared::structure::block::Geometry;

use super::{Effect, settings};

/// Equation of motion of the block: full or slender.
pub const GEOMETRY: Effect = Effect {
    name: "geometry",
    summary: "the exact block, or its linearisation for small angles",
    equation: &[
        "full:    λ θ̈ = −(g/R) [ sin δ + (ü_g/g) cos δ ],  δ = α s − θ",
        "slender: λ θ̈ = −(g/R) [ δ + ü_g/g ],  ℓ constant",
    ],
    source: "Thiers-Moggia and Málaga-Chuquitaype 2019, Eq. 2 and 15-18; Housner 1963",
    keys: &["block.geometry"],
    is_on: |scene, _| scene.geometry() == Geometry::Slender,
};

/// Vertical ground motion.
pub const VERTICAL: Effect = Effect {
    name: "vertical",
    summary: "a vertical ground acceleration, positive upwards, that makes the block heavier and lighter",
    equation: &["g sin δ becomes (g + v̈_g) sin δ; uplift from rest when |ü_g| > (g + v̈_g) tan α; refused unless 1 + v̈_g/g > 0"],
    source: "Yim, Chopra and Penzien 1980",
    keys: &["vertical"],
    is_on: |scene, _| !scene.file.vertical.is_empty(),
};

/// Impacts that differ.
pub const SCATTER: Effect = Effect {
    name: "scatter",
    summary: "each impact draws its own restitution: no two of one block are alike",
    equation: &[
        "η_k = η + s z_k,  z_k normal with mean 0 and variance 1, drawn again until 0 < η_k ≤ 1: no impact adds energy",
        "z_k = √(−2 ln(1 − u)) cos 2πv, u and v from the seed and the impact's number k alone (SplitMix64)",
        "near 1 the mean moves down: by s φ(a)/Φ(a) with a = (1 − η)/s",
    ],
    source: "normal errors of many small causes, truncated; that free-rocking tests scatter so: Bachmann et al. 2018",
    keys: &["block.restitution_scatter", "block.restitution_seed"],
    is_on: |scene, _| scene.file.block.scatter().is_on(),
};

/// A base that slides.
pub const SLIDING: Effect = Effect {
    name: "sliding",
    summary: "Coulomb friction under a block without a device: the base slides flat, or under the block while it rocks",
    equation: &[
        "stands while |ü_g| ≤ (g + v̈_g) min(μ, tan α); slides flat by ẍ = −μ d (g + v̈_g) − ü_g,  d = sgn ẋ",
        "rocks about a toe that sticks while |H| ≤ μ V; about one that slides, H = −μ d V, with q = sin δ − μ d cos δ:",
        "(λ − 1 + q sin δ) θ̈ = −q (g + v̈_g − R cos δ θ̇²)/R,  V/m = (λ − 1)(g + v̈_g − R cos δ θ̇²)/(λ − 1 + q sin δ)",
        "impact: impulses at the new toe within the cone, |P_x| ≤ μ P_y; the run ends where V = 0: flight is not modelled",
    ],
    source: "Shenton and Jones 1991, Shenton 1996 (slide, rock, slide-rock); Newmark 1965; impact by moment of momentum, derived here",
    keys: &["block.friction_coefficient"],
    is_on: |scene, _| scene.file.block.friction_coefficient.is_some(),
};

/// A base that gives.
pub const FOUNDATION: Effect = Effect {
    name: "foundation",
    summary: "a spring and a dashpot under each toe: the base gives, a toe lifts as its foot's force ends, and nothing hits",
    equation: &[
        "ÿ = φ₁ + φ₂ − (g + v̈_g)/R;  feet push only: φᵢ = (k cᵢ + c ċᵢ)/m > 0,  c₁ = cos δ − cos α − y,  c₂ = c₁ − 2 sin α sin|θ|",
        "(λ − 1 + (1 + nσ) cos²δ) θ̈ + s (1 + nσ) sin δ cos δ θ̇² = −ü_g cos δ/R − s φ₁ sin δ − s φ₂ (sin δ − 2 sin α cos θ)",
        "2k/m = (2π f_v)²,  2c/m = 2 ζ (2π f_v);  lengths over R; the toe about which it turns does not slide",
        "φᵢ in contact, cᵢ > 0;  n: flywheels engaged;  the paper's kinematics leave nσ out of the θ̇² term",
    ],
    source: "two-spring foundation of Psycharis and Jennings 1983; full geometry by Lagrange's equations, derived here",
    keys: &["block.foundation"],
    is_on: |scene, _| scene.file.block.foundation.is_some(),
};

/// Where η comes from.
pub const IMPACT: Effect = Effect {
    name: "impact",
    summary: "velocity after an impact: given, of the bare block's momentum, or with what stays engaged",
    equation: &[
        "θ̇⁺ = η θ̇⁻",
        "geometric:        η = 1 − 2 sin²α/λ",
        "momentum-balance: (λ + n σ ℓ₊²) θ̇⁺ = (λ η_geometric + n σ ℓ₊ ℓ₋) θ̇⁻, n flywheels locked to the rack through the impact",
        "friction needed:  (1 − η)/(1 + η) (cos α + n (Σσ + μ_g) ℓ(0))/sin α, Σσ locked to the rack, n of the pulley; horizontal",
        "                  0.46 for η = 0.85 and α = 10°, 0.69 with σ = 0.5 engaged at the centre of mass",
    ],
    source: "Eq. 3 of the paper; Housner 1963; moment of momentum about the new toe with the inerter's impulse, derived here",
    keys: &["block.restitution"],
    // On a base that gives nothing hits.
    is_on: |scene, index| scene.file.block.foundation.is_none() && !settings(scene, index, IMPACT.keys).is_empty(),
};
