//! `[[device]]`: which device, where, and what is real about it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_with::skip_serializing_none;
use sprag_shared::observers::ledger::{Account, Clutching};
use sprag_shared::structure::Structure;
use sprag_shared::structure::added_mass::AddedMass;
use sprag_shared::structure::block::Block;
use sprag_shared::structure::device::{Device, DeviceKind, KinematicsKind};
use sprag_shared::structure::drivetrain::{Drivetrain, Engagement};
use sprag_shared::structure::inertance::{Flywheel, inertance_of_train};
use sprag_shared::structure::mount::Mount;

use super::drivetrain::{ActuationTable, ClutchTable, EngagementName, FlywheelLossesTable, RackTable};
use super::error::SceneError;
use super::schema::KeyOf;
use super::support::SupportRecordTable;
use super::weight::WeightTable;

/// A device of a scene, every value within its range.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneDevice {
    /// Its name in tables and legends.
    pub name: String,
    /// Kind, mass ratio, mount, kinematics.
    pub device: Device,
    /// What it has beyond the ideal device; [`Drivetrain::default`] without.
    pub drivetrain: Drivetrain,
    /// What of it rides on the block.
    pub added_mass: AddedMass,
}

impl SceneDevice {
    /// Resolves `table`, one of `all` of a scene with `block` of `block_mass` (kg); `key` names the keys of this table.
    ///
    /// # Errors
    /// [`SceneError`] names the key.
    pub(super) fn resolve(
        table: &DeviceTable,
        all: &[DeviceTable],
        block: &Block,
        block_mass: Option<f64>,
        key: &KeyOf<'_>,
    ) -> Result<SceneDevice, SceneError> {
        let mut device = resolve_inerter(table, block_mass, key)?;
        let (mut drivetrain, mut added_mass) = (Drivetrain::default(), AddedMass::NONE);
        if device.kind != DeviceKind::None {
            drivetrain = table.drivetrain(&device, block, block_mass, key)?;
            if let Some(weight) = &table.weight {
                (added_mass, drivetrain.rack.guided_mass_ratio) = weight.resolve(&device, block, block_mass, key)?;
            }
        }
        if drivetrain.needs_consistent_kinematics(device.kind) {
            if table.kinematics == Some(KinematicsName::Paper) {
                let reason = if drivetrain.support.moves() {
                    "clutches that follow a support of its own motion need consistent kinematics: the speed of the paper's rack is not \
                     the integral of its acceleration"
                } else {
                    "flywheels with a speed of their own need consistent kinematics: the paper's rack would run away from them"
                };
                return Err(key("kinematics").conflict(reason));
            }
            device.kinematics = KinematicsKind::Consistent;
        }
        drivetrain.check().map_err(|error| key(&table.key_of(error.parameter)).range(error.value, error.range))?;
        let name = table.name.clone().unwrap_or_else(|| default_name(table, all));
        Ok(SceneDevice { name, device, drivetrain, added_mass })
    }

    /// Whether it has clutches that take commands, and coils with them: those of a pair, unless they are one-way.
    pub fn takes_commands(&self) -> bool {
        self.device.kind == DeviceKind::ClutchedPair && self.drivetrain.engagement != Engagement::Overrunning
    }

    /// Whether it is the ideal device of the paper, however mounted and whatever it weighs.
    pub fn is_ideal(&self) -> bool {
        self.drivetrain == Drivetrain::default()
    }

    /// What a ledger and checks have to know of it on a `loaded` block.
    pub fn account(&self, loaded: &Structure) -> Account {
        Account {
            clutching: match (self.device.kind, self.drivetrain.engagement) {
                (DeviceKind::ClutchedPair, Engagement::Ideal) => Clutching::Ideal,
                (DeviceKind::ClutchedPair, Engagement::Rigid) => Clutching::Rigid,
                (DeviceKind::ClutchedPair, _) | (DeviceKind::Inerter, Engagement::Viscous { .. }) => Clutching::Real,
                _ => Clutching::Permanent,
            },
            mass_ratio: loaded.device.mass_ratio,
            rack_mass_ratio: self.drivetrain.rack.guided_mass_ratio / (1.0 + self.added_mass.mass_ratio),
            rack_riding: self
                .device
                .mount
                .support_ratio()
                .map_or(0.0, |n| (1.0 - n) * (self.drivetrain.support.amplification - 1.0)),
            on_support: self.drivetrain.support.moves(),
            drags: self.drivetrain.flywheel.drag_rate > 0.0,
            springs: matches!(self.drivetrain.engagement, Engagement::Elastic { .. }),
        }
    }
}

/// `[[device]]`.
#[skip_serializing_none]
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DeviceTable {
    /// Kind of device.
    pub kind: Kind,
    /// Name in tables and legends; its kind without the key.
    #[schemars(example = &"pair")]
    pub name: Option<String>,
    /// Mass ratio σ of inertance and block; or give `inertance_kg` or `flywheels`.
    #[schemars(range(min = 0.0, max = 1e4))]
    pub mass_ratio: Option<f64>,
    /// Inertance m_r; or give `mass_ratio` or `flywheels`.
    #[schemars(range(min = 0.0))]
    pub inertance_kg: Option<f64>,
    /// Flywheel train (Eq. 9), the first on the rack; or give `mass_ratio` or `inertance_kg`.
    #[schemars(example = EXAMPLE_TRAIN)]
    pub flywheels: Option<Vec<FlywheelTable>>,
    /// Where the device is attached (Figure 3).
    #[schemars(extend("default" = MountName::default()))]
    pub mount: Option<MountName>,
    /// Height of a tying point above the base.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub mount_height_m: Option<f64>,
    /// Travel of the terminal over that of the tying point or corner; of "tying-point" and "base-corners".
    #[schemars(extend("exclusiveMinimum" = 0.0, "default" = 1.0))]
    pub pulley_ratio: Option<f64>,
    /// Acceleration of the terminals; "consistent" for flywheels that keep their speed, and clutches that follow a support.
    #[schemars(extend("default" = KinematicsName::Paper))]
    pub kinematics: Option<KinematicsName>,
    /// How the flywheels of a clutched pair are coupled, in the place of `clutch`.
    #[schemars(extend("default" = EngagementName::default()))]
    pub engagement: Option<EngagementName>,
    /// Losses of the flywheels, as deceleration of a rack that moves with them.
    pub flywheel: Option<FlywheelLossesTable>,
    /// Properties of the clutches of a clutched pair: a capacity makes plates that slip, a stiffness a spring.
    pub clutch: Option<ClutchTable>,
    /// Friction that the rack meets, whatever the clutch does.
    pub rack: Option<RackTable>,
    /// Delays between a command and a clutch that has obeyed it.
    pub actuation: Option<ActuationTable>,
    /// Corner f_c of an inertance that falls as 1/√(1 + (f/f_c)²), by viscous slip; in the place of `engagement` and `clutch`.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 1000.0))]
    pub inertance_corner_hz: Option<f64>,
    /// Gravitational mass of the device, and what it rides on.
    pub weight: Option<WeightTable>,
    /// Horizontal acceleration of the support that carries the device over the ground's; 1 where it moves with the ground.
    #[schemars(range(min = -10.0, max = 10.0), extend("default" = 1.0))]
    pub support_amplification: Option<f64>,
    /// Natural frequency of a support that is a damped oscillator on the ground, so heavy that the device does not move it.
    #[schemars(range(min = 0.1, max = 1e3))]
    pub support_frequency_hz: Option<f64>,
    /// Damping ratio of the oscillator that the support is.
    #[schemars(range(min = 0.005, max = 0.9))]
    pub support_damping_ratio: Option<f64>,
    /// Recorded motion of the support itself.
    pub support_record: Option<SupportRecordTable>,
}

impl DeviceTable {
    /// The ideal device of this kind, at the centre of mass; without a mass ratio yet.
    pub fn of(kind: Kind) -> DeviceTable {
        DeviceTable { kind, ..DeviceTable::default() }
    }
}

/// Kinds of devices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// No device.
    #[default]
    None,
    /// One inerter.
    Inerter,
    /// Two clutched inerters (Eq. 10).
    ClutchedPair,
}

impl Kind {
    /// As scenes spell it.
    pub fn name(self) -> &'static str {
        match self {
            Kind::None => "none",
            Kind::Inerter => "inerter",
            Kind::ClutchedPair => "clutched-pair",
        }
    }
}

impl From<Kind> for DeviceKind {
    fn from(kind: Kind) -> DeviceKind {
        match kind {
            Kind::None => DeviceKind::None,
            Kind::Inerter => DeviceKind::Inerter,
            Kind::ClutchedPair => DeviceKind::ClutchedPair,
        }
    }
}

/// A train of one flywheel.
const EXAMPLE_TRAIN: [FlywheelTable; 1] = [FlywheelTable { mass_kg: 3.0, radius_m: 0.4, pinion_radius_m: 0.1 }];

/// A flywheel and its pinion.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlywheelTable {
    /// Mass of the flywheel.
    #[schemars(range(min = 0.0))]
    pub mass_kg: f64,
    /// Radius of the flywheel.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub radius_m: f64,
    /// Radius of its pinion.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub pinion_radius_m: f64,
}

impl FlywheelTable {
    /// As the core has it.
    pub fn wheel(&self) -> Flywheel {
        Flywheel { mass: self.mass_kg, radius: self.radius_m, pinion_radius: self.pinion_radius_m }
    }
}

/// Mounts of Figure 3.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MountName {
    /// Horizontal, at the centre of mass.
    #[default]
    CentreOfMass,
    /// Horizontal, at `mount_height_m` on the centre line.
    TyingPoint,
    /// Vertical, at both base corners.
    BaseCorners,
}

impl MountName {
    /// As scenes spell it.
    pub fn name(self) -> &'static str {
        match self {
            MountName::CentreOfMass => "centre-of-mass",
            MountName::TyingPoint => "tying-point",
            MountName::BaseCorners => "base-corners",
        }
    }
}

/// Paper or consistent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum KinematicsName {
    /// ü = R ℓ θ̈ (Eq. 11).
    Paper,
    /// With the θ̇² term, which conserves energy.
    Consistent,
}

impl From<KinematicsName> for KinematicsKind {
    fn from(name: KinematicsName) -> KinematicsKind {
        match name {
            KinematicsName::Paper => KinematicsKind::Paper,
            KinematicsName::Consistent => KinematicsKind::Consistent,
        }
    }
}

/// A name for a device without one, among `all` devices of its scene.
pub(super) fn default_name(table: &DeviceTable, all: &[DeviceTable]) -> String {
    let kind = match table.kind {
        Kind::None => "none",
        Kind::Inerter => "inerter",
        Kind::ClutchedPair => "clutched pair",
    };
    if all.iter().filter(|other| other.kind == table.kind && other.name.is_none()).count() < 2 {
        return kind.to_owned();
    }
    // Several of a kind are distinguished by what they differ in most often.
    let position = all.iter().position(|other| std::ptr::eq(other, table)).unwrap_or(0);
    match table.mass_ratio {
        Some(ratio) => format!("{kind} {} (σ = {ratio})", position + 1),
        None => format!("{kind} {}", position + 1),
    }
}

/// The device itself: kind, mass ratio, mount and kinematics.
///
/// # Errors
/// [`SceneError`] names the key.
fn resolve_inerter(table: &DeviceTable, block_mass: Option<f64>, key: &KeyOf<'_>) -> Result<Device, SceneError> {
    let kind = DeviceKind::from(table.kind);
    if kind == DeviceKind::None {
        // Those that are given, in their order.
        let keys = serde_json::to_value(table).unwrap_or_default();
        let stray = keys.as_object().and_then(|keys| keys.keys().find(|name| !["kind", "name"].contains(&name.as_str())));
        return match stray {
            Some(name) => Err(key(name).conflict("a device of kind \"none\" has no inerter")),
            None => Ok(Device::NONE),
        };
    }
    let mass = || block_mass.ok_or_else(|| key("inertance_kg").conflict("an inertance in kg needs block.mass_kg"));
    let mass_ratio = match (table.mass_ratio, table.inertance_kg, &table.flywheels) {
        (Some(ratio), None, None) => ratio,
        (None, Some(inertance), None) => inertance / mass()?,
        (None, None, Some(wheels)) => {
            let train: Vec<Flywheel> = wheels.iter().map(FlywheelTable::wheel).collect();
            inertance_of_train(&train).map_err(|error| key("flywheels").parameter(&error))? / mass()?
        }
        (None, None, None) => return Err(key("mass_ratio").missing("mass_ratio, inertance_kg or flywheels")),
        _ => return Err(key("mass_ratio").conflict("give only one of mass_ratio, inertance_kg and flywheels")),
    };
    let mount = resolve_mount(table.mount.unwrap_or_default(), table.mount_height_m, table.pulley_ratio, key)?;
    let kinematics = table.kinematics.map_or(KinematicsKind::Paper, KinematicsKind::from);
    Ok(Device { kind, mass_ratio, mount, kinematics })
}

/// The mount of these keys; ranges are left to [`Mount::lever`].
///
/// # Errors
/// [`SceneError`] names the key.
pub fn resolve_mount(
    mount: MountName,
    height: Option<f64>,
    pulley_ratio: Option<f64>,
    key: &KeyOf<'_>,
) -> Result<Mount, SceneError> {
    let ratio = pulley_ratio.unwrap_or(1.0);
    match (mount, height) {
        (MountName::TyingPoint, Some(height)) => Ok(Mount::TyingPoint { height, pulley_ratio: ratio }),
        (MountName::TyingPoint, None) => Err(key("mount_height_m").missing("the height of the tying point above the base, in m")),
        (_, Some(_)) => Err(key("mount_height_m").conflict("only a mount of kind \"tying-point\" has a height")),
        (MountName::BaseCorners, None) => Ok(Mount::BaseCorners { pulley_ratio: ratio }),
        (MountName::CentreOfMass, None) if pulley_ratio.is_some() => {
            Err(key("pulley_ratio").conflict("a pulley needs a mount of kind \"tying-point\" or \"base-corners\""))
        }
        (MountName::CentreOfMass, None) => Ok(Mount::CentreOfMass),
    }
}
