//! Outcome of a motion: which of the four of the paper (section 4).

use serde::Serialize;

use super::peaks::Peaks;
use crate::math::scalar::Real;
use crate::motion::state::{BlockState, Phase};

/// The four outcomes of the paper's section 4, in the order of what they ask of the ground, and where the model ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// The block never uplifts.
    NoRocking,
    /// It rocks and stays up (Region 3).
    Safe,
    /// It overturns before any impact, however weak (Region 1).
    OverturnedWithoutImpact,
    /// It overturns after one impact or more (Region 2).
    OverturnedAfterImpact,
    /// The toe of a block that slides leaves the ground, where the run ends: the flight is not modelled.
    LiftedOff,
}

impl Outcome {
    /// Those of the paper, in the order of their numbers: each of a block that cannot slide.
    pub const ALL: [Outcome; 4] =
        [Outcome::NoRocking, Outcome::Safe, Outcome::OverturnedWithoutImpact, Outcome::OverturnedAfterImpact];

    /// The outcome of a motion that `rocked` or not, with an `impact`, however weak, or without, and `overturned` or not.
    pub fn new(rocked: bool, impact: bool, overturned: bool) -> Outcome {
        match (overturned, impact, rocked) {
            (true, false, _) => Outcome::OverturnedWithoutImpact,
            (true, true, _) => Outcome::OverturnedAfterImpact,
            (false, _, false) => Outcome::NoRocking,
            (false, _, true) => Outcome::Safe,
        }
    }

    /// The outcome of a motion that ended in `state` with `peaks`.
    pub fn of<S: Real>(state: &BlockState<S>, peaks: &Peaks<S>) -> Outcome {
        Outcome::new(peaks.rocked, peaks.first_impact.is_some(), state.phase == Phase::Overturned)
    }

    /// Name of the outcome in tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Outcome::NoRocking => "no-rocking",
            Outcome::Safe => "safe",
            Outcome::OverturnedWithoutImpact => "overturned-without-impact",
            Outcome::OverturnedAfterImpact => "overturned-after-impact",
            Outcome::LiftedOff => "lifted-off",
        }
    }

    /// The outcome that is printed as `name`.
    pub fn from_name(name: &str) -> Option<Outcome> {
        Outcome::ALL.into_iter().find(|outcome| outcome.name() == name)
    }

    /// The run went to its end: it has peaks.
    pub fn stands(self) -> bool {
        matches!(self, Outcome::NoRocking | Outcome::Safe)
    }

    /// The block lies on the ground.
    pub fn overturned(self) -> bool {
        matches!(self, Outcome::OverturnedWithoutImpact | Outcome::OverturnedAfterImpact)
    }
}

impl core::fmt::Display for Outcome {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        formatter.pad(self.name())
    }
}
