//! Effects between rack and flywheels: engagement, clutch, actuation, flywheel losses.

use sprag_shared::structure::drivetrain::{Actuation, Engagement, FlywheelLosses};

use super::Effect;

/// Clutches without properties of their own.
pub const ENGAGEMENT: Effect = Effect {
    name: "engagement",
    summary: "flywheels that keep spinning: a rigid clutch by Eq. 10, or a one-way (sprag) clutch that obeys nobody",
    equation: &[
        "rigid:       at engagement (λ + (K + σ) ℓ²) θ̇⁺ = (λ + K ℓ²) θ̇⁻ + σ ℓ w/R, K already locked; w runs on when released",
        "overrunning: locked while the flywheel of this direction resists; lets go when it would drive; locks again at w = ẋ",
    ],
    source: "Makris and Kampas 2016 for the pair; conservation of angular momentum; kinematics of one-way clutches",
    keys: &["device.N.engagement"],
    is_on: |scene, index| match scene.devices[index].drivetrain.engagement {
        Engagement::Rigid | Engagement::Overrunning => true,
        Engagement::Ideal | Engagement::Friction { .. } | Engagement::Elastic { .. } | Engagement::Viscous { .. } => false,
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
        "device.N.clutch.capacity_ratio",
        "device.N.clutch.capacity_n",
        "device.N.clutch.stiffness_ratio",
        "device.N.clutch.stiffness_n_m",
        "device.N.clutch.damping_ratio",
        "device.N.clutch.damping_n_s_m",
        "device.N.clutch.backlash_m",
    ],
    is_on: |scene, index| match scene.devices[index].drivetrain.engagement {
        Engagement::Friction { .. } | Engagement::Elastic { .. } => true,
        Engagement::Ideal | Engagement::Rigid | Engagement::Overrunning | Engagement::Viscous { .. } => false,
    },
};

/// Viscous slip.
pub const SLIP: Effect = Effect {
    name: "slip",
    summary: "inertance that falls with frequency, by viscous slip between rack and flywheel",
    equation: &[
        "F = c (ẋ − w),  m_r ẇ = F less bearings,  c = 2π f_c m_r,  while engaged",
        "at a frequency f: |F| = m_r |ẍ|/√(1 + (f/f_c)²), which lags ẍ by arctan(f/f_c)",
    ],
    source: "a dashpot in series (Maxwell); Madhamshetty and Manimala 2018 measured a fall below 5 Hz",
    keys: &["device.N.inertance_corner_hz"],
    is_on: |scene, index| matches!(scene.devices[index].drivetrain.engagement, Engagement::Viscous { .. }),
};

/// Delays of the clutch.
pub const ACTUATION: Effect = Effect {
    name: "actuation",
    summary: "delays, a gradual engagement, a dwell and missed engagements of a clutch that obeys Eq. 10",
    equation: &[
        "inertial delay:  a command takes effect after its delay if it has lasted that long; a shorter one is lost",
        "transport delay: every command takes effect after its delay, in order; up to 8 under way, a ninth takes back the newest",
        "F_c(t) = F_c min(1, t_e/rise) or F_c (1 − e^(−t_e/τ)) after t_e of engagement",
    ],
    source: "inertial: the current of a coil must build up before the armature moves; misses drawn from the seed",
    keys: &[
        "device.N.actuation.engagement_delay_s",
        "device.N.actuation.release_delay_s",
        "device.N.actuation.delay",
        "device.N.actuation.rise_time_s",
        "device.N.actuation.time_constant_s",
        "device.N.actuation.dwell_s",
        "device.N.actuation.miss_probability",
        "device.N.actuation.miss_seed",
    ],
    is_on: |scene, index| scene.devices[index].drivetrain.actuation != Actuation::default(),
};

/// What slows flywheels down.
pub const FLYWHEEL: Effect = Effect {
    name: "flywheel",
    summary: "bearing friction of the flywheels, a brake on released ones, and the drag of open clutches",
    equation: &[
        "ẇ = F/m_r − c w − (d + b) sgn w,  w the speed of a rack that moves with it; b only while released",
        "F = c_d m_r (ẋ − w) while released, by the drag of the open clutch",
    ],
    source: "Newton's law with viscous and Coulomb friction; the paper asks for a means to slow it down (Eq. 10); drag torques of data sheets",
    keys: &[
        "device.N.flywheel.viscous_rate_1_s",
        "device.N.flywheel.dry_deceleration_m_s2",
        "device.N.flywheel.brake_deceleration_m_s2",
        "device.N.flywheel.drag_rate_1_s",
    ],
    is_on: |scene, index| scene.devices[index].drivetrain.flywheel != FlywheelLosses::default(),
};
