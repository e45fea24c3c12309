//! Effects between rack and flywheels: engagement, clutch, actuation, flywheel losses.

use sprag_shared::structure::drivetrain::{Actuation, Engagement, FlywheelLosses};

use super::{Effect, EffectKey, settings};

/// Clutches without properties of their own.
pub const ENGAGEMENT: Effect = Effect {
    name: "engagement",
    summary: "flywheels that keep spinning: a rigid clutch by Eq. 10, or a one-way (sprag) clutch that obeys nobody",
    equation: &[
        "rigid:       at engagement (λ + (K + σ) ℓ²) θ̇⁺ = (λ + K ℓ²) θ̇⁻ + σ ℓ w/R, K already locked; w runs on when released",
        "overrunning: locked while the flywheel of this direction resists; lets go when it would drive; locks again at w = ẋ",
    ],
    source: "Makris and Kampas 2016 for the pair; conservation of angular momentum; kinematics of one-way clutches",
    keys: &[EffectKey {
        key: "device.N.engagement",
        default: "\"ideal\"",
        range: "\"ideal\", \"rigid\" or \"overrunning\"; clutched pair",
    }],
    of_device: true,
    is_on: |scene, index| {
        let on = match scene.devices[index].drivetrain.engagement {
            Engagement::Rigid | Engagement::Overrunning => true,
            Engagement::Ideal | Engagement::Friction { .. } | Engagement::Elastic { .. } => false,
        };
        on.then(|| settings(scene, index, ENGAGEMENT.keys))
    },
};

/// Friction and elastic clutches.
pub const CLUTCH: Effect = Effect {
    name: "clutch",
    summary: "plates that slip above a capacity, or a spring with damper and backlash",
    equation: &[
        "friction: stuck while |F| ≤ F_c; else F = F_c sgn(ẋ − w)",
        "elastic:  F = K (z − z_0) + C ż,  ż = ẋ − w, within the backlash F = 0; plates in series hold |F| ≤ F_c",
    ],
    source: "Coulomb friction; Nordin and Gutman 2002 for the dead zone of a backlash",
    keys: &[
        EffectKey { key: "device.N.clutch.capacity_ratio", default: "-", range: "above 0, to 1e6, of the block's weight" },
        EffectKey { key: "device.N.clutch.capacity_n", default: "-", range: "the same in N; needs block.mass_kg" },
        EffectKey { key: "device.N.clutch.stiffness_ratio", default: "-", range: "K/(m p²), above 0; K/m to 1e12 1/s²" },
        EffectKey { key: "device.N.clutch.stiffness_n_m", default: "-", range: "K in N/m; needs block.mass_kg" },
        EffectKey { key: "device.N.clutch.damping_ratio", default: "-", range: "C/(2 √(K m_r)), 0 or more; C/m to 1e6 1/s" },
        EffectKey { key: "device.N.clutch.damping_n_s_m", default: "-", range: "C in N s/m; needs block.mass_kg" },
        EffectKey { key: "device.N.clutch.backlash_m", default: "-", range: "from 0 to 1 m, from contact to contact" },
    ],
    of_device: true,
    is_on: |scene, index| {
        let on = match scene.devices[index].drivetrain.engagement {
            Engagement::Friction { .. } | Engagement::Elastic { .. } => true,
            Engagement::Ideal | Engagement::Rigid | Engagement::Overrunning => false,
        };
        on.then(|| settings(scene, index, CLUTCH.keys))
    },
};

/// Delays of the clutch.
pub const ACTUATION: Effect = Effect {
    name: "actuation",
    summary: "delays, a gradual engagement, a dwell and missed engagements of a clutch that obeys Eq. 10",
    equation: &[
        "inertial delay:  a command takes effect after its delay if it has lasted that long; a shorter one is lost",
        "transport delay: every command takes effect after its delay, in order; up to 8 under way, a ninth takes back the newest",
        "F_c(t) = F_c min(1, t_e/rise) after t_e of engagement",
    ],
    source: "inertial: the current of a coil must build up before the armature moves; misses drawn from the seed",
    keys: &[
        EffectKey { key: "device.N.actuation.engagement_delay_s", default: "0", range: "from 0 to 10 s" },
        EffectKey { key: "device.N.actuation.release_delay_s", default: "0", range: "from 0 to 10 s" },
        EffectKey { key: "device.N.actuation.delay", default: "\"inertial\"", range: "\"inertial\" or \"transport\"" },
        EffectKey { key: "device.N.actuation.rise_time_s", default: "0", range: "from 0 to 10 s; needs a capacity" },
        EffectKey { key: "device.N.actuation.dwell_s", default: "0", range: "from 0 to 10 s" },
        EffectKey { key: "device.N.actuation.miss_probability", default: "0", range: "from 0 to 1" },
        EffectKey { key: "device.N.actuation.miss_seed", default: "0", range: "an integer, 0 or more" },
    ],
    of_device: true,
    is_on: |scene, index| {
        let on = scene.devices[index].drivetrain.actuation != Actuation::default();
        on.then(|| settings(scene, index, ACTUATION.keys))
    },
};

/// What slows flywheels down.
pub const FLYWHEEL: Effect = Effect {
    name: "flywheel",
    summary: "bearing friction of the flywheels, and a brake on released ones",
    equation: &["ẇ = F/m_r − c w − (d + b) sgn w,  w the speed of a rack that moves with it; b only while released"],
    source: "Newton's law of a flywheel with viscous and Coulomb friction; the paper asks for a means to slow it down (Eq. 10)",
    keys: &[
        EffectKey { key: "device.N.flywheel.viscous_rate_1_s", default: "0", range: "from 0 to 1e6 1/s" },
        EffectKey { key: "device.N.flywheel.dry_deceleration_m_s2", default: "0", range: "from 0 to 1e6 m/s²" },
        EffectKey {
            key: "device.N.flywheel.brake_deceleration_m_s2",
            default: "0",
            range: "from 0 to 1e9 m/s² or \"instant\"; not if ideal",
        },
    ],
    of_device: true,
    is_on: |scene, index| {
        let on = scene.devices[index].drivetrain.flywheel != FlywheelLosses::default();
        on.then(|| settings(scene, index, FLYWHEEL.keys))
    },
};
