//! Outcome and peak of a block with one device under each motion: in lanes where they know it, by the core elsewhere.

use rayon::prelude::*;
use sprag_ensemble::shaken::Shaken;
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::structure::block::Block;
use sprag_sim::accuracy::ErrorEstimate;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::side_by_side::{Followed, Subject, followed};
use sprag_sim::simulation::{DeviceRun, RunError, simulate_for_study};

use super::motion::StudyMotion;

/// Motions that one task takes: enough to keep lanes full.
const TOGETHER: usize = 32;

/// What a run comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// Outcome of the run.
    pub outcome: Outcome,
    /// max |θ|/α; `None` when overturned.
    pub peak: Option<f64>,
    /// How accurate that is, where it was asked for.
    pub error: Option<ErrorEstimate>,
}

/// Reasons why there is no answer.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Missing {
    Interrupted,
    Impossible(String),
    Failed(String),
}

/// What becomes of `subject` under each of `motions`, with their `vertical` ones or without, on rayon's threads; `done` is called after each.
pub(crate) fn answers(
    subject: &Subject,
    vertical: bool,
    motions: &[StudyMotion],
    interrupt: &Interrupt,
    done: &(dyn Fn() + Sync),
) -> Vec<Result<Answer, Missing>> {
    let together = |motions: &[StudyMotion]| -> Vec<Result<Answer, Missing>> {
        if interrupt.is_set() {
            return vec![Err(Missing::Interrupted); motions.len()];
        }
        let known: Vec<_> = motions.iter().map(|motion| motion.shaking(vertical)).collect();
        let runs: Vec<_> = known.iter().flatten().map(|shaking| (subject, *shaking)).collect();
        let mut found = followed(&runs).into_iter();
        let in_lanes: Vec<_> = known.iter().map(|known| known.and_then(|_| found.next().flatten())).collect();
        let answer = |(motion, in_lanes): (&StudyMotion, Option<Followed>)| {
            let answer = match in_lanes {
                Some(followed) => Ok(Answer::of_shaken(&followed.motion, &subject.scene.block)),
                None => by_core(subject, motion, vertical, interrupt),
            };
            done();
            answer
        };
        motions.par_iter().zip(in_lanes).map(answer).collect()
    };
    motions.par_chunks(TOGETHER).flat_map(together).collect()
}

/// The answer to `motion` by the core.
fn by_core(subject: &Subject, motion: &StudyMotion, vertical: bool, interrupt: &Interrupt) -> Result<Answer, Missing> {
    let ground = match &motion.with_vertical {
        Ok(ground) if vertical => ground,
        Err(reason) if vertical => return Err(Missing::Impossible(reason.clone())),
        _ => &motion.ground,
    };
    let runs = simulate_for_study(&subject.scene, ground, interrupt).map_err(|error| match error {
        RunError::Interrupted => Missing::Interrupted,
        error => Missing::Failed(error.to_string()),
    })?;
    match runs.first() {
        Some(run) => Ok(Answer::of_run(run)),
        None => Err(Missing::Failed("no device".to_owned())),
    }
}

impl Answer {
    pub(crate) fn of_run(run: &DeviceRun) -> Answer {
        Answer { outcome: run.outcome, peak: run.peak_rotation, error: run.error.map(|report| report.estimate) }
    }

    fn of_shaken(shaken: &Shaken, block: &Block) -> Answer {
        let peak = shaken.relative_peaks(block).map(|(rotation, _)| rotation);
        Answer { outcome: shaken.outcome(), peak, error: None }
    }
}
