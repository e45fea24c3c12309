//! A free damped oscillation, as of a support on the ground.

use super::GroundSegment;
use crate::math;
use crate::math::scalar::Real;

/// ü/g = e^{−βτ} (a cos ωτ − b sin ωτ), the real part of (a + ib) e^{μτ} with μ = −β + iω.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DampedOscillation<S> {
    /// a, in g.
    pub real: S,
    /// b, in g.
    pub imaginary: S,
    /// β, 1/s; 0 or more.
    pub decay: S,
    /// ω, rad/s.
    pub frequency: S,
}

impl<S: Real> DampedOscillation<S> {
    /// Upper bound of |ü/g|.
    pub fn bound(&self) -> S {
        (self.real * self.real + self.imaginary * self.imaginary).square_root()
    }

    /// In precision `T`.
    pub fn to<T: Real>(&self) -> DampedOscillation<T> {
        let precise = |number: S| T::of(number.to_f64());
        DampedOscillation {
            real: precise(self.real),
            imaginary: precise(self.imaginary),
            decay: precise(self.decay),
            frequency: precise(self.frequency),
        }
    }

    /// (a + ib) e^{μτ}.
    fn turned(&self, time: S) -> (S, S) {
        let (sin, cos) = (self.frequency * time).sin_cos_of_phase();
        let left = (-(self.decay * time)).exp();
        (left * (self.real * cos - self.imaginary * sin), left * (self.imaginary * cos + self.real * sin))
    }

    /// The product of μ and `number`.
    fn rate(&self, (real, imaginary): (S, S)) -> (S, S) {
        (-(self.decay * real) - self.frequency * imaginary, self.frequency * real - self.decay * imaginary)
    }
}

impl<S: Real> GroundSegment<S> for DampedOscillation<S> {
    // Out of line, for `AnySegment`.
    #[inline(never)]
    fn acceleration(&self, time: S) -> S {
        self.turned(time).0
    }

    fn slope(&self, time: S) -> S {
        self.rate(self.turned(time)).0
    }

    fn gain(&self, time: S) -> S {
        // The real part of (a + ib)(e^{μτ} − 1)/μ, and 1/μ = (−β − iω)/(β² + ω²).
        let (real, imaginary) = self.turned(time);
        let change = self.frequency * (imaginary - self.imaginary) - self.decay * (real - self.real);
        change / (self.decay * self.decay + self.frequency * self.frequency)
    }

    fn curvature_bound(&self) -> S {
        (self.decay * self.decay + self.frequency * self.frequency) * self.bound()
    }

    fn curvature_bound_from(&self, time: S) -> S {
        (-(self.decay * time)).exp() * self.curvature_bound()
    }

    fn angular_frequency(&self) -> S {
        self.frequency + self.decay
    }

    fn series(&self, time: S, coefficients: &mut [S]) {
        let mut term = self.turned(time);
        for (k, slot) in coefficients.iter_mut().enumerate() {
            *slot = term.0;
            let (real, imaginary) = self.rate(term);
            let reciprocal = S::of(math::RECIPROCALS[(k + 1) & 63]);
            term = (real * reciprocal, imaginary * reciprocal);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_is_that_of_the_oscillation() {
        let oscillation = DampedOscillation { real: 0.3, imaginary: -0.8, decay: 0.7, frequency: 9.0 };
        crate::ground::check::consistency(&oscillation, &[0.0, 0.2, 0.9]);
        let exact = math::exp(-0.14) * (0.3 * math::cos(1.8) + 0.8 * math::sin(1.8));
        assert!((GroundSegment::<f64>::acceleration(&oscillation, 0.2) - exact).abs() < 1e-15);
        let single: f32 = oscillation.to::<f32>().acceleration(0.2);
        assert!((f64::from(single) - exact).abs() < 1e-6);
    }

    /// Many turns on, f32 knows the phase to its rounding.
    #[test]
    fn many_turns_in_single_precision() {
        let oscillation = DampedOscillation { real: 0.3, imaginary: -0.8, decay: 0.01, frequency: 31.0 };
        for turn in 1..100 {
            let time = f64::from(turn) * 0.37;
            let exact: f64 = oscillation.acceleration(time);
            let single: f32 = oscillation.to::<f32>().acceleration(time as f32);
            assert!((f64::from(single) - exact).abs() < 1e-6 * (1.0 + 31.0 * time), "at {time}: {single} for {exact}");
        }
    }
}
