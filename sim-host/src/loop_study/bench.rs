//! Many closed loops in parallel: motions by variants.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use crate::accuracy::{Accuracy, Closeness, Worst};
use crate::closed_loop::run::Ending;
use crate::closed_loop::{LoopFailure, LoopTask};
use crate::cloud::study_file::RecordTable;
use crate::interrupt::Interrupt;
use crate::outcome::Outcome;
use crate::progress::Progress;
use crate::record::RecordSummary;
use crate::scene::Scene;
use crate::scene::error::SceneError;
use crate::scene::ground::GroundError;
use crate::simulation::ErrorReport;

/// A ground motion of a study.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// A one-cycle pulse.
    Pulse {
        /// "sine" or "cosine".
        shape: &'static str,
        /// ω_g/p.
        frequency: f64,
        /// a_g/(g tan α).
        amplitude: f64,
    },
    /// A recorded one.
    Record {
        /// File, from where the user stands.
        file: PathBuf,
        /// What the file does not say.
        reading: RecordTable,
        /// Factor on its accelerations.
        scale: f64,
    },
}

impl Motion {
    /// `[[ground]]` and `[run]` of a scene.
    fn tables(&self) -> String {
        match self {
            Motion::Pulse { shape, frequency, amplitude } => format!(
                "[[ground]]\nmotion = \"{shape}\"\nfrequency_ratio = {frequency:?}\namplitude_ratio = {amplitude:?}\n\
                 [run]\nfree_time_ratio = 10.0\n"
            ),
            Motion::Record { file, reading, scale } => {
                let file = toml::Value::String(file.display().to_string().replace('\\', "/"));
                let reading = toml::to_string(reading).unwrap_or_default();
                format!("[[ground]]\nmotion = \"record\"\nfile = {file}\nscale = {scale:?}\n{reading}[run]\nfree_time_s = 5.0\n")
            }
        }
    }
}

/// A structure with its device and controller, in the words of a scene; without a ground motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    /// For tables.
    pub name: String,
    /// Keys of the scene.
    pub overrides: Vec<String>,
    /// Of the sensors.
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

/// Why a study ended early.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A scene that the study wrote.
    #[error("{0}")]
    Scene(#[from] SceneError),
    /// A record.
    #[error("{0}")]
    Ground(#[from] GroundError),
    /// A loop.
    #[error("{motion}: {failure}")]
    Loop {
        /// Motion and variant.
        motion: String,
        /// Why.
        failure: LoopFailure,
    },
    /// Ctrl-C.
    #[error("interrupted")]
    Interrupted,
    /// A figure.
    #[error("the picture cannot be drawn: {0}")]
    Plot(#[from] crate::plot::PlotError),
}

/// The scene of a motion and a variant.
///
/// # Errors
/// [`StudyError`] for a scene that cannot be.
pub fn scene_of(motion: &Motion, variant: &Variant) -> Result<Scene, StudyError> {
    let text = format!("{BASE}{}", motion.tables());
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
    /// Of a study that begins.
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
///
/// # Errors
/// [`StudyError`].
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
    let task = LoopTask {
        scene: &scene,
        ground: &ground,
        index: 0,
        controller: &controller,
        suite: &suite,
        seed: variant.seed,
        closeness: conditions.accuracy.map(|accuracy| Closeness { tolerance: accuracy.tolerance() }),
        interrupt: conditions.interrupt,
    };
    work(&task).map_err(|failure| match failure {
        LoopFailure::Loop(crate::closed_loop::run::LoopError::Interrupted) => StudyError::Interrupted,
        failure => StudyError::Loop { motion: format!("{motion:?}, {}", variant.name), failure },
    })
}

/// Runs one closed loop.
///
/// # Errors
/// [`StudyError`].
pub fn run_loop(motion: &Motion, variant: &Variant, conditions: &Conditions<'_>) -> Result<LoopResult, StudyError> {
    with_loop(motion, variant, conditions, |task| {
        let (_, error, looped) = task.answered::<()>()?;
        let (outcome, peak) = (looped.outcome(), looped.extremes.peaks.rotation / task.scene.block.slenderness());
        if let Some(error) = error {
            conditions.note(&error, (!outcome.overturned()).then_some(peak));
        }
        Ok(LoopResult { outcome, peak, ending: looped.ending })
    })
}

/// Outcome and peak |θ|/α of the ideal device of `variant` without a controller.
///
/// # Errors
/// [`StudyError`].
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
    progress.begin((motions.len() * variants.len()) as u64);
    let results: Vec<Result<R, StudyError>> = (0..motions.len() * variants.len())
        .into_par_iter()
        .map(|index| {
            let result = work(&motions[index % motions.len()], &variants[index / motions.len()]);
            progress.step();
            result
        })
        .collect();
    let mut results = results.into_iter();
    let by_variant = |_| results.by_ref().take(motions.len()).collect::<Result<Vec<R>, StudyError>>();
    (0..variants.len()).map(by_variant).collect()
}

/// A grid of pulses, both shapes: ω/p from `frequencies` and amplitudes from `amplitudes`, first and last included.
pub fn grid(shape: &'static str, count: usize, frequencies: (f64, f64), amplitudes: (f64, f64)) -> Vec<Motion> {
    let at = |(from, to): (f64, f64), index: usize| from + (to - from) * index as f64 / (count.max(2) - 1) as f64;
    (0..count * count)
        .map(|index| Motion::Pulse { shape, frequency: at(frequencies, index % count), amplitude: at(amplitudes, index / count) })
        .collect()
}
