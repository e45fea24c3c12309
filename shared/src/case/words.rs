//! The words of a case, in order: 25 for the scene, then its ground motion. Numbers are the bits of an f32 in SI units;
//! kinds count from 0 in the order in which their types list them.
//!
//! | words | what |
//! | --- | --- |
//! | 0, 1 | [`MAGIC`], [`VERSION`] |
//! | 2-5 | size R, slenderness α, inertia ratio λ, geometry (kind) |
//! | 6-11 | device (kind), mass ratio σ, mount (kind), height, pulley ratio, kinematics (kind) |
//! | 12, 13 | carried mass ratio μ, its height |
//! | 14-16 | restitution (0 given, 1 geometric, 2 momentum balance), η (read if given), rest speed |
//! | 17-19 | initially (0 rest, 1 released), θ, θ̇ |
//! | 20-22 | method (kind), step, free time |
//! | 23, 24 | ground (0 pieces, 1 record); number of pieces or of samples |
//! | 25- | pieces: 11 words each, shape (kind), duration, and up to nine numbers; record: interval, samples |

use core::fmt;

use super::{Case, FixedMethod, Ground, GroundPiece, Initially, MOST_PIECES, Shape};
use crate::block::{Block, Geometry};
use crate::carried::Carried;
use crate::error::{ParameterError, require};
use crate::ground::harmonic::Harmonic;
use crate::ground::{Harmonics, Linear, Ricker};
use crate::lever::Mount;
use crate::restitution::Restitution;
use crate::rocking::Stopped;
use crate::structure::{Device, DeviceKind, KinematicsKind, Structure};

/// "CASE", to be told from other files.
pub const MAGIC: u32 = u32::from_le_bytes(*b"CASE");

/// Of the words' meaning.
pub const VERSION: u32 = 2;

/// Numbers of a shape.
const NUMBERS: usize = 9;

/// Why words are no case, or a case could not be run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CaseError {
    /// The first word is not [`MAGIC`].
    Magic(u32),
    /// The second is not [`VERSION`].
    Version(u32),
    /// The words end before what stands here.
    Missing(&'static str),
    /// So many words follow the case.
    Trailing(u32),
    /// No such kind.
    Kind {
        /// Of what.
        of: &'static str,
        /// The word.
        word: u32,
    },
    /// More pieces of ground motion than fit.
    TooManyPieces(u32),
    /// More steps than [`super::MOST_STEPS`].
    TooManySteps,
    /// The words do not fit the buffer.
    Full,
    /// A number outside its range.
    Parameter(ParameterError),
    /// The run came to a stop.
    Stopped(Stopped),
}

impl fmt::Display for CaseError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            CaseError::Magic(word) => write!(formatter, "the first word is {word:#010x}, so this is no case"),
            CaseError::Version(version) => write!(formatter, "version {version}, but only {VERSION} is known"),
            CaseError::Missing(what) => write!(formatter, "the words end before {what}"),
            CaseError::Trailing(count) => write!(formatter, "{count} words follow the end of the case"),
            CaseError::Kind { of, word } => write!(formatter, "there is no {of} of kind {word}"),
            CaseError::TooManyPieces(count) => write!(formatter, "{count} pieces of ground motion; at most {MOST_PIECES} fit"),
            CaseError::TooManySteps => write!(formatter, "more than {} steps", super::MOST_STEPS),
            CaseError::Full => formatter.write_str("the case does not fit the buffer"),
            CaseError::Parameter(error) => error.fmt(formatter),
            CaseError::Stopped(stopped) => stopped.fmt(formatter),
        }
    }
}

impl core::error::Error for CaseError {}

impl From<ParameterError> for CaseError {
    fn from(error: ParameterError) -> CaseError {
        CaseError::Parameter(error)
    }
}

impl From<Stopped> for CaseError {
    fn from(stopped: Stopped) -> CaseError {
        CaseError::Stopped(stopped)
    }
}

/// Takes words from the front.
struct Reader<'a>(&'a [u32]);

impl<'a> Reader<'a> {
    fn word(&mut self, what: &'static str) -> Result<u32, CaseError> {
        let (&word, rest) = self.0.split_first().ok_or(CaseError::Missing(what))?;
        self.0 = rest;
        Ok(word)
    }

    fn single(&mut self, what: &'static str) -> Result<f32, CaseError> {
        self.word(what).map(f32::from_bits)
    }

    fn number(&mut self, what: &'static str) -> Result<f64, CaseError> {
        self.single(what).map(f64::from)
    }

    fn kind<K: Copy>(&mut self, of: &'static str, kinds: &[K]) -> Result<K, CaseError> {
        let word = self.word(of)?;
        kinds.get(word as usize).copied().ok_or(CaseError::Kind { of, word })
    }
}

/// Puts words into a buffer.
struct Writer<'a> {
    words: &'a mut [u32],
    count: usize,
}

impl Writer<'_> {
    fn word(&mut self, word: u32) -> Result<(), CaseError> {
        *self.words.get_mut(self.count).ok_or(CaseError::Full)? = word;
        self.count += 1;
        Ok(())
    }

    fn single(&mut self, number: f32) -> Result<(), CaseError> {
        self.word(number.to_bits())
    }

    fn number(&mut self, number: f64) -> Result<(), CaseError> {
        self.single(number as f32)
    }
}

impl<'a> Case<'a> {
    /// Writes the case to the front of `words` and gives the number of words. Numbers are rounded to single precision.
    ///
    /// # Errors
    /// [`CaseError::Full`].
    pub fn encode(&self, words: &mut [u32]) -> Result<usize, CaseError> {
        let mut out = Writer { words, count: 0 };
        out.word(MAGIC)?;
        out.word(VERSION)?;
        let Structure { block, geometry, device, carried, restitution, rest_speed } = &self.structure;
        out.number(block.size())?;
        out.number(block.slenderness())?;
        out.number(block.inertia_ratio())?;
        out.word(*geometry as u32)?;
        out.word(device.kind as u32)?;
        out.number(device.mass_ratio)?;
        let (mount, height, pulley_ratio) = match device.mount {
            Mount::CentreOfMass => (0, 0.0, 0.0),
            Mount::TyingPoint { height, pulley_ratio } => (1, height, pulley_ratio),
            Mount::BaseCorners { pulley_ratio } => (2, 0.0, pulley_ratio),
        };
        out.word(mount)?;
        out.number(height)?;
        out.number(pulley_ratio)?;
        out.word(device.kinematics as u32)?;
        out.number(carried.mass_ratio)?;
        out.number(carried.height)?;
        let (rule, eta) = match *restitution {
            Restitution::Constant(eta) => (0, eta),
            Restitution::Geometric => (1, 0.0),
            Restitution::MomentumBalance => (2, 0.0),
        };
        out.word(rule)?;
        out.number(eta)?;
        out.number(*rest_speed)?;
        let (released, rotation, velocity) = match self.initially {
            Initially::Rest => (0, 0.0, 0.0),
            Initially::Released { rotation, velocity } => (1, rotation, velocity),
        };
        out.word(released)?;
        out.single(rotation)?;
        out.single(velocity)?;
        out.word(self.method as u32)?;
        out.single(self.step)?;
        out.single(self.free_time)?;
        match &self.ground {
            Ground::Pieces(pieces) => {
                let used = pieces.iter().rposition(|piece| piece.duration != 0.0).map_or(0, |last| last + 1);
                out.word(0)?;
                out.word(used as u32)?;
                pieces[..used].iter().try_for_each(|piece| piece.encode(&mut out))?;
            }
            Ground::Record { interval, samples } => {
                out.word(1)?;
                out.word(samples.len() as u32)?;
                out.single(*interval)?;
                samples.iter().try_for_each(|&bits| out.word(bits))?;
            }
        }
        Ok(out.count)
    }

    /// The case that `words` hold, all of them and no more. Whether its numbers make sense is found by [`Case::run`].
    ///
    /// # Errors
    /// [`CaseError`] names the first word that is wrong or missing.
    pub fn decode(words: &'a [u32]) -> Result<Case<'a>, CaseError> {
        let mut input = Reader(words);
        let magic = input.word("the first word")?;
        if magic != MAGIC {
            return Err(CaseError::Magic(magic));
        }
        let version = input.word("the version")?;
        if version != VERSION {
            return Err(CaseError::Version(version));
        }
        let block = Block::new(input.number("size")?, input.number("slenderness")?, input.number("inertia_ratio")?)?;
        let geometry = input.kind("geometry", &[Geometry::Full, Geometry::Slender])?;
        let kind = input.kind("device", &[DeviceKind::None, DeviceKind::Inerter, DeviceKind::ClutchedPair])?;
        let mass_ratio = input.number("mass_ratio")?;
        let mount = input.kind("mount", &[0, 1, 2])?;
        let (height, pulley_ratio) = (input.number("height")?, input.number("pulley_ratio")?);
        let mount = match mount {
            0 => Mount::CentreOfMass,
            1 => Mount::TyingPoint { height, pulley_ratio },
            _ => Mount::BaseCorners { pulley_ratio },
        };
        let kinematics = input.kind("kinematics", &[KinematicsKind::Paper, KinematicsKind::Consistent])?;
        let carried = Carried { mass_ratio: input.number("carried mass_ratio")?, height: input.number("carried height")? };
        let rule = input.kind("restitution", &[0, 1, 2])?;
        let eta = input.number("restitution")?;
        let restitution = match rule {
            0 => Restitution::Constant(eta),
            1 => Restitution::Geometric,
            _ => Restitution::MomentumBalance,
        };
        let rest_speed = input.number("rest_speed")?;
        let released = input.kind("start", &[false, true])?;
        let (rotation, velocity) = (input.single("rotation")?, input.single("velocity")?);
        let methods = [FixedMethod::SemiImplicitEuler, FixedMethod::RungeKutta4, FixedMethod::Taylor];
        let method = input.kind("method", &methods)?;
        let (step, free_time) = (input.single("step")?, input.single("free_time")?);
        let recorded = input.kind("ground", &[false, true])?;
        let count = input.word("the length of the ground motion")?;
        let ground = if recorded {
            let interval = input.single("interval")?;
            let (samples, rest) = input.0.split_at_checked(count as usize).ok_or(CaseError::Missing("the last sample"))?;
            input.0 = rest;
            Ground::Record { interval, samples }
        } else {
            let mut pieces = [GroundPiece { shape: Shape::Quiet, duration: 0.0 }; MOST_PIECES];
            let used = pieces.get_mut(..count as usize).ok_or(CaseError::TooManyPieces(count))?;
            for piece in used {
                *piece = GroundPiece::decode(&mut input)?;
            }
            Ground::Pieces(pieces)
        };
        if !input.0.is_empty() {
            return Err(CaseError::Trailing(input.0.len() as u32));
        }
        let device = Device { kind, mass_ratio, mount, kinematics };
        let structure = Structure { block, geometry, device, carried, restitution, rest_speed };
        let initially = if released { Initially::Released { rotation, velocity } } else { Initially::Rest };
        Ok(Case { structure, initially, method, step, ground, free_time })
    }
}

impl GroundPiece {
    fn encode(&self, out: &mut Writer<'_>) -> Result<(), CaseError> {
        let sines = |terms: &[Harmonic<f32>]| {
            let mut numbers = [0.0; NUMBERS];
            for (three, term) in numbers.as_chunks_mut::<3>().0.iter_mut().zip(terms) {
                *three = [term.amplitude, term.frequency, term.phase];
            }
            numbers
        };
        let (kind, numbers) = match &self.shape {
            Shape::Quiet => (0, [0.0; NUMBERS]),
            Shape::Linear(line) => (1, [line.start, line.slope, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
            Shape::Sine(sine) => (2, sines(&sine.terms)),
            Shape::ThreeSines(three) => (3, sines(&three.terms)),
            Shape::Ricker(r) => (4, [r.amplitude, r.rate, r.centre, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        };
        out.word(kind)?;
        out.single(self.duration)?;
        numbers.iter().try_for_each(|&number| out.single(number))
    }

    fn decode(input: &mut Reader<'_>) -> Result<GroundPiece, CaseError> {
        let kind = input.kind("shape", &[0, 1, 2, 3, 4])?;
        let duration = input.single("duration")?;
        let mut numbers = [0.0; NUMBERS];
        for number in &mut numbers {
            *number = input.single("a number of the shape")?;
            require("number of a shape", f64::from(*number), true, "finite")?;
        }
        let [a, b, c, ..] = numbers;
        let sine = |[amplitude, frequency, phase]: [f32; 3]| Harmonic { amplitude, frequency, phase };
        let shape = match kind {
            0 => Shape::Quiet,
            1 => Shape::Linear(Linear { start: a, slope: b }),
            2 => Shape::Sine(Harmonics { terms: [sine([a, b, c])] }),
            3 => {
                let [_, _, _, d, e, f, g, h, i] = numbers;
                Shape::ThreeSines(Harmonics { terms: [sine([a, b, c]), sine([d, e, f]), sine([g, h, i])] })
            }
            _ => Shape::Ricker(Ricker { amplitude: a, rate: b, centre: c }),
        };
        Ok(GroundPiece { shape, duration })
    }
}
