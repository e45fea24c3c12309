//! `[controller]`: what drives the clutches in a closed loop.

use serde::{Deserialize, Serialize};

use super::error::{Key, SceneError};
use super::schema::KeyOf;
use super::sensors::SensorsTable;
use crate::sensor::Suite;

/// Estimators.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EstimatorName {
    /// The equation of motion, corrected by gyroscope and encoder.
    #[default]
    ModelAided,
    /// Kinematic Kalman filter of gyroscope, accelerometers and encoder.
    Kalman,
    /// Encoder and accelerometers, without a gyroscope.
    Complementary,
}

impl EstimatorName {
    /// All of them.
    pub const ALL: [EstimatorName; 3] = [EstimatorName::ModelAided, EstimatorName::Kalman, EstimatorName::Complementary];

    /// As scenes spell it.
    pub fn name(self) -> &'static str {
        match self {
            EstimatorName::ModelAided => "model-aided",
            EstimatorName::Kalman => "kalman",
            EstimatorName::Complementary => "complementary",
        }
    }
}

/// Clutch laws.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LawName {
    /// Never engaged.
    Passive,
    /// One flywheel, always engaged.
    AlwaysEngaged,
    /// Eq. 10 on the motion as it is estimated to be now.
    Resisting,
    /// Eq. 10 on the motion as it will be when the clutch moves.
    #[default]
    ResistingPredicted,
    /// Engaged when exactly one of a·v > 0 and ü_g·v > 0, or by `sign_table`.
    SignTable,
    /// A table of signs, one row of which counts only while the ground has gained velocity.
    GatedTable,
    /// The safer of engaging and releasing, by the equation of motion.
    LookAhead,
}

impl LawName {
    /// All of them.
    pub const ALL: [LawName; 7] = [
        LawName::Passive,
        LawName::AlwaysEngaged,
        LawName::Resisting,
        LawName::ResistingPredicted,
        LawName::SignTable,
        LawName::GatedTable,
        LawName::LookAhead,
    ];

    /// As scenes spell it.
    pub fn name(self) -> &'static str {
        match self {
            LawName::Passive => "passive",
            LawName::AlwaysEngaged => "always-engaged",
            LawName::Resisting => "resisting",
            LawName::ResistingPredicted => "resisting-predicted",
            LawName::SignTable => "sign-table",
            LawName::GatedTable => "gated-table",
            LawName::LookAhead => "look-ahead",
        }
    }
}

/// What the clutches do after a fault.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SafeStateName {
    /// Both are open: the block alone.
    Released,
    /// The first stays engaged: a plain inerter.
    #[default]
    Engaged,
}

/// What tells the controller which clutches are engaged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FeedbackName {
    /// A switch at each armature.
    #[default]
    Position,
    /// The current through each coil, which goes before the armature.
    Current,
}

/// Share of p²α by which the model-aided estimator takes the equation of motion to be wrong where a scene does not say. `sprag loop-study
/// practice` compares it with larger ones over records and specimens of the sensors: trusting the equation this far lets less of the sensors'
/// noise through to the signs that decide, and peaks are closer to the ideal pair's, also where α, R, σ or η are believed 5 % off.
pub const MODEL_ERROR: f64 = 0.02;

/// What the controller believes of the structure, as factors on the truth, and how far it trusts that.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BeliefTable {
    /// On α.
    pub slenderness_factor: f64,
    /// On R.
    pub size_factor: f64,
    /// On σ.
    pub mass_ratio_factor: f64,
    /// On η.
    pub restitution_factor: f64,
    /// On the clutches' lags behind their currents.
    pub lag_factor: f64,
    /// Share of p²α by which the equation of motion may be wrong (α and R, friction, the other direction): the process noise of the
    /// model-aided estimator.
    pub model_error: f64,
}

impl Default for BeliefTable {
    fn default() -> Self {
        BeliefTable {
            slenderness_factor: 1.0,
            size_factor: 1.0,
            mass_ratio_factor: 1.0,
            restitution_factor: 1.0,
            lag_factor: 1.0,
            model_error: MODEL_ERROR,
        }
    }
}

/// `[controller]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ControllerTable {
    /// Control ticks a second, Hz.
    pub rate_hz: f64,
    /// Estimator.
    pub estimator: EstimatorName,
    /// Law.
    pub law: LawName,
    /// The table of the sign-table law: bit 4 [θ·v > 0] + 2 [a·v > 0] + [ü_g·v > 0].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sign_table: Option<u8>,
    /// Computation and transport, from a sample to the command at the clutch, s. The clutch's own delays are the device's.
    pub latency_s: f64,
    /// Width of the hysteresis of signs, in standard deviations of the estimate.
    pub hysteresis: f64,
    /// Minimum dwell of a command, s.
    pub dwell_s: f64,
    /// Both clutches are engaged while the block stands, so that a flywheel resists from the start of uplift to either side.
    pub engaged_at_rest: bool,
    /// What the clutches do after a fault.
    pub safe_state: SafeStateName,
    /// What tells which clutches are engaged.
    pub feedback: FeedbackName,
    /// From a current that engages to a clutch that has closed, s.
    pub closing_lag_s: f64,
    /// From a current that has died to a clutch that has opened, s.
    pub opening_lag_s: f64,
    /// Pieces of a tick at whose ends the sensors see the plant.
    pub substeps: u32,
    /// Duration of the shock that sensors see at an impact, s.
    pub shock_s: f64,
    /// Stillness before the motion, for self-test and calibration, s.
    pub prelude_s: f64,
    /// Belief about the structure.
    pub belief: BeliefTable,
    /// Sensors.
    pub sensors: SensorsTable,
}

impl Default for ControllerTable {
    fn default() -> Self {
        ControllerTable {
            rate_hz: 2000.0,
            estimator: EstimatorName::default(),
            law: LawName::default(),
            sign_table: None,
            latency_s: 0.0,
            hysteresis: 1.0,
            dwell_s: 0.0,
            engaged_at_rest: true,
            safe_state: SafeStateName::default(),
            feedback: FeedbackName::default(),
            closing_lag_s: 0.0,
            opening_lag_s: 0.0,
            substeps: 4,
            shock_s: 0.001,
            prelude_s: 2.0,
            belief: BeliefTable::default(),
            sensors: SensorsTable::default(),
        }
    }
}

impl ControllerTable {
    /// The sensors; `origin` is the scene's name in messages.
    ///
    /// # Errors
    /// As [`ControllerTable::check`].
    pub fn suite(&self, origin: &str) -> Result<Suite, SceneError> {
        self.check(&|key: &str| Key { origin: origin.to_owned(), key: key.to_owned() })
    }

    /// The sensors, once everything has been checked.
    ///
    /// # Errors
    /// [`SceneError`] names the key.
    pub fn check(&self, key: &KeyOf<'_>) -> Result<Suite, SceneError> {
        let within = |name: &str, value: f64, lowest: f64, highest: f64, range: &str| {
            key(&format!("controller.{name}")).require(value, (lowest..=highest).contains(&value), range)
        };
        within("rate_hz", self.rate_hz, 100.0, 100_000.0, "from 100 to 100000 Hz")?;
        within("latency_s", self.latency_s, 0.0, 0.1, "from 0 to 0.1 s")?;
        within("hysteresis", self.hysteresis, 0.0, 10.0, "from 0 to 10")?;
        within("dwell_s", self.dwell_s, 0.0, 1.0, "from 0 to 1 s")?;
        within("closing_lag_s", self.closing_lag_s, 0.0, 1.0, "from 0 to 1 s")?;
        within("opening_lag_s", self.opening_lag_s, 0.0, 1.0, "from 0 to 1 s")?;
        within("substeps", f64::from(self.substeps), 1.0, 64.0, "from 1 to 64")?;
        within("shock_s", self.shock_s, 0.0, 0.1, "from 0 to 0.1 s")?;
        within("prelude_s", self.prelude_s, 0.0, 60.0, "from 0 to 60 s")?;
        for (name, factor) in [
            ("slenderness_factor", self.belief.slenderness_factor),
            ("size_factor", self.belief.size_factor),
            ("mass_ratio_factor", self.belief.mass_ratio_factor),
            ("restitution_factor", self.belief.restitution_factor),
        ] {
            within(&format!("belief.{name}"), factor, 0.1, 3.0, "from 0.1 to 3")?;
        }
        within("belief.model_error", self.belief.model_error, 1e-4, 10.0, "from 0.0001 to 10")?;
        if self.sign_table.is_some() && self.law != LawName::SignTable {
            return Err(key("controller.sign_table").conflict("only the law \"sign-table\" has a table"));
        }
        self.sensors.resolve(&|name: &str| key(&format!("controller.{name}")))
    }
}
