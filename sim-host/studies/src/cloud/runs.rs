//! The runs of a study: every structure under every record, scaled, with every device.

use std::ops::Range;

use rayon::prelude::*;
use sprag_ensemble::shaken::{Samples, Shaken};
use sprag_report::long_run::in_order::in_order;
use sprag_shared::observers::outcome::Outcome;
use sprag_sim::accuracy::{ErrorEstimate, Worst};
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::Scene;
use sprag_sim::scene::motions::GroundMotions;
use sprag_sim::side_by_side::{self, Followed, Subject, followed};
use sprag_sim::simulation::{RunError, simulate_for_study};

use super::measure::Measure;
use super::records::StudyRecord;
use super::structures::StudyStructure;
use super::study::{Scaling, Study};

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
    /// Outcome of the run.
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
    /// Value of `measure` in the run.
    pub fn measure(&self, measure: Measure) -> f64 {
        Measure::ALL.into_iter().zip(self.measures).find(|(other, _)| *other == measure).map_or(0.0, |(_, value)| value)
    }
}

#[cfg(test)]
impl Run {
    /// One of a structure and a device: every measure is `intensity`, and both peaks of a block that stands are `peak`.
    pub(super) fn of(record: usize, intensity: f64, outcome: Outcome, peak: f64) -> Run {
        let peak = (!outcome.overturned()).then_some(peak);
        let answer = Answer { outcome, peak_rotation: peak, peak_acceleration: peak, impacts: 0, end_time_s: 0.0, error: None };
        let measures = [intensity; Measure::COUNT];
        Run { structure: 0, record, device: 0, factor: 1.0, level: None, measures, answer: Ok(answer) }
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
#[derive(Clone, Copy)]
struct Shaking<'a> {
    structure: usize,
    record: usize,
    motion: &'a StudyRecord,
    factor: f64,
    level: Option<f64>,
}

/// Shakings that one task takes, at most: enough to keep lanes full, and a twentieth of a small study.
const MOST_TOGETHER: usize = 256;

/// What a study runs: each of its structures under every record, scaled, with every device. A row is a run.
pub struct RunList<'a> {
    /// The study.
    pub study: &'a Study,
    /// Records of the study.
    pub records: &'a [StudyRecord],
    shakings: Vec<Shaking<'a>>,
    left_out: Vec<String>,
    targets: Vec<Target<'a>>,
    samples: Vec<Samples>,
}

impl<'a> RunList<'a> {
    /// Runs of `study` under `records`.
    pub fn new(study: &'a Study, records: &'a [StudyRecord]) -> RunList<'a> {
        let mut left_out = Vec::new();
        let mut shakings = Vec::new();
        for (number, structure) in study.structures.iter().enumerate() {
            for (record, motion) in records.iter().enumerate() {
                for (factor, level) in scales(study, structure, motion, &mut left_out) {
                    shakings.push(Shaking { structure: number, record, motion, factor, level });
                }
            }
        }
        let targets = study.structures.iter().map(Target::new).collect();
        let samples = records.par_iter().map(|record| Samples::from(&record.motion.record)).collect();
        RunList { study, records, shakings, left_out, targets, samples }
    }

    /// Runs of the same shaking, one a device: neighbouring rows.
    pub fn together(&self) -> usize {
        self.study.devices.len()
    }

    /// How many runs there are.
    pub fn rows(&self) -> usize {
        self.shakings.len() * self.together()
    }

    /// Rows that one task takes.
    fn task(&self) -> usize {
        (self.shakings.len() / 20).clamp(1, MOST_TOGETHER) * self.together()
    }

    /// Row number `row`, if it came to `answer`; `measures` are those of the scaled record.
    pub(super) fn run(&self, row: usize, measures: [f64; Measure::COUNT], answer: Result<Answer, String>) -> Run {
        let Shaking { structure, record, factor, level, .. } = self.shakings[row / self.together()];
        Run { structure, record, device: row % self.together(), factor, level, measures, answer }
    }

    /// The runs of `rows`, whole shakings; none once interrupted.
    fn runs(&self, rows: Range<usize>, interrupt: &Interrupt, done: &(dyn Fn() + Sync)) -> Option<Vec<Run>> {
        let shakings = &self.shakings[rows.start / self.together()..rows.end / self.together()];
        let of_one = shakings.chunk_by(|a, b| a.structure == b.structure);
        let runs = of_one.flat_map(|part| self.targets[part[0].structure].runs(part, &self.samples, interrupt, done)).collect();
        (!interrupt.is_set()).then_some(runs)
    }

    /// What `all` runs say together.
    pub fn sum_up(&self, all: Vec<Run>) -> Runs {
        let mut runs = Runs { left_out: self.left_out.clone(), ..Runs::default() };
        for run in &all {
            match &run.answer {
                Ok(Answer { error: Some(error), peak_rotation, .. }) => {
                    runs.worst.get_or_insert_default().note(error, *peak_rotation);
                }
                Ok(_) => {}
                Err(reason) => {
                    let [structure, record] = [&self.study.structures[run.structure].name, &self.records[run.record].name];
                    runs.left_out.push(format!("{structure}, {record} times {}: {reason}", run.factor));
                    runs.failed = true;
                }
            }
        }
        Runs { all, ..runs }
    }

    /// Works through `rows`, whole shakings, on rayon's threads, and hands runs to `keep` in their order; `done` is called after each.
    /// Neither the number of threads nor their order changes a bit of the runs. `false` when it was interrupted.
    ///
    /// # Errors
    /// The errors of `keep`.
    pub fn work_through<E: Send>(
        &self,
        rows: Range<usize>,
        interrupt: &Interrupt,
        done: &(dyn Fn() + Sync),
        keep: impl FnMut(Vec<Run>) -> Result<(), E>,
    ) -> Result<bool, E> {
        in_order(rows, self.task(), |rows| Ok(self.runs(rows, interrupt, done)), keep)
    }
}

impl Runs {
    /// Runs `study` under `records`. `begin` is given how many runs there will be, `done` is called after each.
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
        let list = RunList::new(study, records);
        begin(list.rows() as u64);
        let mut all = Vec::with_capacity(list.rows());
        let whole = list.work_through(0..list.rows(), interrupt, done, |runs| {
            all.extend(runs);
            Ok::<(), RunError>(())
        })?;
        if whole { Ok(list.sum_up(all)) } else { Err(RunError::Interrupted) }
    }
}

/// The factors on `motion`; levels without one go to `left_out`.
pub(crate) fn scales(
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

/// A structure, ready to be shaken.
struct Target<'a> {
    structure: &'a StudyStructure,
    /// One a device, so that the failure of one is not that of the others.
    subjects: Vec<Subject>,
}

impl Target<'_> {
    fn new(structure: &StudyStructure) -> Target<'_> {
        let scene = &structure.scene;
        Target { structure, subjects: (0..scene.devices.len()).map(|device| Subject::new(scene.only(device))).collect() }
    }

    /// Each of `shakings` with every device; fewer once interrupted.
    fn runs(&self, shakings: &[Shaking<'_>], samples: &[Samples], interrupt: &Interrupt, done: &(dyn Fn() + Sync)) -> Vec<Run> {
        let in_lanes = |subject| self.in_lanes(subject, shakings, samples, interrupt);
        let answers: Vec<Vec<Option<Answer>>> = self.subjects.iter().map(in_lanes).collect();
        let mut runs = Vec::with_capacity(shakings.len() * self.subjects.len());
        for (index, shaking) in shakings.iter().enumerate() {
            let Shaking { structure, record, factor, level, motion } = *shaking;
            let measures = Measure::ALL.map(|measure| measure.of(&motion.motion, factor, self.structure.scales));
            let mut ground = None;
            for (device, answers) in answers.iter().enumerate() {
                if interrupt.is_set() {
                    return runs;
                }
                let answer = match answers[index] {
                    Some(answer) => Ok(answer),
                    None => self.alone(device, ground.get_or_insert_with(|| self.ground(shaking)), interrupt),
                };
                runs.push(Run { structure, record, device, factor, level, measures, answer });
                done();
            }
        }
        runs
    }

    /// What becomes of `subject` under each of `shakings`, where the lanes can know; nothing once interrupted.
    fn in_lanes(
        &self,
        subject: &Subject,
        shakings: &[Shaking<'_>],
        samples: &[Samples],
        interrupt: &Interrupt,
    ) -> Vec<Option<Answer>> {
        if interrupt.is_set() {
            return vec![None; shakings.len()];
        }
        let level = |shaking: &Shaking<'_>| (&samples[shaking.record], shaking.factor);
        let run = |shaking| (subject, side_by_side::Shaking::Record { level: level(shaking), vertical: None });
        let found = followed(&shakings.iter().map(run).collect::<Vec<_>>());
        let answer = |(shaking, found): (_, Option<Followed>)| {
            Some(Answer::shaken(&found?.motion, &subject.scene, level(shaking).0.duration()))
        };
        shakings.iter().zip(found).map(answer).collect()
    }

    fn ground(&self, shaking: &Shaking<'_>) -> GroundMotions {
        shaking.motion.ground(shaking.factor, self.structure.scene.file.ground[0].start_s)
    }

    /// The run of one device by itself.
    fn alone(&self, device: usize, ground: &GroundMotions, interrupt: &Interrupt) -> Result<Answer, String> {
        let runs = simulate_for_study(&self.subjects[device].scene, ground, interrupt).map_err(|error| error.to_string())?;
        runs.first().map(Answer::of).ok_or_else(|| "no device".to_owned())
    }
}

impl Answer {
    /// Of a motion that has come to its end after a record of `duration` (s).
    fn shaken(shaken: &Shaken, scene: &Scene, duration: f64) -> Answer {
        let Shaken { peaks, impacts, .. } = shaken;
        let relative = shaken.relative_peaks(&scene.block);
        let from_start = peaks.ended.unwrap_or(duration + scene.free_time_s());
        Answer {
            outcome: shaken.outcome(),
            peak_rotation: relative.map(|(rotation, _)| rotation),
            peak_acceleration: relative.map(|(_, acceleration)| acceleration),
            impacts: *impacts,
            end_time_s: scene.file.ground[0].start_s + from_start,
            error: None,
        }
    }

    fn of(run: &sprag_sim::simulation::DeviceRun) -> Answer {
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
