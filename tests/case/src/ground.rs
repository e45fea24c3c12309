//! The ground motion of a case: a few shapes in closed form, or a record.

use crate::{CaseError, MOST_PIECES};
use sprag_shared::ground::{AnySegment, GroundSegment, Linear};
use sprag_shared::structure::error::{ParameterError, require};

/// One shape of ground acceleration, in g, over local time.
pub type Shape = AnySegment<f32>;

/// A shape and how long it lasts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundPiece {
    /// What.
    pub shape: Shape,
    /// s, 0 or more.
    pub duration: f32,
}

/// The ground motion of a case. What it does vertically has the pieces or the samples of what it does horizontally.
#[expect(clippy::large_enum_variant, reason = "there is no allocation, and a program has one")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ground<'a> {
    /// Piece after piece; those of no duration are skipped.
    Pieces {
        /// ü_g.
        horizontal: [GroundPiece; MOST_PIECES],
        /// v̈_g over each of them, positive upwards.
        vertical: Option<[Shape; MOST_PIECES]>,
    },
    /// A record, straight between its samples.
    Record {
        /// s, above 0.
        interval: f32,
        /// Bits of ü_g, in g.
        samples: &'a [u32],
        /// Bits of v̈_g, in g and positive upwards; as many.
        vertical: Option<&'a [u32]>,
    },
}

impl Ground<'_> {
    /// The pieces in `list`, of which there may be [`MOST_PIECES`], without a vertical motion.
    ///
    /// # Errors
    /// [`CaseError::TooManyPieces`].
    pub fn pieces(list: &[GroundPiece]) -> Result<Ground<'static>, CaseError> {
        let mut horizontal = [GroundPiece::NONE; MOST_PIECES];
        horizontal.get_mut(..list.len()).ok_or(CaseError::TooManyPieces(list.len() as u32))?.copy_from_slice(list);
        Ok(Ground::Pieces { horizontal, vertical: None })
    }

    /// As [`Ground::pieces`], each with what the ground does vertically.
    ///
    /// # Errors
    /// As there.
    pub fn both_ways(list: &[(GroundPiece, Shape)]) -> Result<Ground<'static>, CaseError> {
        let (mut horizontal, mut vertical) = ([GroundPiece::NONE; MOST_PIECES], [Shape::Quiet; MOST_PIECES]);
        if list.len() > MOST_PIECES {
            return Err(CaseError::TooManyPieces(list.len() as u32));
        }
        for ((piece, up), &given) in horizontal.iter_mut().zip(&mut vertical).zip(list) {
            (*piece, *up) = given;
        }
        Ok(Ground::Pieces { horizontal, vertical: Some(vertical) })
    }

    /// Whether the ground moves vertically too.
    pub fn is_vertical(&self) -> bool {
        match self {
            Ground::Pieces { vertical, .. } => vertical.is_some(),
            Ground::Record { vertical, .. } => vertical.is_some(),
        }
    }

    /// Upper bound of |ü_g/g|.
    pub(super) fn bound(&self) -> f32 {
        match self {
            Ground::Pieces { horizontal, .. } => horizontal.iter().fold(0.0, |bound, piece| bound.max(piece.bound())),
            Ground::Record { samples, .. } => samples.iter().fold(0.0, |bound, &bits| bound.max(f32::from_bits(bits).abs())),
        }
    }

    /// ü_g/g and v̈_g/g at the start.
    pub(super) fn first(&self) -> [f32; 2] {
        match self {
            Ground::Pieces { horizontal, vertical } => {
                let Some(first) = horizontal.iter().position(|piece| piece.duration > 0.0) else { return [0.0; 2] };
                [horizontal[first].shape, vertical.map_or(Shape::Quiet, |shapes| shapes[first])]
                    .map(|shape| shape.acceleration(0.0))
            }
            Ground::Record { samples, vertical, .. } => {
                [*samples, vertical.unwrap_or(&[])].map(|samples| samples.first().map_or(0.0, |&bits| f32::from_bits(bits)))
            }
        }
    }

    /// When it ends, s.
    pub(super) fn duration(&self) -> f32 {
        match self {
            Ground::Pieces { horizontal, .. } => horizontal.iter().map(|piece| piece.duration).sum(),
            Ground::Record { interval, samples, .. } => samples.len().saturating_sub(1) as f32 * interval,
        }
    }

    /// Every piece that lasts, with its vertical shape, when it starts and its duration, in order, for as long as `follow` has no
    /// error. In a record the time is counted: a sum of its intervals would drift.
    pub(super) fn try_for_each<E>(
        &self,
        mut follow: impl FnMut(&Shape, Option<&Shape>, f32, f32) -> Result<(), E>,
    ) -> Result<(), E> {
        match self {
            Ground::Pieces { horizontal, vertical } => {
                let mut pieces = horizontal.iter().enumerate().filter(|(_, piece)| piece.duration > 0.0);
                let mut start = 0.0;
                pieces.try_for_each(|(index, piece)| {
                    let up = vertical.as_ref().and_then(|shapes| shapes.get(index));
                    let done = follow(&piece.shape, up, start, piece.duration);
                    start += piece.duration;
                    done
                })
            }
            Ground::Record { interval, samples, vertical } => {
                let line = |pair: &[u32]| match *pair {
                    [from, to] => Shape::Linear(Linear::between(f32::from_bits(from), f32::from_bits(to), *interval)),
                    _ => Shape::Quiet,
                };
                let mut verticals = vertical.map(|samples| samples.windows(2));
                samples.windows(2).enumerate().try_for_each(|(index, pair)| {
                    let up = verticals.as_mut().map(|pairs| line(pairs.next().unwrap_or(&[])));
                    follow(&line(pair), up.as_ref(), index as f32 * interval, *interval)
                })
            }
        }
    }

    /// Checks every number and gives how many steps of `step` s (above 0) the motion takes at most.
    ///
    /// # Errors
    /// [`CaseError`] names the first number that is wrong.
    pub(super) fn check(&self, step: f32) -> Result<f32, CaseError> {
        match self {
            Ground::Pieces { horizontal, vertical } => {
                let mut steps = 0.0;
                for (index, piece) in horizontal.iter().enumerate() {
                    number("duration", piece.duration, piece.duration >= 0.0, "0 s or more")?;
                    number("ground acceleration", piece.bound(), true, "finite")?;
                    if let Some(shapes) = vertical {
                        let up = GroundPiece { shape: shapes[index], ..*piece };
                        number("vertical acceleration", up.bound(), true, "finite")?;
                        weighs("vertical acceleration", up.lowest())?;
                    }
                    steps += piece.duration / step + 1.0;
                }
                Ok(steps)
            }
            Ground::Record { interval, samples, vertical } => {
                number("interval", *interval, *interval > 0.0, "above 0 s")?;
                for &bits in *samples {
                    number("sample", f32::from_bits(bits), true, "finite")?;
                }
                if let Some(vertical) = vertical {
                    if vertical.len() != samples.len() {
                        return Err(CaseError::Uneven { horizontal: samples.len() as u32, vertical: vertical.len() as u32 });
                    }
                    for &bits in *vertical {
                        weighs("vertical sample", f32::from_bits(bits))?;
                    }
                }
                Ok(samples.len() as f32 * (interval / step + 1.0))
            }
        }
    }
}

fn number(name: &'static str, value: f32, allowed: bool, range: &'static str) -> Result<(), ParameterError> {
    require(name, f64::from(value), allowed, range).map(|_| ())
}

/// The block is pressed to the ground as long as v̈_g/g stays above −1.
fn weighs(name: &'static str, lowest: f32) -> Result<(), ParameterError> {
    number(name, lowest, lowest > -1.0, "above -1 g, where the ground would fall away from the block")
}

impl GroundPiece {
    /// Of no duration.
    pub(super) const NONE: GroundPiece = GroundPiece { shape: Shape::Quiet, duration: 0.0 };

    /// Upper bound of the magnitude.
    fn bound(&self) -> f32 {
        if self.duration == 0.0 {
            return 0.0;
        }
        self.shape.bound(self.duration)
    }

    /// Lower bound of the value.
    fn lowest(&self) -> f32 {
        match &self.shape {
            Shape::Linear(line) if self.duration > 0.0 => line.start.min(line.acceleration(self.duration)),
            _ => -self.bound(),
        }
    }
}
