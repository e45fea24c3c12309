//! An observer that counts and checks, and keeps nothing: for long motions.

use sprag_shared::equation::motion::Motion;
use sprag_shared::math::scalar::Real;
use sprag_shared::method::dense_output::DenseOutput;
use sprag_shared::motion::observer::{Event, MonotoneInterval, Observer};
use sprag_shared::motion::rest::impact_accumulation::Accumulation;
use sprag_shared::motion::state::BlockState;
use sprag_shared::observers::peaks::Peaks;

use crate::energy::Energy;
use crate::follow::Watcher;

/// Counts of a motion, and how far it strays from what holds for every motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally<S> {
    /// Peaks.
    pub peaks: Peaks<S>,
    /// Time from the start of the motion to that of the present segment, s.
    pub origin: f64,
    /// Monotone intervals.
    pub stretches: u64,
    /// Steps: intervals at the start of an arc.
    pub steps: u64,
    /// Events: uplift, impact, turn, switch, coupling, rest, overturned.
    pub events: [u64; 8],
    /// Deepest reach below the floor, in ulps of the largest |θ| so far and of how far the block moves in the time of its piece.
    pub depth: f64,
    /// The same in rad.
    pub reach: f64,
    /// How deep it may be, in those ulps.
    pub floor: f64,
    /// Something was not finite.
    pub not_finite: bool,
    /// Stretches or events that began before the one before them, beyond an ulp of the clock.
    pub backwards: u64,
    /// Events that were reported twice at one instant with one state.
    pub twice: u64,
    /// The energy that must not grow, with the level reached so far and the largest gain over it.
    pub energy: Option<Level>,
    /// Largest |θ| at the last turn, and the largest growth from one turn to the next.
    pub turn: (f64, f64),
    /// Largest speed after an impact over that before it.
    pub rebound: f64,
    speed: f64,
    last: f64,
    event: Option<(Event, u64, BlockState<S>)>,
}

/// An energy that must not grow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Which.
    pub energy: Energy,
    /// The least so far.
    pub least: f64,
    /// At the start.
    pub first: f64,
    /// Largest gain over the least so far, relative to the barrier.
    pub gain: f64,
}

impl<S: Real> Tally<S> {
    /// Nothing counted yet.
    pub fn new() -> Tally<S> {
        Tally { last: f64::NEG_INFINITY, turn: (f64::INFINITY, 0.0), floor: 64.0, ..Tally::default() }
    }

    /// The same, and watches `energy`, which must not grow.
    pub fn with_energy(energy: Energy) -> Tally<S> {
        let level = Level { energy, least: f64::INFINITY, first: f64::NAN, gain: 0.0 };
        Tally { energy: Some(level), ..Tally::new() }
    }

    /// How often `event` happened.
    pub fn count(&self, event: Event) -> u64 {
        self.events[index(event)]
    }

    /// All events.
    pub fn total(&self) -> u64 {
        self.events.iter().sum()
    }

    /// Asserts what holds for every motion: finite, forward in time, above the floor, no event twice, at most `steps` steps and
    /// `events` events.
    #[track_caller]
    pub fn assert_sane(&self, steps: u64, events: u64) {
        assert!(!self.not_finite, "not finite: {self:?}");
        assert_eq!(self.backwards, 0, "time ran backwards: {self:?}");
        assert_eq!(self.twice, 0, "an event was reported twice: {self:?}");
        assert!(self.depth <= self.floor, "through the floor: {self:?}");
        assert!(self.steps <= steps, "{} steps, at most {steps} expected: {self:?}", self.steps);
        assert!(self.total() <= events, "{} events, at most {events} expected: {self:?}", self.total());
    }

    /// Asserts that the energy never grew by more than `tolerance` times the barrier.
    #[track_caller]
    pub fn assert_no_energy_gained(&self, tolerance: f64) {
        let level = self.energy.expect("an energy to watch");
        assert!(level.gain <= tolerance, "the energy grew by {:e} of the barrier: {self:?}", level.gain);
    }

    fn clock(&mut self, time: S, ulp: f64) -> f64 {
        let now = self.origin + time.to_f64();
        if now < self.last - 2.0 * ulp {
            self.backwards += 1;
        }
        self.last = self.last.max(now);
        now
    }

    fn look(&mut self, motion: &Motion<S>, interval: &MonotoneInterval<S>) {
        let Motion { rotation, velocity, acceleration } = *motion;
        self.not_finite |= !(rotation.is_finite() && velocity.is_finite() && acceleration.is_finite());
        let below = -interval.side.times(rotation).to_f64();
        self.reach = self.reach.max(below);
        // Below any meaning, where a search that halves a step 64 times has no digits left.
        if below > 1e-36 {
            let reach = (interval.start + interval.to).to_f64();
            let speed = interval.first.velocity.abs().larger(interval.last.velocity.abs()).to_f64();
            let size = self.peaks.rotation.to_f64() + speed * reach;
            self.depth = self.depth.max(below / (S::EPSILON.to_f64() * size));
        }
        if let Some(level) = &mut self.energy {
            let energy = level.energy.at(motion, interval.side, interval.engaged);
            level.gain = level.gain.max((energy - level.least) / level.energy.barrier());
            level.least = level.least.min(energy);
            if level.first.is_nan() {
                level.first = energy;
            }
        }
    }
}

fn index(event: Event) -> usize {
    match event {
        Event::Uplift => 0,
        Event::Impact => 1,
        Event::Turn => 2,
        Event::Switch => 3,
        Event::Coupling => 4,
        Event::Rest => 5,
        Event::Overturned => 6,
        Event::Slip => 7,
    }
}

impl<S: Real> Observer<S> for Tally<S> {
    fn interval(&mut self, output: &dyn DenseOutput<S>, interval: &MonotoneInterval<S>) {
        self.peaks.interval(output, interval);
        self.stretches += 1;
        self.steps += u64::from(interval.from == S::ZERO);
        let ulp = S::EPSILON.to_f64() * (interval.start + interval.to).to_f64();
        self.clock(interval.start + interval.from, ulp);
        self.look(&interval.first, interval);
        self.look(&interval.last, interval);
        self.clock(interval.start + interval.to, ulp);
        self.speed = interval.last.velocity.abs().to_f64();
    }

    fn accumulation(&mut self, tail: &Accumulation<S>) {
        self.peaks.accumulation(tail);
    }

    fn event(&mut self, event: Event, time: S, state: &BlockState<S>) {
        self.peaks.event(event, time, state);
        self.events[index(event)] += 1;
        let now = self.clock(time, S::EPSILON.to_f64() * time.to_f64());
        self.not_finite |= !(state.rotation.is_finite() && state.velocity.is_finite() && time.is_finite());
        if event == Event::Impact && self.speed > 0.0 {
            self.rebound = self.rebound.max(state.velocity.abs().to_f64() / self.speed);
        }
        if event == Event::Turn {
            let rotation = state.rotation.abs().to_f64();
            self.turn = (rotation, self.turn.1.max(rotation / self.turn.0 - 1.0));
        }
        let reported = Some((event, now.to_bits(), *state));
        self.twice += u64::from(reported == self.event);
        self.event = reported;
    }
}

impl<S: Real> Watcher<S> for Tally<S> {
    fn passed(&mut self, duration: S) {
        self.origin += duration.to_f64();
        self.peaks.origin = S::of(self.origin);
    }
}
