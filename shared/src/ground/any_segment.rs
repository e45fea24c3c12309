//! A ground segment chosen at run time.

use super::harmonic::Harmonic;
use super::{DampedOscillation, Elementary, GroundSegment, Harmonics, Linear, Ricker};
use crate::math::scalar::Real;

/// A ground segment of any shape. It is chosen at every look, not before the loop: one loop for each structure and method is what
/// fits the flash.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnySegment<S> {
    /// No ground acceleration.
    Quiet,
    /// A straight line.
    Linear(Linear<S>),
    /// One sine.
    Sine(Harmonics<S, 1>),
    /// Three, as a Mavroeidis-Papageorgiou wavelet has.
    ThreeSines(Harmonics<S, 3>),
    /// A Ricker wavelet.
    Ricker(Ricker<S>),
    /// A free damped oscillation.
    Damped(DampedOscillation<S>),
}

macro_rules! each {
    ($segment:expr, $inner:ident => $result:expr) => {
        match $segment {
            AnySegment::Quiet => {
                let $inner = &Harmonics::QUIET;
                $result
            }
            AnySegment::Linear($inner) => $result,
            AnySegment::Sine($inner) => $result,
            AnySegment::ThreeSines($inner) => $result,
            AnySegment::Ricker($inner) => $result,
            AnySegment::Damped($inner) => $result,
        }
    };
}

impl<S: Real> AnySegment<S> {
    /// Upper bound of |ü_g/g| over `duration` (s).
    pub fn bound(&self, duration: S) -> S {
        match self {
            AnySegment::Quiet => S::ZERO,
            AnySegment::Linear(line) => line.bound(duration),
            AnySegment::Sine(sine) => sine.bound(),
            AnySegment::ThreeSines(sines) => sines.bound(),
            AnySegment::Ricker(wavelet) => wavelet.amplitude.abs(),
            AnySegment::Damped(oscillation) => oscillation.bound(),
        }
    }

    /// The other way round.
    pub fn opposite(&self) -> AnySegment<S> {
        fn waves<S: Real, const M: usize>(sines: &Harmonics<S, M>) -> Harmonics<S, M> {
            Harmonics { terms: sines.terms.map(|term| Harmonic { amplitude: -term.amplitude, ..term }) }
        }
        match self {
            AnySegment::Quiet => AnySegment::Quiet,
            AnySegment::Linear(line) => AnySegment::Linear(Linear { start: -line.start, slope: -line.slope }),
            AnySegment::Sine(sine) => AnySegment::Sine(waves(sine)),
            AnySegment::ThreeSines(sines) => AnySegment::ThreeSines(waves(sines)),
            AnySegment::Ricker(wavelet) => AnySegment::Ricker(Ricker { amplitude: -wavelet.amplitude, ..*wavelet }),
            AnySegment::Damped(free) => {
                AnySegment::Damped(DampedOscillation { real: -free.real, imaginary: -free.imaginary, ..*free })
            }
        }
    }

    /// In precision `T`.
    pub fn to<T: Real>(&self) -> AnySegment<T> {
        match self {
            AnySegment::Quiet => AnySegment::Quiet,
            AnySegment::Linear(line) => AnySegment::Linear(line.to()),
            AnySegment::Sine(sine) => AnySegment::Sine(sine.to()),
            AnySegment::ThreeSines(sines) => AnySegment::ThreeSines(sines.to()),
            AnySegment::Ricker(wavelet) => AnySegment::Ricker(wavelet.to()),
            AnySegment::Damped(oscillation) => AnySegment::Damped(oscillation.to()),
        }
    }
}

impl<S: Real> GroundSegment<S> for AnySegment<S> {
    // Shapes that are no line are looked at out of line: in line they would cost every look registers, in one program and not in another.
    fn acceleration(&self, time: S) -> S {
        each!(self, segment => segment.acceleration(time))
    }

    fn slope(&self, time: S) -> S {
        each!(self, segment => segment.slope(time))
    }

    fn gain(&self, time: S) -> S {
        each!(self, segment => segment.gain(time))
    }

    fn curvature_bound(&self) -> S {
        each!(self, segment => segment.curvature_bound())
    }

    fn curvature_bound_from(&self, time: S) -> S {
        each!(self, segment => segment.curvature_bound_from(time))
    }

    fn angular_frequency(&self) -> S {
        each!(self, segment => segment.angular_frequency())
    }

    fn series(&self, time: S, coefficients: &mut [S]) {
        each!(self, segment => segment.series(time, coefficients));
    }

    fn is_quiet(&self) -> bool {
        matches!(self, AnySegment::Quiet)
    }

    fn elementary(&self, time: S) -> Option<Elementary<S>> {
        each!(self, segment => segment.elementary(time))
    }
}
