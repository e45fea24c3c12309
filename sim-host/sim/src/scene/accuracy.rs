//! `[accuracy]`: how a scene is integrated.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_with::skip_serializing_none;
use sprag_loops::Method;
use sprag_shared::method::fixed::{FixedStep, Scheme};

use super::error::SceneError;
use super::schema::{KeyOf, SceneFile};
use crate::accuracy::{Accuracy, Closeness};

/// How a scene is integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MethodName {
    /// Taylor series, in steps of its own choice without a fixed step.
    #[default]
    Taylor,
    /// Runge-Kutta, order 4, fixed steps.
    #[serde(rename = "runge-kutta-4")]
    RungeKutta4,
    /// Semi-implicit Euler, order 1, fixed steps; ideal devices only.
    SemiImplicitEuler,
    /// Exponential midpoint, order 2, fixed steps, for stiff elastic clutches; other devices by Runge-Kutta 4.
    ExponentialMidpoint,
}

impl MethodName {
    /// The scheme of fixed steps, unless the method is that of Taylor series.
    fn scheme(self) -> Option<Scheme> {
        match self {
            MethodName::Taylor => None,
            MethodName::RungeKutta4 => Some(Scheme::RungeKutta4),
            MethodName::SemiImplicitEuler => Some(Scheme::SemiImplicitEuler),
            MethodName::ExponentialMidpoint => Some(Scheme::ExponentialMidpoint),
        }
    }

    /// The method in fixed steps of `step` (s), unless it is that of Taylor series.
    pub fn fixed<S>(self, step: S) -> Option<FixedStep<S>> {
        self.scheme().map(|scheme| FixedStep { scheme, step })
    }

    /// The method in steps of `step` (s).
    pub fn in_steps<S: Copy>(self, step: S) -> Method<S> {
        self.fixed(step).map_or(Method::Series(step), Method::Fixed)
    }

    /// As scenes spell it.
    pub fn name(self) -> &'static str {
        match self {
            MethodName::Taylor => "taylor",
            MethodName::RungeKutta4 => "runge-kutta-4",
            MethodName::SemiImplicitEuler => "semi-implicit-euler",
            MethodName::ExponentialMidpoint => "exponential-midpoint",
        }
    }
}

/// f32 or f64.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Precision {
    /// 64 bits, as on the host.
    #[default]
    F64,
    /// 32 bits, as on the microcontroller; needs a fixed step.
    F32,
}

/// Located inside the step, or noticed at its end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum EventTreatment {
    /// Impacts and clutch switches take place where they are.
    #[default]
    Located,
    /// Impacts and clutch switches are noticed at ends of steps, as in the paper; ideal devices only.
    StepEnd,
}

/// `[accuracy]`.
#[skip_serializing_none]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AccuracyTable {
    /// Accuracy in place of all other keys of the table: a word, or a relative error of the peak rotation; commands with `--accuracy` report errors.
    #[serde(default, with = "level")]
    #[schemars(with = "level::Written")]
    pub level: Option<Accuracy>,
    /// Method of integration.
    #[serde(default)]
    pub method: MethodName,
    /// Floating-point numbers that are used.
    #[serde(default)]
    pub precision: Precision,
    /// Where events take place.
    #[serde(default)]
    pub events: EventTreatment,
    /// Size of the last terms of the series over the rotation that matters.
    #[serde(default = "tight")]
    #[schemars(range(min = 1e-20, max = 1e-2))]
    pub tolerance: f64,
    /// Fixed step, divided where viscous forces or springs of clutches need shorter ones; or give `step_ratio`.
    #[schemars(range(min = 1e-7, max = 1.0))]
    pub step_s: Option<f64>,
    /// Fixed step, in 1/p; or give `step_s`.
    #[schemars(range(min = 1e-7, max = 1.0))]
    pub step_ratio: Option<f64>,
}

fn tight() -> f64 {
    crate::batch::case::TIGHT
}

/// A level is a word or a number.
mod level {
    use schemars::JsonSchema;
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    use crate::accuracy::Accuracy;

    #[derive(Deserialize, JsonSchema)]
    #[serde(untagged)]
    pub enum Written {
        /// "tight" is the most accurate.
        #[schemars(extend("enum" = ["fast", "normal", "tight"]))]
        Word(String),
        /// Relative error of the peak rotation.
        Number(#[schemars(range(min = 1e-15, max = 0.1))] f64),
    }

    pub fn serialize<S: Serializer>(level: &Option<Accuracy>, serializer: S) -> Result<S::Ok, S::Error> {
        match level {
            None => serializer.serialize_none(),
            Some(Accuracy::Error(error)) => serializer.serialize_f64(*error),
            Some(word) => serializer.serialize_str(&word.to_string()),
        }
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Accuracy>, D::Error> {
        // Of what is neither, an untagged enum says nothing that a user knows.
        let text = match Written::deserialize(deserializer).map_err(|_| D::Error::custom(Accuracy::expected()))? {
            Written::Word(word) => word,
            Written::Number(number) => format!("{number:e}"),
        };
        text.parse().map(Some).map_err(D::Error::custom)
    }
}

impl Default for AccuracyTable {
    fn default() -> Self {
        AccuracyTable {
            level: None,
            method: MethodName::Taylor,
            precision: Precision::F64,
            events: EventTreatment::Located,
            tolerance: tight(),
            step_s: None,
            step_ratio: None,
        }
    }
}

impl AccuracyTable {
    /// # Errors
    /// [`SceneError`] names the key.
    pub(super) fn check(&self, key: &KeyOf<'_>) -> Result<(), SceneError> {
        let own = AccuracyTable { level: None, ..self.clone() };
        if self.level.is_some() && own != AccuracyTable::default() {
            return Err(key("accuracy.level").conflict("give a level, or a method and its parameters"));
        }
        if self.step_s.is_some() && self.step_ratio.is_some() {
            return Err(key("accuracy.step_s").conflict("give only one of step_s and step_ratio"));
        }
        let fixed = self.step_s.is_some() || self.step_ratio.is_some();
        if !fixed && self.method != MethodName::Taylor {
            return Err(key("accuracy.step_s").missing("a fixed-step method needs step_s or step_ratio"));
        }
        if !fixed && self.precision == Precision::F32 {
            return Err(key("accuracy.precision").conflict("f32 needs a fixed step: give step_s or step_ratio"));
        }
        if self.events == EventTreatment::StepEnd && self.method == MethodName::Taylor {
            return Err(key("accuracy.events").conflict("step-end events need method runge-kutta-4 or semi-implicit-euler"));
        }
        Ok(())
    }

    /// What only ideal devices, or only elastic clutches, are followed by. `beyond_ideal` is the first key that goes beyond the
    /// ideal device, if any; `elastic` is whether any device has an elastic clutch.
    ///
    /// # Errors
    /// [`SceneError::Conflict`] names the key.
    pub(super) fn check_devices(&self, key: &KeyOf<'_>, beyond_ideal: Option<&str>, elastic: bool) -> Result<(), SceneError> {
        if let Some(effect) = beyond_ideal {
            let reason = |what: &str| format!("{what} is for ideal devices only, and {effect} goes beyond them");
            if self.method == MethodName::SemiImplicitEuler {
                return Err(key("accuracy.method").conflict(&reason("semi-implicit-euler")));
            }
            if self.events == EventTreatment::StepEnd {
                return Err(key("accuracy.events").conflict(&reason("step-end")));
            }
            if self.method == MethodName::Taylor && self.precision == Precision::F32 {
                let reason = reason("taylor in f32") + "; runge-kutta-4 is for all";
                return Err(key("accuracy.method").conflict(&reason));
            }
        }
        if self.method == MethodName::ExponentialMidpoint && !elastic {
            let reason = "exponential-midpoint is for elastic clutches, and no device has one: give a clutch.stiffness_ratio or \
                          another method";
            return Err(key("accuracy.method").conflict(reason));
        }
        Ok(())
    }

    /// Refuses what `file` asks of every instant, where events are looked at once a step and nobody watches between them.
    ///
    /// # Errors
    /// [`SceneError::Conflict`] names the key.
    pub(super) fn check_watched(&self, file: &SceneFile, key: &KeyOf<'_>) -> Result<(), SceneError> {
        if self.events == EventTreatment::StepEnd && file.output.energy {
            return Err(key("output.energy").conflict("the ledger needs accuracy.events = \"located\""));
        }
        if self.events == EventTreatment::StepEnd && file.checks.is_some() {
            return Err(key("checks").conflict("the checks need accuracy.events = \"located\""));
        }
        Ok(())
    }

    /// By the series, as closely as asked.
    pub fn as_close(closeness: Closeness) -> AccuracyTable {
        AccuracyTable { tolerance: closeness.tolerance, ..AccuracyTable::default() }
    }

    /// The fixed step for a block of frequency parameter `p`, s.
    pub fn step(&self, p: f64) -> Option<f64> {
        self.step_s.or(self.step_ratio.map(|ratio| ratio / p))
    }
}
