//! The delay that the clutches are allowed: how long from a command to a clutch that has moved before it costs too much.

use serde::Serialize;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::SceneError;
use sprag_sim::simulation::RunError;

use super::subject::Subject;
use crate::sensitivity::answer::Answer;
use crate::sensitivity::motion::StudyMotion;

/// Delays that are tried, s: those of clutches that one can buy lie between.
pub const DELAYS_S: [f64; 8] = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2];

/// How often the delay is bisected between the last that is allowed and the first that is not.
pub const BISECTIONS: usize = 4;

/// The device with clutches that are later.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Late {
    /// By so much, s.
    pub delay_s: f64,
    /// max |θ|/α over the motions in which it stands, without the delay too; null where there is none.
    pub largest_rotation: Option<f64>,
    /// Motions that overturn it.
    pub overturned: usize,
    /// Those of them that do not without the delay.
    pub newly_overturned: usize,
    /// Motions without a run.
    pub failed: usize,
    /// Whether that is within the tolerance.
    pub allowed: bool,
    /// Number of the motion that decides: the first that overturns it newly, or that of the largest rotation.
    #[serde(skip)]
    pub motion: Option<usize>,
}

/// Why nobody knows which delay is allowed.
#[derive(Debug, thiserror::Error)]
pub enum Unknown {
    /// The scene takes no delay.
    #[error("{0}")]
    Scene(SceneError),
    /// There is nothing to lose.
    #[error("every motion overturns the block without a delay too, so that none can cost anything")]
    NeverStands,
}

/// The delay that is allowed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Allowed {
    /// Delays tried, rising, 0 first.
    pub tried: Vec<Late>,
    /// The longest up to which all that were tried are allowed, s; beyond the scene's own delays.
    pub delay_s: f64,
    /// The least tried that is not, s; null where all are.
    pub lost_at_s: Option<f64>,
}

impl Allowed {
    /// The one that is lost, if any.
    pub fn lost(&self) -> Option<&Late> {
        self.tried.iter().find(|late| !late.allowed)
    }
}

/// Tries `subject`, which comes to `undelayed`, with later clutches: a delay is allowed while no motion overturns it that does not without a
/// delay, and the largest rotation over the motions grows by no more than `tolerance`. Past the first delay that is not, nothing is allowed,
/// for what a delay costs is not monotonic. [`Unknown`] where nobody can know.
///
/// # Errors
/// [`RunError::Interrupted`].
pub fn allowed(
    subject: &Subject,
    undelayed: &[Option<Answer>],
    tolerance: f64,
    motions: &[StudyMotion],
    interrupt: &Interrupt,
    done: &(dyn Fn() + Sync),
) -> Result<Result<Allowed, Unknown>, RunError> {
    if undelayed.iter().flatten().all(|answer| answer.peak.is_none()) {
        return Ok(Err(Unknown::NeverStands));
    }
    let late = |delay_s: f64, answers: &[Option<Answer>]| compared(delay_s, answers, undelayed, tolerance);
    let mut tried = vec![late(0.0, undelayed)];
    let follow = |delay_s: f64| -> Result<Result<Late, Unknown>, RunError> {
        let subject = match subject.later(delay_s) {
            Ok(subject) => subject,
            Err(error) => return Ok(Err(Unknown::Scene(error))),
        };
        let answers = subject.answers(motions, interrupt, done)?;
        let answers: Vec<Option<Answer>> = answers.into_iter().map(Result::ok).collect();
        Ok(Ok(late(delay_s, &answers)))
    };
    for delay_s in DELAYS_S {
        match follow(delay_s)? {
            Ok(late) => tried.push(late),
            Err(error) => return Ok(Err(error)),
        }
    }
    for _ in 0..BISECTIONS {
        // Without a delay everything is as it is, so that 0 is allowed.
        let Some(lost) = tried.iter().position(|late| !late.allowed).filter(|lost| *lost > 0) else { break };
        match follow(0.5 * (tried[lost - 1].delay_s + tried[lost].delay_s))? {
            Ok(late) => tried.insert(lost, late),
            Err(error) => return Ok(Err(error)),
        }
    }
    let lost = tried.iter().position(|late| !late.allowed);
    let delay_s = tried[..lost.unwrap_or(tried.len())].last().map_or(0.0, |late| late.delay_s);
    Ok(Ok(Allowed { delay_s, lost_at_s: lost.map(|lost| tried[lost].delay_s), tried }))
}

fn compared(delay_s: f64, answers: &[Option<Answer>], undelayed: &[Option<Answer>], tolerance: f64) -> Late {
    let overturned = |answer: &Option<Answer>| answer.is_some_and(|answer| answer.outcome.overturned());
    let peak = |answers: &[Option<Answer>]| {
        // A motion that the delay lets it survive has no say: its rotation is no loss.
        let stood = |motion: &usize| undelayed[*motion].is_some_and(|before| before.peak.is_some());
        let peaks = (0..answers.len()).filter(stood).filter_map(|motion| Some((motion, answers[motion]?.peak?)));
        peaks.reduce(|a, b| if b.1 > a.1 { b } else { a })
    };
    let newly: Vec<usize> =
        (0..answers.len()).filter(|&motion| overturned(&answers[motion]) && !overturned(&undelayed[motion])).collect();
    let (largest, before) = (peak(answers), peak(undelayed).map_or(0.0, |(_, peak)| peak));
    let failed = answers.iter().zip(undelayed).filter(|(answer, before)| answer.is_none() && before.is_some()).count();
    Late {
        delay_s,
        largest_rotation: largest.map(|(_, peak)| peak),
        overturned: answers.iter().filter(|answer| overturned(answer)).count(),
        newly_overturned: newly.len(),
        failed,
        allowed: newly.is_empty() && failed == 0 && largest.is_none_or(|(_, peak)| peak <= (1.0 + tolerance) * before),
        motion: newly.first().copied().or(largest.map(|(motion, _)| motion)),
    }
}

#[cfg(test)]
mod tests {
    use sprag_shared::observers::outcome::Outcome;

    use super::*;

    fn answer(peak: Option<f64>) -> Option<Answer> {
        let outcome = if peak.is_some() { Outcome::Safe } else { Outcome::OverturnedAfterImpact };
        Some(Answer { outcome, peak, error: None })
    }

    #[test]
    fn a_delay_is_allowed_while_nothing_more_overturns_and_the_largest_rotation_stays() {
        let before = [answer(Some(0.2)), answer(Some(0.5)), answer(None)];
        let of = |after: [Option<Answer>; 3]| compared(0.01, &after, &before, 0.05);
        // A small rotation may grow below the largest; a motion that overturns anyhow may be survived.
        let late = of([answer(Some(0.5)), answer(Some(0.52)), answer(Some(0.9))]);
        assert!(late.allowed && late.motion == Some(1) && late.overturned == 0);
        let late = of([answer(Some(0.53)), answer(Some(0.5)), answer(None)]);
        assert!(!late.allowed && late.motion == Some(0) && late.newly_overturned == 0);
        let late = of([answer(Some(0.2)), answer(None), answer(None)]);
        assert!(!late.allowed && (late.overturned, late.newly_overturned, late.motion) == (2, 1, Some(1)));
        assert!(!of([None, answer(Some(0.5)), answer(None)]).allowed, "a run that fails proves nothing");
        assert!(compared(0.0, &before, &before, 0.05).allowed);
    }
}
