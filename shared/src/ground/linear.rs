//! A straight line: between two samples of a record, a rectangular pulse, or quiet ground seen by a controller's tick.

use super::{Elementary, GroundSegment};
use crate::math::scalar::Real;

/// ü_g/g = start + slope τ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear<S> {
    /// At τ = 0, in g.
    pub start: S,
    /// g/s.
    pub slope: S,
}

impl<S: Real> Linear<S> {
    /// From one sample to the next over `duration` (s, above 0).
    pub fn between(first: S, second: S, duration: S) -> Linear<S> {
        Linear { start: first, slope: (second - first) / duration }
    }

    /// Constant.
    pub fn constant(level: S) -> Linear<S> {
        Linear { start: level, slope: S::ZERO }
    }

    /// The same line from `delay` (s) on, in a time of its own.
    pub fn after(&self, delay: S) -> Linear<S> {
        Linear { start: self.acceleration(delay), slope: self.slope }
    }

    /// Upper bound of |ü_g/g| over `duration` (s).
    pub fn bound(&self, duration: S) -> S {
        self.start.abs().larger(self.acceleration(duration).abs())
    }

    /// In precision `T`.
    pub fn to<T: Real>(&self) -> Linear<T> {
        Linear { start: T::of(self.start.to_f64()), slope: T::of(self.slope.to_f64()) }
    }
}

impl<S: Real> GroundSegment<S> for Linear<S> {
    fn acceleration(&self, time: S) -> S {
        self.start + self.slope * time
    }

    fn slope(&self, _time: S) -> S {
        self.slope
    }

    fn gain(&self, time: S) -> S {
        time * (self.start + S::HALF * self.slope * time)
    }

    fn curvature_bound(&self) -> S {
        S::ZERO
    }

    fn series(&self, time: S, coefficients: &mut [S]) {
        coefficients.fill(S::ZERO);
        if let [first, second, ..] = coefficients {
            *first = self.acceleration(time);
            *second = self.slope;
        }
    }

    fn elementary(&self, _time: S) -> Option<Elementary<S>> {
        Some(Elementary::line(self.slope))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_straight() {
        let line = Linear::between(0.3, -0.1, 0.02);
        crate::ground::check::consistency(&line, &[0.0, 0.01]);
        assert!((GroundSegment::<f64>::acceleration(&line, 0.02) + 0.1).abs() < 1e-15);
    }
}
