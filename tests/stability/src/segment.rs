//! Ground motions, segment by segment.

use sprag_shared::ground::harmonic::Harmonic;
use sprag_shared::ground::{AnySegment, Harmonics, Linear};
use sprag_shared::math::scalar::Real;

/// A ground motion and how long it lasts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<S> {
    /// The motion.
    pub ground: AnySegment<S>,
    /// s.
    pub duration: S,
}

impl<S: Real> Segment<S> {
    /// A constant acceleration (in g).
    pub fn constant(level: S, duration: S) -> Segment<S> {
        Segment { ground: AnySegment::Linear(Linear::constant(level)), duration }
    }

    /// A straight line from `first` to `second` (in g).
    pub fn line(first: S, second: S, duration: S) -> Segment<S> {
        Segment { ground: AnySegment::Linear(Linear::between(first, second, duration)), duration }
    }

    /// A sin ωτ.
    pub fn sine(amplitude: S, frequency: S, duration: S) -> Segment<S> {
        Segment { ground: AnySegment::Sine(Harmonics::sine(amplitude, frequency)), duration }
    }

    /// A cos ωτ.
    pub fn cosine(amplitude: S, frequency: S, duration: S) -> Segment<S> {
        Segment { ground: AnySegment::Sine(Harmonics::cosine(amplitude, frequency)), duration }
    }

    /// A sin(ωτ + φ) with φ in rad.
    pub fn sine_from(amplitude: S, frequency: S, phase: S, duration: S) -> Segment<S> {
        Segment { ground: AnySegment::Sine(Harmonics { terms: [Harmonic { amplitude, frequency, phase }] }), duration }
    }

    /// No motion.
    pub fn quiet(duration: S) -> Segment<S> {
        Segment { ground: AnySegment::Quiet, duration }
    }

    /// The same motion towards the other side.
    pub fn mirrored(mut self) -> Segment<S> {
        self.ground = self.ground.opposite();
        self
    }

    /// Bound of |ü_g/g|.
    pub(crate) fn bound(&self) -> S {
        self.ground.bound(self.duration)
    }
}
