//! A scene's text: the keys of `docs/scenes.md` that decide the motion. Other tables are not looked at.

use serde::Deserialize;

/// A scene.
#[derive(Clone, Debug, Deserialize)]
pub struct Scene {
    /// `[block]`.
    pub block: BlockTable,
    /// `[[device]]`, one run each.
    pub device: Vec<DeviceTable>,
    /// `[[ground]]`, summed.
    #[serde(default)]
    pub ground: Vec<MotionTable>,
    /// `[[vertical]]`, summed.
    #[serde(default)]
    pub vertical: Vec<MotionTable>,
    /// `[run]`.
    #[serde(default)]
    pub run: RunTable,
    /// `[output]`.
    #[serde(default)]
    pub output: OutputTable,
}

impl Scene {
    /// Reads a scene.
    ///
    /// # Errors
    /// What does not parse, in words.
    pub fn parse(text: &str) -> Result<Scene, String> {
        toml::from_str(text).map_err(|error| error.to_string())
    }

    /// With a block that is less slender by four roundings.
    pub fn nudged(&self) -> Scene {
        let mut scene = self.clone();
        scene.block.slenderness_deg *= 1.0 + 4.0 * f64::EPSILON;
        scene
    }
}

/// A number or a word in its place.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub enum NumberOr {
    /// The number.
    Number(f64),
    /// The word.
    Word(String),
}

/// `[block]`.
#[derive(Clone, Debug, Deserialize)]
#[allow(missing_docs)]
pub struct BlockTable {
    pub size_m: Option<f64>,
    pub frequency_parameter_1_s: Option<f64>,
    pub slenderness_deg: f64,
    pub inertia_ratio: Option<f64>,
    pub geometry: Option<String>,
    pub restitution: Option<NumberOr>,
    #[serde(default)]
    pub restitution_scatter: f64,
    #[serde(default)]
    pub restitution_seed: u64,
    pub mass_kg: Option<f64>,
    pub friction_coefficient: Option<f64>,
    pub foundation: Option<FoundationTable>,
    #[serde(default)]
    pub initial_rotation_ratio: f64,
    #[serde(default)]
    pub initial_velocity_ratio: f64,
}

/// `block.foundation`.
#[derive(Clone, Copy, Debug, Deserialize)]
#[allow(missing_docs)]
pub struct FoundationTable {
    pub vertical_frequency_hz: f64,
    pub damping_ratio: f64,
}

/// `[[device]]`.
#[derive(Clone, Debug, Deserialize)]
#[allow(missing_docs)]
pub struct DeviceTable {
    pub kind: String,
    pub mass_ratio: Option<f64>,
    pub inertance_kg: Option<f64>,
    pub flywheels: Option<Vec<GearTable>>,
    pub mount: Option<String>,
    pub mount_height_m: Option<f64>,
    pub pulley_ratio: Option<f64>,
    pub kinematics: Option<String>,
    pub engagement: Option<String>,
    #[serde(default)]
    pub flywheel: FlywheelTable,
    pub clutch: Option<ClutchTable>,
    #[serde(default)]
    pub rack: RackTable,
    #[serde(default)]
    pub actuation: ActuationTable,
    pub inertance_corner_hz: Option<f64>,
    #[serde(default)]
    pub weight: WeightTable,
    pub support_amplification: Option<f64>,
    pub support_frequency_hz: Option<f64>,
    pub support_damping_ratio: Option<f64>,
    pub support_record: Option<MotionTable>,
}

/// One flywheel of a train (Eq. 9).
#[derive(Clone, Copy, Debug, Deserialize)]
#[allow(missing_docs)]
pub struct GearTable {
    pub mass_kg: f64,
    pub radius_m: f64,
    pub pinion_radius_m: f64,
}

/// `flywheel`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default)]
#[allow(missing_docs)]
pub struct FlywheelTable {
    pub viscous_rate_1_s: f64,
    pub dry_deceleration_m_s2: f64,
    pub brake_deceleration_m_s2: Option<NumberOr>,
    pub drag_rate_1_s: f64,
}

/// `clutch`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default)]
#[allow(missing_docs)]
pub struct ClutchTable {
    pub capacity_ratio: Option<f64>,
    pub capacity_n: Option<f64>,
    pub stiffness_ratio: Option<f64>,
    pub stiffness_n_m: Option<f64>,
    pub damping_ratio: Option<f64>,
    pub damping_n_s_m: Option<f64>,
    pub backlash_m: f64,
}

/// `rack`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default)]
#[allow(missing_docs)]
pub struct RackTable {
    pub viscous_1_s: Option<f64>,
    pub viscous_n_s_m: Option<f64>,
    pub dry_friction_ratio: Option<f64>,
    pub dry_friction_n: Option<f64>,
    pub load_friction: f64,
}

/// `actuation`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default)]
#[allow(missing_docs)]
pub struct ActuationTable {
    pub engagement_delay_s: f64,
    pub release_delay_s: f64,
    pub delay: Option<String>,
    pub rise_time_s: f64,
    pub time_constant_s: f64,
    pub dwell_s: f64,
    pub miss_probability: f64,
    pub miss_seed: u64,
}

/// `weight`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default)]
#[allow(missing_docs)]
pub struct WeightTable {
    pub flywheels_ratio: Option<f64>,
    pub flywheels_kg: Option<f64>,
    pub flywheels_on: Option<String>,
    pub rack_ratio: Option<f64>,
    pub rack_kg: Option<f64>,
    pub rack_on: Option<String>,
}

/// `[[ground]]` and `[[vertical]]`.
#[derive(Clone, Debug, Deserialize)]
#[allow(missing_docs)]
pub struct MotionTable {
    /// Not said of a support's record.
    #[serde(default)]
    pub motion: String,
    pub amplitude_ratio: Option<f64>,
    pub amplitude_g: Option<f64>,
    pub amplitude_m_s2: Option<f64>,
    pub velocity_amplitude_m_s: Option<f64>,
    pub frequency_ratio: Option<f64>,
    pub frequency_hz: Option<f64>,
    pub duration_s: Option<f64>,
    pub duration_ratio: Option<f64>,
    pub oscillations: Option<f64>,
    #[serde(default)]
    pub phase_deg: f64,
    pub file: Option<String>,
    pub units: Option<String>,
    pub time_step_s: Option<f64>,
    pub component: Option<String>,
    pub resample_to_s: Option<f64>,
    #[serde(default = "one")]
    pub scale: f64,
    #[serde(default)]
    pub start_s: f64,
}

fn one() -> f64 {
    1.0
}

/// `[run]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default)]
#[allow(missing_docs)]
pub struct RunTable {
    pub free_time_s: Option<f64>,
    pub free_time_ratio: Option<f64>,
    pub rest_speed_ratio: Option<f64>,
}

/// `[output]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default)]
#[allow(missing_docs)]
pub struct OutputTable {
    pub interval_s: Option<f64>,
}
