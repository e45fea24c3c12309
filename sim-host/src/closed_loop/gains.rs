//! Steady-state Kalman gains, solved on the host; the target has them as constants.

use nalgebra::{SMatrix, SVector};

/// A linear model x' = A x + w, z = H x + v with independent noises of variances q and r.
#[derive(Clone, Copy, Debug)]
pub struct Tracking<const N: usize, const M: usize> {
    /// A, of one tick.
    pub transition: SMatrix<f64, N, N>,
    /// Covariance of w over one tick.
    pub process: SMatrix<f64, N, N>,
    /// H.
    pub measurement: SMatrix<f64, M, N>,
    /// Variance of each reading.
    pub noise: SVector<f64, M>,
}

/// Iterations within which every design here settles; the slowest, a bias that walks by 1e-9 of the noise, takes 300,000.
const MOST_ITERATIONS: u32 = 2_000_000;

impl<const N: usize, const M: usize> Tracking<N, M> {
    /// Gains K of the filter that corrects its prediction by K (z − H x), and the covariance after the correction: the fixed point of the
    /// Riccati recursion P⁻ = A P Aᵀ + Q, K = P⁻ Hᵀ (H P⁻ Hᵀ + R)⁻¹, P = (I − K H) P⁻ (Anderson and Moore 1979, section 4.4), by
    /// iteration until no gain changes by 1e-12 of itself. `None` if a matrix cannot be inverted.
    pub fn steady(&self) -> Option<(SMatrix<f64, N, M>, SMatrix<f64, N, N>)> {
        let identity = SMatrix::<f64, N, N>::identity();
        let noise = SMatrix::<f64, M, M>::from_diagonal(&self.noise);
        let mut covariance = self.process;
        let mut gains = SMatrix::<f64, N, M>::zeros();
        for _ in 0..MOST_ITERATIONS {
            let ahead = self.transition * covariance * self.transition.transpose() + self.process;
            let innovation = self.measurement * ahead * self.measurement.transpose() + noise;
            let next = ahead * self.measurement.transpose() * innovation.try_inverse()?;
            let kept = identity - next * self.measurement;
            // Joseph's form stays symmetric and positive.
            covariance = kept * ahead * kept.transpose() + next * noise * next.transpose();
            let change = (next - gains).abs().max();
            gains = next;
            if change <= 1e-13 * gains.abs().max() {
                break;
            }
        }
        Some((gains, covariance))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprag_shared::math;

    /// A random walk seen through noise: P⁻ = q/2 (1 + √(1 + 4 r/q)), K = P⁻/(P⁻ + r).
    #[test]
    fn a_random_walk_has_its_closed_form() {
        for (q, r) in [(1.0_f64, 1.0_f64), (1e-6, 1.0), (0.3, 1e-3)] {
            let one = SMatrix::<f64, 1, 1>::identity();
            let tracking = Tracking { transition: one, process: one * q, measurement: one, noise: SVector::<f64, 1>::new(r) };
            let (gains, covariance) = tracking.steady().unwrap();
            let ahead = 0.5 * q * (1.0 + math::square_root(1.0 + 4.0 * r / q));
            let exact = ahead / (ahead + r);
            assert!((gains[0] / exact - 1.0).abs() < 1e-6, "{} {exact}", gains[0]);
            assert!((covariance[0] / (exact * r) - 1.0).abs() < 1e-6);
        }
    }

    /// Position and velocity driven by white acceleration: Kalata's relation between the two gains, β = 4 − 2α − 4 √(1 − α), for the
    /// piecewise constant acceleration.
    #[test]
    fn position_and_velocity_follow_kalatas_relation() {
        let period = 5e-4;
        let drive = SVector::<f64, 2>::new(0.5 * period * period, period);
        let tracking = Tracking {
            transition: SMatrix::<f64, 2, 2>::new(1.0, period, 0.0, 1.0),
            process: drive * drive.transpose() * 4.0,
            measurement: SMatrix::<f64, 1, 2>::new(1.0, 0.0),
            noise: SVector::<f64, 1>::new(1e-10),
        };
        let (gains, _) = tracking.steady().unwrap();
        let (alpha, beta) = (gains[0], gains[1] * period);
        assert!((beta - (4.0 - 2.0 * alpha - 4.0 * math::square_root(1.0 - alpha))).abs() < 1e-6 * beta);
    }

    #[test]
    fn readings_without_noise_are_taken_as_they_are() {
        let one = SMatrix::<f64, 1, 1>::identity();
        let tracking = Tracking { transition: one, process: one, measurement: one, noise: SVector::<f64, 1>::new(0.0) };
        assert_eq!(tracking.steady().unwrap().0[0], 1.0);
    }
}
