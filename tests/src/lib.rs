//! Whole-workspace tests of Sprag, and what they share: blocks, ground motions, an observer that remembers, and the way to
//! the project's shared folder.
//!
//! Numbers that the tests compare with come from closed forms and from the reference cells, never from an earlier run.

pub mod device_loop;
pub mod dice;
pub mod emulation;
pub mod flash;

use std::path::PathBuf;

use sprag_shared::arc::{Arc, Method, Motion};
use sprag_shared::block::{Block, Geometry, RECTANGLE_INERTIA_RATIO};
use sprag_shared::carried::Carried;
use sprag_shared::clutch::Clutch;
use sprag_shared::decay::Decay;
use sprag_shared::equation::Equation;
use sprag_shared::ground::{Harmonics, Linear, Piece, Quiet};
use sprag_shared::lever::Mount;
use sprag_shared::observer::{Event, Observer, Peaks, Stretch};
use sprag_shared::rocking::{Limits, Phase, State, Stopped, System};
use sprag_shared::scalar::{Real, Sign};
use sprag_shared::structure::{Device, DeviceKind, KinematicsKind, REST_SPEED, Restitution, Structure, WithSystem};
use sprag_shared::taylor::Taylor;

/// The devices that a block can carry.
pub const DEVICES: [DeviceKind; 3] = [DeviceKind::None, DeviceKind::Inerter, DeviceKind::ClutchedPair];

/// Both equations of motion.
pub const GEOMETRIES: [Geometry; 2] = [Geometry::Full, Geometry::Slender];

/// A file of the shared folder, or None, with one line on stderr, where that folder is absent.
pub fn shared_file(name: &str) -> Option<PathBuf> {
    let path = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared")).join(name);
    if path.exists() {
        return Some(path);
    }
    eprintln!("SKIPPED: the optional shared folder has no {name}");
    None
}

/// The Taylor method as tight as f64 allows.
pub fn tight() -> Taylor<f64, 20> {
    Taylor::adaptive(1e-17)
}

/// A block of unit frequency parameter, so that seconds read as times 1/p, with a device at its centre of mass in the
/// paper's kinematics. `slenderness` in degrees.
pub fn unit_block(geometry: Geometry, slenderness: f64, device: DeviceKind, mass_ratio: f64, restitution: f64) -> Structure {
    let block = Block::of_unit_frequency(slenderness.to_radians(), RECTANGLE_INERTIA_RATIO).expect("a slenderness within range");
    Structure {
        block,
        geometry,
        device: Device { kind: device, mass_ratio, mount: Mount::CentreOfMass, kinematics: KinematicsKind::Paper },
        carried: Carried::NONE,
        restitution: Restitution::Constant(restitution),
        rest_speed: REST_SPEED,
    }
}

/// The same structure with a block of `size` R (m) in place of the unit frequency.
pub fn resized(structure: Structure, size: f64) -> Structure {
    let block = Block::new(size, structure.block.slenderness(), structure.block.inertia_ratio()).expect("a size above 0");
    Structure { block, ..structure }
}

/// Smooth ground motion over a stretch of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ground<S> {
    /// A straight line.
    Line(Linear<S>),
    /// One sine with a phase.
    Sine(Harmonics<S, 1>),
    /// None.
    Quiet,
}

impl<S: Real> Ground<S> {
    /// The same motion towards the other side.
    pub fn mirrored(self) -> Ground<S> {
        match self {
            Ground::Line(line) => Ground::Line(Linear { start: -line.start, slope: -line.slope }),
            Ground::Sine(mut sine) => {
                sine.terms[0].amplitude = -sine.terms[0].amplitude;
                Ground::Sine(sine)
            }
            Ground::Quiet => Ground::Quiet,
        }
    }

    /// Its acceleration at the local time 0, in g.
    pub fn at_start(&self) -> S {
        match self {
            Ground::Line(line) => line.start,
            Ground::Sine(sine) => sine.acceleration(S::ZERO),
            Ground::Quiet => S::ZERO,
        }
    }
}

/// A ground motion and how long it lasts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<S> {
    /// The motion.
    pub ground: Ground<S>,
    /// s.
    pub duration: S,
}

impl<S: Real> Segment<S> {
    /// A constant acceleration (in g).
    pub fn constant(level: S, duration: S) -> Segment<S> {
        Segment { ground: Ground::Line(Linear::constant(level)), duration }
    }

    /// A straight line from `first` to `second` (in g).
    pub fn line(first: S, second: S, duration: S) -> Segment<S> {
        Segment { ground: Ground::Line(Linear::between(first, second, duration)), duration }
    }

    /// A sin ωτ.
    pub fn sine(amplitude: S, frequency: S, duration: S) -> Segment<S> {
        Segment { ground: Ground::Sine(Harmonics::sine(amplitude, frequency)), duration }
    }

    /// A cos ωτ.
    pub fn cosine(amplitude: S, frequency: S, duration: S) -> Segment<S> {
        Segment { ground: Ground::Sine(Harmonics::cosine(amplitude, frequency)), duration }
    }

    /// No motion.
    pub fn quiet(duration: S) -> Segment<S> {
        Segment { ground: Ground::Quiet, duration }
    }

    /// The same motion towards the other side.
    pub fn mirrored(self) -> Segment<S> {
        Segment { ground: self.ground.mirrored(), ..self }
    }

    /// Bound of |ü_g/g|.
    fn bound(&self) -> S {
        match self.ground {
            Ground::Line(line) => line.start.abs().larger(line.acceleration(self.duration).abs()),
            Ground::Sine(sine) => sine.terms[0].amplitude.abs(),
            Ground::Quiet => S::ZERO,
        }
    }
}

/// How a motion starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start<S> {
    /// Standing still.
    Rest,
    /// At θ (rad) with θ̇ (rad/s).
    Released(S, S),
}

/// An event, the time from the start of the motion (s), and the state after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Logged<S> {
    /// What happened.
    pub event: Event,
    /// When, s.
    pub time: S,
    /// The state after it.
    pub state: State<S>,
}

/// Some motions of one stretch.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampled<S> {
    /// When the stretch begins, s from the start of the motion.
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

/// An observer that remembers peaks, events and, if asked, samples of every stretch. With `EVERY` it wants every swing of
/// a free motion; without, the closed form may take over.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Log<S, const EVERY: bool> {
    /// Peaks.
    pub peaks: Peaks<S>,
    /// Events, in order.
    pub events: Vec<Logged<S>>,
    /// Samples of each stretch.
    pub stretches: Vec<Sampled<S>>,
    /// How many intervals each stretch is sampled in; 0 for none.
    pub intervals: u32,
    /// How often a closed form took over.
    pub decays: u32,
}

/// A log of a motion whose every swing is integrated.
pub type FullLog = Log<f64, true>;

impl<S: Real, const EVERY: bool> Log<S, EVERY> {
    /// An empty log that samples every stretch in `intervals` intervals.
    pub fn sampling(intervals: u32) -> Self {
        Log { intervals, ..Log::default() }
    }

    /// The times of all events of one kind, s.
    pub fn times(&self, event: Event) -> Vec<S> {
        self.events.iter().filter(|logged| logged.event == event).map(|logged| logged.time).collect()
    }

    /// The states after all events of one kind.
    pub fn states(&self, event: Event) -> Vec<State<S>> {
        self.events.iter().filter(|logged| logged.event == event).map(|logged| logged.state).collect()
    }
}

impl<S: Real, const EVERY: bool> Observer<S> for Log<S, EVERY> {
    const EVERY_SWING: bool = EVERY;

    fn stretch<A: Arc<S>>(&mut self, arc: &A, stretch: &Stretch<S>) {
        self.peaks.stretch(arc, stretch);
        if self.intervals > 0 {
            let width = stretch.to - stretch.from;
            let at = |k: u32| match k {
                0 => stretch.first,
                k if k == self.intervals => stretch.last,
                k => arc.at(stretch.from + width * S::count(k) / S::count(self.intervals)),
            };
            self.stretches.push(Sampled {
                time: self.peaks.origin + stretch.start + stretch.from,
                engaged: stretch.engaged,
                side: stretch.side,
                direction: stretch.direction,
                motions: (0..=self.intervals).map(at).collect(),
            });
        }
    }

    fn event(&mut self, event: Event, time: S, state: &State<S>) {
        self.peaks.event(event, time, state);
        self.events.push(Logged { event, time: self.peaks.origin + time, state: *state });
    }

    fn decay(&mut self, decay: &Decay<S>) {
        self.peaks.decay(decay);
        self.decays += 1;
    }
}

/// Follows `structure` from `start` over all `segments`, or until it overturns.
///
/// # Errors
/// [`Stopped`] when the motion takes more than a million arcs in one segment, or is no longer finite.
pub fn follow<S: Real, M: Method<S>, const EVERY: bool>(
    structure: &Structure,
    method: &M,
    start: Start<S>,
    segments: &[Segment<S>],
    log: &mut Log<S, EVERY>,
) -> Result<State<S>, Stopped> {
    let run = Run { structure, method, start, segments, log };
    structure.resolve(run).expect("parameters within range")
}

/// [`follow`] from rest by the tight Taylor method, with every swing integrated.
pub fn shake(structure: &Structure, segments: &[Segment<f64>]) -> (State<f64>, FullLog) {
    let mut log = FullLog::default();
    let state = follow(structure, &tight(), Start::Rest, segments, &mut log).expect("a motion that can be followed");
    (state, log)
}

/// [`follow`] on quiet ground by the tight Taylor method, with every swing integrated.
pub fn release(structure: &Structure, rotation: f64, velocity: f64, duration: f64, log: &mut FullLog) -> State<f64> {
    follow(structure, &tight(), Start::Released(rotation, velocity), &[Segment::quiet(duration)], log)
        .expect("a motion that can be followed")
}

/// The block has overturned, and before that no impact.
pub fn overturned_without_impact(state: &State<f64>) -> bool {
    state.phase == Phase::Overturned && state.impacts == 0
}

struct Run<'a, S, M, const EVERY: bool> {
    structure: &'a Structure,
    method: &'a M,
    start: Start<S>,
    segments: &'a [Segment<S>],
    log: &'a mut Log<S, EVERY>,
}

impl<S: Real, M: Method<S>, const EVERY: bool> WithSystem<S> for Run<'_, S, M, EVERY> {
    type Output = Result<State<S>, Stopped>;

    fn with<R: Equation<S>, E: Equation<S>, C: Clutch>(self, system: System<S, R, E, C>) -> Self::Output {
        let mut state = match self.start {
            Start::Rest => State::default(),
            Start::Released(rotation, velocity) => {
                let ground = self.segments.first().map_or(S::ZERO, |segment| segment.ground.at_start());
                system.released_at(rotation, velocity, ground)
            }
        };
        for (index, segment) in self.segments.iter().enumerate() {
            // The ground may yet push back as hard as its strongest segment still to come.
            let bound = self.segments[index..].iter().fold(S::ZERO, |bound, later| bound.larger(later.bound()));
            let limit = self.structure.geometry.point_of_no_return(&self.structure.block, bound.to_f64());
            let limits = Limits { overturned: S::of(limit), events: 1_000_000 };
            let log = &mut *self.log;
            match &segment.ground {
                Ground::Line(line) => system.advance(self.method, &mut state, line, segment.duration, &limits, log)?,
                Ground::Sine(sine) => system.advance(self.method, &mut state, sine, segment.duration, &limits, log)?,
                Ground::Quiet => system.advance(self.method, &mut state, &Quiet, segment.duration, &limits, log)?,
            }
            log.peaks.origin = log.peaks.origin + segment.duration;
        }
        Ok(state)
    }
}

/// Where `predicate` turns from false at `low` to true at `high`, to the last bits.
pub fn boundary(mut low: f64, mut high: f64, mut predicate: impl FnMut(f64) -> bool) -> f64 {
    assert!(!predicate(low), "already true at {low}");
    assert!(predicate(high), "still false at {high}");
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if predicate(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

/// |a/b − 1|.
pub fn relative(a: f64, b: f64) -> f64 {
    (a / b - 1.0).abs()
}

/// A small generator of numbers that look random and are the same everywhere (SplitMix64).
#[derive(Clone, Debug)]
pub struct Dice(pub u64);

impl Dice {
    /// The next number in [0, 1).
    pub fn roll(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// The next number between `low` and `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.roll()
    }
}

/// Asserts what holds for every motion: time runs forward, the block stays above its floor, and events are finite in number.
pub fn sane<const EVERY: bool>(log: &Log<f64, EVERY>) {
    assert!(log.events.is_sorted_by(|a, b| a.time <= b.time), "time runs forward");
    for stretch in &log.stretches {
        for motion in &stretch.motions {
            assert!(stretch.side.times(motion.rotation) >= -1e-14, "through the floor: {motion:?} on {:?}", stretch.side);
        }
    }
    assert!(log.events.len() < 20_000, "{} events", log.events.len());
}
