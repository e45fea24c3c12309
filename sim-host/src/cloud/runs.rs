//! The runs of a study: every structure under every record, scaled, with every device.

use rayon::prelude::*;

use super::measure::Measure;
use super::records::StudyRecord;
use super::structures::StudyStructure;
use super::study::{Scaling, Study};
use crate::accuracy::{ErrorEstimate, Worst};
use crate::ground_motion::{Component, GroundMotion};
use crate::interrupt::Interrupt;
use crate::outcome::Outcome;
use crate::record::STANDARD_GRAVITY_M_S2;
use crate::scene::Scene;
use crate::scene::motions::GroundMotions;
use crate::simulation::{RunError, simulate};

/// One run.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Number of the structure.
    pub structure: usize,
    /// Number of the record.
    pub record: usize,
    /// Number of the device.
    pub device: usize,
    /// Factor on the record.
    pub factor: f64,
    /// Level that it was scaled to, in a study of stripes.
    pub level: Option<f64>,
    /// Measures of the scaled record, in the order of [`Measure::ALL`].
    pub measures: [f64; Measure::COUNT],
    /// What it came to, or why it failed.
    pub answer: Result<Answer, String>,
}

/// What a run came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// Its outcome.
    pub outcome: Outcome,
    /// max |θ|/α; `None` when overturned.
    pub peak_rotation: Option<f64>,
    /// max |θ̈|/(p²α); `None` when overturned.
    pub peak_acceleration: Option<f64>,
    /// Impacts.
    pub impacts: u32,
    /// Rest, overturning or the end of the run, s.
    pub end_time_s: f64,
    /// How accurate that is, where it was asked for.
    pub error: Option<ErrorEstimate>,
}

impl Run {
    /// Its value of `measure`.
    pub fn measure(&self, measure: Measure) -> f64 {
        Measure::ALL.into_iter().zip(self.measures).find(|(other, _)| *other == measure).map_or(0.0, |(_, value)| value)
    }
}

/// All runs of a study.
#[derive(Clone, Debug, Default)]
pub struct Runs {
    /// By structure, record, scale and device.
    pub all: Vec<Run>,
    /// Records that have no level of a stripe, and runs that failed, in a line each.
    pub left_out: Vec<String>,
    /// Whether a run failed.
    pub failed: bool,
    /// The least accurate of them, where that was asked for.
    pub worst: Option<Worst>,
}

/// A scaled record under a structure.
struct Shaking<'a> {
    structure: usize,
    record: usize,
    motion: &'a StudyRecord,
    factor: f64,
    level: Option<f64>,
}

impl Runs {
    /// Runs `study` under `records` on rayon's threads. `begin` is told how many runs there will be, `done` is called after
    /// each. Neither the number of threads nor their order changes a bit of the runs.
    ///
    /// # Errors
    /// [`RunError::Interrupted`]; runs that fail are among [`Runs::left_out`].
    pub fn of(
        study: &Study,
        records: &[StudyRecord],
        interrupt: &Interrupt,
        begin: impl FnOnce(u64),
        done: &(dyn Fn() + Sync),
    ) -> Result<Runs, RunError> {
        let mut runs = Runs::default();
        let mut shakings = Vec::new();
        for (number, structure) in study.structures.iter().enumerate() {
            for (record, motion) in records.iter().enumerate() {
                for (factor, level) in scales(study, structure, motion, &mut runs.left_out) {
                    shakings.push(Shaking { structure: number, record, motion, factor, level });
                }
            }
        }
        let scenes: Vec<Vec<Scene>> = study.structures.iter().map(|structure| devices(&structure.scene)).collect();
        begin((shakings.len() * study.devices.len()) as u64);
        let found: Vec<Vec<Run>> = shakings
            .par_iter()
            .map(|shaking| shaking.run(&study.structures[shaking.structure], &scenes[shaking.structure], interrupt, done))
            .collect();
        if interrupt.is_set() {
            return Err(RunError::Interrupted);
        }
        runs.all = found.into_iter().flatten().collect();
        for run in &runs.all {
            match &run.answer {
                Ok(Answer { error: Some(error), peak_rotation, .. }) => {
                    runs.worst.get_or_insert_default().note(error, *peak_rotation);
                }
                Ok(_) => {}
                Err(reason) => {
                    let [structure, record] = [&study.structures[run.structure].name, &records[run.record].name];
                    runs.left_out.push(format!("{structure}, {record} times {}: {reason}", run.factor));
                    runs.failed = true;
                }
            }
        }
        Ok(runs)
    }
}

/// The factors on `motion`; levels without one go to `left_out`.
fn scales(
    study: &Study,
    structure: &StudyStructure,
    motion: &StudyRecord,
    left_out: &mut Vec<String>,
) -> Vec<(f64, Option<f64>)> {
    match &study.scaling {
        Scaling::Factors(factors) => factors.iter().map(|factor| (*factor, None)).collect(),
        Scaling::Levels(measure, levels) => {
            let mut found = Vec::new();
            for &level in levels {
                match measure.factor(&motion.motion, level, structure.scales) {
                    Some(factor) => found.push((factor, Some(level))),
                    None => left_out.push(format!(
                        "{}, {}: no factor up to {} gives a {} of {level}",
                        structure.name,
                        motion.name,
                        super::measure::LARGEST_FACTOR,
                        measure.name()
                    )),
                }
            }
            found
        }
    }
}

/// A scene for each device, so that the failure of one is not that of the others.
fn devices(scene: &Scene) -> Vec<Scene> {
    (0..scene.devices.len()).map(|device| scene.only(device)).collect()
}

impl Shaking<'_> {
    /// With every device; fewer once interrupted.
    fn run(&self, structure: &StudyStructure, scenes: &[Scene], interrupt: &Interrupt, done: &(dyn Fn() + Sync)) -> Vec<Run> {
        let motion = &self.motion.motion;
        let samples = motion.record.acceleration_m_s2.iter().map(|a| self.factor * a / STANDARD_GRAVITY_M_S2);
        let start = structure.scene.file.ground[0].start_s;
        let component = Component::record(start, motion.record.time_step_s, samples);
        let ground = GroundMotions { horizontal: GroundMotion::sum(&[component]), vertical: None };
        let measures = Measure::ALL.map(|measure| measure.of(motion, self.factor, structure.scales));
        let mut runs = Vec::new();
        for (device, scene) in scenes.iter().enumerate() {
            if interrupt.is_set() {
                break;
            }
            let answer = simulate(scene, &ground, interrupt).map_err(|error| error.to_string());
            let answer = answer.and_then(|runs| runs.first().map(Answer::of).ok_or_else(|| "no device".to_owned()));
            let Shaking { structure, record, factor, level, .. } = *self;
            runs.push(Run { structure, record, device, factor, level, measures, answer });
            done();
        }
        runs
    }
}

impl Answer {
    fn of(run: &crate::simulation::DeviceRun) -> Answer {
        Answer {
            outcome: run.outcome,
            peak_rotation: run.peak_rotation,
            peak_acceleration: run.peak_acceleration,
            impacts: run.impacts,
            end_time_s: run.end_time_s,
            error: run.error.map(|report| report.estimate),
        }
    }
}
