//! A closed loop whose plant is followed as closely as asked, with the error of its result.
//!
//! Between two ticks the plant is integrated, and that errs; what the controller decides of it is part of the loop, so a decision that falls
//! otherwise for an error of the plant shows in the estimate.

use sprag_shared::motion::state::Phase;
use sprag_shared::observers::outcome::Outcome;

use super::LoopTask;
use super::assemble::LoopFailure;
use super::plant::Extremes;
use super::run::{Ending, TickObserver};
use crate::accuracy::answer::{Comparable, answer};
use crate::accuracy::{Accuracy, Answer, Compared};
use crate::simulation::ErrorReport;

/// One closed loop, with what was seen of it.
#[derive(Clone, Debug)]
pub struct Looped<T> {
    /// How it ended.
    pub ending: Ending,
    /// Largest rotation and acceleration.
    pub extremes: Extremes,
    /// Whoever looked at its ticks.
    pub ticks: T,
    /// α, rad.
    slenderness: f64,
}

impl<T> Looped<T> {
    /// How it ended, in the paper's words.
    pub fn outcome(&self) -> Outcome {
        Outcome::of(&self.ending.motion, &self.extremes.peaks)
    }
}

impl<T> Comparable for Looped<T> {
    type Outcome = Outcome;

    fn compared(&self) -> Compared<Outcome> {
        let stands = self.ending.motion.phase != Phase::Overturned;
        let peaks = &self.extremes.peaks;
        Compared {
            outcome: self.outcome(),
            peak_rotation: stands.then_some(peaks.rotation / self.slenderness),
            // Nobody looks for it in a loop.
            peak_acceleration: None,
            first_impact_time: peaks.first_counted_impact,
        }
    }
}

impl<'a> LoopTask<'a> {
    /// Runs the loop, and shows its ticks to a new `T`.
    ///
    /// # Errors
    /// [`LoopFailure`].
    pub fn looped<T: TickObserver + Default>(&self) -> Result<Looped<T>, LoopFailure> {
        let (mut extremes, mut ticks) = (Extremes::default(), T::default());
        let ending = self.run(&mut extremes, &mut ticks)?;
        Ok(Looped { ending, extremes, ticks, slenderness: self.scene.block.slenderness() })
    }

    /// Runs the loop as accurately as the scene asks. Gives the task as it was run, so that another controller can be put into the same
    /// loop; the error where one was asked for; and what was seen.
    ///
    /// # Errors
    /// [`LoopFailure`].
    pub fn answered<T: TickObserver + Default>(self) -> Result<(LoopTask<'a>, Option<ErrorReport>, Looped<T>), LoopFailure> {
        let Some(level) = self.scene.file.accuracy.level else {
            let looped = self.looped()?;
            return Ok((self, None, looped));
        };
        let found: Answer<Looped<T>> = self.answer(level)?;
        let task = LoopTask { closeness: Some(found.closeness), ..self };
        Ok((task, Some(ErrorReport::of(&found)), found.result))
    }

    /// Runs the loop as accurately as `level` asks.
    fn answer<T: TickObserver + Default>(&self, level: Accuracy) -> Result<Answer<Looped<T>>, LoopFailure> {
        answer(level, |closeness| LoopTask { closeness: Some(closeness), ..*self }.looped())
    }
}
