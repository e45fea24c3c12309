//! A closed loop whose plant is followed as closely as asked, with the error of its result.
//!
//! Between two ticks the plant is integrated, and that errs; what the controller decides of it is part of the loop, so a decision that falls
//! otherwise for an error of the plant shows in the estimate.

use sprag_shared::observers::outcome::Outcome;
use sprag_shared::structure::error::ParameterError;

use super::LoopTask;
use super::assemble::LoopFailure;
use super::disturbance::Disturbance;
use super::driver::Driver;
use super::plant::Extremes;
use super::run::{Ending, TickObserver};
use crate::accuracy::answer::{Comparable, Steps, answer};
use crate::accuracy::{Answer, Compared};
use crate::simulation::ErrorReport;
use crate::simulation::demand::Demand;

/// One closed loop, with what was seen of it.
#[derive(Clone, Debug)]
pub struct Looped<T> {
    /// How it ended.
    pub ending: Ending,
    /// Largest rotation and acceleration.
    pub extremes: Extremes,
    /// Whoever looked at its ticks.
    pub ticks: T,
    /// What its motion asks of toe, device and gears, where the scene has `[checks]`.
    pub checks: Option<Demand>,
    /// α, rad.
    slenderness: f64,
}

impl<T> Looped<T> {
    /// max |θ|/α; `None` of a block that overturns.
    pub fn peak_rotation(&self) -> Option<f64> {
        (!self.outcome().overturned()).then_some(self.extremes.peaks.rotation / self.slenderness)
    }

    /// How it ended, in the paper's words.
    pub fn outcome(&self) -> Outcome {
        Outcome::of(&self.ending.motion, &self.extremes.peaks)
    }
}

impl<T> Comparable for Looped<T> {
    type Outcome = Outcome;

    fn compared(&self) -> Compared<Outcome> {
        Compared {
            outcome: self.outcome(),
            peak_rotation: self.peak_rotation(),
            // Nobody looks for it in a loop.
            peak_acceleration: None,
            first_impact_time: self.extremes.peaks.first_counted_impact,
        }
    }
}

impl<'a> LoopTask<'a> {
    /// Runs the loop once with `driver` and `disturbance`, and shows its ticks to a new `T`.
    ///
    /// # Errors
    /// Why the loop cannot be followed.
    pub fn looped<T: TickObserver + Default>(
        &self,
        driver: &mut dyn Driver,
        disturbance: &mut dyn Disturbance,
    ) -> Result<Looped<T>, LoopFailure> {
        let (mut extremes, mut ticks) = (Extremes::default(), T::default());
        let (ending, extremes, checks) = match &self.scene.file.checks {
            Some(table) => {
                let (ending, extremes, checks) = self.checked(table, driver, disturbance, &mut ticks)?;
                (ending, extremes, Some(checks))
            }
            None => (self.run_with(driver, disturbance, &mut extremes, &mut ticks)?, extremes, None),
        };
        Ok(Looped { ending, extremes, ticks, checks, slenderness: self.scene.block.slenderness() })
    }

    /// Runs the loop as accurately as the scene asks. Gives the task as it was run, so that another controller can be put into the same
    /// loop; the error where one was asked for; and what was seen.
    pub fn answered<T: TickObserver + Default>(self) -> Result<(LoopTask<'a>, Option<ErrorReport>, Looped<T>), LoopFailure> {
        self.answered_by(LoopTask::driver)
    }

    /// [`LoopTask::answered`] with any `driver`, which is made anew for each run.
    pub fn answered_by<T: TickObserver + Default>(
        self,
        driver: impl Fn(&LoopTask<'a>) -> Result<Box<dyn Driver>, ParameterError>,
    ) -> Result<(LoopTask<'a>, Option<ErrorReport>, Looped<T>), LoopFailure> {
        let run = |task: &LoopTask<'a>| task.looped(&mut *driver(task)?, &mut ());
        let Some(level) = self.scene.file.accuracy.level else {
            let looped = run(&self)?;
            return Ok((self, None, looped));
        };
        let closer = |closeness| run(&LoopTask { closeness: Some(closeness), ..self });
        let found: Answer<Looped<T>> = answer(level, Steps::Equal, closer)?;
        let task = LoopTask { closeness: Some(found.closeness), ..self };
        Ok((task, Some(ErrorReport::of(&found)), found.result))
    }
}
