//! Many blocks under records at once: side by side where lanes know the device; the rest is left to [`crate::simulation`].

use sprag_ensemble::hybrid::{HybridBlock, HybridMotion};
use sprag_ensemble::machine::{Registers, shake, shake_hybrid};
use sprag_ensemble::plain::PlainBlock;
use sprag_ensemble::shaken::{Samples, Shaken, ShakenBlock};
use sprag_shared::motion::hybrid::HybridSystem;
use sprag_shared::observers::checks::Checks;

use crate::record::Record;
use crate::scene::Scene;
use crate::scene::checks::ChecksTable;
use crate::scene::ground::GroundError;

/// A scene of one device, and which lanes know it.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The scene.
    pub scene: Scene,
    known: Option<Known>,
    /// Who looks at what the device asks for.
    checks: Option<Checks<f64>>,
}

/// What became of a subject.
#[derive(Clone, Copy, Debug)]
pub struct Followed {
    /// Its motion.
    pub motion: Shaken,
    /// What its device asked for, of a [`Subject::watched`].
    pub demand: Option<DeviceDemand>,
}

/// What a device asks for until the end of a run, the fall of a block that overturns included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeviceDemand {
    /// max |F|/(mg) of the device on its support.
    pub force_ratio: f64,
    /// Farthest travel of the terminals to one side, m.
    pub stroke_m: f64,
}

/// The block of a scene as lanes take it.
#[derive(Clone, Debug)]
enum Known {
    /// With an ideal device.
    Ideal(PlainBlock),
    /// With any other one, or one whose force is asked for.
    Real(Box<HybridSystem<f64>>),
}

/// A record, and the vertical one of as many samples beside it, each with the factor on it.
#[derive(Clone, Copy, Debug)]
pub struct Shaking<'a> {
    /// Horizontal motion.
    pub level: (&'a Samples, f64),
    /// Vertical motion; the scene has one too.
    pub vertical: Option<(&'a Samples, f64)>,
}

/// The only record that shakes the block of a scene, and the only one that lifts it at the same time, if any does.
#[derive(Clone, Debug)]
pub struct OnlyRecords {
    level: Samples,
    vertical: Option<Samples>,
}

impl OnlyRecords {
    /// Of `scene`; none where anything else moves the ground.
    ///
    /// # Errors
    /// As of [`Scene::ground_motions`].
    pub fn of(scene: &Scene) -> Result<Option<OnlyRecords>, GroundError> {
        let samples = |(level, up): (Record, Option<Record>)| OnlyRecords {
            level: Samples::from(&level),
            vertical: up.map(|up| Samples::from(&up)),
        };
        Ok(scene.only_records()?.map(samples))
    }

    /// How they shake `scene`, which may scale them otherwise.
    pub fn shaking(&self, scene: &Scene) -> Shaking<'_> {
        let vertical = self.vertical.as_ref().map(|up| (up, scene.file.vertical[0].scale));
        Shaking { level: (&self.level, scene.file.ground[0].scale), vertical }
    }
}

impl Subject {
    /// `scene`, of one device.
    pub fn new(scene: Scene) -> Subject {
        let real = || scene.hybrid_system(0).map(|system| Known::Real(Box::new(system)));
        let known = scene.plain_block(0).map(Known::Ideal).or_else(real);
        Subject { scene, known, checks: None }
    }

    /// `scene`, of one device whose force and stroke are asked for too.
    pub fn watched(scene: Scene) -> Subject {
        let checks = checks(&scene);
        let system = scene.hybrid_system(0).filter(|_| checks.is_some());
        Subject { known: system.map(|system| Known::Real(Box::new(system))), scene, checks }
    }

    /// Whether lanes know it.
    pub fn is_known(&self) -> bool {
        self.known.is_some()
    }
}

/// Who looks at force and stroke of the device of `scene`; nobody where its `[checks]` ask for more.
fn checks(scene: &Scene) -> Option<Checks<f64>> {
    let asks_for_more = scene.file.checks.as_ref().is_some_and(|checks| *checks != ChecksTable::default());
    let device = scene.devices.first().filter(|_| !asks_for_more)?;
    let loaded = scene.structure(0).loaded().ok()?;
    let checks = Checks::new(&loaded.block, scene.geometry(), &loaded.device.mount, &device.account(&loaded));
    checks.ok().map(Checks::brief)
}

/// What becomes of each subject under its record and in the free time of its scene, in their order; `None` for those that the core is to follow.
/// No result depends on the others.
pub fn followed(runs: &[(&Subject, Shaking<'_>)]) -> Vec<Option<Followed>> {
    // A page has no lanes for records: they would be much of its size.
    if cfg!(target_arch = "wasm32") {
        return vec![None; runs.len()];
    }
    let (mut ideal, mut real) = (Vec::new(), Vec::new());
    for (index, (subject, Shaking { level: (samples, factor), vertical })) in runs.iter().enumerate() {
        let (samples, factor, vertical) = (*samples, *factor, *vertical);
        let frequency_parameter = subject.scene.block.frequency_parameter();
        match &subject.known {
            Some(Known::Ideal(plain)) if vertical.is_none() => {
                ideal.push((index, ShakenBlock { plain: *plain, frequency_parameter, samples, factor }));
            }
            Some(Known::Real(system)) => {
                let overturned_at_slenderness = subject.scene.overturned_at_slenderness();
                let checks = subject.checks.as_ref();
                real.push((index, HybridBlock { system, overturned_at_slenderness, samples, factor, vertical, checks }));
            }
            _ => {}
        }
    }
    let mut found = vec![None; runs.len()];
    let blocks: Vec<ShakenBlock<'_>> = ideal.iter().map(|(_, block)| *block).collect();
    for ((index, block), shaken) in ideal.iter().zip(shake(&blocks, Registers::Widest)) {
        let scene = &runs[*index].0.scene;
        let (structure, duration) = (scene.structure(0), block.samples.duration());
        let after = |shaken: Shaken| shaken.after(&block.plain, &structure, duration, scene.free_time_s()).ok();
        found[*index] = shaken.and_then(after).map(|motion| Followed { motion, demand: None });
    }
    let blocks: Vec<HybridBlock<'_>> = real.iter().map(|(_, block)| *block).collect();
    for ((index, block), moved) in real.iter().zip(shake_hybrid(&blocks, Registers::Widest)) {
        let scene = &runs[*index].0.scene;
        let heavier = 1.0 + scene.devices[0].added_mass.mass_ratio;
        let demand = |moved: &HybridMotion| {
            let (force, stroke_m) = moved.support_force_ratio().zip(moved.stroke())?;
            Some(DeviceDemand { force_ratio: force * heavier, stroke_m })
        };
        let ended = moved.and_then(|moved| moved.after(block, scene.free_time_s()).ok());
        found[*index] = ended.map(|moved| Followed { motion: Shaken::from(moved), demand: demand(&moved) });
    }
    found
}
