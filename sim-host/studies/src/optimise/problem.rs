//! A study's question for a device, and the runs that answer it.

use rayon::prelude::*;
use sprag_sim::accuracy::Worst;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::accuracy::EventTreatment;
use sprag_sim::scene::error::KeyPath;
use sprag_sim::scene::schema::{DeviceTable, KeyOf, Kind};
use sprag_sim::scene::{Scene, SceneError};
use sprag_sim::simulation::{RunError, simulate_for_study};

use super::curve::{Curve, curves, watched};
use super::design::{Candidate, Design, Responses, Score};
use super::limit::Limits;
use super::motion::{Motion, motions};
use super::response::Response;
use super::search::search;
use super::table::OptimiseTable;
use super::tried::Memory;
use crate::cloud::records::StudyRecord;
use crate::cloud::structures::StudyStructure;
use crate::cloud::study::Study;

/// Designs that are tried at a time: enough for many threads, and no more than an interrupt may cost.
const TOGETHER: usize = 8;

/// Which devices a study has to choose from, every value within its range.
#[derive(Clone, Debug)]
pub struct Choices<'a> {
    /// The study.
    pub study: &'a Study,
    /// The structure that gets the device.
    pub structure: &'a StudyStructure,
    /// `[optimise]`, with defaults filled in.
    pub table: OptimiseTable,
    /// Laws and mounts.
    pub curves: Vec<Curve>,
    /// What devices may ask for.
    pub limits: Limits,
    /// Laws that cannot be on a mount, in a line each.
    pub left_out: Vec<String>,
}

impl<'a> Choices<'a> {
    /// Choices of `study`.
    ///
    /// # Errors
    /// [`SceneError`] names the key of the study, its value and what it may be.
    pub fn of(study: &'a Study) -> Result<Choices<'a>, SceneError> {
        let key = |name: &str| KeyPath { origin: study.origin.clone(), key: format!("optimise.{name}") };
        let mut table = study.file.optimise.clone().unwrap_or_default();
        table.check(&key)?;
        let structure = structure(study, &table, key("structure"))?;
        limits_of_scene(&mut table, &structure.scene, &key)?;
        if structure.scene.file.accuracy.events == EventTreatment::StepEnd {
            let of_scene = KeyPath { origin: structure.scene.origin.clone(), key: "accuracy.events".to_owned() };
            return Err(of_scene.conflict("largest forces lie between steps: an optimisation needs \"located\""));
        }
        let mut left_out = Vec::new();
        let curves = curves(&table, &structure.scene, &key, &mut left_out)?;
        let limits = Limits {
            force: table.largest_force_ratio,
            stroke: table.largest_stroke_m,
            tooth_stress: table.largest_tooth_stress_mpa,
            coil_energy: table.largest_coil_energy_j,
            quantile: table.limit_quantile,
            force_of_overturned: table.force_of_overturned,
        };
        Ok(Choices { study, structure, table, curves, limits, left_out })
    }
}

/// Fills in the limits of `scene` where `table` has none.
///
/// # Errors
/// [`SceneError`] for a limit on what the scene does not have.
fn limits_of_scene(table: &mut OptimiseTable, scene: &Scene, key: &KeyOf<'_>) -> Result<(), SceneError> {
    let checks = scene.file.checks.clone().unwrap_or_default();
    for (name, limit, part, there) in [
        ("largest_tooth_stress_mpa", table.largest_tooth_stress_mpa, "checks.gear", checks.gear.is_some()),
        ("largest_coil_energy_j", table.largest_coil_energy_j, "checks.coil", checks.coil.is_some()),
    ] {
        if limit.is_some() && !there {
            return Err(key(name).conflict(&format!("it needs {part} of the scene")));
        }
    }
    table.largest_force_ratio = table.largest_force_ratio.or(checks.largest_force_ratio);
    table.largest_stroke_m = table.largest_stroke_m.or(checks.largest_stroke_m);
    let (of_gear, of_coil) =
        (checks.gear.map(|gear| gear.allowable_stress_mpa), checks.coil.and_then(|coil| coil.largest_energy_j));
    table.largest_tooth_stress_mpa = table.largest_tooth_stress_mpa.or(of_gear);
    table.largest_coil_energy_j = table.largest_coil_energy_j.or(of_coil);
    Ok(())
}

/// The structure of `study` that gets the device.
fn structure<'a>(study: &'a Study, table: &OptimiseTable, key: KeyPath) -> Result<&'a StudyStructure, SceneError> {
    let names = || study.structures.iter().map(|structure| format!("{:?}", structure.name)).collect::<Vec<_>>().join(", ");
    match (&table.structure, &study.structures[..]) {
        (None, [only]) => Ok(only),
        (None, _) => Err(key.missing(&format!("which of the structures {} gets the device", names()))),
        (Some(name), all) => all
            .iter()
            .find(|structure| structure.name == *name)
            .ok_or_else(|| key.outside(format!("{name:?}"), &format!("among the structures {}", names()))),
    }
}

/// Choices and the motions under which they are tried.
#[derive(Clone, Debug)]
pub struct Problem<'a> {
    /// The devices.
    pub choices: Choices<'a>,
    /// The motions.
    pub motions: Vec<Motion<'a>>,
    /// Levels that no factor gives, in a line each.
    pub left_out: Vec<String>,
}

/// What was tried, and what came of it.
#[derive(Clone, Debug)]
pub struct Solution {
    /// The bare block.
    pub bare: Design,
    /// Devices, by law and mount and by mass ratio.
    pub designs: Vec<Design>,
    /// Runs of one design under one motion, that of the bare block included.
    pub runs: usize,
    /// Runs that failed, in a line each.
    pub failures: Vec<String>,
    /// The least accurate of the others, where that was asked for.
    pub worst: Option<Worst>,
}

impl<'a> Problem<'a> {
    /// `choices` under `records`, scaled as their study says.
    pub fn new(choices: Choices<'a>, records: &'a [StudyRecord]) -> Problem<'a> {
        let mut left_out = Vec::new();
        let motions = motions(choices.study, choices.structure, records, &mut left_out);
        Problem { choices, motions, left_out }
    }

    /// Tries designs on rayon's threads until the best is found, but for those that `memory` has of an earlier search. `begin` is given
    /// runs to come, as often as there are more; `done` is called after each. Neither the number of threads nor their order changes a
    /// bit of the solution.
    ///
    /// # Errors
    /// [`RunError::Interrupted`], and those of `memory`; runs that fail are among [`Solution::failures`].
    pub fn solve<M: Memory>(
        &self,
        memory: &mut M,
        interrupt: &Interrupt,
        begin: &dyn Fn(u64),
        done: &(dyn Fn() + Sync),
    ) -> Result<Solution, M::Error> {
        let Choices { table, curves, limits, .. } = &self.choices;
        let mut respond = |batch: &[Option<Candidate>]| self.respond_to(batch, memory, interrupt, (begin, done));
        let bare = respond(&[None])?.pop().unwrap_or_default();
        let designs = search(curves.len(), &table.mass_ratio.grid(), limits, |batch: &[Candidate]| {
            let found = respond(&batch.iter().copied().map(Some).collect::<Vec<_>>())?;
            let design = |(at, responses): (&Candidate, Responses)| {
                let score = Score::of(&responses, &bare, limits);
                Design { candidate: Some(*at), responses, score }
            };
            Ok::<_, M::Error>(batch.iter().zip(found).map(design).collect())
        })?;
        let score = Score::of(&bare, &bare, limits);
        let bare = Design { candidate: None, responses: bare, score };
        Ok(self.solution(bare, designs))
    }

    /// The responses of the designs of a `batch`, remembered or new, a few designs at a time.
    fn respond_to<M: Memory>(
        &self,
        batch: &[Option<Candidate>],
        memory: &mut M,
        interrupt: &Interrupt,
        (begin, done): (&dyn Fn(u64), &(dyn Fn() + Sync)),
    ) -> Result<Vec<Responses>, M::Error> {
        let mut found: Vec<Option<Responses>> = batch.iter().map(|of| memory.recall(*of)).collect();
        let new: Vec<usize> = (0..batch.len()).filter(|&index| found[index].is_none()).collect();
        begin((new.len() * self.motions.len()) as u64);
        for together in new.chunks(TOGETHER) {
            let scenes: Vec<_> = together.iter().map(|&index| self.scene(batch[index])).collect();
            for (&index, responses) in together.iter().zip(self.respond(&scenes, interrupt, done)?) {
                memory.keep(batch[index], &responses)?;
                found[index] = Some(responses);
            }
        }
        Ok(found.into_iter().flatten().collect())
    }

    /// The block with a device, or bare.
    fn scene(&self, of: Option<Candidate>) -> Result<Scene, String> {
        let base = &self.choices.structure.scene;
        let scene = match of {
            Some(Candidate { curve, mass_ratio }) => self.choices.curves[curve].scene(base, mass_ratio),
            None => watched(base, DeviceTable::of(Kind::None)),
        };
        scene.map_err(|error| error.to_string())
    }

    /// Responses of every scene to every motion, by scene.
    fn respond(
        &self,
        scenes: &[Result<Scene, String>],
        interrupt: &Interrupt,
        done: &(dyn Fn() + Sync),
    ) -> Result<Vec<Responses>, RunError> {
        let of_motion = |motion: &Motion<'_>| -> Responses {
            let ground = motion.ground();
            let run = |scene: &Result<Scene, String>| {
                let scene = scene.as_ref().map_err(Clone::clone)?;
                if interrupt.is_set() {
                    return Err(RunError::Interrupted.to_string());
                }
                let runs = simulate_for_study(scene, &ground, interrupt).map_err(|error| error.to_string())?;
                done();
                runs.first().map(Response::of).ok_or_else(|| "no device".to_owned())
            };
            scenes.par_iter().map(run).collect()
        };
        let by_motion: Vec<Responses> = self.motions.par_iter().map(of_motion).collect();
        if interrupt.is_set() {
            return Err(RunError::Interrupted);
        }
        let mut by_scene: Vec<Responses> = scenes.iter().map(|_| Vec::with_capacity(by_motion.len())).collect();
        for responses in by_motion {
            by_scene.iter_mut().zip(responses).for_each(|(of_scene, response)| of_scene.push(response));
        }
        Ok(by_scene)
    }

    fn solution(&self, bare: Design, designs: Vec<Design>) -> Solution {
        let mut solution = Solution { runs: 0, failures: Vec::new(), worst: None, bare, designs };
        for design in std::iter::once(&solution.bare).chain(&solution.designs) {
            solution.runs += design.responses.len();
            for (motion, response) in self.motions.iter().zip(&design.responses) {
                match response {
                    Ok(Response { error: Some(error), peak_rotation, .. }) => {
                        solution.worst.get_or_insert_default().note(error, *peak_rotation);
                    }
                    Ok(_) => {}
                    Err(reason) => {
                        let name = self.choices.name(design.candidate);
                        solution.failures.push(format!("{name}, {}: {reason}", motion.name()));
                    }
                }
            }
        }
        solution
    }
}

impl Choices<'_> {
    /// A device in one string.
    pub fn name(&self, candidate: Option<Candidate>) -> String {
        match candidate {
            Some(Candidate { curve, mass_ratio }) => format!("{}, σ = {mass_ratio}", self.curves[curve].name()),
            None => "bare block".to_owned(),
        }
    }
}
