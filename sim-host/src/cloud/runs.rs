//! The runs of a study: every structure under every record, scaled, with every device.

use rayon::prelude::*;

use super::measure::Measure;
use super::records::StudyRecord;
use super::structures::StudyStructure;
use super::study::{Scaling, Study};
use crate::accuracy::{ErrorEstimate, Worst};
use crate::ensemble::machine::{Registers, shake};
use crate::ensemble::plain::PlainBlock;
use crate::ensemble::records::{Samples, Shaken, ShakenBlock};
use crate::interrupt::Interrupt;
use crate::outcome::Outcome;
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
        let subjects: Vec<Subject<'_>> = study.structures.iter().map(Subject::new).collect();
        let samples: Vec<Samples> = records.par_iter().map(|record| Samples::of(&record.motion.record)).collect();
        begin((shakings.len() * study.devices.len()) as u64);
        let together = (shakings.len() / 20).clamp(1, MOST_TOGETHER);
        let found: Vec<Vec<Run>> = shakings
            .par_chunks(together)
            .flat_map_iter(|shakings| shakings.chunk_by(|a, b| a.structure == b.structure))
            .map(|shakings| subjects[shakings[0].structure].runs(shakings, &samples, interrupt, done))
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
struct Subject<'a> {
    structure: &'a StudyStructure,
    /// A scene for each device, so that the failure of one is not that of the others.
    scenes: Vec<Scene>,
    /// Those of its devices that the lanes know.
    plain: Vec<Option<PlainBlock>>,
}

impl Subject<'_> {
    fn new(structure: &StudyStructure) -> Subject<'_> {
        let scene = &structure.scene;
        let devices = 0..scene.devices.len();
        let plain = devices.clone().map(|device| PlainBlock::of(scene, device)).collect();
        Subject { structure, scenes: devices.map(|device| scene.only(device)).collect(), plain }
    }

    /// Each of `shakings` with every device; fewer once interrupted.
    fn runs(&self, shakings: &[Shaking<'_>], samples: &[Samples], interrupt: &Interrupt, done: &(dyn Fn() + Sync)) -> Vec<Run> {
        let devices = 0..self.scenes.len();
        let answers: Vec<Vec<Option<Answer>>> =
            devices.map(|device| self.in_lanes(device, shakings, samples, interrupt)).collect();
        let mut runs = Vec::with_capacity(shakings.len() * self.scenes.len());
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

    /// What becomes of the block under each of `shakings` with device number `device`, where the lanes can tell.
    fn in_lanes(
        &self,
        device: usize,
        shakings: &[Shaking<'_>],
        samples: &[Samples],
        interrupt: &Interrupt,
    ) -> Vec<Option<Answer>> {
        let scene = &self.scenes[device];
        let (Some(plain), false) = (self.plain[device], interrupt.is_set()) else { return vec![None; shakings.len()] };
        let block = |shaking: &Shaking<'_>| ShakenBlock {
            plain,
            frequency_parameter: scene.block.frequency_parameter(),
            samples: &samples[shaking.record],
            factor: shaking.factor,
        };
        let blocks: Vec<ShakenBlock<'_>> = shakings.iter().map(block).collect();
        let structure = scene.structure(0);
        let after = |(block, found): (&ShakenBlock<'_>, Option<Shaken>)| {
            let shaken = found?.after(&structure, "", block.samples.duration(), scene.free_time_s()).ok()?;
            Some(Answer::shaken(&shaken, scene, block.samples.duration()))
        };
        blocks.iter().zip(shake(&blocks, Registers::Widest)).map(after).collect()
    }

    /// The motion of the ground.
    fn ground(&self, shaking: &Shaking<'_>) -> GroundMotions {
        shaking.motion.ground(shaking.factor, self.structure.scene.file.ground[0].start_s)
    }

    /// The run of one device by itself.
    fn alone(&self, device: usize, ground: &GroundMotions, interrupt: &Interrupt) -> Result<Answer, String> {
        let runs = simulate(&self.scenes[device], ground, interrupt).map_err(|error| error.to_string())?;
        runs.first().map(Answer::of).ok_or_else(|| "no device".to_owned())
    }
}

impl Answer {
    /// Of a motion that has come to its end after a record of `duration` (s).
    fn shaken(shaken: &Shaken, scene: &Scene, duration: f64) -> Answer {
        let (alpha, p) = (scene.block.slenderness(), scene.block.frequency_parameter());
        let Shaken { peaks, impacts, .. } = shaken;
        let outcome = shaken.outcome();
        let safe = |value: f64| (!outcome.overturned()).then_some(value);
        let from_start = peaks.ended.unwrap_or(duration + scene.free_time_s());
        Answer {
            outcome,
            peak_rotation: safe(peaks.rotation / alpha),
            peak_acceleration: safe(peaks.acceleration / (p * p * alpha)),
            impacts: *impacts,
            end_time_s: scene.file.ground[0].start_s + from_start,
            error: None,
        }
    }

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
