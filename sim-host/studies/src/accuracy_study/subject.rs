//! The motions that are followed.

use sprag_shared::ground::{AnySegment, GroundSegment, Harmonics};
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::{Block, Geometry};
use sprag_shared::structure::error::ParameterError;
use sprag_sim::ground_motion::{Component, GroundMotion, SumSegment};
use sprag_sim::scene::Scene;
use sprag_sim::scene::motions::GroundMotions;
use sprag_sim::simulation::drive::{Course, Overturning};

/// A block with a device, and what shakes it.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The block, and its device.
    pub structure: Structure,
    /// The same as a block that carries nothing.
    pub loaded: Structure,
    /// What shakes it.
    pub ground: GroundMotion,
    /// How long it is followed after that, s.
    pub free_time: f64,
    /// θ (rad), θ̇ (rad/s) and the ground's acceleration (in g) at the start, if the block is not at rest.
    pub released: Option<(f64, f64, f64)>,
    /// When it counts as overturned.
    overturning: Overturning,
}

/// How long a cell of the grid is followed after its pulse, in 1/p.
const FREE_TIME_RATIO: f64 = 10.0;

/// ω_g/p over the grid.
const FREQUENCIES: (f64, f64) = (0.5, 8.0);

/// a_g over the uplift threshold over the grid.
const AMPLITUDES: (f64, f64) = (1.05, 10.0);

impl Subject {
    /// Device number `index` of a scene.
    ///
    /// # Errors
    /// For a load that the core refuses.
    pub fn of_scene(scene: &Scene, ground: &GroundMotions, index: usize) -> Result<Subject, ParameterError> {
        let structure = scene.structure(index);
        let (alpha, p) = (scene.block.slenderness(), scene.block.frequency_parameter());
        let table = &scene.file.block;
        let (rotation, velocity) = (table.initial_rotation_ratio * alpha, table.initial_velocity_ratio * p * alpha);
        let first = ground.horizontal.segments().first().map_or(0.0, |segment| segment.shape.acceleration(0.0));
        Ok(Subject {
            structure,
            loaded: structure.loaded()?,
            ground: ground.horizontal.clone(),
            free_time: scene.free_time_s(),
            released: (rotation != 0.0 || velocity != 0.0).then_some((rotation, velocity, first)),
            overturning: Overturning::Reached,
        })
    }

    /// A grid of `count` x `count` one-cycle sine pulses on the same structure.
    pub fn grid(&self, count: usize) -> Vec<Subject> {
        let block = &self.loaded.block;
        let p = block.frequency_parameter();
        let threshold = self.loaded.geometry.uplift_threshold(block.slenderness());
        let at = |(from, to): (f64, f64), index: usize| from + (to - from) * (index as f64 + 0.5) / count as f64;
        let cell = |index: usize| {
            let frequency = at(FREQUENCIES, index % count) * p;
            let pulse = AnySegment::Sine(Harmonics::sine(at(AMPLITUDES, index / count) * threshold, frequency));
            let ground = GroundMotion::sum(&[Component::pulse(0.0, core::f64::consts::TAU / frequency, pulse)]);
            let free_time = FREE_TIME_RATIO / p;
            Subject { ground, free_time, released: None, overturning: Overturning::Proven, ..self.clone() }
        };
        (0..count * count).map(cell).collect()
    }

    /// What a method follows.
    pub fn course(&self) -> Course<'_> {
        Course::of(&self.loaded, &self.ground, self.free_time, self.overturning)
    }

    /// When it ends, s.
    pub fn end(&self) -> f64 {
        self.ground.duration() + self.free_time
    }

    /// The bare block.
    pub fn block(&self) -> &Block {
        &self.structure.block
    }

    /// The slender block has closed forms under lines and sines.
    pub fn has_closed_form(&self) -> bool {
        let closed = |segment: &AnySegment<f64>| segment.elementary(0.0).is_some();
        let known = |shape: &SumSegment<f64>| match shape {
            SumSegment::Single(segment) => closed(segment),
            SumSegment::Several(parts) => parts.iter().all(|(_, part)| closed(part)),
        };
        self.loaded.geometry == Geometry::Slender && self.ground.segments().iter().all(|segment| known(&segment.shape))
    }
}
