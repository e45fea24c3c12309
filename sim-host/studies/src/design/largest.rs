//! The largest over the motions, and which motion it is of.

use serde::{Serialize, Serializer};
use sprag_shared::observers::checks::Extreme;

use super::asked::Asked;
use crate::sensitivity::motion::StudyMotion;

/// A largest value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Largest {
    /// The value.
    pub value: f64,
    /// Name of the motion.
    pub motion: String,
    /// When, s; not a number (null in JSON) of a total over a run.
    #[serde(serialize_with = "finite")]
    pub time_s: f64,
    /// Whether it is of the run with the chosen clutches.
    pub chosen_clutches: bool,
}

fn finite<S: Serializer>(time: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    Some(*time).filter(|time| time.is_finite()).serialize(serializer)
}

impl Largest {
    /// In another unit.
    #[must_use]
    pub fn times(&self, factor: f64) -> Largest {
        Largest { value: factor * self.value, ..self.clone() }
    }

    /// The larger of both; this one of equals.
    #[must_use]
    pub fn or_larger(self, other: Option<&Largest>) -> Largest {
        other.filter(|other| other.value > self.value).cloned().unwrap_or(self)
    }
}

/// The largest of `of` over what was `asked` under each of `motions`; of equals the first.
pub fn largest(motions: &[StudyMotion], asked: &[Option<Asked>], of: impl Fn(&Asked) -> Option<Extreme<f64>>) -> Option<Largest> {
    let extremes = motions.iter().zip(asked).filter_map(|(motion, asked)| Some((motion, of(asked.as_ref()?)?)));
    let (motion, extreme) = extremes.reduce(|a, b| if b.1.value > a.1.value { b } else { a })?;
    Some(Largest { value: extreme.value, motion: motion.name.clone(), time_s: extreme.time, chosen_clutches: false })
}
