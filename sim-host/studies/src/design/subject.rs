//! One device of a scene, ready to be shaken: as it is, with later clutches, or with the clutches that were chosen.

use rayon::prelude::*;
use sprag_shared::structure::drivetrain::Engagement;
use sprag_sim::closed_loop::LoopTask;
use sprag_sim::closed_loop::assemble::LoopFailure;
use sprag_sim::closed_loop::run::LoopError;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::checks::{ChecksTable, CoilTable};
use sprag_sim::scene::controller::ControllerTable;
use sprag_sim::scene::drivetrain::{BrakeValue, BrakeWord, ClutchTable};
use sprag_sim::scene::motions::GroundMotions;
use sprag_sim::scene::{Scene, SceneDevice, SceneError};
use sprag_sim::sensor::Suite;
use sprag_sim::side_by_side;
use sprag_sim::simulation::{DeviceRun, RunError, simulate};

use super::asked::Asked;
use crate::sensitivity::answer::{Answer, Missing, answers};
use crate::sensitivity::motion::StudyMotion;

/// Between two samples of a history, in 1/p: a rocking block changes little within it.
const INTERVAL_RATIO: f64 = 0.005;

/// The toe is looked at only where a coefficient is known; this one is beyond all demands.
const ANY_FRICTION: f64 = 10.0;

/// Whether clutches that are chosen for `device` are tried with released flywheels that a brake stops at once: in the place of ideal ones, whose do.
pub fn is_tried_with_brakes(device: &SceneDevice) -> bool {
    device.drivetrain.engagement == Engagement::Ideal
}

/// A device.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The scene with it alone.
    pub scene: Scene,
    /// What drives its clutches, where the scene has a controller and they take commands.
    controlled: Option<(ControllerTable, Suite)>,
}

impl Subject {
    /// Device number `index` of `scene`. A `[controller]` drives its clutches if they take commands; Eq. 10 does elsewhere.
    ///
    /// # Errors
    /// [`SceneError`] for a controller that cannot be.
    pub fn new(scene: &Scene, index: usize) -> Result<Subject, SceneError> {
        let one = scene.only(index);
        let controlled = match one.file.controller.clone().filter(|_| one.devices[0].takes_commands()) {
            Some(controller) => {
                let suite = scene.loop_sensors(&controller, &[index])?;
                Some((controller, suite))
            }
            None => None,
        };
        Ok(Subject { scene: one, controlled })
    }

    /// Whether a controller drives its clutches.
    pub fn is_controlled(&self) -> bool {
        self.controlled.is_some()
    }

    /// The same with clutches that engage and release later by `delay_s` than the scene says.
    ///
    /// # Errors
    /// [`SceneError`] where the scene does not take it.
    pub fn later(&self, delay_s: f64) -> Result<Subject, SceneError> {
        let mut device = self.scene.file.device[0].clone();
        let actuation = device.actuation.get_or_insert_default();
        actuation.engagement_delay_s += delay_s;
        actuation.release_delay_s += delay_s;
        self.with(self.scene.with_device(device)?)
    }

    /// The same with plates that slip above `capacity_n` (N at the rack) in the place of an ideal or rigid clutch, [with
    /// brakes](is_tried_with_brakes) in that of an ideal one. None where the scene has a clutch of its own.
    ///
    /// # Errors
    /// [`SceneError`] where the scene does not take it.
    pub fn built(&self, capacity_n: f64) -> Result<Option<Subject>, SceneError> {
        let mut device = self.scene.file.device[0].clone();
        if is_tried_with_brakes(&self.scene.devices[0]) {
            device.flywheel.get_or_insert_default().brake_deceleration_m_s2 = BrakeValue::Word(BrakeWord::Instant);
        } else if self.scene.devices[0].drivetrain.engagement != Engagement::Rigid {
            return Ok(None);
        }
        device.engagement = None;
        // Flywheels with a speed of their own move by the consistent kinematics.
        device.kinematics = None;
        device.clutch = Some(ClutchTable { capacity_n: Some(capacity_n), ..ClutchTable::default() });
        self.with(self.scene.with_device(device)?).map(Some)
    }

    fn with(&self, scene: Scene) -> Result<Subject, SceneError> {
        Ok(Subject { scene: scene.only(0), controlled: self.controlled.clone() })
    }

    /// The same with a history, and with checks that look at forces, travel, toe and coils; `coil` is what the scene says of them.
    #[must_use]
    pub fn watched(mut self, coil: Option<CoilTable>) -> Subject {
        let coil = coil.unwrap_or(CoilTable { holding_power_w: 0.0, closing_energy_j: 0.0, largest_energy_j: None });
        self.scene.file.checks =
            Some(ChecksTable { friction_coefficient: Some(ANY_FRICTION), coil: Some(coil), ..ChecksTable::default() });
        self.scene.file.output.interval_s = Some(INTERVAL_RATIO / self.scene.block.frequency_parameter());
        self
    }

    /// What one that is [`Subject::watched`] asks for under each of `motions`, on rayon's threads; in words why nobody knows. `done` is called
    /// after each.
    ///
    /// # Errors
    /// [`RunError::Interrupted`].
    pub fn asked(
        &self,
        motions: &[StudyMotion],
        interrupt: &Interrupt,
        done: &(dyn Fn() + Sync),
    ) -> Result<Vec<Result<Asked, String>>, RunError> {
        let interval = self.scene.file.output.interval_s.unwrap_or(f64::INFINITY);
        let one = |motion: &StudyMotion| {
            let run = match &self.controlled {
                Some(_) => self.in_loop(&motion.ground, interval, interrupt),
                None => match simulate(&self.scene, &motion.ground, interrupt) {
                    Ok(runs) => runs.into_iter().next().ok_or_else(|| Missing::Failed("no device".to_owned())),
                    Err(RunError::Interrupted) => Err(Missing::Interrupted),
                    Err(error) => Err(Missing::Failed(error.to_string())),
                },
            };
            done();
            run.map(|run| Asked::of(&self.scene, &motion.ground, &run))
        };
        words(motions.par_iter().map(one).collect(), interrupt)
    }

    /// Outcome and peak under each of `motions`, as [`Subject::asked`].
    ///
    /// # Errors
    /// [`RunError::Interrupted`].
    pub fn answers(
        &self,
        motions: &[StudyMotion],
        interrupt: &Interrupt,
        done: &(dyn Fn() + Sync),
    ) -> Result<Vec<Result<Answer, String>>, RunError> {
        if self.controlled.is_none() {
            let subject = side_by_side::Subject::new(self.scene.clone());
            return words(answers(&subject, false, motions, interrupt, done), interrupt);
        }
        let one = |motion: &StudyMotion| {
            let run = self.in_loop(&motion.ground, f64::INFINITY, interrupt);
            done();
            run.map(|run| Answer::of_run(&run))
        };
        words(motions.par_iter().map(one).collect(), interrupt)
    }

    fn in_loop(&self, ground: &GroundMotions, interval: f64, interrupt: &Interrupt) -> Result<DeviceRun, Missing> {
        let Some((controller, suite)) = &self.controlled else { return Err(Missing::Interrupted) };
        if interrupt.is_set() {
            return Err(Missing::Interrupted);
        }
        let task = LoopTask::of(&self.scene, ground, (controller, suite, controller.sensors.seed()), interrupt);
        task.measured_at(interval).map_err(|failure| match failure {
            LoopFailure::Loop(LoopError::Interrupted) => Missing::Interrupted,
            failure => Missing::Failed(failure.to_string()),
        })
    }
}

/// Those of a study that was not interrupted, with the reasons of failures in words.
fn words<T>(found: Vec<Result<T, Missing>>, interrupt: &Interrupt) -> Result<Vec<Result<T, String>>, RunError> {
    if interrupt.is_set() || found.iter().any(|found| matches!(found, Err(Missing::Interrupted))) {
        return Err(RunError::Interrupted);
    }
    let word = |missing: Missing| match missing {
        Missing::Impossible(reason) | Missing::Failed(reason) => reason,
        Missing::Interrupted => RunError::Interrupted.to_string(),
    };
    Ok(found.into_iter().map(|found| found.map_err(word)).collect())
}
