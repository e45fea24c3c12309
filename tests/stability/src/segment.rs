//! Ground motions, segment by segment.

use sprag_shared::ground::harmonic::Harmonic;
use sprag_shared::ground::{GroundSegment, Harmonics, Linear};
use sprag_shared::math::scalar::Real;

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

impl<S: Real> GroundSegment<S> for Ground<S> {
    fn acceleration(&self, time: S) -> S {
        match self {
            Ground::Line(line) => line.acceleration(time),
            Ground::Sine(sine) => sine.acceleration(time),
            Ground::Quiet => S::ZERO,
        }
    }

    fn slope(&self, time: S) -> S {
        match self {
            Ground::Line(line) => GroundSegment::slope(line, time),
            Ground::Sine(sine) => sine.slope(time),
            Ground::Quiet => S::ZERO,
        }
    }

    fn curvature_bound(&self) -> S {
        match self {
            Ground::Sine(sine) => sine.curvature_bound(),
            _ => S::ZERO,
        }
    }

    fn series(&self, time: S, coefficients: &mut [S]) {
        match self {
            Ground::Line(line) => line.series(time, coefficients),
            Ground::Sine(sine) => sine.series(time, coefficients),
            Ground::Quiet => coefficients.fill(S::ZERO),
        }
    }

    fn is_quiet(&self) -> bool {
        matches!(self, Ground::Quiet)
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

    /// A sin(ωτ + φ) with φ in rad.
    pub fn sine_from(amplitude: S, frequency: S, phase: S, duration: S) -> Segment<S> {
        Segment { ground: Ground::Sine(Harmonics { terms: [Harmonic { amplitude, frequency, phase }] }), duration }
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
    pub(crate) fn bound(&self) -> S {
        match self.ground {
            Ground::Line(line) => line.start.abs().larger(line.acceleration(self.duration).abs()),
            Ground::Sine(sine) => sine.terms[0].amplitude.abs(),
            Ground::Quiet => S::ZERO,
        }
    }
}
