//! A device's numbers, per mass of the block with what rides on it.

use crate::block::{Block, GRAVITY, Lever, Mount, Restitution};
use crate::scene::{ActuationTable, BlockTable, DeviceTable, NumberOr};

/// How flywheels hang on the rack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coupling {
    /// No inerter.
    None,
    /// One flywheel, always locked.
    Inerter,
    /// The paper's clutched pair.
    Ideal,
    /// Locked while engaged; an exchange of momentum at engagement.
    Rigid,
    /// One-way clutches that nobody commands.
    Overrunning,
    /// Plates that slip above the capacity.
    Plates,
    /// A spring and damper with backlash, and plates in series.
    Elastic {
        /// K, 1/s².
        stiffness: f64,
        /// C, 1/s.
        damping: f64,
        /// Half the backlash, m.
        half_play: f64,
    },
    /// Viscous slip.
    Slip {
        /// Force over the difference of the speeds, 1/s.
        damping: f64,
        /// Of one flywheel that is always engaged.
        permanent: bool,
    },
}

/// A device.
#[derive(Clone, Debug)]
pub struct Device {
    /// Kind of coupling.
    pub coupling: Coupling,
    /// σ.
    pub inertance: f64,
    /// ℓ(θ).
    pub lever: Lever,
    /// 1 with the θ̇² term of the terminals' acceleration, 0 without (Eq. 11).
    pub consistent: f64,
    /// Mass of a guided rack, μ_g.
    pub guided: f64,
    /// r: acceleration of the terminal on the support, as travel of the other one, over the support's.
    pub support: f64,
    /// Viscous friction of the rack, 1/s.
    pub rack_viscous: f64,
    /// Dry friction of the rack, m/s².
    pub rack_dry: f64,
    /// Friction of the mesh over the force of a locked flywheel.
    pub mesh: f64,
    /// Viscous rate of a flywheel, 1/s.
    pub bearing_viscous: f64,
    /// Dry deceleration of a flywheel, m/s².
    pub bearing_dry: f64,
    /// Deceleration by the brake of an open flywheel, m/s²; may be infinite.
    pub brake: f64,
    /// Force of an open clutch over the difference of the speeds, 1/s.
    pub drag: f64,
    /// Capacity of the plates, m/s²; infinite without plates.
    pub capacity: f64,
    /// When the lines by which the capacity rises begin and end after engagement, s, and what share of it there is then.
    pub rise: Vec<(f64, f64)>,
    /// Delay from a command to engage, s.
    pub engagement_delay: f64,
    /// Delay from a command to release, s.
    pub release_delay: f64,
    /// Commands that are shorter than these arrive too.
    pub transport: bool,
    /// Time for which a clutch that moved stays, s.
    pub dwell: f64,
    /// Probability of a missed engagement.
    pub miss_probability: f64,
    /// And its seed.
    pub miss_seed: u64,
}

impl Device {
    /// Clutches that obey Eq. 10.
    pub fn is_commanded(&self) -> bool {
        !matches!(
            self.coupling,
            Coupling::None | Coupling::Inerter | Coupling::Overrunning | Coupling::Slip { permanent: true, .. }
        )
    }

    /// Its clutches move later than they are commanded.
    pub fn is_late(&self) -> bool {
        self.engagement_delay.max(self.release_delay).max(self.dwell) > 0.0
    }

    /// Start and end of the line by which a capacity rises so long after engagement, each with its share.
    pub fn line(&self, since: f64) -> Option<[(f64, f64); 2]> {
        self.rise.windows(2).find(|line| since < line[1].0 * (1.0 - 1e-12)).map(|line| [line[0], line[1]])
    }

    /// Locking is all there is: no plates that might slip.
    pub fn only_locks(&self) -> bool {
        matches!(self.coupling, Coupling::Inerter | Coupling::Ideal | Coupling::Rigid)
    }

    /// The block that moves, and the device on it.
    ///
    /// # Errors
    /// A missing or unknown value, in words.
    pub fn of(table: &DeviceTable, bare: &Block, block_table: &BlockTable) -> Result<(Block, Device), String> {
        let mass = || block_table.mass_kg.ok_or("block.mass_kg".to_owned());
        let either = |ratio: Option<f64>, absolute: Option<f64>, unit: f64| -> Result<Option<f64>, String> {
            match (ratio, absolute) {
                (ratio, None) => Ok(ratio),
                (None, Some(value)) => Ok(Some(value / (mass()? * unit))),
                _ => Err("a value and its ratio".to_owned()),
            }
        };
        let mount = mount(table)?;
        // What rides on the block, at the height of the mount.
        let weight = &table.weight;
        let on = |seat: &Option<String>| seat.as_deref() == Some("block");
        let flywheels = either(weight.flywheels_ratio, weight.flywheels_kg, 1.0)?.unwrap_or(0.0);
        let rack = either(weight.rack_ratio, weight.rack_kg, 1.0)?.unwrap_or(0.0);
        let (carried, guided) = match (on(&weight.flywheels_on), on(&weight.rack_on)) {
            (true, false) => (flywheels, 0.0),
            (false, true) => (rack, 0.0),
            (false, false) => (0.0, rack),
            (true, true) => return Err("rack and flywheels both on the block".to_owned()),
        };
        let height = match mount {
            Mount::CentreOfMass => bare.size * bare.slenderness.cos(),
            Mount::TyingPoint(height, _) => height,
            Mount::BaseCorners(_) => 0.0,
        };
        let block = if carried > 0.0 { bare.carrying(carried, height) } else { *bare };
        let per = 1.0 / (1.0 + carried);
        let inertance = match (table.mass_ratio, table.inertance_kg, &table.flywheels) {
            (Some(ratio), None, None) => ratio,
            (None, Some(kg), None) => kg / mass()?,
            (None, None, Some(train)) => train_inertance(train) / mass()?,
            (None, None, None) if table.kind == "none" => 0.0,
            _ => return Err("one of mass_ratio, inertance_kg, flywheels".to_owned()),
        };
        let clutch = table.clutch.clone().unwrap_or_default();
        let p = bare.frequency_parameter();
        let stiffness = either(clutch.stiffness_ratio.map(|ratio| ratio * p * p), clutch.stiffness_n_m, 1.0)?;
        let coupling = match (table.kind.as_str(), &table.clutch, table.engagement.as_deref(), stiffness) {
            ("none", ..) => Coupling::None,
            (kind, None, None, _) if table.inertance_corner_hz.is_some() => {
                let rate = 2.0 * std::f64::consts::PI * table.inertance_corner_hz.unwrap_or(0.0);
                Coupling::Slip { damping: per * inertance * rate, permanent: kind == "inerter" }
            }
            ("inerter", ..) => Coupling::Inerter,
            ("clutched-pair", None, None | Some("ideal"), _) => Coupling::Ideal,
            ("clutched-pair", None, Some("rigid"), _) => Coupling::Rigid,
            ("clutched-pair", None, Some("overrunning"), _) => Coupling::Overrunning,
            ("clutched-pair", Some(_), None, None) => Coupling::Plates,
            ("clutched-pair", Some(_), None, Some(stiffness)) => {
                let critical = 2.0 * (stiffness * inertance).sqrt();
                let damping = either(clutch.damping_ratio.map(|ratio| ratio * critical), clutch.damping_n_s_m, 1.0)?;
                Coupling::Elastic {
                    stiffness: per * stiffness,
                    damping: per * damping.unwrap_or(0.0),
                    half_play: clutch.backlash_m / 2.0,
                }
            }
            other => return Err(format!("device {other:?}")),
        };
        let carried = table.support_amplification.is_some_and(|factor| factor != 1.0)
            || table.support_frequency_hz.is_some()
            || table.support_record.is_some();
        let remembers = !matches!(coupling, Coupling::None | Coupling::Inerter | Coupling::Ideal);
        let follows = carried && matches!(coupling, Coupling::Ideal);
        let consistent = if remembers || follows || table.kinematics.as_deref() == Some("consistent") { 1.0 } else { 0.0 };
        let capacity = either(clutch.capacity_ratio, clutch.capacity_n, GRAVITY)?.map_or(f64::INFINITY, |ratio| ratio * GRAVITY);
        let brake = match &table.flywheel.brake_deceleration_m_s2 {
            None => 0.0,
            Some(NumberOr::Number(value)) => *value,
            Some(NumberOr::Word(word)) if word == "instant" => f64::INFINITY,
            Some(NumberOr::Word(word)) => return Err(format!("brake {word}")),
        };
        let ActuationTable { engagement_delay_s, release_delay_s, dwell_s, miss_probability, miss_seed, .. } = table.actuation;
        let transport = match table.actuation.delay.as_deref() {
            None | Some("inertial") => false,
            Some("transport") => true,
            Some(other) => return Err(format!("delay {other}")),
        };
        let viscous = either(table.rack.viscous_1_s, table.rack.viscous_n_s_m, 1.0)?.unwrap_or(0.0);
        let dry = either(table.rack.dry_friction_ratio, table.rack.dry_friction_n, GRAVITY)?.unwrap_or(0.0);
        let device = Device {
            coupling,
            inertance: per * inertance,
            lever: Lever::of(mount, bare, &block),
            consistent,
            guided: per * guided,
            support: match mount {
                Mount::CentreOfMass => 1.0,
                Mount::TyingPoint(_, pulley) => pulley,
                Mount::BaseCorners(_) => 0.0,
            },
            rack_viscous: per * viscous,
            rack_dry: per * dry * GRAVITY,
            mesh: table.rack.load_friction,
            bearing_viscous: table.flywheel.viscous_rate_1_s,
            bearing_dry: table.flywheel.dry_deceleration_m_s2,
            brake,
            drag: per * inertance * table.flywheel.drag_rate_1_s,
            capacity: per * capacity,
            rise: rise(table.actuation.rise_time_s, table.actuation.time_constant_s),
            engagement_delay: engagement_delay_s,
            release_delay: release_delay_s,
            transport,
            dwell: dwell_s,
            miss_probability,
            miss_seed,
        };
        Ok((block, device))
    }

    /// θ̇⁺/θ̇⁻ at an impact of `block` with `locked` flywheels on the rack:
    /// (λ + (μ_g + nσ) ℓ₊²) θ̇⁺ = (λ η_geometric + (μ_g + nσ) ℓ₊ ℓ₋) θ̇⁻.
    pub fn restitution(&self, block: &Block, rule: Restitution, locked: usize) -> f64 {
        let geometric = block.geometric_restitution();
        match rule {
            Restitution::Constant(value) => value,
            Restitution::Geometric => geometric,
            Restitution::MomentumBalance => {
                // An ideal clutch takes no momentum, so it does not carry any through an impact either.
                let count = if self.coupling == Coupling::Ideal { 0.0 } else { locked as f64 };
                let (lever, _) = self.lever.at(1.0, block.slenderness);
                let moving = (self.guided + count * self.inertance) * lever * lever;
                (block.inertia * geometric + moving * self.lever.carries_over) / (block.inertia + moving)
            }
        }
    }
}

/// A straight rise, or one by 32 lines through 1 − e^(−t/τ) where the root of what is missing is a multiple of 1/32, the last of which
/// goes on for 2τ after the last but one.
fn rise(linear: f64, time_constant: f64) -> Vec<(f64, f64)> {
    if time_constant == 0.0 {
        return if linear > 0.0 { vec![(0.0, 0.0), (linear, 1.0)] } else { Vec::new() };
    }
    let root = |k: u32| 1.0 - f64::from(k) / 32.0;
    let mut lines: Vec<(f64, f64)> = (0..32).map(|k| (-2.0 * time_constant * root(k).ln(), 1.0 - root(k) * root(k))).collect();
    lines.push((lines[31].0 + 2.0 * time_constant, 1.0));
    lines
}

/// Eq. 9.
fn train_inertance(train: &[crate::scene::GearTable]) -> f64 {
    let mut gain = 1.0;
    let mut sum = 0.0;
    for wheel in train {
        gain *= (wheel.radius_m / wheel.pinion_radius_m).powi(2);
        sum += 0.5 * wheel.mass_kg * gain;
    }
    sum
}

fn mount(table: &DeviceTable) -> Result<Mount, String> {
    let pulley = table.pulley_ratio.unwrap_or(1.0);
    match (table.mount.as_deref(), table.mount_height_m) {
        (None | Some("centre-of-mass"), None) => Ok(Mount::CentreOfMass),
        (Some("tying-point"), Some(height)) => Ok(Mount::TyingPoint(height, pulley)),
        (Some("base-corners"), None) => Ok(Mount::BaseCorners(pulley)),
        other => Err(format!("mount {other:?}")),
    }
}
