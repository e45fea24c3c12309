//! Ground acceleration, piece by smooth piece.
//!
//! A ground motion is a row of pieces, each smooth in its own local time from 0, with every kink and jump at a boundary
//! between two. Accelerations are in g. Steppers see one piece at a time, so no step ever crosses a kink.
//!
//! The room imports `math` and `structure`.

pub mod any_segment;
pub mod damped;
pub mod elementary;
pub mod harmonic;
pub mod linear;
pub mod ricker;

pub use any_segment::AnySegment;
pub use damped::DampedOscillation;
pub use elementary::Elementary;
pub use harmonic::Harmonics;
pub use linear::Linear;
pub use ricker::Ricker;

use crate::math::scalar::Real;

/// A smooth stretch of ground acceleration ü_g/g over local time τ ≥ 0 (s).
pub trait GroundSegment<S: Real> {
    /// ü_g/g at τ.
    fn acceleration(&self, time: S) -> S;

    /// d(ü_g/g)/dτ at τ, 1/s.
    fn slope(&self, time: S) -> S;

    /// ∫₀^τ ü_g/g dt, s: what the ground's velocity gains, over g.
    fn gain(&self, time: S) -> S;

    /// Upper bound of |d²(ü_g/g)/dτ²| over the piece, 1/s²; 0 for straight lines.
    fn curvature_bound(&self) -> S;

    /// The same from τ on, for a shape that dies out.
    fn curvature_bound_from(&self, _time: S) -> S {
        self.curvature_bound()
    }

    /// Largest angular frequency of its waves, rad/s; 0 for straight lines.
    fn angular_frequency(&self) -> S {
        S::ZERO
    }

    /// Taylor coefficients of ü_g/g about τ, as many as `coefficients` holds.
    fn series(&self, time: S, coefficients: &mut [S]);

    /// Whether the ground is known to stand still over the whole piece, so that a free motion may be summed to its end.
    fn is_quiet(&self) -> bool {
        false
    }

    /// Continuation of ü_g/g from τ, if it is made of a line and a few sines; the same answer, yes or no, for every τ.
    fn elementary(&self, _time: S) -> Option<Elementary<S>> {
        None
    }
}

#[cfg(test)]
pub(crate) mod check {
    use super::*;
    use crate::math::power_series::MAXIMUM_ORDER;
    use crate::math::quadrature::integral;

    /// Two motions at once.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Sum<A, B>(pub A, pub B);

    impl<S: Real, A: GroundSegment<S>, B: GroundSegment<S>> GroundSegment<S> for Sum<A, B> {
        fn acceleration(&self, time: S) -> S {
            self.0.acceleration(time) + self.1.acceleration(time)
        }

        fn slope(&self, time: S) -> S {
            self.0.slope(time) + self.1.slope(time)
        }

        fn gain(&self, time: S) -> S {
            self.0.gain(time) + self.1.gain(time)
        }

        fn curvature_bound(&self) -> S {
            self.0.curvature_bound() + self.1.curvature_bound()
        }

        fn series(&self, time: S, coefficients: &mut [S]) {
            self.0.series(time, coefficients);
            let mut others = [S::ZERO; MAXIMUM_ORDER];
            let length = coefficients.len().min(others.len());
            self.1.series(time, &mut others[..length]);
            for (sum, &other) in coefficients.iter_mut().zip(&others) {
                *sum = *sum + other;
            }
        }

        fn elementary(&self, time: S) -> Option<Elementary<S>> {
            self.0.elementary(time)?.and(&self.1.elementary(time)?)
        }
    }

    /// A piece's slope and series must be those of its acceleration.
    pub fn consistency(piece: &impl GroundSegment<f64>, times: &[f64]) {
        for &time in times {
            let step = 1e-5;
            let slope = (piece.acceleration(time + step) - piece.acceleration(time - step)) / (2.0 * step);
            assert!((slope - piece.slope(time)).abs() < 1e-6 * (1.0 + slope.abs()), "slope at {time}");
            let [gain] = integral(0.0, time, 0.05, |t| [piece.acceleration(t)]);
            assert!((gain - piece.gain(time)).abs() < 1e-14, "gain at {time}: {gain} {}", piece.gain(time));
            let second = (piece.slope(time + step) - piece.slope(time - step)) / (2.0 * step);
            assert!(second.abs() <= piece.curvature_bound() * (1.0 + 1e-6) + 1e-6, "curvature at {time}");
            let mut coefficients = [0.0; 24];
            piece.series(time, &mut coefficients);
            for offset in [-0.02, 0.013, 0.05] {
                let sum = coefficients.iter().rev().fold(0.0, |sum, c| sum * offset + c);
                let exact = piece.acceleration(time + offset);
                assert!((sum - exact).abs() < 1e-13 * (1.0 + exact.abs()), "series at {time} + {offset}: {sum} {exact}");
            }
        }
    }

    #[test]
    fn a_sum_is_the_sum() {
        let sum = Sum(Harmonics::sine(1.5, 4.0), Linear { start: 0.2, slope: -0.3 });
        consistency(&sum, &[0.1, 0.9]);
        assert!((GroundSegment::<f64>::acceleration(&sum, 0.3) - (1.5 * crate::math::sin(1.2) + 0.2 - 0.09)).abs() < 1e-15);
    }
}
