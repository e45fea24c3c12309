//! A ground segment that is a sum of others.

use sprag_shared::ground::{AnySegment, Elementary, GroundSegment, Linear};
use sprag_shared::math::power_series::MAXIMUM_ORDER;
use sprag_shared::math::scalar::Real;

/// A sum of ground segments, of any number: that takes an allocation, which the core does not have.
#[derive(Clone, Debug)]
pub enum SumSegment<S> {
    /// One segment: the straight line that lines add up to, or none.
    Single(AnySegment<S>),
    /// Several segments, each with its local time (s) at which the sum starts.
    Several(Vec<(S, AnySegment<S>)>),
}

impl<S: Real> SumSegment<S> {
    /// Ground that does not move.
    pub const QUIET: Self = SumSegment::Single(AnySegment::Quiet);

    /// The sum of `parts`, each with its local time (s) at which the sum starts.
    pub fn of(parts: &[(S, AnySegment<S>)]) -> Self {
        let mut sum = Linear::constant(S::ZERO);
        for (offset, part) in parts {
            let Some(line) = line(*offset, part) else { return SumSegment::Several(parts.to_vec()) };
            sum = Linear { start: sum.start + line.start, slope: sum.slope + line.slope };
        }
        SumSegment::Single(AnySegment::Linear(sum))
    }

    /// The same sum from `delay` (s) on, in a time of its own.
    pub fn after(&self, delay: S) -> Self {
        match self {
            SumSegment::Single(AnySegment::Quiet) => SumSegment::QUIET,
            SumSegment::Single(AnySegment::Linear(line)) => SumSegment::Single(AnySegment::Linear(line.after(delay))),
            SumSegment::Single(segment) => SumSegment::Several(vec![(delay, *segment)]),
            SumSegment::Several(parts) => {
                SumSegment::Several(parts.iter().map(|(offset, part)| (*offset + delay, *part)).collect())
            }
        }
    }

    /// Acceleration at `time` (s) of the sum [after](SumSegment::after) `delay` (s): of a line, which most are, without making a sum.
    #[inline]
    pub fn acceleration_after(&self, delay: S, time: S) -> S {
        match self {
            SumSegment::Single(AnySegment::Linear(line)) => line.after(delay).acceleration(time),
            _ => self.after(delay).acceleration(time),
        }
    }

    /// Upper bound of |ü_g/g| over `duration` (s).
    pub fn bound(&self, duration: S) -> S {
        match self {
            SumSegment::Single(segment) => segment.bound(duration),
            SumSegment::Several(parts) => parts.iter().fold(S::ZERO, |sum, (offset, part)| {
                sum + line(*offset, part).map_or_else(|| part.bound(duration), |line| line.bound(duration))
            }),
        }
    }

    /// In precision `T`.
    pub fn to<T: Real>(&self) -> SumSegment<T> {
        match self {
            SumSegment::Single(segment) => SumSegment::Single(segment.to()),
            SumSegment::Several(parts) => {
                SumSegment::Several(parts.iter().map(|(offset, part)| (T::of(offset.to_f64()), part.to())).collect())
            }
        }
    }
}

/// As a straight line from the local time `offset` on, if it is one.
fn line<S: Real>(offset: S, segment: &AnySegment<S>) -> Option<Linear<S>> {
    match segment {
        AnySegment::Linear(line) => Some(line.after(offset)),
        _ => None,
    }
}

impl<S: Real> GroundSegment<S> for SumSegment<S> {
    #[inline]
    fn acceleration(&self, time: S) -> S {
        match self {
            SumSegment::Single(segment) => segment.acceleration(time),
            SumSegment::Several(parts) => {
                parts.iter().fold(S::ZERO, |sum, (offset, part)| sum + part.acceleration(*offset + time))
            }
        }
    }

    #[inline]
    fn slope(&self, time: S) -> S {
        match self {
            SumSegment::Single(segment) => segment.slope(time),
            SumSegment::Several(parts) => parts.iter().fold(S::ZERO, |sum, (offset, part)| sum + part.slope(*offset + time)),
        }
    }

    fn gain(&self, time: S) -> S {
        match self {
            SumSegment::Single(segment) => segment.gain(time),
            SumSegment::Several(parts) => {
                parts.iter().fold(S::ZERO, |sum, (offset, part)| sum + (part.gain(*offset + time) - part.gain(*offset)))
            }
        }
    }

    #[inline]
    fn curvature_bound(&self) -> S {
        match self {
            SumSegment::Single(segment) => segment.curvature_bound(),
            SumSegment::Several(parts) => parts.iter().fold(S::ZERO, |sum, (_, part)| sum + part.curvature_bound()),
        }
    }

    fn angular_frequency(&self) -> S {
        match self {
            SumSegment::Single(segment) => segment.angular_frequency(),
            SumSegment::Several(parts) => {
                parts.iter().fold(S::ZERO, |fastest, (_, part)| fastest.larger(part.angular_frequency()))
            }
        }
    }

    #[inline]
    fn series(&self, time: S, coefficients: &mut [S]) {
        let parts = match self {
            SumSegment::Single(segment) => return segment.series(time, coefficients),
            SumSegment::Several(parts) => parts,
        };
        coefficients.fill(S::ZERO);
        let mut others = [S::ZERO; MAXIMUM_ORDER];
        let length = coefficients.len().min(others.len());
        for (offset, part) in parts {
            part.series(*offset + time, &mut others[..length]);
            for (sum, other) in coefficients.iter_mut().zip(&others) {
                *sum = *sum + *other;
            }
        }
    }

    #[inline]
    fn is_quiet(&self) -> bool {
        matches!(self, SumSegment::Single(AnySegment::Quiet))
    }

    fn elementary(&self, time: S) -> Option<Elementary<S>> {
        match self {
            SumSegment::Single(segment) => segment.elementary(time),
            SumSegment::Several(parts) => {
                parts.iter().try_fold(Elementary::line(S::ZERO), |sum, (offset, part)| sum.and(&part.elementary(*offset + time)?))
            }
        }
    }
}
