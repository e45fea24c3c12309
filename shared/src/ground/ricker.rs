//! The Ricker wavelet, second derivative of a Gaussian.

use super::GroundSegment;
use crate::math;
use crate::math::scalar::Real;

/// ü_g/g = A (1 − 2x²) e^{−x²}, x = πf(τ − t₀) (symmetric Ricker wavelet, used for rocking by Vassiliou and Makris 2011).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ricker<S> {
    /// A, in g.
    pub amplitude: S,
    /// πf, rad/s; above 0.
    pub rate: S,
    /// t₀, s.
    pub centre: S,
}

impl<S: Real> Ricker<S> {
    fn gaussian(&self, time: S) -> (S, S) {
        let x = self.rate * (time - self.centre);
        (x, (-(x * x)).exp())
    }

    /// In precision `T`.
    pub fn to<T: Real>(&self) -> Ricker<T> {
        let precise = |number: S| T::of(number.to_f64());
        Ricker { amplitude: precise(self.amplitude), rate: precise(self.rate), centre: precise(self.centre) }
    }
}

impl<S: Real> GroundSegment<S> for Ricker<S> {
    // Out of line, for `AnySegment`.
    #[inline(never)]
    fn acceleration(&self, time: S) -> S {
        let (x, gaussian) = self.gaussian(time);
        self.amplitude * (S::ONE - S::of(2.0) * (x * x)) * gaussian
    }

    fn slope(&self, time: S) -> S {
        let (x, gaussian) = self.gaussian(time);
        self.amplitude * self.rate * (S::of(4.0) * (x * x * x) - S::of(6.0) * x) * gaussian
    }

    fn gain(&self, time: S) -> S {
        // d/dx x e^{−x²} = (1 − 2x²) e^{−x²}.
        let [(from, first), (to, last)] = [S::ZERO, time].map(|time| self.gaussian(time));
        self.amplitude * (to * last - from * first) / self.rate
    }

    fn curvature_bound(&self) -> S {
        // |d²/dx² (1 − 2x²)e^{−x²}| = |−6 + 24x² − 8x⁴| e^{−x²} is largest at x = 0, where it is 6.
        S::of(6.0) * self.amplitude.abs() * (self.rate * self.rate)
    }

    fn angular_frequency(&self) -> S {
        // At its crest, A(1 − 3x²), it is as curved as a wave of √6 times its rate.
        S::of(2.45) * self.rate
    }

    fn series(&self, time: S, coefficients: &mut [S]) {
        // (1 − 2x²)e^{−x²} = −½ G''(x) with G = e^{−x²}. About x₀, G' = −2xG gives for the coefficients of G in x
        // (k+1) g_{k+1} = −2 (x₀ g_k + g_{k−1}), and −½ G'' has the coefficients −½ (k+1)(k+2) g_{k+2}.
        let (x, gaussian) = self.gaussian(time);
        let minus_two = S::of(-2.0);
        let mut before = gaussian;
        let mut last = minus_two * (x * gaussian);
        let mut scale = self.amplitude * S::of(-0.5);
        for (k, slot) in coefficients.iter_mut().enumerate() {
            let next = minus_two * (x * last + before) * S::of(math::RECIPROCALS[(k + 2) & 63]);
            *slot = scale * S::of(((k + 1) * (k + 2)) as f64) * next;
            scale = scale * self.rate;
            before = last;
            last = next;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_is_that_of_the_wavelet() {
        let wavelet = Ricker { amplitude: 0.8, rate: 4.0, centre: 1.0 };
        crate::ground::check::consistency(&wavelet, &[0.2, 0.7, 1.0, 1.4]);
        assert!((GroundSegment::<f64>::acceleration(&wavelet, 1.0) - 0.8).abs() < 1e-16);
    }
}
