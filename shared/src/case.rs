//! A case: one scene as a flat row of 32-bit words, small and plain enough for a board to read from its host, and complete
//! enough for both to run it in single precision with fixed steps and compare every bit ([`crate::digest`]).
//!
//! The words and their order are in [`words`]; this page is what they mean and how they are run.

#[cfg(test)]
mod tests;
pub mod words;

pub use words::CaseError;

use crate::arc::Method;
use crate::clutch::Clutch;
use crate::equation::Equation;
use crate::error::require;
use crate::fixed::{RungeKutta4, SemiImplicitEuler};
use crate::ground::{Harmonics, Linear, Piece, Quiet, Ricker};
use crate::observer::{Observer, Peaks, Stretch};
use crate::rocking::{Limits, Phase, State, Stopped, System};
use crate::structure::{Structure, WithSystem};
use crate::taylor::Taylor;

/// Most pieces of ground motion in a case without a record.
pub const MOST_PIECES: usize = 8;

/// Most steps of a case: what a host runs in a second and the emulator in a minute or two.
pub const MOST_STEPS: u32 = 1 << 22;

/// Coefficients of the Taylor method in a case.
pub const TERMS: usize = 12;

/// How the block starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Initially {
    /// On both toes.
    Rest,
    /// Tilted to θ (rad; not 0, |θ| ≤ π/2) and let go with θ̇ (rad/s).
    Released {
        /// θ.
        rotation: f32,
        /// θ̇.
        velocity: f32,
    },
}

/// The method, with fixed steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FixedMethod {
    /// [`SemiImplicitEuler`].
    SemiImplicitEuler,
    /// [`RungeKutta4`].
    RungeKutta4,
    /// [`Taylor`] with [`TERMS`] coefficients.
    Taylor,
}

/// One shape of ground acceleration, in g, over local time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// None.
    Quiet,
    /// A straight line.
    Linear(Linear<f32>),
    /// One sine.
    Sine(Harmonics<f32, 1>),
    /// Three, as a Mavroeidis-Papageorgiou wavelet has.
    ThreeSines(Harmonics<f32, 3>),
    /// A Ricker wavelet.
    Ricker(Ricker<f32>),
}

/// A shape and how long it lasts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundPiece {
    /// What.
    pub shape: Shape,
    /// s, 0 or more.
    pub duration: f32,
}

/// The ground motion of a case.
#[expect(clippy::large_enum_variant, reason = "there is no allocation, and a program has one")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ground<'a> {
    /// Piece after piece; those of no duration are skipped.
    Pieces([GroundPiece; MOST_PIECES]),
    /// A record, straight between its samples.
    Record {
        /// s, above 0.
        interval: f32,
        /// Bits of the accelerations, in g.
        samples: &'a [u32],
    },
}

impl Ground<'_> {
    /// The pieces in `list`, of which there may be [`MOST_PIECES`].
    ///
    /// # Errors
    /// [`CaseError::TooManyPieces`].
    pub fn pieces(list: &[GroundPiece]) -> Result<Ground<'static>, CaseError> {
        let mut pieces = [GroundPiece { shape: Shape::Quiet, duration: 0.0 }; MOST_PIECES];
        pieces.get_mut(..list.len()).ok_or(CaseError::TooManyPieces(list.len() as u32))?.copy_from_slice(list);
        Ok(Ground::Pieces(pieces))
    }

    /// Upper bound of |ü_g/g|.
    fn bound(&self) -> f32 {
        match self {
            Ground::Pieces(pieces) => pieces.iter().fold(0.0, |bound, piece| bound.max(piece.bound())),
            Ground::Record { samples, .. } => samples.iter().fold(0.0, |bound, &bits| bound.max(f32::from_bits(bits).abs())),
        }
    }
}

impl GroundPiece {
    fn bound(&self) -> f32 {
        if self.duration == 0.0 {
            return 0.0;
        }
        match &self.shape {
            Shape::Quiet => 0.0,
            Shape::Linear(line) => line.start.abs().max(line.acceleration(self.duration).abs()),
            Shape::Sine(sines) => sines.terms.iter().map(|term| term.amplitude.abs()).sum(),
            Shape::ThreeSines(sines) => sines.terms.iter().map(|term| term.amplitude.abs()).sum(),
            Shape::Ricker(wavelet) => wavelet.amplitude.abs(),
        }
    }
}

/// A scene that a board and its host can both run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case<'a> {
    /// The block and its device. The words hold its numbers in single precision.
    pub structure: Structure,
    /// How it starts.
    pub initially: Initially,
    /// The method.
    pub method: FixedMethod,
    /// Its step, s; above 0.
    pub step: f32,
    /// What shakes it.
    pub ground: Ground<'a>,
    /// Time on quiet ground after that, s; 0 or more.
    pub free_time: f32,
}

/// How a run ended, in the words of the paper's section 4.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The block never uplifts.
    NoRocking,
    /// It rocks and stays up (Region 3).
    Safe,
    /// It overturns before any impact (Region 1).
    OverturnedWithoutImpact,
    /// It overturns after one impact or more (Region 2).
    OverturnedAfterImpact,
}

impl Ending {
    /// As tables and files print it.
    pub fn name(self) -> &'static str {
        match self {
            Ending::NoRocking => "no-rocking",
            Ending::Safe => "safe",
            Ending::OverturnedWithoutImpact => "overturned-without-impact",
            Ending::OverturnedAfterImpact => "overturned-after-impact",
        }
    }
}

/// What a run came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunEnd {
    /// How it ended.
    pub ending: Ending,
    /// The last state.
    pub state: State<f32>,
    /// Largest rotation and acceleration.
    pub peaks: Peaks<f32>,
    /// Steps begun; an event that ends one early begins another.
    pub steps: u32,
}

/// Runs the case that `words` encode and tells `observer` of it. Never panics, always ends.
///
/// # Errors
/// [`CaseError`] names the word that is wrong, or why the run stopped.
pub fn run<O: Observer<f32>>(words: &[u32], observer: &mut O) -> Result<RunEnd, CaseError> {
    Case::decode(words)?.run(observer)
}

impl Case<'_> {
    /// Runs the case and tells `observer` of it, piece after piece; times start anew with each.
    ///
    /// # Errors
    /// [`CaseError::Parameter`] names the first parameter outside its range; [`CaseError::Stopped`].
    pub fn run<O: Observer<f32>>(&self, observer: &mut O) -> Result<RunEnd, CaseError> {
        self.check()?;
        self.structure.resolve(Runner { case: self, observer }).map_err(CaseError::Parameter)?
    }

    /// Everything that is not the structure's own to check.
    fn check(&self) -> Result<(), CaseError> {
        let number = |name, value: f32, allowed: bool, range| require(name, f64::from(value), allowed, range).map(|_| ());
        number("step", self.step, self.step > 0.0, "above 0 s")?;
        number("free_time", self.free_time, self.free_time >= 0.0, "0 s or more")?;
        if let Initially::Released { rotation, velocity } = self.initially {
            let bound = core::f32::consts::FRAC_PI_2;
            number("rotation", rotation, rotation != 0.0 && rotation.abs() <= bound, "from -π/2 to π/2 rad, and not 0")?;
            number("velocity", velocity, true, "finite")?;
        }
        let mut steps = self.free_time / self.step;
        match &self.ground {
            Ground::Pieces(pieces) => {
                for piece in pieces {
                    number("duration", piece.duration, piece.duration >= 0.0, "0 s or more")?;
                    number("ground acceleration", piece.bound(), true, "finite")?;
                    steps += piece.duration / self.step + 1.0;
                }
            }
            Ground::Record { interval, samples } => {
                number("interval", *interval, *interval > 0.0, "above 0 s")?;
                for &bits in *samples {
                    number("sample", f32::from_bits(bits), true, "finite")?;
                }
                steps += samples.len() as f32 * (interval / self.step + 1.0);
            }
        }
        if steps <= MOST_STEPS as f32 { Ok(()) } else { Err(CaseError::TooManySteps) }
    }
}

/// A shape is chosen at every look, not before the loop: one loop for each structure and method is what fits the flash.
impl Piece<f32> for Shape {
    #[inline]
    fn acceleration(&self, time: f32) -> f32 {
        match self {
            Shape::Quiet => 0.0,
            Shape::Linear(piece) => piece.acceleration(time),
            Shape::Sine(piece) => piece.acceleration(time),
            Shape::ThreeSines(piece) => piece.acceleration(time),
            Shape::Ricker(piece) => piece.acceleration(time),
        }
    }

    fn slope(&self, time: f32) -> f32 {
        match self {
            Shape::Quiet => 0.0,
            Shape::Linear(piece) => Piece::slope(piece, time),
            Shape::Sine(piece) => piece.slope(time),
            Shape::ThreeSines(piece) => piece.slope(time),
            Shape::Ricker(piece) => piece.slope(time),
        }
    }

    fn curvature_bound(&self) -> f32 {
        match self {
            Shape::Quiet | Shape::Linear(_) => 0.0,
            Shape::Sine(piece) => piece.curvature_bound(),
            Shape::ThreeSines(piece) => piece.curvature_bound(),
            Shape::Ricker(piece) => piece.curvature_bound(),
        }
    }

    fn series(&self, time: f32, coefficients: &mut [f32]) {
        match self {
            Shape::Quiet => Quiet.series(time, coefficients),
            Shape::Linear(piece) => piece.series(time, coefficients),
            Shape::Sine(piece) => piece.series(time, coefficients),
            Shape::ThreeSines(piece) => piece.series(time, coefficients),
            Shape::Ricker(piece) => piece.series(time, coefficients),
        }
    }
}

/// The caller's observer, the peaks, and a count of steps.
struct Watch<'o, O> {
    observer: &'o mut O,
    peaks: Peaks<f32>,
    steps: u32,
}

impl<O: Observer<f32>> Observer<f32> for Watch<'_, O> {
    #[inline]
    fn stretch<A: crate::arc::Arc<f32>>(&mut self, arc: &A, stretch: &Stretch<f32>) {
        self.steps += u32::from(stretch.from == 0.0);
        self.peaks.stretch(arc, stretch);
        self.observer.stretch(arc, stretch);
    }

    #[inline]
    fn event(&mut self, event: crate::observer::Event, time: f32, state: &State<f32>) {
        self.peaks.event(event, time, state);
        self.observer.event(event, time, state);
    }
}

struct Runner<'c, 'w, 'o, O> {
    case: &'c Case<'w>,
    observer: &'o mut O,
}

impl<O: Observer<f32>> WithSystem<f32> for Runner<'_, '_, '_, O> {
    type Output = Result<RunEnd, CaseError>;

    fn with<R: Equation<f32>, E: Equation<f32>, C: Clutch>(self, system: System<f32, R, E, C>) -> Self::Output {
        let step = self.case.step;
        match self.case.method {
            FixedMethod::SemiImplicitEuler => self.run(&system, &SemiImplicitEuler { step }),
            FixedMethod::RungeKutta4 => self.run(&system, &RungeKutta4 { step }),
            FixedMethod::Taylor => self.run(&system, &Taylor::<f32, TERMS>::fixed(step)),
        }
    }
}

impl<O: Observer<f32>> Runner<'_, '_, '_, O> {
    fn run<R: Equation<f32>, E: Equation<f32>, C: Clutch, M: Method<f32>>(
        self,
        system: &System<f32, R, E, C>,
        method: &M,
    ) -> Result<RunEnd, CaseError> {
        let Case { structure, initially, step, ground, free_time, .. } = self.case;
        let mut watch = Watch { observer: self.observer, peaks: Peaks::default(), steps: 0 };
        let first = match ground {
            Ground::Pieces(pieces) => pieces.iter().find(|piece| piece.duration > 0.0).map(|piece| piece.shape.acceleration(0.0)),
            Ground::Record { samples, .. } => samples.first().map(|&bits| f32::from_bits(bits)),
        };
        let mut state = match *initially {
            Initially::Rest => State::default(),
            Initially::Released { rotation, velocity } => system.released_at(rotation, velocity, first.unwrap_or(0.0)),
        };
        watch.peaks.rocked = state.phase == Phase::Rocking;
        let block = structure.loaded()?.block;
        let no_return = |bound: f32| structure.geometry.point_of_no_return(&block, f64::from(bound)) as f32;
        let overturned = no_return(ground.bound());
        let mut follow = |shape: &Shape, duration: f32, overturned: f32| -> Result<(), Stopped> {
            // Every step may meet a few events, and dying impacts accumulate before they are summed.
            let events = 10_000 + (duration / step) as u32 * 8;
            let limits = Limits { overturned, events };
            let done = system.advance(method, &mut state, shape, duration, &limits, &mut watch);
            watch.peaks.origin += duration;
            done
        };
        match ground {
            Ground::Pieces(pieces) => pieces.iter().try_for_each(|piece| follow(&piece.shape, piece.duration, overturned)),
            Ground::Record { interval, samples } => samples.windows(2).try_for_each(|pair| {
                let line = Linear::between(f32::from_bits(pair[0]), f32::from_bits(pair[1]), *interval);
                follow(&Shape::Linear(line), *interval, overturned)
            }),
        }?;
        follow(&Shape::Quiet, *free_time, no_return(0.0))?;
        let ending = match (state.phase, watch.peaks.rocked, state.impacts) {
            (Phase::Overturned, _, 0) => Ending::OverturnedWithoutImpact,
            (Phase::Overturned, ..) => Ending::OverturnedAfterImpact,
            (_, false, _) => Ending::NoRocking,
            _ => Ending::Safe,
        };
        Ok(RunEnd { ending, state, peaks: watch.peaks, steps: watch.steps })
    }
}
