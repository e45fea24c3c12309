//! Specimens of a block whose impacts differ, under the motion of its scene.

use std::ops::Range;

use rayon::prelude::*;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::Scene;
use sprag_sim::scene::motions::GroundMotions;
use sprag_sim::side_by_side::{Followed, OnlyRecords, Shaking, Subject, followed};
use sprag_sim::simulation::{RunError, simulate};

use super::specimens::Specimen;

/// Says that specimens of `scene` would differ.
///
/// # Errors
/// A scene whose impacts are all alike.
pub fn check(scene: &Scene) -> anyhow::Result<()> {
    if !scene.file.block.scatter().is_on() {
        anyhow::bail!("--monte-carlo: every specimen would be the same; block.restitution_scatter lets impacts differ");
    }
    Ok(())
}

/// Specimens that one task takes: enough to keep lanes full.
pub const TOGETHER: usize = 32;

/// Device `index` with the seeds of its impacts that come `numbers` places after that of the scene: in lanes, as they take `records` where
/// these alone move the ground, and by the core where lanes do not know the device.
///
/// # Errors
/// The first error of [`simulate`].
pub fn run(
    (scene, ground): (&Scene, &GroundMotions),
    records: Option<&OnlyRecords>,
    index: usize,
    numbers: Range<u64>,
    interrupt: &Interrupt,
) -> anyhow::Result<Vec<Specimen<1>>> {
    if interrupt.is_set() {
        return Err(RunError::Interrupted.into());
    }
    let subject = |number| {
        let mut alone = scene.only(index);
        alone.file.block.restitution_seed = Some(scene.file.block.scatter().seed.wrapping_add(number));
        Subject::new(alone)
    };
    let subjects: Vec<Subject> = numbers.map(subject).collect();
    let shaking = |subject: &Subject| records.map_or(Shaking::Any(ground), |records| records.shaking(&subject.scene));
    let runs: Vec<_> = subjects.iter().map(|subject| (subject, shaking(subject))).collect();
    let in_lanes = followed(&runs);
    let specimen = |(Subject { scene, .. }, in_lanes): (&Subject, Option<Followed>)| {
        let (outcome, peak, impacts) = match in_lanes {
            Some(Followed { motion, .. }) => {
                (motion.outcome(), motion.relative_peaks(&scene.block).map(|(rotation, _)| rotation), motion.impacts)
            }
            None => {
                let run = simulate(scene, ground, interrupt)?.swap_remove(0);
                (run.outcome, run.peak_rotation, run.impacts)
            }
        };
        Ok(Specimen { seed: scene.file.block.scatter().seed, outcome, peak, more: [impacts.into()] })
    };
    subjects.par_iter().zip(in_lanes).map(specimen).collect()
}
