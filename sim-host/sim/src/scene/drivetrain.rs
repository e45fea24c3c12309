//! The tables of a `[[device]]` that take it beyond the ideal device: `engagement`, `flywheel`, `clutch`, `rack`, `actuation`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_with::skip_serializing_none;
use sprag_shared::math;
use sprag_shared::structure::block::{Block, GRAVITY};
use sprag_shared::structure::device::Device;
use sprag_shared::structure::drivetrain::{Actuation, Delay, Drivetrain, Engagement, FlywheelLosses, Rack};
use sprag_shared::structure::mount::Mount;

use super::device::{DeviceTable, Kind};
use super::error::SceneError;
use super::schema::KeyOf;

/// How flywheels are coupled by a clutch without properties of its own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum EngagementName {
    /// The paper's: a released flywheel stops at once.
    #[default]
    Ideal,
    /// By Eq. 10, with an exchange of momentum.
    Rigid,
    /// One-way (sprag) clutch, which holds by itself and obeys nobody.
    Overrunning,
}

/// `flywheel`: what slows it down, as deceleration of a rack that moves with it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlywheelLossesTable {
    /// Rate at which an idle flywheel slows down, as e^(−rate t).
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub viscous_rate_1_s: f64,
    /// Deceleration by dry friction of the bearings.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub dry_deceleration_m_s2: f64,
    /// Deceleration by a brake on released flywheels; not of an inerter, an ideal or an overrunning clutch.
    #[serde(default)]
    pub brake_deceleration_m_s2: BrakeValue,
    /// Rate at which drag of an open clutch, rigid or plates with a delay, takes a flywheel to a steady rack: e^(−rate t).
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e3))]
    pub drag_rate_1_s: f64,
}

/// A number or a word.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "brake_deceleration_m_s2 must be a number in m/s² or \"instant\"")]
pub enum BrakeValue {
    /// Deceleration, m/s².
    Number(#[schemars(range(min = 0.0, max = 1e9))] f64),
    /// "instant".
    Word(BrakeWord),
}

/// The word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BrakeWord {
    /// Stopped at once.
    Instant,
}

impl Default for BrakeValue {
    fn default() -> Self {
        BrakeValue::Number(0.0)
    }
}

impl BrakeValue {
    /// m/s², or infinite.
    fn deceleration(&self) -> f64 {
        match self {
            BrakeValue::Number(deceleration) => *deceleration,
            BrakeValue::Word(BrakeWord::Instant) => f64::INFINITY,
        }
    }
}

/// `clutch`: a capacity makes plates that slip, a stiffness a spring.
#[skip_serializing_none]
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClutchTable {
    /// Largest force at the rack over the block's weight; or give `capacity_n`.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 1e6))]
    pub capacity_ratio: Option<f64>,
    /// Largest force at the rack; or give `capacity_ratio`.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub capacity_n: Option<f64>,
    /// Stiffness K at the rack, K/(mp²); or give `stiffness_n_m`.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub stiffness_ratio: Option<f64>,
    /// Stiffness K at the rack; or give `stiffness_ratio`.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub stiffness_n_m: Option<f64>,
    /// Damping C at the rack, ζ = C/(2 √(K m_r)); or give `damping_n_s_m`. With a stiffness.
    #[schemars(range(min = 0.0))]
    pub damping_ratio: Option<f64>,
    /// Damping C at the rack; or give `damping_ratio`. With a stiffness.
    #[schemars(range(min = 0.0))]
    pub damping_n_s_m: Option<f64>,
    /// Play at the rack from contact to contact. With a stiffness.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub backlash_m: Option<f64>,
}

/// `rack`: friction that the rack meets, whatever the clutch does.
#[skip_serializing_none]
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RackTable {
    /// Viscous force over the block's mass and the velocity; or give `viscous_n_s_m`.
    #[schemars(range(min = 0.0, max = 1e3))]
    pub viscous_1_s: Option<f64>,
    /// Viscous force over the velocity; or give `viscous_1_s`.
    #[schemars(range(min = 0.0))]
    pub viscous_n_s_m: Option<f64>,
    /// Dry friction over the block's weight; or give `dry_friction_n`.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub dry_friction_ratio: Option<f64>,
    /// Dry friction; or give `dry_friction_ratio`.
    #[schemars(range(min = 0.0))]
    pub dry_friction_n: Option<f64>,
    /// Friction of rack and pinion over the force of a locked flywheel in their mesh; of an inerter, an ideal or a rigid clutch.
    #[schemars(extend("exclusiveMaximum" = 1.0), range(min = 0.0))]
    pub load_friction: Option<f64>,
}

/// Of a clutch's delays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DelayName {
    /// A command that does not last as long as its delay is lost.
    #[default]
    Inertial,
    /// Every command takes effect after its delay, in order; up to 8 are under way.
    Transport,
}

impl From<DelayName> for Delay {
    fn from(name: DelayName) -> Delay {
        match name {
            DelayName::Inertial => Delay::Inertial,
            DelayName::Transport => Delay::Transport,
        }
    }
}

/// `actuation`: what lies between a command and a clutch that has obeyed it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ActuationTable {
    /// Time from the command to engagement; in a closed loop below 5 s.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub engagement_delay_s: f64,
    /// Time from the command to release; in a closed loop below 5 s.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub release_delay_s: f64,
    /// Kind of these two delays.
    pub delay: DelayName,
    /// Time from first contact to full capacity, linearly; or give `time_constant_s`. Needs a capacity.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub rise_time_s: f64,
    /// Time constant τ of a capacity that rises as 1 − e^(−t/τ), that of a coil; or give `rise_time_s`. Needs a capacity.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub time_constant_s: f64,
    /// Time for which a clutch that has just moved stays so.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub dwell_s: f64,
    /// Probability that an engagement is missed.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub miss_probability: f64,
    /// Seed of which engagements are missed.
    pub miss_seed: u64,
}

/// A quantity per mass of the block from the one of two keys that is given: `direct` already is one, `absolute` is divided by
/// `unit` times the block's mass.
pub(super) fn either(
    key: &KeyOf<'_>,
    direct: (&str, Option<f64>),
    absolute: (&str, Option<f64>),
    block_mass: Option<f64>,
    unit: f64,
) -> Result<Option<f64>, SceneError> {
    match (direct.1, absolute.1) {
        (Some(_), Some(_)) => Err(key(direct.0).conflict(&format!("give only one of {} and {}", direct.0, absolute.0))),
        (given, None) => Ok(given),
        (None, Some(value)) => match block_mass {
            Some(mass) => Ok(Some(value / (mass * unit))),
            None => Err(key(absolute.0).conflict("a value in kg or N needs block.mass_kg")),
        },
    }
}

impl DeviceTable {
    /// What these tables make of `device`, which has an inerter; its weight left out.
    ///
    /// # Errors
    /// [`SceneError`] names the key; ranges are left to [`Drivetrain::check`].
    pub(super) fn drivetrain(
        &self,
        device: &Device,
        block: &Block,
        block_mass: Option<f64>,
        key: &KeyOf<'_>,
    ) -> Result<Drivetrain, SceneError> {
        let needs_pair = |name: &str, reason: &str| {
            Err(key(name).conflict(&format!("{reason}: a device of kind \"{}\" has no clutch", self.kind.name())))
        };
        if self.kind != Kind::ClutchedPair {
            if self.engagement.is_some() {
                return needs_pair("engagement", "only a clutch engages");
            }
            if self.clutch.is_some() {
                return needs_pair("clutch", "a clutch's properties without a clutch");
            }
            if self.actuation.is_some() {
                return needs_pair("actuation", "only a clutch is commanded");
            }
        }
        if let (Some(_), Some(_)) = (self.engagement, &self.clutch) {
            return Err(key("engagement").conflict("the properties of clutch already say how it engages: give only one of both"));
        }
        let engagement = match (&self.clutch, self.engagement.unwrap_or_default()) {
            _ if self.inertance_corner_hz.is_some() => self.slip(key)?,
            (Some(clutch), _) => clutch.engagement(device.mass_ratio, block, block_mass, key)?,
            (None, EngagementName::Ideal) => Engagement::Ideal,
            (None, EngagementName::Rigid) => Engagement::Rigid,
            (None, EngagementName::Overrunning) => Engagement::Overrunning,
        };
        let actuation = self.actuation(engagement, key)?;
        let flywheel = self.flywheel_losses(engagement, &actuation, key)?;
        let rack = match &self.rack {
            Some(rack) => rack.resolve(engagement, block_mass, key)?,
            None => Rack::default(),
        };
        let mut drivetrain = Drivetrain { engagement, flywheel, rack, actuation, ..Drivetrain::default() };
        drivetrain.support = self.support(&drivetrain, device, key)?;
        if let Some(name) = self.beyond_ideal(&drivetrain).filter(|name| *name != "rack") {
            if device.mass_ratio == 0.0 {
                return Err(key(name).conflict("there is no flywheel: the mass ratio is 0"));
            }
            let remembers = engagement != Engagement::Ideal || actuation != Actuation::default();
            if remembers && let Mount::BaseCorners { .. } = device.mount {
                let reason = match engagement {
                    Engagement::Ideal => {
                        "a clutch that obeys late needs a horizontal mount: at the base corners each corner would have clutches of \
                         its own"
                    }
                    _ => {
                        "a flywheel that keeps its speed needs a horizontal mount: at the base corners each corner would have \
                         flywheels of its own"
                    }
                };
                return Err(key(if name == "flywheel" { "mount" } else { name }).conflict(reason));
            }
        }
        Ok(drivetrain)
    }

    /// The first of the device's keys that takes it beyond the ideal device, if any.
    pub fn beyond_ideal(&self, drivetrain: &Drivetrain) -> Option<&'static str> {
        let ideal = Drivetrain::default();
        let coupling = match drivetrain.engagement {
            Engagement::Viscous { .. } => "inertance_corner_hz",
            _ if self.clutch.is_some() => "clutch",
            _ => "engagement",
        };
        [
            (coupling, drivetrain.engagement != ideal.engagement),
            ("actuation", drivetrain.actuation != ideal.actuation),
            ("flywheel", drivetrain.flywheel != ideal.flywheel),
            ("weight", drivetrain.rack.guided_mass_ratio != 0.0),
            ("rack", drivetrain.rack != ideal.rack),
            (self.support_key().unwrap_or("support_amplification"), drivetrain.support != ideal.support),
        ]
        .into_iter()
        .find_map(|(name, is_on)| is_on.then_some(name))
    }

    /// Viscous slip in the place of a clutch's other properties.
    fn slip(&self, key: &KeyOf<'_>) -> Result<Engagement, SceneError> {
        for (name, given) in [("engagement", self.engagement.is_some()), ("clutch", self.clutch.is_some())] {
            if given {
                return Err(
                    key(name).conflict("inertance_corner_hz already says that a clutch slips viscously: give only one of both")
                );
            }
        }
        Ok(Engagement::Viscous { corner_frequency: self.inertance_corner_hz.unwrap_or_default() })
    }

    fn flywheel_losses(
        &self,
        engagement: Engagement,
        actuation: &Actuation,
        key: &KeyOf<'_>,
    ) -> Result<FlywheelLosses, SceneError> {
        let Some(table) = &self.flywheel else {
            return Ok(FlywheelLosses::default());
        };
        let brake_deceleration = table.brake_deceleration_m_s2.deceleration();
        if brake_deceleration != 0.0 {
            let name = "flywheel.brake_deceleration_m_s2";
            if self.kind == Kind::Inerter {
                return Err(key(name).conflict("a brake acts on a released flywheel, and that of a single inerter never is"));
            }
            if engagement == Engagement::Ideal {
                let reason =
                    "the ideal clutch stops a released flywheel at once, so a brake needs another engagement or a clutch";
                return Err(key(name).conflict(reason));
            }
        }
        let drag_rate = table.drag_rate_1_s;
        if drag_rate != 0.0 {
            let name = "flywheel.drag_rate_1_s";
            if self.kind == Kind::Inerter {
                return Err(key(name).conflict("an open clutch drags, and a single inerter has none"));
            }
            if !matches!(engagement, Engagement::Rigid | Engagement::Friction { .. }) {
                let reason = "the drag of an open clutch is known for a rigid one and for plates: give engagement = \"rigid\" or \
                              clutch.capacity_ratio without a stiffness";
                return Err(key(name).conflict(reason));
            }
            if actuation.engagement_delay == 0.0 && actuation.release_delay == 0.0 {
                let reason = "a clutch that drags needs actuation.engagement_delay_s or release_delay_s: without either Eq. 10 would engage \
                              and release it at one instant of a turn, over and over";
                return Err(key(name).conflict(reason));
            }
            if brake_deceleration.is_infinite() {
                let reason = "no drag moves a flywheel that is stopped at once: give brake_deceleration_m_s2 a number";
                return Err(key(name).conflict(reason));
            }
            if self.rack.as_ref().is_some_and(|rack| rack.load_friction.unwrap_or_default() != 0.0) {
                return Err(key(name).conflict("the drag of an open clutch is not known beside rack.load_friction"));
            }
        }
        Ok(FlywheelLosses {
            viscous_rate: table.viscous_rate_1_s,
            dry_deceleration: table.dry_deceleration_m_s2,
            brake_deceleration,
            drag_rate,
        })
    }

    fn actuation(&self, engagement: Engagement, key: &KeyOf<'_>) -> Result<Actuation, SceneError> {
        let Some(table) = &self.actuation else {
            return Ok(Actuation::default());
        };
        if engagement == Engagement::Overrunning {
            return Err(key("actuation").conflict("nobody commands an overrunning clutch"));
        }
        let has_capacity = match engagement {
            Engagement::Friction { .. } => true,
            Engagement::Elastic { capacity_ratio, .. } => capacity_ratio != f64::INFINITY,
            _ => false,
        };
        for (name, time) in [("actuation.rise_time_s", table.rise_time_s), ("actuation.time_constant_s", table.time_constant_s)] {
            if time != 0.0 && !has_capacity {
                let reason = "only a capacity can rise: give clutch.capacity_ratio or clutch.capacity_n";
                return Err(key(name).conflict(reason));
            }
        }
        if table.rise_time_s != 0.0 && table.time_constant_s != 0.0 {
            let reason = "a capacity rises linearly or exponentially: give only one of rise_time_s and time_constant_s";
            return Err(key("actuation.time_constant_s").conflict(reason));
        }
        Ok(Actuation {
            engagement_delay: table.engagement_delay_s,
            release_delay: table.release_delay_s,
            // Of no delay there is one kind.
            delay: if table.engagement_delay_s == 0.0 && table.release_delay_s == 0.0 {
                Delay::Inertial
            } else {
                table.delay.into()
            },
            rise_time: table.rise_time_s,
            time_constant: table.time_constant_s,
            dwell: table.dwell_s,
            miss_probability: table.miss_probability,
            // A seed of nothing is no effect.
            miss_seed: if table.miss_probability == 0.0 { 0 } else { table.miss_seed },
        })
    }

    /// The key from which a parameter of [`Drivetrain::check`] comes, and the parameter too where its value is not the key's.
    pub(super) fn key_of(&self, parameter: &str) -> String {
        let (clutch, rack) = (self.clutch.as_ref(), self.rack.as_ref());
        let of =
            |absolute: bool, name: &str, other: &str| if absolute { format!("{name} as {parameter}") } else { other.to_owned() };
        match parameter {
            "guided_mass_ratio" => "weight.rack_ratio".to_owned(),
            "rack viscous" => of(rack.is_some_and(|r| r.viscous_n_s_m.is_some()), "rack.viscous_n_s_m", "rack.viscous_1_s"),
            "rack dry_ratio" => {
                of(rack.is_some_and(|r| r.dry_friction_n.is_some()), "rack.dry_friction_n", "rack.dry_friction_ratio")
            }
            "load_friction" => "rack.load_friction".to_owned(),
            "corner_frequency" => "inertance_corner_hz".to_owned(),
            "capacity_ratio" => of(clutch.is_some_and(|c| c.capacity_n.is_some()), "clutch.capacity_n", "clutch.capacity_ratio"),
            "stiffness" if clutch.is_some_and(|c| c.stiffness_n_m.is_some()) => of(true, "clutch.stiffness_n_m", ""),
            "stiffness" => of(true, "clutch.stiffness_ratio", ""),
            "damping" if clutch.is_some_and(|c| c.damping_n_s_m.is_some()) => of(true, "clutch.damping_n_s_m", ""),
            "damping" => of(true, "clutch.damping_ratio", ""),
            "backlash" => "clutch.backlash_m".to_owned(),
            "viscous_rate" => "flywheel.viscous_rate_1_s".to_owned(),
            "dry_deceleration" => "flywheel.dry_deceleration_m_s2".to_owned(),
            "brake_deceleration" => "flywheel.brake_deceleration_m_s2".to_owned(),
            "drag_rate" => "flywheel.drag_rate_1_s".to_owned(),
            "miss_probability" => "actuation.miss_probability".to_owned(),
            "support_amplification" => parameter.to_owned(),
            "support_motion" => self.support_key().unwrap_or(parameter).to_owned(),
            time => format!("actuation.{time}_s"),
        }
    }
}

impl ClutchTable {
    fn engagement(
        &self,
        mass_ratio: f64,
        block: &Block,
        block_mass: Option<f64>,
        key: &KeyOf<'_>,
    ) -> Result<Engagement, SceneError> {
        let either = |direct, absolute, unit| either(key, direct, absolute, block_mass, unit);
        let capacity = either(("clutch.capacity_ratio", self.capacity_ratio), ("clutch.capacity_n", self.capacity_n), GRAVITY)?;
        let p2 = block.frequency_parameter_squared();
        let stiffness = either(
            ("clutch.stiffness_ratio", self.stiffness_ratio.map(|ratio| ratio * p2)),
            ("clutch.stiffness_n_m", self.stiffness_n_m),
            1.0,
        )?;
        let Some(stiffness) = stiffness else {
            let stray = [
                ("clutch.damping_ratio", self.damping_ratio.is_some()),
                ("clutch.damping_n_s_m", self.damping_n_s_m.is_some()),
                ("clutch.backlash_m", self.backlash_m.is_some()),
            ];
            if let Some((name, _)) = stray.iter().find(|(_, given)| *given) {
                let reason = "only an elastic clutch has damping and play: give clutch.stiffness_ratio or clutch.stiffness_n_m";
                return Err(key(name).conflict(reason));
            }
            let capacity_ratio =
                capacity.ok_or_else(|| key("clutch").missing("a capacity (capacity_ratio, capacity_n) or a stiffness"))?;
            return Ok(Engagement::Friction { capacity_ratio });
        };
        // C = 2ζ √(K m_r), each over the block's mass.
        let critical = 2.0 * math::square_root((stiffness * mass_ratio).max(0.0));
        let damping = either(
            ("clutch.damping_ratio", self.damping_ratio.map(|ratio| ratio * critical)),
            ("clutch.damping_n_s_m", self.damping_n_s_m),
            1.0,
        )?;
        Ok(Engagement::Elastic {
            stiffness,
            damping: damping.unwrap_or(0.0),
            backlash: self.backlash_m.unwrap_or(0.0),
            capacity_ratio: capacity.unwrap_or(f64::INFINITY),
        })
    }
}

impl RackTable {
    fn resolve(&self, engagement: Engagement, block_mass: Option<f64>, key: &KeyOf<'_>) -> Result<Rack, SceneError> {
        let load_friction = self.load_friction.unwrap_or_default();
        if load_friction != 0.0 && !matches!(engagement, Engagement::Ideal | Engagement::Rigid) {
            let reason = "friction that grows with load is known for flywheels that are locked to the rack: those of an inerter, an ideal \
                          or a rigid clutch, without an inertance_corner_hz";
            return Err(key("rack.load_friction").conflict(reason));
        }
        let either = |direct, absolute, unit| either(key, direct, absolute, block_mass, unit);
        let viscous = either(("rack.viscous_1_s", self.viscous_1_s), ("rack.viscous_n_s_m", self.viscous_n_s_m), 1.0)?;
        let dry =
            either(("rack.dry_friction_ratio", self.dry_friction_ratio), ("rack.dry_friction_n", self.dry_friction_n), GRAVITY)?;
        let (viscous, dry_ratio) = (viscous.unwrap_or(0.0), dry.unwrap_or(0.0));
        Ok(Rack { guided_mass_ratio: 0.0, viscous, dry_ratio, load_friction })
    }
}
