//! From a scene to a closed loop: the controller with its belief about the structure, the sensors, the plant.

use sprag_shared::control::clutch_position::ClutchLag;
use sprag_shared::control::controller::{Controller, Horizons};
use sprag_shared::control::law::any_law::ClutchLaw;
use sprag_shared::control::law::costate::Costate;
use sprag_shared::control::law::look_ahead::LookAhead;
use sprag_shared::control::law::minimum_dwell::Gate;
use sprag_shared::control::law::{GatedTable, Law, SignTable};
use sprag_shared::control::model::Model;
use sprag_shared::control::supervisor::{Parameters, Supervisor};
use sprag_shared::control::ticks::ticks;
use sprag_shared::drivetrain::under_way::MOST_UNDER_WAY;
use sprag_shared::motion::hybrid::HybridSystem;
use sprag_shared::settings::kind::{Description, Kind};
use sprag_shared::settings::{Item, SettingError, Settings};
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::Block;
use sprag_shared::structure::device::{DeviceKind, KinematicsKind};
use sprag_shared::structure::drivetrain::{Delay, Drivetrain, Engagement};
use sprag_shared::structure::error::ParameterError;
use sprag_shared::structure::restitution::Restitution;

use super::design::SensorDesign;
use super::disturbance::Disturbance;
use super::driver::{Driver, Shared};
use super::feedback::Feedback;
use super::plant::{Plant, Surroundings, Watcher};
use super::run::{Clock, ClosedLoop, Ending, LoopError, TickObserver};
use super::supervision::supervision;
use crate::accuracy::Closeness;
use crate::interrupt::Interrupt;
use crate::scene::Scene;
use crate::scene::accuracy::MethodName;
use crate::scene::controller::{ControllerTable, FeedbackName, LawName};
use crate::scene::motions::GroundMotions;
use crate::sensor::Suite;
use crate::simulation::run::{Failure, Task};

/// Why a loop cannot be run, or ended without a result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LoopFailure {
    /// A parameter that the core refuses.
    #[error("{0}")]
    Parameter(#[from] ParameterError),
    /// The loop ended.
    #[error("{0}")]
    Loop(#[from] LoopError),
}

impl From<Failure> for LoopFailure {
    fn from(failure: Failure) -> LoopFailure {
        match failure {
            Failure::Parameter(error) => LoopFailure::Parameter(error),
            Failure::Stopped(stopped) => LoopFailure::Loop(LoopError::Stopped(stopped)),
            // Closed loops are an effect, so there are effects here.
            Failure::Interrupted | Failure::NoEffects => LoopFailure::Loop(LoopError::Interrupted),
        }
    }
}

/// A closed loop of one device of a scene.
#[derive(Clone, Copy)]
pub struct LoopTask<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its ground motion.
    pub ground: &'a GroundMotions,
    /// Index of the device, a clutched pair.
    pub index: usize,
    /// What drives it.
    pub controller: &'a ControllerTable,
    /// Sensors of the controller.
    pub suite: &'a Suite,
    /// Of the sensors' specimens and noise.
    pub seed: u64,
    /// How closely the plant is followed; without it by a step a tick.
    pub closeness: Option<Closeness>,
    /// Ctrl-C.
    pub interrupt: &'a Interrupt,
}

impl ControllerTable {
    /// The law of its name.
    pub fn clutch_law(&self) -> ClutchLaw {
        match self.law {
            LawName::Passive => ClutchLaw::Passive,
            LawName::AlwaysEngaged => ClutchLaw::AlwaysEngaged,
            LawName::Resisting => ClutchLaw::Resisting,
            LawName::ResistingPredicted => ClutchLaw::ResistingPredicted,
            LawName::SignTable => ClutchLaw::SignTable(self.sign_table.map_or(SignTable::EITHER, SignTable)),
            LawName::GatedTable => ClutchLaw::GatedTable(GatedTable::DEFAULT),
            LawName::LookAhead => ClutchLaw::LookAhead(LookAhead::default()),
            LawName::Costate => ClutchLaw::Costate(Costate::TRAINED),
        }
    }
}

impl<'a> LoopTask<'a> {
    /// The loop of the first device of `scene` with a controller, its sensors and their seed, as closely as the scene says.
    pub fn of(
        scene: &'a Scene,
        ground: &'a GroundMotions,
        (controller, suite, seed): (&'a ControllerTable, &'a Suite, u64),
        interrupt: &'a Interrupt,
    ) -> LoopTask<'a> {
        let closeness = scene.file.accuracy.level.map(Closeness::from);
        LoopTask { scene, ground, index: 0, controller, suite, seed, closeness, interrupt }
    }

    pub(super) fn task(&self) -> Task<'a> {
        let LoopTask { scene, ground, index, interrupt, .. } = *self;
        Task { scene, ground, index, interval: f64::INFINITY, reports: false, interrupt }
    }

    fn drivetrain(&self) -> Drivetrain {
        self.scene.devices[self.index].drivetrain
    }

    /// Devices with a memory move by the consistent kinematics, whatever the scene says.
    fn structure(&self) -> Structure {
        let mut structure = self.scene.structure(self.index);
        if self.drivetrain().needs_consistent_kinematics(DeviceKind::ClutchedPair) {
            structure.device.kinematics = KinematicsKind::Consistent;
        }
        structure
    }

    /// What the controller believes.
    ///
    /// # Errors
    /// [`ParameterError`] where a belief is beyond what a block can be.
    pub fn believed(&self) -> Result<Structure, ParameterError> {
        let (mut structure, belief) = (self.structure().loaded()?, &self.controller.belief);
        let block = &structure.block;
        let (size, slenderness) = (belief.size_factor, belief.slenderness_factor);
        let range = "such that the block which the controller believes in is one";
        let of = |parameter, value| ParameterError { parameter, value, range };
        structure.block = Block::new(block.size() * size, block.slenderness() * slenderness, block.inertia_ratio()).map_err(
            |error| match error.parameter {
                "size" => of("controller.belief.size_factor", size),
                _ => of("controller.belief.slenderness_factor", slenderness),
            },
        )?;
        structure.device.mass_ratio *= belief.mass_ratio_factor;
        let restitution = structure.restitution().map_err(|_| of("controller.belief.slenderness_factor", slenderness))?;
        structure.restitution = Restitution::Constant((restitution * belief.restitution_factor).min(1.0));
        Ok(structure)
    }

    /// From a command to a clutch that has moved, s: the longer of engaging and releasing.
    pub fn actuation(&self) -> f64 {
        let actuation = self.drivetrain().actuation;
        self.controller.latency_s + actuation.engagement_delay.max(actuation.release_delay)
    }

    /// For how long earlier moves of a clutch may keep it as it is, s: the dwell of the last, or of all that are under way before the newest.
    fn held(&self) -> f64 {
        let actuation = self.drivetrain().actuation;
        let moves = match actuation.delay {
            Delay::Inertial => 1,
            Delay::Transport => MOST_UNDER_WAY,
        };
        moves as f64 * actuation.dwell
    }

    /// To the middle of the ticks at which its commands are given, each with the delay of what is commanded.
    fn horizons(&self, period: f64) -> Horizons {
        let actuation = self.drivetrain().actuation;
        let after = |delay: f64| (self.controller.latency_s + delay + 0.5 * period) as f32;
        Horizons { engagement: after(actuation.engagement_delay), release: after(actuation.release_delay) }
    }

    fn feedback(&self) -> Feedback {
        let (table, actuation) = (self.controller, self.drivetrain().actuation);
        match table.feedback {
            FeedbackName::Position => Feedback::Position,
            FeedbackName::Current => Feedback::by_current(
                [actuation.engagement_delay, actuation.release_delay].map(|delay| table.latency_s + delay),
                [table.closing_lag_s, table.opening_lag_s],
                1.0 / table.rate_hz,
            ),
        }
    }

    /// What the controller believes of the same.
    fn lag(&self) -> ClutchLag {
        let table = self.controller;
        let nearest = |lag: f64| match table.feedback {
            FeedbackName::Position => 0,
            FeedbackName::Current => (lag * table.belief.lag_factor * table.rate_hz).round() as u16,
        };
        ClutchLag { closing: nearest(table.closing_lag_s), opening: nearest(table.opening_lag_s), closing_time: 0.0 }
    }

    /// The controller by `law`.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter outside its range.
    pub fn controller<L: Law>(&self, law: L) -> Result<Controller<L>, ParameterError> {
        Ok(self.supervised(law)?.0)
    }

    /// The controller, and what its supervisor is made from.
    fn supervised<L: Law>(&self, law: L) -> Result<(Controller<L>, Parameters), ParameterError> {
        let structure = self.believed()?;
        let table = self.controller;
        let period = 1.0 / table.rate_hz;
        let (shock, model_error) = (table.shock_s, table.belief.model_error);
        let design = SensorDesign::new(&structure, self.suite, table.estimator, period, shock, model_error)?;
        let supervision = supervision(&structure, self.suite, &design, table, (self.actuation(), self.held()));
        let controller = Controller {
            model: Model::new(&structure, &self.drivetrain())?,
            instruments: design.instruments,
            estimator: design.estimator,
            law,
            horizons: self.horizons(period),
            bands: table.hysteresis as f32,
            engaged_at_rest: table.engaged_at_rest,
            gate: Gate { dwell: ticks(table.dwell_s as f32, period as f32).min(u16::MAX.into()) as u16 },
            lag: self.lag(),
            supervisor: Supervisor::new(&supervision)?,
        };
        Ok((controller, supervision))
    }

    /// The same controller by the law of its table, as the words that a board is given.
    ///
    /// # Errors
    /// As [`LoopTask::controller`], and for what a board's settings cannot be.
    pub fn settings(&self) -> Result<Settings, ParameterError> {
        let (controller, supervision) = self.supervised(self.controller.clutch_law())?;
        let written = Settings::written(&controller, &supervision).unwrap_or_default();
        Settings::of(&controller, &supervision).map_err(|error| unfit(error, &written))
    }

    /// What a board refuses of the controller, as [`Scene::warnings`] have it.
    pub fn warning(&self) -> Option<String> {
        let Scene { origin, devices, .. } = self.scene;
        self.settings().err().map(|error| format!("{origin}: the controller of {}: {error}", devices[self.index].name))
    }

    /// The controller by the law of its table, at power-on.
    ///
    /// # Errors
    /// The errors of [`LoopTask::controller`].
    // Compiled here, where it is optimised, and not once more by each who calls it.
    pub fn driver(&self) -> Result<Box<dyn Driver>, ParameterError> {
        self.driver_by(self.controller.clutch_law())
    }

    /// [`LoopTask::driver`] by any `law`.
    ///
    /// # Errors
    /// The errors of [`LoopTask::controller`].
    pub fn driver_by<L: Law + 'static>(&self, law: L) -> Result<Box<dyn Driver>, ParameterError> {
        Ok(Box::new(Shared::new(self.controller(law)?)))
    }

    /// Block and device.
    pub(crate) fn machine(&self) -> Result<HybridSystem<f64>, ParameterError> {
        let mut structure = self.scene.structure(self.index);
        // Another specimen of the sensors meets other impacts.
        let specimen = self.seed.wrapping_sub(self.controller.sensors.seed());
        structure.restitution_scatter.seed = structure.restitution_scatter.seed.wrapping_add(specimen);
        self.drivetrain().resolve(&structure, self.ground.vertical.is_some())
    }

    /// Clock of the loop.
    pub fn clock(&self) -> Clock {
        let task = self.task();
        Clock {
            period: 1.0 / self.controller.rate_hz,
            substeps: self.controller.substeps,
            prelude: self.controller.prelude_s,
            end: task.end(),
            ground_end: self.ground.horizontal.duration(),
            actuation: self.actuation(),
        }
    }

    /// Runs the loop with the law of its table.
    pub fn run(&self, watcher: &mut dyn Watcher, observer: &mut dyn TickObserver) -> Result<Ending, LoopFailure> {
        let mut driver = self.driver()?;
        self.run_with(&mut *driver, &mut (), watcher, observer)
    }

    /// Runs the loop with any controller, and with whatever goes wrong.
    pub fn run_with(
        &self,
        driver: &mut dyn Driver,
        disturbance: &mut dyn Disturbance,
        watcher: &mut dyn Watcher,
        observer: &mut dyn TickObserver,
    ) -> Result<Ending, LoopFailure> {
        let loaded = self.task().loaded()?;
        let closed = ClosedLoop {
            clock: self.clock(),
            suite: self.suite,
            seed: self.seed,
            feedback: self.feedback(),
            disturbance,
            slenderness: loaded.block.slenderness(),
            interrupt: self.interrupt,
        };
        Ok(closed.run(&mut self.plant(&loaded.block)?, driver, watcher, observer)?)
    }

    /// The plant, of which `block` is the block with what it carries.
    pub(super) fn plant<'b>(&'b self, block: &'b Block) -> Result<Plant<'b>, ParameterError> {
        let task = self.task();
        let surroundings = Surroundings {
            course: task.course(block),
            ground: self.ground,
            released: task.released(),
            ground_at_start: task.ground_at_start(),
            shock: self.controller.shock_s,
            latency: self.controller.latency_s,
            step: self.clock().period / f64::from(self.closeness.map_or(1, Closeness::steps_per_tick)),
            // A level leaves the method to the program: the one for stiff clutches, where there are any.
            exponential: self.scene.file.accuracy.method == MethodName::ExponentialMidpoint || self.closeness.is_some(),
        };
        Ok(Plant::new(self.machine()?, surroundings))
    }

    /// The same device as the paper has it, without a controller: ideal engagement, nothing lost, nothing late.
    pub fn ideal(&self) -> Result<crate::simulation::DeviceRun, LoopFailure> {
        let mut scene = self.scene.clone();
        scene.devices[self.index].drivetrain = Drivetrain { engagement: Engagement::Ideal, ..Drivetrain::default() };
        scene.file.output.energy = false;
        scene.file.checks = None;
        let task = self.task();
        let interval = (task.end() / 2000.0).max(1e-6);
        Ok(Task { scene: &scene, interval, ..task }.run()?)
    }
}

/// A setting that a board refuses, as the parameter that it was made from; `settings` are those that contradict themselves.
fn unfit(error: SettingError, settings: &Settings) -> ParameterError {
    let (index, word, range) = match error {
        SettingError::OutOfRange { index, word } => (Some(index), Some(word), "within what a board's settings allow"),
        SettingError::Contradiction { index, .. } => {
            let range = if index == Item::RotationByEncoder.index() {
                "such that with the other gains an estimator's errors die out, or a board refuses them"
            } else {
                "as its companion among a board's settings allows"
            };
            (Some(index), settings.get(index), range)
        }
        SettingError::NoSuch { .. } | SettingError::NotRepresentable => {
            (None, None, "such that they make the same controller again")
        }
    };
    let setting = index.and_then(Description::at);
    let number = |word| if setting.is_some_and(|it| it.kind == Kind::Real) { f32::from_bits(word).into() } else { word.into() };
    ParameterError { parameter: setting.map_or("settings", |it| it.name), value: word.map_or(f64::NAN, number), range }
}
