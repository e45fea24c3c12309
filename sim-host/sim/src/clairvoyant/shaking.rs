//! A ground motion in the steps of a search.

use sprag_shared::ground::GroundSegment;

use crate::ground_motion::GroundMotion;

/// Ground accelerations (g) in the middle of every step.
#[derive(Clone, Debug)]
pub struct Shaking {
    ground: Vec<f64>,
    /// Bound from each step on.
    bounds: Vec<f64>,
    step: f64,
    steps: usize,
}

/// One decision's.
#[derive(Clone, Copy, Debug)]
pub struct Part<'a> {
    /// Step by step, g.
    pub ground: &'a [f64],
    /// Bound of |ü_g| from its beginning on, g.
    pub bound: f64,
    /// The ground does not move any more after it.
    pub quiet: bool,
}

impl Shaking {
    /// Of `motion`, in decisions an `interval` (s) long of `steps` each, and for a time `afterwards` (s).
    pub fn of(motion: &GroundMotion, interval: f64, steps: u32, afterwards: f64) -> Shaking {
        let step = interval / f64::from(steps);
        let intervals = ((motion.duration() + afterwards) / interval).ceil() as usize;
        let mut segments = motion.segments().iter().peekable();
        let mut at = |time: f64| {
            while segments.next_if(|segment| segment.start + segment.duration <= time).is_some() {}
            segments.peek().map_or(0.0, |segment| segment.shape.acceleration(time - segment.start))
        };
        let ground: Vec<f64> = (0..intervals * steps as usize).map(|index| at((index as f64 + 0.5) * step)).collect();
        let mut bounds = vec![0.0; ground.len() + 1];
        for index in (0..ground.len()).rev() {
            bounds[index] = ground[index].abs().max(bounds[index + 1]);
        }
        Shaking { ground, bounds, step, steps: steps as usize }
    }

    /// Length of a step, s.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Decision by decision.
    pub fn parts(&self) -> impl Iterator<Item = Part<'_>> {
        self.ground.chunks(self.steps).enumerate().map(|(index, ground)| {
            let start = index * self.steps;
            Part { ground, bound: self.bounds[start], quiet: self.bounds[start + ground.len()] == 0.0 }
        })
    }
}
