//! A segment's shape in the precision of a run, as the core's steppers see it.

use sprag_shared::ground::harmonic::Harmonic;
use sprag_shared::ground::{Elementary, GroundSegment, Harmonics, Linear, Quiet, Ricker};
use sprag_shared::math::scalar::Real;

use super::{Shape, Smooth};

/// A mixture in the precision of a run.
#[derive(Clone, Debug)]
pub struct MixturePiece<S> {
    parts: Vec<(S, SmoothPiece<S>)>,
}

/// A segment's shape in the precision of a run.
#[derive(Clone, Debug)]
pub enum ShapePiece<S> {
    /// None, after the ground motion.
    Quiet,
    /// A straight line.
    Linear(Linear<S>),
    /// Anything else.
    Mixture(MixturePiece<S>),
}

impl<S: Real> ShapePiece<S> {
    /// In precision `S`.
    pub fn of(shape: &Shape) -> Self {
        match shape {
            Shape::Linear(line) => ShapePiece::Linear(line_of(line)),
            Shape::Mixture(parts) => ShapePiece::Mixture(MixturePiece::of(parts)),
        }
    }
}

impl<S: Real> ShapePiece<S> {
    /// The same shape from `delay` (s) on, in a time of its own.
    pub fn after(&self, delay: S) -> Self {
        match self {
            ShapePiece::Quiet => ShapePiece::Quiet,
            ShapePiece::Linear(line) => ShapePiece::Linear(Linear { start: line.acceleration(delay), slope: line.slope }),
            ShapePiece::Mixture(mixture) => ShapePiece::Mixture(MixturePiece {
                parts: mixture.parts.iter().map(|(offset, piece)| (*offset + delay, *piece)).collect(),
            }),
        }
    }
}

impl<S: Real> GroundSegment<S> for ShapePiece<S> {
    #[inline]
    fn acceleration(&self, time: S) -> S {
        match self {
            ShapePiece::Quiet => S::ZERO,
            ShapePiece::Linear(line) => line.acceleration(time),
            ShapePiece::Mixture(mixture) => mixture.acceleration(time),
        }
    }

    #[inline]
    fn slope(&self, time: S) -> S {
        match self {
            ShapePiece::Quiet => S::ZERO,
            ShapePiece::Linear(line) => line.slope(time),
            ShapePiece::Mixture(mixture) => mixture.slope(time),
        }
    }

    #[inline]
    fn curvature_bound(&self) -> S {
        match self {
            ShapePiece::Quiet | ShapePiece::Linear(_) => S::ZERO,
            ShapePiece::Mixture(mixture) => mixture.curvature_bound(),
        }
    }

    #[inline]
    fn series(&self, time: S, coefficients: &mut [S]) {
        match self {
            ShapePiece::Quiet => Quiet.series(time, coefficients),
            ShapePiece::Linear(line) => line.series(time, coefficients),
            ShapePiece::Mixture(mixture) => mixture.series(time, coefficients),
        }
    }

    #[inline]
    fn is_quiet(&self) -> bool {
        matches!(self, ShapePiece::Quiet)
    }

    fn elementary(&self, time: S) -> Option<Elementary<S>> {
        match self {
            ShapePiece::Quiet => Quiet.elementary(time),
            ShapePiece::Linear(line) => line.elementary(time),
            ShapePiece::Mixture(mixture) => mixture.elementary(time),
        }
    }
}

#[derive(Clone, Copy, Debug)]
enum SmoothPiece<S> {
    Linear(Linear<S>),
    Single(Harmonics<S, 1>),
    Triple(Harmonics<S, 3>),
    Ricker(Ricker<S>),
}

fn line_of<S: Real>(line: &Linear<f64>) -> Linear<S> {
    Linear { start: S::of(line.start), slope: S::of(line.slope) }
}

fn harmonics_of<S: Real, const M: usize>(harmonics: &Harmonics<f64, M>) -> Harmonics<S, M> {
    Harmonics {
        terms: harmonics.terms.map(|term| Harmonic {
            amplitude: S::of(term.amplitude),
            frequency: S::of(term.frequency),
            phase: S::of(term.phase),
        }),
    }
}

impl<S: Real> MixturePiece<S> {
    /// In precision `S`.
    pub fn of(mixture: &[(f64, Smooth)]) -> Self {
        let part = |smooth: &Smooth| match smooth {
            Smooth::Linear(line) => SmoothPiece::Linear(line_of(line)),
            Smooth::Single(harmonics) => SmoothPiece::Single(harmonics_of(harmonics)),
            Smooth::Triple(harmonics) => SmoothPiece::Triple(harmonics_of(harmonics)),
            Smooth::Ricker(wavelet) => SmoothPiece::Ricker(Ricker {
                amplitude: S::of(wavelet.amplitude),
                rate: S::of(wavelet.rate),
                centre: S::of(wavelet.centre),
            }),
        };
        MixturePiece { parts: mixture.iter().map(|(offset, smooth)| (S::of(*offset), part(smooth))).collect() }
    }
}

macro_rules! each {
    ($piece:expr, $inner:ident => $result:expr) => {
        match $piece {
            SmoothPiece::Linear($inner) => $result,
            SmoothPiece::Single($inner) => $result,
            SmoothPiece::Triple($inner) => $result,
            SmoothPiece::Ricker($inner) => $result,
        }
    };
}

impl<S: Real> GroundSegment<S> for MixturePiece<S> {
    fn acceleration(&self, time: S) -> S {
        self.parts.iter().fold(S::ZERO, |sum, (offset, piece)| sum + each!(piece, p => p.acceleration(*offset + time)))
    }

    fn slope(&self, time: S) -> S {
        self.parts.iter().fold(S::ZERO, |sum, (offset, piece)| sum + each!(piece, p => p.slope(*offset + time)))
    }

    fn curvature_bound(&self) -> S {
        self.parts.iter().fold(S::ZERO, |sum, (_, piece)| sum + each!(piece, p => GroundSegment::<S>::curvature_bound(p)))
    }

    fn series(&self, time: S, coefficients: &mut [S]) {
        coefficients.fill(S::ZERO);
        let mut others = [S::ZERO; sprag_shared::math::power_series::MAXIMUM_ORDER];
        let length = coefficients.len().min(others.len());
        for (offset, piece) in &self.parts {
            each!(piece, p => p.series(*offset + time, &mut others[..length]));
            for (sum, other) in coefficients.iter_mut().zip(&others) {
                *sum = *sum + *other;
            }
        }
    }

    fn elementary(&self, time: S) -> Option<Elementary<S>> {
        self.parts.iter().try_fold(Elementary::line(S::ZERO), |sum, (offset, piece)| {
            sum.and(&each!(piece, p => p.elementary(*offset + time))?)
        })
    }
}
