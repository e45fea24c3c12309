//! Many closed loops in parallel: motions by variants.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use sprag_report::long_run::in_order::all_in_order;
use sprag_report::progress::Progress;
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::structure::block::Block;
use sprag_sim::accuracy::{Accuracy, Worst};
use sprag_sim::closed_loop::run::{Ending, TickObserver};
use sprag_sim::closed_loop::{LoopFailure, LoopTask};
use sprag_sim::interrupt::Interrupt;
use sprag_sim::record::RecordSummary;
use sprag_sim::scene::Scene;
use sprag_sim::scene::error::SceneError;
use sprag_sim::scene::ground::GroundError;
use sprag_sim::simulation::ErrorReport;

use super::motion::Motion;

/// A structure with its device and controller, in the words of a scene; without a ground motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    /// For tables.
    pub name: String,
    /// Keys of the scene.
    pub overrides: Vec<String>,
    /// Seed of the sensors.
    pub seed: u64,
}

impl Variant {
    /// With overrides `KEY=VALUE`.
    pub fn new(name: &str, overrides: &[&str]) -> Variant {
        Variant { name: name.to_owned(), overrides: overrides.iter().map(|&text| text.to_owned()).collect(), seed: 1 }
    }

    /// The same with one override more.
    #[must_use]
    pub fn with(&self, text: &str) -> Variant {
        let mut variant = self.clone();
        variant.overrides.push(text.to_owned());
        variant
    }
}

/// The block and pair of the studies, as the paper's section 5 has them: R = 2 m, α = 10°, η = 0.85, σ = 0.5.
pub const BASE: &str = "\
[block]
size_m = 2.0
slenderness_deg = 10.0
restitution = 0.85
[[device]]
kind = \"clutched-pair\"
mass_ratio = 0.5
[controller]
substeps = 1
";

/// Eq. 10 predicted, which is what the ideal pair does.
pub const EQUATION_10: &str = "controller.law=\"resisting-predicted\"";

/// A ground that does not move.
const STILL: &str = "[[ground]]\nmotion = \"sine\"\nfrequency_ratio = 1.0\namplitude_ratio = 0.0\n[run]\nfree_time_ratio = 1.0\n";

/// What one closed loop came to.
#[derive(Clone, Debug)]
pub struct LoopResult {
    /// Outcome.
    pub outcome: Outcome,
    /// max |θ|/α.
    pub peak: f64,
    /// How it ended.
    pub ending: Ending,
}

/// Reasons why a study ended early.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A scene that the study wrote.
    #[error("{0}")]
    Scene(#[from] SceneError),
    /// A record.
    #[error("{0}")]
    Ground(#[from] GroundError),
    /// A record that is to be scaled to a peak.
    #[error("{}: the ground does not move: no factor gives it a peak", .file.display())]
    Still {
        /// Its file.
        file: PathBuf,
    },
    /// A loop.
    #[error("{motion}: {failure}")]
    Loop {
        /// Motion and variant.
        motion: String,
        /// Failure of the loop.
        failure: LoopFailure,
    },
    /// Ctrl-C.
    #[error("interrupted")]
    Interrupted,
    /// A figure.
    #[error("the picture cannot be drawn: {0}")]
    Plot(#[from] sprag_report::plot::PlotError),
}

/// The block of a variant, which pulses are measured by.
///
/// # Errors
/// [`StudyError`] for a scene that cannot be.
pub fn block_of(variant: &Variant) -> Result<Block, StudyError> {
    Ok(Scene::parse_with(&format!("{BASE}{STILL}"), "study", &variant.overrides)?.block)
}

/// The scene of a motion and a variant.
///
/// # Errors
/// [`StudyError`] for a scene that cannot be.
pub fn scene_of(motion: &Motion, variant: &Variant) -> Result<Scene, StudyError> {
    let text = format!("{BASE}{}", motion.tables(&block_of(variant)?));
    let mut scene = Scene::parse_with(&text, "study", &variant.overrides)?;
    scene.folder = PathBuf::new();
    Ok(scene)
}

/// What the record files of `motions` hold.
///
/// # Errors
/// [`StudyError::Ground`] names the first file that cannot be read.
pub fn records_of(motions: &[Motion]) -> Result<Vec<RecordSummary>, StudyError> {
    let mut records = Vec::new();
    for motion in motions {
        let scene = scene_of(motion, &Variant::new("records", &[]))?;
        // The scene is the study's own, and has no keys for a user.
        records.extend(scene.records().map_err(|error| match error {
            GroundError::Record { error, .. } => GroundError::Record { error, key: None },
            error => error,
        })?);
    }
    Ok(records)
}

/// Under what the loops of a study are run.
pub struct Conditions<'a> {
    /// How accurately the plant is followed; without it by a step a tick.
    pub accuracy: Option<Accuracy>,
    /// Ctrl-C.
    pub interrupt: &'a Interrupt,
    worst: Mutex<Worst>,
}

impl<'a> Conditions<'a> {
    /// Conditions of a study that begins.
    pub fn new(accuracy: Option<Accuracy>, interrupt: &'a Interrupt) -> Conditions<'a> {
        Conditions { accuracy, interrupt, worst: Mutex::default() }
    }

    /// The least accurate loop so far.
    pub fn worst(&self) -> Worst {
        *self.worst.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn note(&self, error: &ErrorReport, peak: Option<f64>) {
        self.worst.lock().unwrap_or_else(PoisonError::into_inner).note(&error.estimate, peak);
    }
}

/// Gives `work` the closed loop of a motion and a variant.
pub fn with_loop<R>(
    motion: &Motion,
    variant: &Variant,
    conditions: &Conditions<'_>,
    work: impl FnOnce(&LoopTask<'_>) -> Result<R, LoopFailure>,
) -> Result<R, StudyError> {
    let mut scene = scene_of(motion, variant)?;
    scene.file.accuracy.level = conditions.accuracy;
    let ground = scene.ground_motions()?;
    let controller = scene.file.controller.clone().unwrap_or_default();
    let suite = controller.suite("study")?;
    let task = LoopTask::of(&scene, &ground, (&controller, &suite, variant.seed), conditions.interrupt);
    work(&task).map_err(|failure| match failure {
        LoopFailure::Loop(sprag_sim::closed_loop::run::LoopError::Interrupted) => StudyError::Interrupted,
        failure => StudyError::Loop { motion: format!("{motion:?}, {}", variant.name), failure },
    })
}

/// Runs one closed loop.
pub fn run_loop(motion: &Motion, variant: &Variant, conditions: &Conditions<'_>) -> Result<LoopResult, StudyError> {
    Ok(run_loop_observed::<()>(motion, variant, conditions)?.0)
}

/// [`run_loop`] with a new observer of its ticks, which it returns.
pub fn run_loop_observed<T: TickObserver + Default>(
    motion: &Motion,
    variant: &Variant,
    conditions: &Conditions<'_>,
) -> Result<(LoopResult, T), StudyError> {
    with_loop(motion, variant, conditions, |task| {
        let (_, error, looped) = task.answered::<T>()?;
        let (outcome, peak) = (looped.outcome(), looped.extremes.peaks.rotation / task.scene.block.slenderness());
        if let Some(error) = error {
            conditions.note(&error, (!outcome.overturned()).then_some(peak));
        }
        Ok((LoopResult { outcome, peak, ending: looped.ending }, looped.ticks))
    })
}

/// Outcome and peak |θ|/α of the ideal device of `variant` without a controller.
pub fn run_ideal(motion: &Motion, variant: &Variant, conditions: &Conditions<'_>) -> Result<(Outcome, f64), StudyError> {
    with_loop(motion, variant, conditions, |task| {
        let run = task.ideal()?;
        Ok((run.outcome, run.peak_rotation.unwrap_or(f64::INFINITY)))
    })
}

/// Does `work` for every pair of a motion and a variant, in parallel; results by variant, then by motion.
///
/// # Errors
/// The first error by order, not by time.
pub fn each<R: Send>(
    motions: &[Motion],
    variants: &[Variant],
    progress: &Progress,
    work: impl Fn(&Motion, &Variant) -> Result<R, StudyError> + Sync,
) -> Result<Vec<Vec<R>>, StudyError> {
    let jobs: Vec<_> = variants.iter().flat_map(|variant| motions.iter().map(move |motion| (motion, variant))).collect();
    let mut results = all_in_order(&jobs, progress, |(motion, variant)| work(motion, variant))?.into_iter();
    Ok(variants.iter().map(|_| results.by_ref().take(motions.len()).collect()).collect())
}
