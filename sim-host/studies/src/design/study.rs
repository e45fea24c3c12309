//! A parts list for each device of a scene under a set of motions.

use serde::Serialize;
use sprag_shared::observers::checks::Extreme;
use sprag_shared::structure::block::GRAVITY;
use sprag_shared::structure::mount::Mount;
use sprag_sim::accuracy::Worst;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::checks::CoilTable;
use sprag_sim::scene::device::Kind;
use sprag_sim::scene::{Scene, SceneError};
use sprag_sim::simulation::RunError;

use super::asked::Asked;
use super::basis::Basis;
use super::error::DesignError;
use super::flywheel::Disc;
use super::gear::{Pinion, pinion};
use super::largest::{Largest, largest};
use super::late::{Allowed, BISECTIONS, DELAYS_S, Unknown, allowed};
use super::parts::{Built, Item, Sizing};
use super::sensors::SensorClass;
use super::subject::Subject;
use crate::sensitivity::answer::Answer;
use crate::sensitivity::motion::StudyMotion;

/// A scene whose devices are to be designed.
#[derive(Debug)]
pub struct Problem<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// What is assumed.
    pub basis: Basis,
    /// Mass of the block, kg.
    mass_kg: f64,
    /// Numbers of the devices.
    devices: Vec<usize>,
}

/// A device and its parts.
#[derive(Clone, Debug, Serialize)]
pub struct PartsList {
    /// Name of the device.
    pub device: String,
    /// Sets of the parts in the list: one at each base corner there, of which the raised one works, and one elsewhere.
    pub sets: usize,
    /// Number of flywheels, of all sets.
    pub flywheels: usize,
    /// Inertance of each, kg.
    pub inertance_kg: f64,
    /// Whether the scene's controller drives its clutches.
    pub controlled: bool,
    /// Whether its support moves otherwise than the ground: travel and speed of the rack are those of the block then, and no rack is chosen.
    pub on_support: bool,
    /// Motions that were followed.
    pub motions: usize,
    /// Names of those that overturn the block: parts are for the time before its fall.
    pub overturned_by: Vec<String>,
    /// max |θ|/α where the block stands.
    pub largest_rotation: Option<Largest>,
    /// The lines of the list.
    pub items: Vec<Item>,
    /// The pinion, and the clutch on its shaft.
    pub pinion: Pinion,
    /// The flywheel.
    pub flywheel: Disc,
    /// The delay that the clutches are allowed; null of clutches that take no commands, and where nobody knows.
    pub delay: Option<Allowed>,
    /// Why nobody knows.
    pub delay_unknown: Option<String>,
    /// The chosen clutches as plates that slip; null where the scene has a clutch of its own, and where nobody knows.
    pub built: Option<Built>,
    /// Why nobody knows.
    pub built_unknown: Option<String>,
    /// Force at which the scene's own clutch slips, N; null where it has none that slips.
    pub scene_capacity_n: Option<f64>,
    /// Sensors of a controller.
    pub sensors: Option<SensorClass>,
    /// Largest coefficient of friction that the toe needs, impacts and jolts included, over the motions under which it stays on the ground; that
    /// and the next two are those of both runs.
    pub friction_needed: Option<f64>,
    /// Motions under which the toe would leave the ground.
    pub contact_lost: usize,
    /// Largest jump of the velocity of the centre of mass at an impact or a jolt, m/s.
    pub jump: Option<Largest>,
    /// What it asks for under each motion.
    #[serde(skip)]
    pub asked: Vec<Option<Asked>>,
}

/// All lists.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    /// By device.
    pub lists: Vec<PartsList>,
    /// Runs that failed, in a line each.
    pub failed: Vec<String>,
    /// What of the design could not be found out, in a line each.
    pub left_out: Vec<String>,
    /// The least accurate of the runs that parts are sized by, where that was asked for.
    pub worst: Option<Worst>,
}

impl<'a> Problem<'a> {
    /// The devices of `scene` with a flywheel that have one of `names`, or all without any.
    ///
    /// # Errors
    /// [`DesignError`] for an assumption outside its range, a block without a mass or on a foundation, and devices that there are not.
    pub fn new(scene: &'a Scene, names: &[String], basis: Basis) -> Result<Problem<'a>, DesignError> {
        basis.check()?;
        if scene.file.block.foundation.is_some() {
            let reason = "parts are sized for a block on rigid ground: leave block.foundation out";
            return Err(scene.key("block.foundation").conflict(reason).into());
        }
        let needed = "a size needs a force in N; give it in the scene, or by --set block.mass_kg=KG";
        let mass_kg = scene.file.block.mass_kg.ok_or_else(|| scene.key("block.mass_kg").missing(needed))?;
        let with_flywheel: Vec<usize> =
            (0..scene.devices.len()).filter(|&index| scene.devices[index].device.mass_ratio > 0.0).collect();
        if with_flywheel.is_empty() {
            return Err(DesignError::NoDevice { origin: scene.origin.clone() });
        }
        let name_of = |index: &usize| scene.devices[*index].name.as_str();
        if let Some(unknown) = names.iter().find(|name| !with_flywheel.iter().any(|index| name_of(index) == *name)) {
            let known: Vec<String> = with_flywheel.iter().map(|index| format!("{:?}", name_of(index))).collect();
            return Err(DesignError::UnknownDevice { name: unknown.clone(), known: known.join(", ") });
        }
        let asked_for = |index: &usize| names.is_empty() || names.iter().any(|name| name == name_of(index));
        Ok(Problem { scene, basis, mass_kg, devices: with_flywheel.into_iter().filter(asked_for).collect() })
    }

    /// Mass of the block, kg.
    pub fn mass_kg(&self) -> f64 {
        self.mass_kg
    }

    /// Sizes every device under `motions`, on rayon's threads; `begin` is told of runs to come, `done` called after each. The findings do not
    /// depend on the number of threads.
    ///
    /// # Errors
    /// [`DesignError`] for an interrupt, and where there is no list at all: for the first device that has no run, that nothing lifts, or whose force no
    /// standard gear bears. Beside devices with a list such a one is among what was left out.
    pub fn solve(
        &self,
        motions: &[StudyMotion],
        interrupt: &Interrupt,
        begin: &dyn Fn(usize),
        done: &(dyn Fn() + Sync),
    ) -> Result<Findings, DesignError> {
        let mut findings = Findings::default();
        let work = Work { motions, interrupt, begin, done };
        let mut first = None;
        for &index in &self.devices {
            match self.list(index, work, &mut findings) {
                Ok(list) => findings.lists.push(list),
                Err(error) if error.is_of_one_device() => {
                    findings.left_out.push(error.to_string());
                    first = first.or(Some(error));
                }
                Err(error) => return Err(error),
            }
        }
        match first {
            Some(error) if findings.lists.is_empty() => Err(error),
            _ => Ok(findings),
        }
    }

    fn list(&self, index: usize, work: Work<'_>, findings: &mut Findings) -> Result<PartsList, DesignError> {
        let (scene, basis, motions) = (self.scene, &self.basis, work.motions);
        let device = scene.devices[index].name.clone();
        let coil = scene.file.checks.as_ref().and_then(|checks| checks.coil);
        let bare = Subject::new(scene, index)?;
        let takes_commands = scene.devices[index].takes_commands();
        let asked = work.asked(&bare.clone().watched(coil), &device, findings)?;
        if asked.iter().all(Option::is_none) {
            let first = findings.failed.last().cloned().unwrap_or_default();
            return Err(DesignError::NoRun { device, first });
        }
        for (error, peak) in asked.iter().flatten().filter_map(|asked| Some((asked.error.as_ref()?, asked.peak_rotation))) {
            findings.worst.get_or_insert_default().note(error, peak);
        }
        let weight = self.mass_kg * GRAVITY;
        let drive = largest(motions, &asked, |asked| asked.located.drive).filter(|drive| drive.value > 0.0);
        let Some(drive) = drive else { return Err(DesignError::NeverRocks { device }) };
        let force_n = drive.value * weight;
        let has_clutches = scene.file.device[index].kind == Kind::ClutchedPair;
        let sets = if let Mount::BaseCorners { .. } = scene.devices[index].device.mount { 2 } else { 1 };
        let no_gear = |refused: Pinion| DesignError::NoGear {
            device: device.clone(),
            load_n: refused.load_n,
            load: if has_clutches { "at which the clutch slips" } else { "the largest force times the service factor" },
            teeth: basis.teeth,
            allowable_mpa: basis.allowable_stress_mpa,
        };
        let chosen = pinion(force_n, has_clutches, basis).map_err(no_gear)?;
        // Changed scenes have this device alone.
        let in_words = |error: SceneError| error.to_string().replacen("device.0.", &format!("device.{index}."), 1);
        let (mut delay, mut delay_unknown, mut built, mut built_unknown) = (None, None, None, None);
        let mut with_chosen = Vec::new();
        if takes_commands {
            let undelayed: Vec<Option<Answer>> = asked.iter().map(|asked| asked.as_ref().map(answer)).collect();
            (work.begin)((DELAYS_S.len() + BISECTIONS) * motions.len());
            match allowed(&bare, &undelayed, basis.tolerance, motions, work.interrupt, work.done).map_err(interrupted)? {
                Ok(allowed) => delay = Some(allowed),
                Err(Unknown::Scene(error)) => delay_unknown = Some(in_words(error)),
                Err(unknown) => delay_unknown = Some(unknown.to_string()),
            }
        }
        if let (Some(delay), true) = (&delay, takes_commands) {
            let late = |bare: Subject| if delay.delay_s > 0.0 { bare.later(delay.delay_s) } else { Ok(bare) };
            match bare.built(chosen.load_n).and_then(|built| built.map(late).transpose()) {
                Ok(None) => {}
                Ok(Some(subject)) => {
                    let found = work.asked(&subject.watched(coil), &format!("{device}, as chosen"), findings)?;
                    built = Some(compare(&chosen, delay.delay_s, (weight, coil.as_ref()), motions, (&asked, &found)));
                    with_chosen = found;
                }
                Err(error) => built_unknown = Some(in_words(error)),
            }
        }
        for (what, reason) in [("the delay allowed", &delay_unknown), ("the chosen clutches", &built_unknown)] {
            findings.left_out.extend(reason.as_ref().map(|reason| format!("{device}: {what}: {reason}")));
        }
        let speed = largest(motions, &asked, |asked| Some(asked.flywheel_speed()));
        let speed = speed.map(|speed| speed.or_larger(built.as_ref().and_then(|built| built.rack_speed_m_s.as_ref())));
        let inertance_kg = scene.devices[index].device.mass_ratio * self.mass_kg;
        let disc = Disc::new(inertance_kg, chosen.radius_m, speed.as_ref().map_or(0.0, |speed| speed.value));
        let on_support = scene.file.device[index].support_key().is_some();
        let clutch = scene.file.device[index].clutch.as_ref();
        let scene_capacity_n = clutch.and_then(|clutch| clutch.capacity_n.or(clutch.capacity_ratio.map(|ratio| ratio * weight)));
        let sizing = Sizing {
            motions,
            asked: &asked,
            basis,
            sets,
            mass_kg: self.mass_kg,
            pinion: &chosen,
            disc: &disc,
            flywheel_speed: speed.as_ref(),
            allowed: delay.as_ref(),
            controlled: bare.is_controlled(),
            built: built.as_ref(),
            on_support,
            coil,
        };
        let sensors = sizing.sensors();
        let items = sizing.items(sensors.as_ref());
        let jump = largest(motions, &asked, |asked| Some(asked.jump));
        let jump = jump.map(|jump| jump.or_larger(built.as_ref().and_then(|built| built.jump_m_s.as_ref())));
        let lost = |motion: usize| [&asked, &with_chosen].into_iter().filter_map(|runs| runs.get(motion)).any(loses_contact);
        let named = motions.iter().zip(&asked).filter(|(_, asked)| overturned(asked));
        Ok(PartsList {
            sets,
            flywheels: if has_clutches { 2 * sets } else { sets },
            inertance_kg,
            controlled: bare.is_controlled(),
            on_support,
            motions: asked.iter().flatten().count(),
            overturned_by: named.map(|(motion, _)| motion.name.clone()).collect(),
            largest_rotation: largest(motions, &asked, rotation),
            items,
            pinion: chosen,
            flywheel: disc,
            delay,
            delay_unknown,
            built,
            built_unknown,
            scene_capacity_n,
            sensors,
            friction_needed: [friction_needed(&asked), friction_needed(&with_chosen)].into_iter().flatten().reduce(f64::max),
            contact_lost: (0..motions.len()).filter(|&motion| lost(motion)).count(),
            jump,
            asked,
            device,
        })
    }
}

/// What all runs have in common.
#[derive(Clone, Copy)]
struct Work<'a> {
    motions: &'a [StudyMotion],
    interrupt: &'a Interrupt,
    begin: &'a dyn Fn(usize),
    done: &'a (dyn Fn() + Sync),
}

impl Work<'_> {
    /// What `subject`, called `name`, asks for; runs that fail are named in `findings`.
    fn asked(&self, subject: &Subject, name: &str, findings: &mut Findings) -> Result<Vec<Option<Asked>>, DesignError> {
        (self.begin)(self.motions.len());
        let found = subject.asked(self.motions, self.interrupt, self.done).map_err(interrupted)?;
        let kept = |(motion, asked): (&StudyMotion, Result<Asked, String>)| match asked {
            Ok(asked) => Some(asked),
            Err(reason) => {
                findings.failed.push(format!("{name} under {}: {reason}", motion.name));
                None
            }
        };
        Ok(self.motions.iter().zip(found).map(kept).collect())
    }
}

fn interrupted(_: RunError) -> DesignError {
    DesignError::Interrupted
}

fn answer(asked: &Asked) -> Answer {
    Answer { outcome: asked.outcome, peak: asked.peak_rotation, error: None }
}

fn overturned(asked: &Option<Asked>) -> bool {
    asked.as_ref().is_some_and(|asked| asked.outcome.overturned())
}

fn loses_contact(asked: &Option<Asked>) -> bool {
    asked.as_ref().is_some_and(|asked| asked.contact_lost)
}

fn friction_needed(asked: &[Option<Asked>]) -> Option<f64> {
    asked.iter().flatten().filter_map(|asked| asked.friction_needed).reduce(f64::max)
}

/// Peak rotation, which has no instant.
fn rotation(asked: &Asked) -> Option<Extreme<f64>> {
    asked.peak_rotation.map(|value| Extreme { value, time: f64::NAN })
}

/// What was found with the chosen clutches, beside what was without.
fn compare(
    chosen: &Pinion,
    delay_s: f64,
    (weight, coil): (f64, Option<&CoilTable>),
    motions: &[StudyMotion],
    (before, after): (&[Option<Asked>], &[Option<Asked>]),
) -> Built {
    let stood: Vec<Option<Asked>> =
        after.iter().zip(before).map(|(after, before)| after.filter(|_| !overturned(before))).collect();
    let mine = |of: &dyn Fn(&Asked) -> Option<Extreme<f64>>| {
        largest(motions, after, of).map(|largest| Largest { chosen_clutches: true, ..largest })
    };
    let newly = before.iter().zip(after).filter(|(before, after)| overturned(after) && !overturned(before));
    Built {
        capacity_n: chosen.load_n,
        delay_s,
        overturned: after.iter().filter(|asked| overturned(asked)).count(),
        newly_overturned: newly.count(),
        failed: after.iter().filter(|asked| asked.is_none()).count(),
        largest_rotation: largest(motions, &stood, rotation).map(|rotation| rotation.value),
        support_n: mine(&|asked| asked.located.support).map(|force| force.times(weight)),
        travel_m: mine(&|asked| asked.located.stroke),
        rack_speed_m_s: mine(&|asked| Some(asked.rack_speed)),
        rate_rad_s: mine(&|asked| Some(asked.rate)),
        acceleration_m_s2: mine(&|asked| Some(asked.acceleration())),
        coils_engaged_s: mine(&Asked::coils_engaged_s),
        coil_energy_j: mine(&|asked| asked.coil_energy_j(coil)),
        friction_needed: friction_needed(after),
        contact_lost: after.iter().filter(|asked| loses_contact(asked)).count(),
        jump_m_s: mine(&|asked| Some(asked.jump)),
    }
}
