//! How the ground moves under a block of the lanes: intervals on each of which it is smooth.

use std::array::from_fn;
use std::fmt;

use sprag_shared::ground::{GroundSegment, Linear};
use sprag_shared::motion::hybrid::mode_output::Shaking;

use super::expansion::RATES;
use crate::shaken::Samples;

/// Motion of the ground.
#[derive(Clone, Copy, Debug)]
pub enum Ground<'a> {
    /// A record.
    Record(Sampled<'a>),
    /// Any motion.
    Pieces(Pieces<'a>),
}

/// A record: straight lines between samples.
#[derive(Clone, Copy, Debug)]
pub struct Sampled<'a> {
    /// Horizontal motion.
    pub samples: &'a Samples,
    /// Factor on it.
    pub factor: f64,
    /// Vertical motion of as many samples, and the factor on it; the system has it too.
    pub vertical: Option<(&'a Samples, f64)>,
}

/// A motion of smooth pieces, one after the other.
#[derive(Clone, Copy, Debug)]
pub struct Pieces<'a> {
    /// The pieces from 0 s on; quiet ones, such as a free time, included.
    pub pieces: &'a [Piece<'a>],
    /// Lower bound of 1 + v̈_g/g, 0 to 1.
    pub lightest: f64,
}

/// A smooth piece of ground motion in its own time.
#[derive(Clone, Copy)]
pub struct Piece<'a> {
    /// s from the start of the motion.
    pub start: f64,
    /// s, above 0.
    pub duration: f64,
    /// Bound of |ü_g/g| from here to the end of the motion.
    pub bound: f64,
    /// Horizontal motion.
    pub horizontal: &'a dyn GroundSegment<f64>,
    /// Vertical motion, if there is one; the system has it too.
    pub vertical: Option<&'a dyn GroundSegment<f64>>,
}

impl fmt::Debug for Piece<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Piece { start, duration, bound, .. } = self;
        f.debug_struct("Piece").field("start", start).field("duration", duration).field("bound", bound).finish_non_exhaustive()
    }
}

impl Sampled<'_> {
    /// Ground acceleration (in g) at `sample`, horizontal and vertical.
    #[inline(always)]
    pub(super) fn at(&self, sample: usize) -> [f64; 2] {
        let Sampled { samples, factor, vertical } = *self;
        [factor * samples.values[sample], vertical.map_or(0.0, |(up, factor)| factor * up.values[sample])]
    }

    /// The lines from `sample` to the next.
    #[inline(always)]
    fn lines(&self, sample: usize) -> [Linear<f64>; 2] {
        let (from, to) = (self.at(sample), self.at(sample + 1));
        from_fn(|way| Linear::between(from[way], to[way], self.samples.step))
    }

    fn is_plain(&self) -> bool {
        let Sampled { samples, factor, vertical } = *self;
        let matches = |(up, _): (&Samples, f64)| up.values.len() == samples.values.len() && up.step == samples.step;
        (1e-9..1e3).contains(&samples.step)
            && samples.values.len() > 1
            && (1e-9..1e4).contains(&(samples.bounds[0] * factor.abs()))
            && vertical.is_none_or(matches)
    }
}

impl Pieces<'_> {
    fn is_plain(&self) -> bool {
        let within = |piece: &Piece<'_>| (1e-9..1e6).contains(&piece.duration) && (0.0..1e4).contains(&piece.bound);
        !self.pieces.is_empty() && self.pieces.iter().all(within)
    }
}

impl Ground<'_> {
    /// Whether lanes may follow a block over it.
    pub(super) fn is_plain(&self) -> bool {
        let plain = match self {
            Ground::Record(record) => record.is_plain(),
            Ground::Pieces(pieces) => pieces.is_plain(),
        };
        plain && self.lightest() > 0.1
    }

    pub(super) fn is_vertical(&self) -> bool {
        match self {
            Ground::Record(record) => record.vertical.is_some(),
            Ground::Pieces(Pieces { pieces, .. }) => pieces.iter().any(|piece| piece.vertical.is_some()),
        }
    }

    /// Lower bound of 1 + v̈_g/g.
    pub(super) fn lightest(&self) -> f64 {
        match self {
            Ground::Record(Sampled { vertical, .. }) => {
                1.0 - vertical.map_or(0.0, |(up, factor)| up.bounds.first().map_or(0.0, |bound| bound * factor.abs()))
            }
            Ground::Pieces(Pieces { lightest, .. }) => *lightest,
        }
    }

    /// Number of intervals.
    #[inline(always)]
    pub(super) fn intervals(&self) -> usize {
        match self {
            Ground::Record(Sampled { samples, .. }) => samples.values.len() - 1,
            Ground::Pieces(Pieces { pieces, .. }) => pieces.len(),
        }
    }

    /// How long it moves, s.
    pub(super) fn duration(&self) -> f64 {
        match self {
            Ground::Record(Sampled { samples, .. }) => samples.duration(),
            Ground::Pieces(Pieces { pieces, .. }) => pieces.last().map_or(0.0, |last| last.start + last.duration),
        }
    }

    /// Start of an `interval`, s.
    pub(super) fn start(&self, interval: usize) -> f64 {
        match self {
            Ground::Record(Sampled { samples, .. }) => samples.step * interval as f64,
            Ground::Pieces(Pieces { pieces, .. }) => pieces[interval].start,
        }
    }

    /// Length of an `interval`, s.
    #[inline(always)]
    pub(super) fn length(&self, interval: usize) -> f64 {
        match self {
            Ground::Record(Sampled { samples, .. }) => samples.step,
            Ground::Pieces(Pieces { pieces, .. }) => pieces[interval].duration,
        }
    }

    /// Bound of |ü_g/g| from the start of an `interval` on.
    #[inline(always)]
    pub(super) fn bound(&self, interval: usize) -> f64 {
        match self {
            Ground::Record(Sampled { samples, factor, .. }) => factor.abs() * samples.bounds[interval],
            Ground::Pieces(Pieces { pieces, .. }) => pieces[interval].bound,
        }
    }

    /// What `then` makes of the motion in an `interval`.
    pub(super) fn over<T>(&self, interval: usize, then: impl FnOnce(Shaking<'_, f64>) -> T) -> T {
        match self {
            Ground::Record(record) => {
                let [level, up] = record.lines(interval);
                let vertical = record.vertical.map(|_| &up as &dyn GroundSegment<f64>);
                then(Shaking { horizontal: &level, vertical, support: None })
            }
            Ground::Pieces(Pieces { pieces, .. }) => {
                let Piece { horizontal, vertical, .. } = pieces[interval];
                then(Shaking { horizontal, vertical, support: None })
            }
        }
    }

    /// Hands the coefficients of the horizontal (0) and the vertical (1) acceleration `time` (s) after the start of an `interval`, of which
    /// `rates` are in use, to `set`, with way and order.
    #[inline(always)]
    pub(super) fn series(&self, interval: usize, time: f64, rates: usize, mut set: impl FnMut(usize, usize, f64)) {
        match self {
            Ground::Record(record) => {
                for (way, line) in record.lines(interval).into_iter().enumerate() {
                    set(way, 0, line.start + line.slope * time);
                    set(way, 1, line.slope);
                }
            }
            Ground::Pieces(Pieces { pieces, .. }) => {
                let Piece { horizontal, vertical, .. } = pieces[interval];
                for (way, segment) in [Some(horizontal), vertical].into_iter().enumerate() {
                    let mut coefficients = [0.0; RATES];
                    if let Some(segment) = segment {
                        segment.series(time, &mut coefficients[..rates]);
                    }
                    for (order, &coefficient) in coefficients[..rates].iter().enumerate() {
                        set(way, order, coefficient);
                    }
                }
            }
        }
    }
}
