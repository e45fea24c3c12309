//! A study's question for a device, and the runs that answer it.

use std::sync::OnceLock;

use rayon::prelude::*;
use sprag_sim::accuracy::Worst;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::accuracy::EventTreatment;
use sprag_sim::scene::error::KeyPath;
use sprag_sim::scene::schema::{DeviceTable, KeyOf, Kind};
use sprag_sim::scene::{Scene, SceneError};
use sprag_sim::simulation::RunError;

use super::curve::{Curve, curves, watched};
use super::delay::try_late;
use super::design::{Candidate, Design, Responses, Score};
use super::limit::Limits;
use super::motion::{Motion, motions};
use super::mount::MountEntry;
use super::objective::Objective;
use super::pulse::{Pulse, pulses};
use super::response::Response;
use super::search::search;
use super::specimen::{Specimen, specimens};
use super::subject::Subject;
use super::table::OptimiseTable;
use super::tried::Memory;
use crate::cloud::records::StudyRecord;
use crate::cloud::structures::StudyStructure;
use crate::cloud::study::Study;
use crate::statistics::Groups;

/// Designs that are tried at a time: enough for many threads, and no more than an interrupt may cost.
const TOGETHER: usize = 16;

/// Motions that go through the lanes at a time.
const IN_LANES: usize = 64;

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
    /// Pulses among the motions.
    pub pulses: Vec<Pulse>,
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
        let pulses = pulses(&table.pulse, &structure.scene, &key)?;
        Ok(Choices { study, structure, table, curves, pulses, limits, left_out })
    }

    /// What looks like a mistake in its mounts, in a line each, as in those of a scene ([`Scene::warnings`]).
    pub fn warnings(&self) -> Vec<String> {
        let reason = |mount: &MountEntry| self.structure.scene.above_the_block(mount.described().mount_height_m?);
        let of_mounts = self.table.mounts.iter().enumerate().filter_map(|(index, mount)| Some((index, reason(mount)?)));
        let origin = &self.study.origin;
        of_mounts.map(|(index, reason)| format!("{origin}: optimise.mounts.{index}.mount_height_m{reason}")).collect()
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
    /// The specimens that each of them shakes. Responses come by specimen, then by motion.
    pub specimens: Vec<Specimen>,
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
    /// The best of them with later clutches, by delay.
    pub late: Vec<Design>,
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
        let motions = motions(choices.study, choices.structure, records, choices.pulses.clone(), &mut left_out);
        let specimens = specimens(choices.table.robust.as_ref());
        Problem { choices, motions, specimens, left_out }
    }

    /// Which motions depend on each other.
    pub fn groups(&self) -> Groups {
        Groups::of(&self.motions.iter().map(Motion::group).collect::<Vec<_>>())
    }

    /// Runs of one design.
    pub fn trials(&self) -> usize {
        self.motions.len() * self.specimens.len()
    }

    /// What is made small.
    pub fn objective(&self) -> Objective {
        let quantile = self.choices.table.robust.and_then(|robust| robust.quantile);
        Objective { specimens: self.specimens.len(), quantile }
    }

    /// Tries designs on rayon's threads until the best is found, but for those that `memory` has of an earlier search. `begin` is given
    /// runs to come, as often as there are more; `done` those that are done, once `memory` keeps them. Neither the number of threads nor
    /// their order changes a bit of the solution.
    ///
    /// # Errors
    /// [`RunError::Interrupted`], and those of `memory`; runs that fail are among [`Solution::failures`].
    pub fn solve<M: Memory>(
        &self,
        memory: &mut M,
        interrupt: &Interrupt,
        begin: &dyn Fn(u64),
        done: &dyn Fn(u64),
    ) -> Result<Solution, M::Error> {
        let Choices { table, curves, limits, .. } = &self.choices;
        let objective = self.objective();
        let mut respond = |batch: &[Option<Candidate>]| self.respond_to(batch, memory, interrupt, (begin, done));
        let bare = respond(&[None])?.pop().unwrap_or_default();
        let mut evaluate = |batch: &[Candidate]| {
            let found = respond(&batch.iter().copied().map(Some).collect::<Vec<_>>())?;
            let design = |(at, responses): (&Candidate, Responses)| {
                let score = Score::of(&responses, &bare, limits, objective);
                Design { candidate: Some(*at), responses, score }
            };
            Ok::<_, M::Error>(batch.iter().zip(found).map(design).collect())
        };
        let designs = search(curves.len(), &table.mass_ratio.grid(), limits, &mut evaluate)?;
        let score = Score::of(&bare, &bare, limits, objective);
        let of_bare = Design { candidate: None, responses: bare.clone(), score };
        let late = try_late(self, &of_bare, &designs, &mut evaluate)?;
        Ok(self.solution(of_bare, designs, late))
    }

    /// The responses of the designs of a `batch`, remembered or new, a few designs at a time.
    fn respond_to<M: Memory>(
        &self,
        batch: &[Option<Candidate>],
        memory: &mut M,
        interrupt: &Interrupt,
        (begin, done): (&dyn Fn(u64), &dyn Fn(u64)),
    ) -> Result<Vec<Responses>, M::Error> {
        let mut found: Vec<Option<Responses>> = batch.iter().map(|of| memory.recall(*of)).collect();
        let new: Vec<usize> = (0..batch.len()).filter(|&index| found[index].is_none()).collect();
        begin((new.len() * self.trials()) as u64);
        for together in new.chunks(TOGETHER) {
            let subjects: Vec<_> = together.iter().map(|&index| self.subjects(batch[index])).collect();
            for (&index, responses) in together.iter().zip(self.respond(&subjects, interrupt)?) {
                memory.keep(batch[index], &responses)?;
                found[index] = Some(responses);
                done(self.trials() as u64);
            }
        }
        Ok(found.into_iter().flatten().collect())
    }

    /// Every specimen of the block with a device, or bare.
    fn subjects(&self, of: Option<Candidate>) -> Result<Vec<Subject>, String> {
        let scene = self.scene(of)?;
        let driven = of.is_some_and(|at| self.choices.curves[at.curve].controller.is_some());
        self.specimens.iter().map(|specimen| Subject::new(scene.clone(), driven, specimen)).collect()
    }

    /// η of every specimen with a device, or bare; none where the block has none.
    pub fn restitutions(&self, of: Option<Candidate>) -> Vec<Option<f64>> {
        let scene = self.scene(of).ok();
        let eta = |specimen: &Specimen| specimen.of(scene.clone()?).ok()?.structure(0).restitution().ok();
        self.specimens.iter().map(eta).collect()
    }

    fn scene(&self, of: Option<Candidate>) -> Result<Scene, String> {
        let base = &self.choices.structure.scene;
        let scene = match of {
            Some(Candidate { curve, mass_ratio, delay_s }) => self.choices.curves[curve].scene(base, mass_ratio, delay_s),
            None => watched(base, DeviceTable::of(Kind::None)),
        };
        scene.map_err(|error| error.to_string())
    }

    /// Responses of the specimens of every design to every motion, by design, then by specimen.
    fn respond(&self, designs: &[Result<Vec<Subject>, String>], interrupt: &Interrupt) -> Result<Vec<Responses>, RunError> {
        let subjects: Vec<Result<&Subject, &String>> = designs
            .iter()
            .flat_map(|design| match design {
                Ok(subjects) => subjects.iter().map(Ok).collect(),
                Err(reason) => vec![Err(reason); self.specimens.len()],
            })
            .collect();
        let in_lanes = |subject: &Result<&Subject, &String>| match subject {
            Ok(subject) if !interrupt.is_set() => {
                self.motions.par_chunks(IN_LANES).flat_map_iter(|some| subject.in_lanes(some)).collect()
            }
            _ => vec![None; self.motions.len()],
        };
        let in_lanes: Vec<Vec<Option<Response>>> = subjects.par_iter().map(in_lanes).collect();
        // One motion of the ground serves all that the core follows.
        let of_motion = |(index, motion): (usize, &Motion<'_>)| -> Responses {
            let ground = OnceLock::new();
            let run = |(subject, known): (&Result<&Subject, &String>, &Vec<Option<Response>>)| {
                if let Some(response) = known[index] {
                    return Ok(response);
                }
                if interrupt.is_set() {
                    return Err(RunError::Interrupted.to_string());
                }
                (*subject).map_err(String::clone)?.respond(ground.get_or_init(|| motion.ground()), interrupt)
            };
            subjects.par_iter().zip(&in_lanes).map(run).collect()
        };
        let by_motion: Vec<Responses> = self.motions.par_iter().enumerate().map(of_motion).collect();
        if interrupt.is_set() {
            return Err(RunError::Interrupted);
        }
        let of_subject = |subject: usize| by_motion.iter().map(move |found| found[subject].clone());
        let numbers: Vec<usize> = (0..subjects.len()).collect();
        Ok(numbers.chunks(self.specimens.len()).map(|some| some.iter().flat_map(|&one| of_subject(one)).collect()).collect())
    }

    fn solution(&self, bare: Design, designs: Vec<Design>, late: Vec<Design>) -> Solution {
        let mut solution = Solution { runs: 0, failures: Vec::new(), worst: None, bare, designs, late };
        for design in std::iter::once(&solution.bare).chain(&solution.designs).chain(&solution.late) {
            solution.runs += design.responses.len();
            for (motion, response) in self.motions.iter().cycle().zip(&design.responses) {
                match response {
                    Ok(Response { error: Some(error), peak_rotation, .. }) => {
                        solution.worst.get_or_insert_default().note(error, *peak_rotation);
                    }
                    Ok(_) => {}
                    Err(reason) => {
                        let name = self.choices.name(design.candidate);
                        solution.failures.push(format!("{name}, {}: {reason}", motion.scaled_name()));
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
            Some(Candidate { curve, mass_ratio, delay_s }) => {
                let late = if delay_s > 0.0 { format!(", {delay_s} s later") } else { String::new() };
                format!("{}, σ = {mass_ratio}{late}", self.curves[curve].name())
            }
            None => "bare block".to_owned(),
        }
    }
}
