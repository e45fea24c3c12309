//! An observer that remembers.

use sprag_shared::equation::motion::Motion;
use sprag_shared::math::scalar::Real;
use sprag_shared::math::sign::Sign;
use sprag_shared::method::dense_output::DenseOutput;
use sprag_shared::motion::observer::{Event, MonotoneInterval, Observer};
use sprag_shared::motion::rest::free_decay::Decay;
use sprag_shared::motion::rest::impact_accumulation::Accumulation;
use sprag_shared::motion::state::BlockState;
use sprag_shared::observers::peaks::Peaks;

use crate::follow::Watcher;

/// An event, the time from the start of the motion (s), and the state after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Logged<S> {
    /// What happened.
    pub event: Event,
    /// When, s.
    pub time: S,
    /// The state after it.
    pub state: BlockState<S>,
}

/// Some motions of one stretch.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampled<S> {
    /// When the interval begins, s from the start of the motion.
    pub time: S,
    /// The inerter is engaged.
    pub engaged: bool,
    /// s.
    pub side: Sign,
    /// Sign of θ̇.
    pub direction: Sign,
    /// The motion at instants spread evenly, the first and the last included.
    pub motions: Vec<Motion<S>>,
}

/// An observer that remembers peaks, events and, if asked, samples of every interval. With `EVERY` it wants every swing of
/// a free motion; without, the closed form may take over.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Log<S, const EVERY: bool> {
    /// Peaks.
    pub peaks: Peaks<S>,
    /// Events, in order.
    pub events: Vec<Logged<S>>,
    /// Samples of each interval.
    pub stretches: Vec<Sampled<S>>,
    /// How many intervals each interval is sampled in; 0 for none.
    pub intervals: u32,
    /// How often a closed form took over.
    pub decays: u32,
}

/// A log of a motion whose every swing is integrated.
pub type FullLog = Log<f64, true>;

impl<S: Real, const EVERY: bool> Log<S, EVERY> {
    /// An empty log that samples every interval in `intervals` intervals.
    pub fn sampling(intervals: u32) -> Self {
        Log { intervals, ..Log::default() }
    }

    /// The times of all events of one kind, s.
    pub fn times(&self, event: Event) -> Vec<S> {
        self.events.iter().filter(|logged| logged.event == event).map(|logged| logged.time).collect()
    }

    /// The states after all events of one kind.
    pub fn states(&self, event: Event) -> Vec<BlockState<S>> {
        self.events.iter().filter(|logged| logged.event == event).map(|logged| logged.state).collect()
    }
}

impl<S: Real, const EVERY: bool> Observer<S> for Log<S, EVERY> {
    fn every_swing(&self) -> bool {
        EVERY
    }

    fn interval(&mut self, output: &dyn DenseOutput<S>, interval: &MonotoneInterval<S>) {
        self.peaks.interval(output, interval);
        if self.intervals > 0 {
            let width = interval.to - interval.from;
            let at = |k: u32| match k {
                0 => interval.first,
                k if k == self.intervals => interval.last,
                k => output.at(interval.from + width * S::count(k) / S::count(self.intervals)),
            };
            self.stretches.push(Sampled {
                time: self.peaks.origin + interval.start + interval.from,
                engaged: interval.engaged,
                side: interval.side,
                direction: interval.direction,
                motions: (0..=self.intervals).map(at).collect(),
            });
        }
    }

    fn event(&mut self, event: Event, time: S, state: &BlockState<S>) {
        self.peaks.event(event, time, state);
        self.events.push(Logged { event, time: self.peaks.origin + time, state: *state });
    }

    fn decay(&mut self, decay: &Decay<S>) {
        self.peaks.decay(decay);
        self.decays += 1;
    }

    fn accumulation(&mut self, tail: &Accumulation<S>) {
        self.peaks.accumulation(tail);
    }
}

impl<S: Real, const EVERY: bool> Watcher<S> for Log<S, EVERY> {
    fn passed(&mut self, duration: S) {
        self.peaks.origin = self.peaks.origin + duration;
    }
}

/// Asserts what holds for every motion: time runs forward, the block stays above its floor, and events are finite in number.
pub fn sane<S: Real, const EVERY: bool>(log: &Log<S, EVERY>) {
    assert!(log.events.is_sorted_by(|a, b| a.time <= b.time), "time runs forward");
    let floor = -64.0 * S::EPSILON.to_f64();
    for interval in &log.stretches {
        for motion in &interval.motions {
            let above = interval.side.times(motion.rotation).to_f64();
            assert!(above >= floor, "through the floor: {motion:?} on {:?}", interval.side);
        }
    }
    assert!(log.events.len() < 20_000, "{} events", log.events.len());
}
