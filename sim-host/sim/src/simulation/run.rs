//! `simulate`: every device of a scene under its ground motion.

use sprag_shared::equation::Accelerations;
use sprag_shared::ground::GroundSegment;
use sprag_shared::math::scalar::Real;
use sprag_shared::motion::state::Stopped;
use sprag_shared::observers::checks::Checks;
use sprag_shared::observers::counted_swing::CountedSwing;
use sprag_shared::observers::peaks::Peaks;
use sprag_shared::structure::block::Block;
use sprag_shared::structure::device::DeviceKind;
use sprag_shared::structure::drivetrain::Engagement;
use sprag_shared::structure::error::ParameterError;
use sprag_shared::structure::{Base, Structure};

use super::asked::Asked;
use super::device_run::{DeviceRun, ErrorReport};
use super::drive::{Course, Overturning};
use super::recorder::Recorder;
use super::watchers::Watchers;
#[cfg(feature = "effects")]
use super::{compliant, sliding};
use super::{ideal, machine};
use crate::accuracy::answer::{Comparable, Steps};
use crate::accuracy::{Accuracy, answer};
use crate::ground_motion::GroundMotion;
use crate::interrupt::Interrupt;
use crate::scene::Scene;
use crate::scene::accuracy::{AccuracyTable, MethodName};
use crate::scene::device::SceneDevice;
use crate::scene::map::OverturnedAt;
use crate::scene::motions::GroundMotions;

/// Samples of a history when the scene names no interval.
const SAMPLES: f64 = 2000.0;

/// Most samples that a history may have.
const MOST_SAMPLES: f64 = 5e6;

/// Step of the second method that looks at a result, in 1/p.
const SECOND_STEP: f64 = 0.02;

/// Why a device could not be simulated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RunError {
    /// A parameter that the core refuses.
    #[error("{device}: {error}")]
    Parameter {
        /// Device.
        device: String,
        /// What is wrong.
        error: ParameterError,
    },
    /// The core gave up.
    #[error("{device}: {error}")]
    Stopped {
        /// Device.
        device: String,
        /// Reason why the motion could not be followed.
        error: Stopped,
    },
    /// The history would be too long.
    #[error("output.interval_s of {interval} s asks for more than 5 million samples over {duration} s")]
    TooManySamples {
        /// s.
        interval: f64,
        /// s.
        duration: f64,
    },
    /// The support of the device has a record, and not one beside this ground.
    #[error("{device}: support_record belongs to the ground motion of the scene itself, and another takes its place here")]
    OtherGround {
        /// Device.
        device: String,
    },
    /// The program was built without effects.
    #[error("{device}: this program was built without effects")]
    NoEffects {
        /// Device.
        device: String,
    },
    /// The toe of a block that slides left the ground, in a study: its answer has a peak.
    #[error("{device}: at {time} s the toe lifts off the ground, and its flight is not modelled")]
    LiftedOff {
        /// Device.
        device: String,
        /// s.
        time: f64,
    },
    /// Ctrl-C.
    #[error("interrupted")]
    Interrupted,
}

/// Runs every device of `scene`, for a report of each.
///
/// # Errors
/// [`RunError`] names the device.
pub fn simulate(scene: &Scene, ground: &GroundMotions, interrupt: &Interrupt) -> Result<Vec<DeviceRun>, RunError> {
    runs(scene, ground, true, interrupt)
}

/// As [`simulate`], for studies, which report no forces and impulses: they are looked at where the scene has `[checks]` only, and there the
/// toe is left out unless the table asks for friction.
///
/// # Errors
/// The errors of [`simulate`], and [`RunError::LiftedOff`].
pub fn simulate_for_study(scene: &Scene, ground: &GroundMotions, interrupt: &Interrupt) -> Result<Vec<DeviceRun>, RunError> {
    let runs = runs(scene, ground, false, interrupt)?;
    let lifted = |run: &DeviceRun| Some((run.device.clone(), run.sliding?.lifted_off_time_s?));
    match runs.iter().find_map(lifted) {
        Some((device, time)) => Err(RunError::LiftedOff { device, time }),
        None => Ok(runs),
    }
}

fn runs(scene: &Scene, ground: &GroundMotions, reports: bool, interrupt: &Interrupt) -> Result<Vec<DeviceRun>, RunError> {
    let rings = scene.file.device.iter().filter_map(|device| device.support_oscillator()).map(|support| support.rings_for());
    let duration = ground.horizontal.duration() + rings.fold(0.0, f64::max) + scene.free_time_s();
    let interval = scene.file.output.interval_s.unwrap_or((duration / SAMPLES).max(1e-9));
    if duration / interval > MOST_SAMPLES {
        return Err(RunError::TooManySamples { interval, duration });
    }
    let run = |index: usize| {
        let device = &scene.devices[index].name;
        let ground = ground.of_device(scene, index).ok_or_else(|| RunError::OtherGround { device: device.clone() })?;
        let task = Task { scene, ground: &ground, index, interval, reports, interrupt };
        let run = match scene.file.accuracy.level {
            Some(level) => task.answer(level),
            None => task.run(),
        };
        run.map_err(|failure| match failure {
            Failure::NoEffects => RunError::NoEffects { device: device.clone() },
            Failure::Parameter(error) => RunError::Parameter { device: device.clone(), error },
            Failure::Stopped(error) => RunError::Stopped { device: device.clone(), error },
            Failure::Interrupted => RunError::Interrupted,
        })
    };
    (0..scene.devices.len()).map(run).collect()
}

/// Why a device's run ended without a result.
pub(crate) enum Failure {
    Parameter(ParameterError),
    Stopped(Stopped),
    Interrupted,
    #[cfg_attr(feature = "effects", expect(dead_code, reason = "for a program without effects"))]
    NoEffects,
}

impl From<ParameterError> for Failure {
    fn from(error: ParameterError) -> Failure {
        Failure::Parameter(error)
    }
}

/// One device of a scene, to be run.
#[derive(Clone, Copy)]
pub(crate) struct Task<'a> {
    pub scene: &'a Scene,
    /// Of the device.
    pub ground: &'a GroundMotions,
    pub index: usize,
    /// Between samples, s.
    pub interval: f64,
    /// Forces and impulses are looked at without `[checks]` too.
    pub reports: bool,
    pub interrupt: &'a Interrupt,
}

impl<'a> Task<'a> {
    /// Nothing calls for a memory: the loop for ideal devices is enough.
    fn is_ideal(&self) -> bool {
        self.scene.is_ideal(self.index) && self.ground.vertical.is_none()
    }

    /// Run of the device.
    pub fn run(&self) -> Result<DeviceRun, Failure> {
        match self.scene.file.block.base() {
            #[cfg(feature = "effects")]
            Base::Friction(_) => sliding::run(self),
            #[cfg(feature = "effects")]
            Base::Compliant(_) => compliant::run(self),
            Base::Rigid if self.is_ideal() => ideal::run(self),
            _ => machine::run(self),
        }
    }

    /// Its run as accurately as `level` asks, with its error; that of a device with a memory is looked at by a method of another kind.
    fn answer(&self, level: Accuracy) -> Result<DeviceRun, Failure> {
        let mut scene = self.scene.clone();
        let steps = if self.is_ideal() { Steps::Free } else { Steps::BetweenEvents };
        let mut found = answer(level, steps, |closeness| {
            scene.file.accuracy = AccuracyTable::as_close(closeness);
            Task { scene: &scene, ..*self }.run()
        })?;
        if !self.is_ideal() {
            let elastic = matches!(self.device().drivetrain.engagement, Engagement::Elastic { .. });
            // Runge-Kutta is closer, but its steps are short with a stiff clutch.
            let methods: &[MethodName] =
                if elastic { &[MethodName::ExponentialMidpoint, MethodName::RungeKutta4] } else { &[MethodName::RungeKutta4] };
            scene.file.output.energy = false;
            scene.file.checks = None;
            found.confirm(level, methods, |method, factor| {
                scene.file.accuracy =
                    AccuracyTable { method, step_ratio: Some(factor * SECOND_STEP), ..AccuracyTable::default() };
                match (Task { scene: &scene, reports: false, ..*self }).run() {
                    Ok(run) => Ok(Some(run.compared())),
                    Err(Failure::Stopped(_)) => Ok(None),
                    Err(failure) => Err(failure),
                }
            })?;
        }
        Ok(DeviceRun { error: Some(ErrorReport::of(&found)), ..found.result })
    }

    /// What the end of a course is for the run: one that was interrupted has none.
    pub fn ended(&self, end: Result<(), Stopped>) -> Result<(), Failure> {
        end.map_err(Failure::Stopped)?;
        if self.interrupt.is_set() { Err(Failure::Interrupted) } else { Ok(()) }
    }

    /// The device.
    pub fn device(&self) -> &'a SceneDevice {
        &self.scene.devices[self.index]
    }

    /// Fixed step, s.
    pub fn step(&self) -> Option<f64> {
        self.scene.file.accuracy.step(self.scene.block.frequency_parameter())
    }

    /// The block with what it carries.
    pub fn loaded(&self) -> Result<Structure, ParameterError> {
        self.scene.structure(self.index).loaded()
    }

    /// When the run ends, s.
    pub fn end(&self) -> f64 {
        self.ground.horizontal.duration() + self.scene.free_time_s()
    }

    /// θ and θ̇ at the start, if the block is not at rest.
    pub fn released(&self) -> Option<(f64, f64)> {
        let table = &self.scene.file.block;
        let (rotation, velocity) = (table.initial_rotation_ratio, table.initial_velocity_ratio);
        let (alpha, p) = (self.scene.block.slenderness(), self.scene.block.frequency_parameter());
        (rotation != 0.0 || velocity != 0.0).then_some((rotation * alpha, velocity * p * alpha))
    }

    /// Whether the device's support moves otherwise than the ground.
    pub(super) fn carried(&self) -> bool {
        self.device().drivetrain.support.moves()
    }

    /// Accelerations of ground and support at the start.
    pub fn ground_at_start(&self) -> Accelerations<f64> {
        let first = |motion: &GroundMotion| motion.segments().first().map_or(0.0, |segment| segment.shape.acceleration(0.0));
        let GroundMotions { horizontal, vertical, support, .. } = self.ground;
        [first(horizontal), vertical.as_ref().map_or(0.0, first), support.as_ref().map_or(0.0, first)]
    }

    /// What to follow; `block` is the loaded one.
    pub fn course(&self, block: &'a Block) -> Course<'a> {
        Course {
            block,
            geometry: self.scene.geometry(),
            ground: &self.ground.horizontal,
            vertical: self.ground.vertical.as_ref(),
            support: self.ground.support.as_ref(),
            free_time: self.scene.free_time_s(),
            overturning: match self.scene.overturned_at {
                OverturnedAt::NoReturn => Overturning::Reached,
                OverturnedAt::Slenderness => Overturning::Slenderness,
            },
        }
    }

    /// From F/(λmR) of the loaded block (1/s²) to F/(mg) of the bare one.
    pub fn force_scale(&self, loaded: &Structure) -> f64 {
        (1.0 + self.device().added_mass.mass_ratio) / loaded.block.frequency_parameter_squared()
    }

    /// Checks that look at all there is.
    ///
    /// # Errors
    /// [`ParameterError`] where the mount has no lever.
    pub fn checks<S: Real>(&self, loaded: &Structure) -> Result<Checks<S>, ParameterError> {
        Checks::new(&loaded.block, self.scene.geometry(), &loaded.device.mount, &self.device().account(loaded))
    }

    /// Those who watch.
    pub fn watchers<S: Real>(&self, loaded: &Structure) -> Result<Watchers<'a, S>, Failure> {
        let stays_engaged = self.device().device.kind == DeviceKind::Inerter;
        let segments = self.ground.horizontal.segments();
        let all = self.scene.file.checks.is_some();
        let checks = if all || self.reports { Some(self.checks(loaded)?) } else { None };
        Ok(Watchers {
            recorder: Recorder::new(self.force_scale(loaded), stays_engaged, self.interval, segments)
                .carried(self.carried())
                .counting(CountedSwing::of(&loaded.block)),
            peaks: Peaks { rocked: self.released().is_some(), ..Peaks::default() },
            checks: checks.map(|checks| match &self.scene.file.checks {
                Some(table) if self.reports || table.friction_coefficient.is_some() => checks,
                Some(table) if table.gear.is_some() => checks.of_flywheels(),
                Some(_) => checks.of_device(),
                None => checks.brief(),
            }),
            asked: Asked::of(self, loaded)?,
        })
    }
}
