//! Outcome of a simulation.

use serde::Serialize;
use sprag_shared::math::scalar::Real;
use sprag_shared::motion::state::{BlockState, Phase};
use sprag_shared::observers::peaks::Peaks;

/// The four outcomes of the paper's section 4, in the order of what they ask of the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// The block never uplifts.
    NoRocking,
    /// It rocks and stays up (Region 3).
    Safe,
    /// It overturns before any impact (Region 1).
    OverturnedWithoutImpact,
    /// It overturns after one impact or more (Region 2).
    OverturnedAfterImpact,
}

impl Outcome {
    /// The outcome of a motion that ended in `state` with `peaks`.
    pub fn of<S: Real>(state: &BlockState<S>, peaks: &Peaks<S>) -> Outcome {
        match (state.phase, peaks.rocked, peaks.first_impact) {
            (Phase::Overturned, _, None) => Outcome::OverturnedWithoutImpact,
            (Phase::Overturned, _, Some(_)) => Outcome::OverturnedAfterImpact,
            (_, false, _) => Outcome::NoRocking,
            _ => Outcome::Safe,
        }
    }

    /// As tables and files print it.
    pub fn name(self) -> &'static str {
        match self {
            Outcome::NoRocking => "no-rocking",
            Outcome::Safe => "safe",
            Outcome::OverturnedWithoutImpact => "overturned-without-impact",
            Outcome::OverturnedAfterImpact => "overturned-after-impact",
        }
    }

    /// The outcome that is printed as `name`.
    pub fn from_name(name: &str) -> Option<Outcome> {
        const ALL: [Outcome; 4] =
            [Outcome::NoRocking, Outcome::Safe, Outcome::OverturnedWithoutImpact, Outcome::OverturnedAfterImpact];
        ALL.into_iter().find(|outcome| outcome.name() == name)
    }

    /// The block lies on the ground.
    pub fn overturned(self) -> bool {
        matches!(self, Outcome::OverturnedWithoutImpact | Outcome::OverturnedAfterImpact)
    }
}

impl std::fmt::Display for Outcome {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.pad(self.name())
    }
}
