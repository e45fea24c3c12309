//! The runs of a study: every motion, every device, as the scene has it and with each variant.

use std::path::Path;

use rayon::prelude::*;
use sprag_sim::accuracy::Worst;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::{Scene, SceneError, document, overrides, text_of};
use sprag_sim::side_by_side::Subject;
use sprag_sim::simulation::RunError;

use super::answer::{Answer, Missing, answers};
use super::motion::{StudyMotion, with_vertical};
use super::variants::{VARIANTS, Variant};

/// Peak |θ|/α of the scene as it is from which a change is reported: below it a block hardly rocks, and ratios are of nothing.
pub const ROCKS_FROM: f64 = 0.05;

/// A variant against the scene as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Number of the motion.
    pub motion: usize,
    /// Number of the device.
    pub device: usize,
    /// Number in [`VARIANTS`].
    pub variant: usize,
    /// The scene as it is.
    pub base: Answer,
    /// The variant.
    pub answer: Answer,
}

/// Direction in which an outcome changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flip {
    /// The block stood and now overturns.
    ToOverturned,
    /// It overturned and now stands.
    ToStanding,
}

impl Comparison {
    /// Relative change of the peak rotation, where both blocks stand and the one of the scene as it is rocks.
    pub fn change(&self) -> Option<f64> {
        let (base, answer) = (self.base.peak?, self.answer.peak?);
        (base >= ROCKS_FROM).then(|| answer / base - 1.0)
    }

    /// Whether it decides about overturning.
    pub fn flip(&self) -> Option<Flip> {
        match (self.base.outcome.overturned(), self.answer.outcome.overturned()) {
            (false, true) => Some(Flip::ToOverturned),
            (true, false) => Some(Flip::ToStanding),
            _ => None,
        }
    }
}

/// What a study compares: for each device the scene as it is, and with each variant that is for it.
#[derive(Debug)]
pub struct Study {
    /// The devices' names.
    pub devices: Vec<String>,
    /// Variants left out for a device, and why, in a line each.
    pub left_out: Vec<String>,
    setups: Vec<Setup>,
}

/// One device of a scene.
#[derive(Debug)]
struct Setup {
    device: usize,
    variant: Option<usize>,
    subject: Subject,
}

/// What all runs of a study came to.
#[derive(Debug, Default)]
pub struct Findings {
    /// By variant, device and motion.
    pub comparisons: Vec<Comparison>,
    /// Runs under one motion that could not be had, and why, in a line each.
    pub left_out: Vec<String>,
    /// Runs that failed, in a line each.
    pub failed: Vec<String>,
    /// The least accurate of them, where that was asked for.
    pub worst: Option<Worst>,
}

impl Study {
    /// The study of the scene at `path` with `overrides`.
    ///
    /// # Errors
    /// [`SceneError`] when the scene itself is wrong.
    pub fn load(path: &Path, overrides: &[String]) -> Result<(Scene, Study), SceneError> {
        let base = Scene::load(path, overrides)?;
        let mut study = Study {
            devices: base.devices.iter().map(|device| device.name.clone()).collect(),
            left_out: Vec::new(),
            setups: Vec::new(),
        };
        for device in 0..base.devices.len() {
            study.setups.push(Setup { device, variant: None, subject: Subject::new(base.only(device)) });
        }
        for (number, variant) in VARIANTS.iter().enumerate() {
            for (device, table) in base.file.device.iter().enumerate() {
                let Some(changes) = variant.overrides(device, table.kind) else {
                    continue;
                };
                match changed(path, overrides, &base, variant, &changes, device) {
                    Ok(scene) => {
                        study.setups.push(Setup { device, variant: Some(number), subject: Subject::new(scene) });
                    }
                    Err(reason) => {
                        study.left_out.push(format!("{} for {}: {reason}", variant.label(), base.devices[device].name));
                    }
                }
            }
        }
        Ok((base, study))
    }

    /// Number of runs under one motion.
    pub fn runs(&self) -> usize {
        self.setups.len()
    }

    /// Runs everything under `motions` on rayon's threads; `done` is called after each run. The findings do not depend on the
    /// number of threads.
    ///
    /// # Errors
    /// [`RunError::Interrupted`]; runs that fail are among the findings.
    pub fn run(&self, motions: &[StudyMotion], interrupt: &Interrupt, done: &(dyn Fn() + Sync)) -> Result<Findings, RunError> {
        let setup = |setup: &Setup| {
            let vertical = setup.variant.is_some_and(|variant| VARIANTS[variant].vertical);
            answers(&setup.subject, vertical, motions, interrupt, done)
        };
        let answers: Vec<Result<Answer, Missing>> = self.setups.par_iter().flat_map(setup).collect();
        let mut findings = Findings::default();
        if interrupt.is_set() || answers.contains(&Err(Missing::Interrupted)) {
            return Err(RunError::Interrupted);
        }
        for (answer, error) in answers.iter().flatten().filter_map(|answer| Some((answer, answer.error.as_ref()?))) {
            findings.worst.get_or_insert_default().note(error, answer.peak);
        }
        for (setup, of_setup) in self.setups.iter().zip(answers.chunks(motions.len().max(1))) {
            for (index, (motion, answer)) in motions.iter().zip(of_setup).enumerate() {
                let what = setup.variant.map_or_else(|| "as it is".to_owned(), |variant| VARIANTS[variant].label());
                let line = |reason: &str| format!("{what} under {}: {reason}", motion.name);
                match (answer, setup.variant) {
                    // The same for every device.
                    (Err(Missing::Impossible(reason)), _) if findings.left_out.contains(&line(reason)) => {}
                    (Err(Missing::Impossible(reason)), _) => findings.left_out.push(line(reason)),
                    (Err(Missing::Failed(reason)), _) => findings.failed.push(line(reason)),
                    (Ok(answer), Some(variant)) => {
                        // The setups of the scene as it is come first, in the order of the devices.
                        if let Ok(base) = answers[setup.device * motions.len() + index] {
                            let device = setup.device;
                            findings.comparisons.push(Comparison { motion: index, device, variant, base, answer: *answer });
                        }
                    }
                    _ => {}
                }
            }
        }
        Ok(findings)
    }
}

/// The scene with `changes`, and with only device number `index`; or why the variant makes no sense there.
fn changed(
    path: &Path,
    overrides: &[String],
    base: &Scene,
    variant: &Variant,
    changes: &[String],
    index: usize,
) -> Result<Scene, String> {
    let isolated = variant.isolated(&base.file.device[index])?;
    let own = if isolated.is_some() { 0 } else { index };
    let isolated: Vec<String> = isolated.into_iter().collect();
    let mut overrides = [overrides, &isolated, changes].concat();
    if variant.vertical {
        if !base.file.vertical.is_empty() {
            return Err("the scene has it already".to_owned());
        }
        // What the scene may not have beside a vertical motion is found here; the motion itself belongs to each ground motion.
        let tables = with_vertical(base, None).file.vertical;
        let tables = toml::Value::try_from(&tables).map_err(|error| error.to_string())?;
        overrides.push(format!("vertical={tables}"));
    }
    let of_scene = |error: SceneError| error.to_string().replace(&format!("device.{own}"), &format!("device.{index}"));
    let scene = unwatched(path, &overrides).map_err(of_scene)?;
    let same = scene.devices[own] == base.devices[index]
        && scene.file.device[own].support_oscillator() == base.file.device[index].support_oscillator()
        && scene.geometry() == base.geometry()
        && scene.file.block.restitution == base.file.block.restitution
        && scene.file.block.scatter() == base.file.block.scatter()
        && scene.file.block.base() == base.file.block.base();
    if same && !variant.vertical {
        return Err("the scene has it already".to_owned());
    }
    Ok(scene.only(own))
}

/// The scene at `path` with `overrides`, without what no run of a study looks at: its checks and the ledger of energy.
fn unwatched(path: &Path, overrides: &[String]) -> Result<Scene, SceneError> {
    let origin = path.display().to_string();
    let mut table = document::table(&text_of(path)?, &origin)?;
    overrides::apply_all(&mut table, overrides, &origin)?;
    table.remove("checks");
    if let Some(toml::Value::Table(output)) = table.get_mut("output") {
        output.remove("energy");
    }
    let mut scene = Scene::of_table(table, &origin)?;
    scene.folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
    Ok(scene)
}

#[cfg(test)]
mod tests {
    use sprag_shared::observers::outcome::Outcome;
    use sprag_sim::scene::device::{DeviceTable, Kind};

    use super::*;

    fn near_fault() -> &'static Path {
        Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/near_fault.toml"))
    }

    #[test]
    fn variants_are_for_the_devices_that_they_apply_to() {
        let (scene, study) = Study::load(near_fault(), &[]).unwrap();
        assert_eq!(study.devices, ["none", "inerter", "clutched pair"]);
        assert!(study.left_out.is_empty(), "{:?}", study.left_out);
        let of_device = |device: usize| study.setups.iter().filter(|setup| setup.device == device).count();
        assert_eq!(of_device(2), VARIANTS.len(), "all but that of a block alone");
        assert!(of_device(0) < of_device(1) && of_device(1) < of_device(2));
        assert!(study.setups.iter().all(|setup| setup.subject.scene.devices.len() == 1));
        assert_eq!(study.setups[2].subject.scene.devices[0], scene.devices[2]);
    }

    #[test]
    fn a_variant_that_the_scene_has_or_contradicts_is_left_out_with_the_reason() {
        let wall = ["device.1.support_frequency_hz=7", "device.1.support_damping_ratio=0.05"];
        let sets = [["device.2.engagement=rigid", "device.1.kinematics=consistent"], wall].concat();
        let sets: Vec<String> = sets.into_iter().map(str::to_owned).collect();
        let (_, study) = Study::load(near_fault(), &sets).unwrap();
        let left_out = study.left_out.join("\n");
        assert!(left_out.contains("kinematics: consistent for inerter: the scene has it already"), "{left_out}");
        assert!(left_out.contains("give only one of both"), "{left_out}");
        assert!(!left_out.contains("wall of 5 Hz, 5 % damping for inerter"), "a wall of 7 Hz is another: {left_out}");
    }

    /// Neither what another device is nor what no run looks at keeps a variant from a device.
    #[test]
    fn a_foundation_is_for_every_ideal_device_of_a_scene() {
        let sets = ["device.2.engagement=rigid", "checks.friction_coefficient=0.5", "output.energy=true"];
        let (_, study) = Study::load(near_fault(), &sets.map(str::to_owned)).unwrap();
        let devices = |effect: &str| -> Vec<usize> {
            let of_effect = |setup: &&Setup| setup.variant.is_some_and(|number| VARIANTS[number].effect == effect);
            study.setups.iter().filter(of_effect).map(|setup| setup.device).collect()
        };
        assert_eq!(devices("foundation"), [0, 1, 0, 1], "{:?}", study.left_out);
        assert_eq!(devices("sliding"), [0], "{:?}", study.left_out);
        let refused: Vec<&String> = study.left_out.iter().filter(|line| line.starts_with("foundation")).collect();
        let of_pair = |line: &&String| line.contains("for clutched pair") && line.contains("device.2 is not an ideal one");
        assert!(refused.len() == 2 && refused.iter().all(of_pair), "{refused:?}");
    }

    /// The keys of `value` below `path` that have a value.
    fn keys(value: &toml::Value, path: &str) -> Vec<(String, toml::Value)> {
        match value.as_table() {
            Some(table) => table.iter().flat_map(|(key, value)| keys(value, &format!("{path}.{key}"))).collect(),
            None => vec![(path.to_owned(), value.clone())],
        }
    }

    #[test]
    fn a_variant_keeps_what_it_does_not_name() {
        let sets = [
            "device.2.actuation={ engagement_delay_s = 0.03, release_delay_s = 0.04, dwell_s = 0.01 }",
            "device.2.flywheel={ dry_deceleration_m_s2 = 0.02 }",
            "device.2.rack={ viscous_1_s = 0.02, dry_friction_ratio = 0.005 }",
            "device.2.weight={ rack_ratio = 0.005, flywheels_ratio = 0.01 }",
        ];
        let (scene, study) = Study::load(near_fault(), &sets.map(str::to_owned)).unwrap();
        let of = |table: &DeviceTable| keys(&toml::Value::try_from(table).unwrap(), "device.2");
        let given = of(&scene.file.device[2]);
        let mut compared = Vec::new();
        for setup in study.setups.iter().filter(|setup| setup.device == 2) {
            let Some(variant) = setup.variant.map(|number| &VARIANTS[number]) else { continue };
            let (changes, found) = (variant.overrides(2, Kind::ClutchedPair).unwrap(), of(&setup.subject.scene.file.device[0]));
            let is_named = |key: &str| changes.iter().any(|change| change.split_once('=').is_some_and(|(name, _)| name == key));
            for key in given.iter().filter(|(name, _)| !is_named(name)) {
                assert!(found.contains(key), "{}: {key:?} {found:?}", variant.label());
            }
            compared.push(variant.effect);
        }
        for effect in ["actuation", "flywheel", "rack", "weight", "engagement", "clutch"] {
            assert!(compared.contains(&effect), "{effect}: {:?}", study.left_out);
        }
    }

    #[test]
    fn a_change_needs_two_blocks_that_stand_and_one_that_rocks() {
        let standing = |peak| Answer { outcome: Outcome::Safe, peak: Some(peak), error: None };
        let lying = Answer { outcome: Outcome::OverturnedAfterImpact, peak: None, error: None };
        let of = |base, answer| Comparison { motion: 0, device: 0, variant: 0, base, answer };
        assert_eq!(of(standing(0.5), standing(0.25)).change(), Some(-0.5));
        assert_eq!(of(standing(0.5), lying).change(), None);
        assert_eq!(of(standing(0.01), standing(0.25)).change(), None);
        assert_eq!(of(standing(0.5), lying).flip(), Some(Flip::ToOverturned));
        assert_eq!(of(lying, standing(0.5)).flip(), Some(Flip::ToStanding));
        assert_eq!(of(lying, lying).flip(), None);
    }
}
