//! `[controller]`: what drives the clutches in a closed loop.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::error::{KeyPath, SceneError};
use super::schema::KeyOf;
use super::sensors::SensorsTable;
use crate::sensor::{MOST_UNDER_WAY, Sampling, Suite};

/// Estimators.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum EstimatorName {
    /// The equation of motion, corrected by gyroscope and encoder.
    #[default]
    ModelAided,
    /// Kinematic Kalman filter of gyroscope, accelerometers and encoder.
    Kalman,
    /// Complementary filter of encoder and accelerometers, without a gyroscope.
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
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
    /// Eq. 10 with the costate of optimal control, linear in what the controller knows, in the place of the velocity.
    Costate,
}

impl LawName {
    /// All of them.
    pub const ALL: [LawName; 8] = [
        LawName::Passive,
        LawName::AlwaysEngaged,
        LawName::Resisting,
        LawName::ResistingPredicted,
        LawName::SignTable,
        LawName::GatedTable,
        LawName::LookAhead,
        LawName::Costate,
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
            LawName::Costate => "costate",
        }
    }
}

/// What the clutches do after a fault.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SafeStateName {
    /// Both open: the block alone.
    Released,
    /// The first engaged: a plain inerter.
    #[default]
    Engaged,
}

/// What shows the controller which clutches are engaged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FeedbackName {
    /// Switches at the armatures.
    #[default]
    Position,
    /// Currents through the coils, which go before the armatures.
    Current,
}

/// Share of p²α by which the model-aided estimator takes the equation of motion to be wrong where a scene does not say. `sprag loop-study
/// practice` compares it with larger ones over records and specimens of the sensors: trusting the equation this far lets less of the sensors'
/// noise through to the signs that decide, and peaks are closer to the ideal pair's, also where α, R, σ or η are believed 5 % off.
pub const MODEL_ERROR: f64 = 0.02;

/// What the controller believes of the structure, as factors on the truth, and how far it trusts that.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BeliefTable {
    /// Believed over true slenderness α.
    #[schemars(range(min = 0.1, max = 3.0))]
    pub slenderness_factor: f64,
    /// Believed over true size R.
    #[schemars(range(min = 0.1, max = 3.0))]
    pub size_factor: f64,
    /// Believed over true mass ratio σ.
    #[schemars(range(min = 0.1, max = 3.0))]
    pub mass_ratio_factor: f64,
    /// Believed over true restitution η.
    #[schemars(range(min = 0.1, max = 3.0))]
    pub restitution_factor: f64,
    /// Believed over true lags of the clutches behind their currents.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub lag_factor: f64,
    /// Share of p²α by which the equation of motion may be wrong: process noise of the model-aided estimator.
    #[schemars(range(min = 1e-4, max = 10.0))]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ControllerTable {
    /// Control ticks a second.
    #[schemars(range(min = 100.0, max = 1e5))]
    pub rate_hz: f64,
    /// Estimator of the motion.
    pub estimator: EstimatorName,
    /// Clutch law.
    pub law: LawName,
    /// Table of the law "sign-table": bit 4 [θ·v > 0] + 2 [a·v > 0] + [ü_g·v > 0] says whether to engage; 102 without the key.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(example = 102)]
    pub sign_table: Option<u8>,
    /// Time from a sample to the command at the clutch, without the clutch's own delays.
    #[schemars(range(min = 0.0, max = 0.1))]
    pub latency_s: f64,
    /// Width of the hysteresis of signs, in standard deviations of the estimate.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub hysteresis: f64,
    /// Least time between two commands; up to 65535 ticks.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub dwell_s: f64,
    /// Whether both clutches are engaged while the block stands, so that a flywheel resists from the start of uplift.
    pub engaged_at_rest: bool,
    /// State of the clutches after a fault.
    pub safe_state: SafeStateName,
    /// What shows the controller which clutches are engaged.
    pub feedback: FeedbackName,
    /// Time from a current that engages to a closed clutch, with feedback by current.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub closing_lag_s: f64,
    /// Time from a current that has died to an open clutch, with feedback by current.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub opening_lag_s: f64,
    /// Parts of a tick at whose ends the sensors see the motion.
    #[schemars(range(min = 1, max = 64))]
    pub substeps: u32,
    /// Duration of an impact as sensors see it.
    #[schemars(range(min = 0.0, max = 0.1))]
    pub shock_s: f64,
    /// Stillness before the motion, for self-test and calibration.
    #[schemars(range(min = 0.0, max = 60.0))]
    pub prelude_s: f64,
    /// Belief of the controller about the structure, as factors on the truth.
    pub belief: BeliefTable,
    /// Sensors of the controller; ideal without a key.
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

/// Ticks that a controller counts of its least time between two commands, and of the clutches' lags.
const MOST_TICKS: f64 = u16::MAX as f64;

impl ControllerTable {
    /// The sensors; `origin` is the scene's name in messages.
    ///
    /// # Errors
    /// The errors of [`ControllerTable::check`].
    pub fn suite(&self, origin: &str) -> Result<Suite, SceneError> {
        self.check(&|key: &str| KeyPath { origin: origin.to_owned(), key: key.to_owned() })
    }

    /// The sensors, once everything has been checked.
    ///
    /// # Errors
    /// [`SceneError`] names the key.
    pub fn check(&self, key: &KeyOf<'_>) -> Result<Suite, SceneError> {
        if self.sign_table.is_some() && self.law != LawName::SignTable {
            return Err(key("controller.sign_table").conflict("only the law \"sign-table\" has a table"));
        }
        let believed = if self.feedback == FeedbackName::Current { self.belief.lag_factor } else { 0.0 };
        for (name, time, factor) in [
            ("dwell_s", self.dwell_s, 1.0),
            ("closing_lag_s", self.closing_lag_s, believed),
            ("opening_lag_s", self.opening_lag_s, believed),
        ] {
            if (time * factor * self.rate_hz).round() > MOST_TICKS {
                let range = format!("at most {MOST_TICKS} ticks, {} s", MOST_TICKS / (factor * self.rate_hz));
                return Err(key(&format!("controller.{name}")).range(time, &range));
            }
        }
        let suite = self.sensors.resolve(&|name: &str| key(&format!("controller.{name}")))?;
        self.check_continuous(&suite, key)?;
        check_delays(&suite, key)?;
        Ok(suite)
    }

    /// Refuses a continuous sensor, which has a reading at each instant that it sees, with more of them under way than it holds.
    fn check_continuous(&self, suite: &Suite, key: &KeyOf<'_>) -> Result<(), SceneError> {
        let Suite { gyroscope, block_accelerometer, ground_accelerometer, encoder } = suite;
        let sensors: [(&str, &Sampling); 4] = [
            ("gyroscope", &gyroscope.sampling),
            ("block_accelerometer", &block_accelerometer.sampling),
            ("ground_accelerometer", &ground_accelerometer.sampling),
            ("encoder", &encoder.sampling),
        ];
        let (most, seen) = (MOST_UNDER_WAY as f64, self.rate_hz * f64::from(self.substeps));
        for (name, sampling) in sensors {
            if sampling.rate == 0.0 && sampling.latency * seen > most * (1.0 + 1e-12) {
                let range =
                    format!("at most {most} substeps of a tick, {} s, of a sensor that is read continuously", most / seen);
                return Err(key(&format!("controller.sensors.{name}.latency_s")).range(sampling.latency, &range));
            }
        }
        Ok(())
    }
}

/// Longest delay of a sensor from the motion to a reading that estimators carry over, s.
const MOST_DELAY: f64 = 0.1;
/// What is as good as none of it, s.
const NOTHING: f64 = 1e-6;
/// Of sums and quotients, in the last digit that a message shows.
const ROUNDING: f64 = 1e-6;

/// Refuses a sensor whose readings are later, by the key that has the largest share in it.
fn check_delays(suite: &Suite, key: &KeyOf<'_>) -> Result<(), SceneError> {
    let Suite { gyroscope, ground_accelerometer, encoder, .. } = suite;
    for (name, bandwidth, sampling) in [
        // Between its readings a turn would look like none, whoever keeps the clock.
        ("gyroscope", gyroscope.bandwidth, Sampling { synchronous: false, ..gyroscope.sampling }),
        ("ground_accelerometer", ground_accelerometer.bandwidth, ground_accelerometer.sampling),
        ("encoder", 0.0, encoder.sampling),
    ] {
        let [filter, held, latency] = sampling.delays(bandwidth);
        let whole = filter + held + latency;
        if whole > MOST_DELAY {
            let shares = [("bandwidth_hz", bandwidth, filter), ("rate_hz", sampling.rate, held), ("latency_s", latency, latency)];
            let (part, value, share) = shares.into_iter().max_by(|a, b| a.2.total_cmp(&b.2)).unwrap_or(shares[0]);
            // What the others leave; where that is nothing, they are refused next.
            let left = MOST_DELAY - (whole - share);
            let left = if left > NOTHING { left } else { MOST_DELAY };
            let bound = if part == "latency_s" {
                format!("at most {} s", (1e6 * left + ROUNDING).floor() / 1e6)
            } else {
                format!("at least {} Hz", (1e3 * value * share / left - ROUNDING).ceil() / 1e3)
            };
            let range =
                format!("{bound}: low-pass, half of the time between readings and latency may delay by {MOST_DELAY} s in all");
            return Err(key(&format!("controller.sensors.{name}.{part}")).range(value, &range));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> Option<String> {
        let table: ControllerTable = toml::from_str(text).unwrap();
        table.suite("scene").err().map(|error| error.to_string())
    }

    #[test]
    fn a_dwell_of_more_ticks_than_a_controller_counts_is_refused() {
        for fits in ["rate_hz = 65535.0\ndwell_s = 1.0", "rate_hz = 100000.0\ndwell_s = 0.65", "dwell_s = 1.0"] {
            assert_eq!(refused(fits), None);
        }
        assert_eq!(
            refused("rate_hz = 1e5\ndwell_s = 0.8").unwrap(),
            "scene: controller.dwell_s is 0.8, but must be at most 65535 ticks, 0.65535 s"
        );
    }

    #[test]
    fn a_lag_of_more_ticks_than_a_controller_counts_is_refused() {
        for lag in ["closing_lag_s", "opening_lag_s"] {
            let text = |rate: &str, factor: &str| format!("rate_hz = {rate}\n{lag} = 1.0\nbelief = {{ lag_factor = {factor} }}");
            let by_current = |rate: &str, factor: &str| refused(&format!("feedback = 'current'\n{}", text(rate, factor)));
            assert_eq!(by_current("65535.0", "1.0"), None);
            // By position no lag is believed in.
            assert_eq!(refused(&text("1e5", "1.0")), None);
            for (rate, factor, most) in [("1e5", "1.0", "0.65535"), ("1e4", "10.0", "0.65535")] {
                let expected = format!("scene: controller.{lag} is 1, but must be at most 65535 ticks, {most} s");
                assert_eq!(by_current(rate, factor), Some(expected));
            }
        }
    }

    /// 32 readings of a sensor that sees the motion 8,000 times a second cover 4 ms.
    #[test]
    fn a_continuous_sensor_holds_no_more_readings_under_way_than_a_sampled_one() {
        for sensor in ["gyroscope", "block_accelerometer", "ground_accelerometer", "encoder"] {
            let late = |latency: &str| format!("[sensors]\n{sensor} = {{ {latency} }}");
            assert_eq!(refused(&late("latency_s = 0.004")), None);
            assert_eq!(refused(&late("latency_s = 0.005, rate_hz = 2000")), None);
            assert_eq!(refused(&format!("substeps = 1\n{}", late("latency_s = 0.016"))), None);
            assert_eq!(
                refused(&late("latency_s = 0.005")).unwrap(),
                format!(
                    "scene: controller.sensors.{sensor}.latency_s is 0.005, but must be at most 32 substeps of a tick, 0.004 s, of a sensor \
                     that is read continuously"
                )
            );
        }
    }

    /// 1/(2 · 0.1 s) = 5 Hz of readings, or √2/(2π · 0.1 s) = 2.251 Hz of a low-pass, where nothing else delays.
    #[test]
    fn a_sensor_later_than_an_estimator_carries_over_is_refused_by_what_delays_it_most() {
        let why = ": low-pass, half of the time between readings and latency may delay by 0.1 s in all";
        for (sensor, keys, key, value, bound) in [
            ("gyroscope", "rate_hz = 4, synchronous = false", "rate_hz", "4", "at least 5 Hz"),
            ("gyroscope", "rate_hz = 2, synchronous = true", "rate_hz", "2", "at least 5 Hz"),
            ("gyroscope", "bandwidth_hz = 1", "bandwidth_hz", "1", "at least 2.251 Hz"),
            ("ground_accelerometer", "bandwidth_hz = 2, latency_s = 0.002", "bandwidth_hz", "2", "at least 2.297 Hz"),
            ("encoder", "rate_hz = 8, synchronous = false, latency_s = 0.09", "latency_s", "0.09", "at most 0.0375 s"),
            ("encoder", "rate_hz = 1, synchronous = false, latency_s = 0.1", "rate_hz", "1", "at least 5 Hz"),
        ] {
            let table = format!("[sensors]\n{sensor} = {{ {keys} }}");
            let expected = format!("scene: controller.sensors.{sensor}.{key} is {value}, but must be {bound}{why}");
            assert_eq!(refused(&table).unwrap(), expected);
        }
        for fits in [
            "rate_hz = 5, synchronous = false",
            "rate_hz = 1, latency_s = 0.1",
            "rate_hz = 8, synchronous = false, latency_s = 0.0375",
        ] {
            assert_eq!(refused(&format!("[sensors]\nencoder = {{ {fits} }}")), None, "{fits}");
        }
        assert_eq!(refused("[sensors]\nblock_accelerometer = { bandwidth_hz = 1 }"), None);
    }
}
