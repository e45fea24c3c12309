//! The block that slides, against closed forms, the loop in which it cannot, balances of energy and momentum, and symmetry.

mod flat;
mod impacts;
mod limits;
mod rocking;

use std::vec::Vec;

use super::{GroundPair, SlidingState, SlidingSystem};
use crate::ground::{AnySegment, GroundSegment, Harmonics, Linear};
use crate::method::dense_output::DenseOutput;
use crate::motion::device_snapshot::DeviceOutput;
use crate::motion::observer::{Event, MonotoneInterval, Observer};
use crate::motion::state::{BlockState, Limits};
use crate::observers::peaks::Peaks;
use crate::structure::block::Block;
use crate::structure::{Base, Restitution, Structure};

/// A block of 1 m whose slenderness is `alpha` (rad).
fn block(alpha: f64, friction: f64) -> Structure {
    Structure {
        base: Base::Friction(friction),
        ..Structure::new(Block::new(1.0, alpha, 4.0 / 3.0).unwrap(), Restitution::Geometric)
    }
}

fn constant(level: f64) -> AnySegment<f64> {
    AnySegment::Linear(Linear::constant(level))
}

fn sine(amplitude: f64, frequency: f64) -> AnySegment<f64> {
    AnySegment::Sine(Harmonics::sine(amplitude, frequency))
}

/// Horizontal and vertical ground motion, and its duration (s).
type Piece = (AnySegment<f64>, Option<AnySegment<f64>>, f64);

/// Largest values, events and samples.
#[derive(Debug, Default)]
struct Seen {
    peaks: Peaks<f64>,
    events: Vec<(Event, f64)>,
    /// Time, θ, θ̇ and x (m) at the ends of intervals.
    ends: Vec<(f64, f64, f64, f64)>,
    origin: f64,
}

impl Observer<f64> for Seen {
    fn interval(&mut self, output: &dyn DenseOutput<f64>, interval: &MonotoneInterval<f64>) {
        self.peaks.interval(output, interval);
    }

    fn device_interval(&mut self, output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
        self.interval(output.motion(), interval);
        let motion = output.motion().at(interval.to);
        let time = self.origin + interval.start + interval.to;
        self.ends.push((time, motion.rotation, motion.velocity, output.displacement(interval.to)));
    }

    fn event(&mut self, event: Event, time: f64, state: &BlockState<f64>) {
        self.peaks.event(event, time, state);
        self.events.push((event, self.origin + time));
    }
}

impl Seen {
    fn count(&self, event: Event) -> usize {
        self.events.iter().filter(|(of, _)| *of == event).count()
    }
}

const LIMITS: Limits<f64> = Limits { overturned: core::f64::consts::FRAC_PI_2, events: 1_000_000 };

/// `state` over `pieces` in steps of `step` (s).
fn follow(system: &SlidingSystem<f64>, state: &mut SlidingState<f64>, pieces: &[Piece], step: f64) -> Seen {
    let mut seen = Seen::default();
    for (horizontal, vertical, duration) in pieces {
        let ground = GroundPair { horizontal, vertical: vertical.as_ref().map(|up| up as &dyn GroundSegment<f64>) };
        system.advance(step, state, ground, *duration, &LIMITS, &mut seen).unwrap();
        seen.origin += duration;
        seen.peaks.origin = seen.origin;
    }
    seen
}

/// From rest.
fn shake(structure: &Structure, pieces: &[Piece], step: f64) -> (SlidingState<f64>, Seen) {
    let system = structure.resolve_sliding().unwrap();
    let mut state = SlidingState::default();
    let seen = follow(&system, &mut state, pieces, step);
    (state, seen)
}
