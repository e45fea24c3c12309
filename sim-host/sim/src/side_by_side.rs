//! Many blocks at once: side by side where lanes know device and ground; the rest is left to [`crate::simulation`].

use sprag_ensemble::hybrid::ground::{Ground, Piece, Pieces, Sampled};
use sprag_ensemble::hybrid::{HybridBlock, HybridMotion};
use sprag_ensemble::machine::{Registers, shake, shake_hybrid};
use sprag_ensemble::plain::PlainBlock;
use sprag_ensemble::shaken::{Samples, Shaken, ShakenBlock};
use sprag_shared::ground::{GroundSegment, Harmonics};
use sprag_shared::motion::hybrid::HybridSystem;
use sprag_shared::observers::checks::Checks;
use sprag_shared::observers::coil_use::CoilUse;

use crate::ground_motion::{GroundMotion, Segment};
use crate::record::Record;
use crate::scene::Scene;
use crate::scene::checks::ChecksTable;
use crate::scene::ground::GroundError;
use crate::scene::motions::GroundMotions;
use crate::simulation::demand::tooth_stresses;

/// A scene of one device, and which lanes know it.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The scene.
    pub scene: Scene,
    /// The block with an ideal device, which lanes follow under records only: elsewhere they would not be faster than the core.
    ideal: Option<PlainBlock>,
    /// That with any other one, or one whose force is asked for.
    real: Option<Box<HybridSystem<f64>>>,
    /// Who looks at the forces of the device, and at its coils, where these are asked for.
    watch: Option<(Checks<f64>, Option<CoilUse>)>,
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
    /// Largest bending stress at the root of a tooth, MPa; none where the scene has no gear.
    pub tooth_stress_mpa: Option<f64>,
    /// Energy of the coils of both clutches, J; none where the scene has no coil, or the device no clutch that one holds.
    pub coil_energy_j: Option<f64>,
}

/// How the ground moves under a subject.
#[derive(Clone, Copy, Debug)]
pub enum Shaking<'a> {
    /// By a record, and the vertical one of as many samples beside it, each with the factor on it.
    Record {
        /// Horizontal motion.
        level: (&'a Samples, f64),
        /// Vertical motion; the scene has one too.
        vertical: Option<(&'a Samples, f64)>,
    },
    /// In any way.
    Any(&'a GroundMotions),
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
        Shaking::Record { level: (&self.level, scene.file.ground[0].scale), vertical }
    }
}

impl Subject {
    /// `scene`, of one device.
    pub fn new(scene: Scene) -> Subject {
        let ideal = scene.plain_block(0);
        let real = if ideal.is_none() { scene.hybrid_system(0) } else { None };
        Subject { ideal, real: real.map(Box::new), scene, watch: None }
    }

    /// `scene`, of one device whose force and stroke are asked for too, and the teeth and coils that its `[checks]` have.
    pub fn watched(scene: Scene) -> Subject {
        let watch = watch(&scene);
        let real = scene.hybrid_system(0).filter(|_| watch.is_some());
        Subject { ideal: None, real: real.map(Box::new), scene, watch }
    }

    /// What was asked of its device by `moved`.
    fn demand(&self, moved: &HybridMotion) -> Option<DeviceDemand> {
        let (force, stroke_m) = moved.support_force_ratio().zip(moved.stroke())?;
        let heavier = 1.0 + self.scene.devices[0].added_mass.mass_ratio;
        let ChecksTable { gear, coil, .. } = self.scene.file.checks.clone().unwrap_or_default();
        let stress = |gear| {
            let force = moved.flywheel_force_ratio()? * heavier;
            Some(tooth_stresses(&gear, &self.scene, 0, force).into_iter().fold(0.0, f64::max))
        };
        Some(DeviceDemand {
            force_ratio: force * heavier,
            stroke_m,
            tooth_stress_mpa: gear.and_then(stress),
            coil_energy_j: coil.zip(moved.coils).map(|(coil, used)| coil.energy_j(&used)),
        })
    }

    /// Whether lanes know it where the ground moves by a record alone (`only_record`), or in any way.
    pub fn is_known(&self, only_record: bool) -> bool {
        self.real.is_some() || only_record && self.ideal.is_some()
    }
}

/// A ground motion and the free time after it, as lanes take them.
#[derive(Debug)]
pub struct InPieces<'a> {
    pieces: Vec<Piece<'a>>,
    lightest: f64,
}

impl<'a> InPieces<'a> {
    /// Of a horizontal motion, a vertical one with the same segments, and so many s after them.
    pub fn new(level: &'a GroundMotion, vertical: Option<&'a GroundMotion>, free_time: f64) -> InPieces<'a> {
        let up = |index: usize| Some(&vertical?.segments().get(index)?.shape as &dyn GroundSegment<f64>);
        let piece = |(index, segment): (usize, &'a Segment)| {
            let Segment { start, duration, shape, bound } = segment;
            Piece { start: *start, duration: *duration, bound: *bound, horizontal: shape, vertical: up(index) }
        };
        let (start, horizontal) = (level.duration(), &Harmonics::QUIET);
        let free = (free_time > 0.0).then_some(Piece { start, duration: free_time, bound: 0.0, horizontal, vertical: None });
        let pieces = level.segments().iter().enumerate().map(piece).chain(free).collect();
        InPieces { pieces, lightest: vertical.map_or(1.0, GroundMotion::lightest) }
    }

    /// As a block of the lanes takes it.
    pub fn ground(&self) -> Ground<'_> {
        Ground::Pieces(Pieces { pieces: &self.pieces, lightest: self.lightest })
    }
}

/// Who looks at what the device of `scene` asks for; nobody where a program without effects is to refuse its `[checks]`.
fn watch(scene: &Scene) -> Option<(Checks<f64>, Option<CoilUse>)> {
    let device = scene.devices.first()?;
    let loaded = scene.structure(0).loaded().ok()?;
    let all = Checks::new(&loaded.block, scene.geometry(), &loaded.device.mount, &device.account(&loaded)).ok()?;
    let table = scene.file.checks.as_ref();
    if cfg!(not(feature = "effects")) && table.is_some() {
        return None;
    }
    let checks = if table.is_some_and(|table| table.gear.is_some()) { all.of_flywheels() } else { all.brief() };
    Some((checks, table.and_then(|table| table.coil_use(device, &loaded, false))))
}

/// What becomes of each subject on its ground and in the free time of its scene, in their order; `None` for those that the core is to follow.
/// No result depends on the others.
pub fn followed<'a>(runs: &[(&Subject, Shaking<'a>)]) -> Vec<Option<Followed>> {
    // A page has no lanes but those of ideal devices under pulses: they would be much of its size.
    if cfg!(target_arch = "wasm32") {
        return vec![None; runs.len()];
    }
    let (mut ideal, mut real) = (Vec::new(), Vec::new());
    let in_pieces = |(subject, shaking): &(&Subject, Shaking<'a>)| match *shaking {
        Shaking::Any(GroundMotions { horizontal, vertical, .. }) if subject.real.is_some() => {
            Some(InPieces::new(horizontal, vertical.as_ref(), subject.scene.free_time_s()))
        }
        _ => None,
    };
    let pieces: Vec<Option<InPieces<'a>>> = runs.iter().map(in_pieces).collect();
    for (index, ((subject, shaking), pieces)) in runs.iter().zip(&pieces).enumerate() {
        if let (Some(plain), Shaking::Record { level: (samples, factor), vertical: None }) = (subject.ideal, *shaking) {
            let frequency_parameter = subject.scene.block.frequency_parameter();
            ideal.push((index, ShakenBlock { plain, frequency_parameter, samples, factor }));
            continue;
        }
        let ground = match *shaking {
            Shaking::Record { level: (samples, factor), vertical } => Some(Ground::Record(Sampled { samples, factor, vertical })),
            Shaking::Any(_) => pieces.as_ref().map(InPieces::ground),
        };
        if let Some((system, ground)) = subject.real.as_deref().zip(ground) {
            let overturned_at_slenderness = subject.scene.overturned_at_slenderness();
            let (checks, coils) = subject.watch.as_ref().map_or((None, None), |(checks, coils)| (Some(checks), *coils));
            real.push((index, HybridBlock { system, overturned_at_slenderness, ground, checks, coils }));
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
        let subject = runs[*index].0;
        let free_time = match block.ground {
            Ground::Record(_) => subject.scene.free_time_s(),
            // The last of them.
            Ground::Pieces(_) => 0.0,
        };
        let ended = moved.and_then(|moved| moved.after(block, free_time).ok());
        found[*index] = ended.map(|moved| Followed { motion: Shaken::from(moved), demand: subject.demand(&moved) });
    }
    found
}
