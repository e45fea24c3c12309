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

/// Doublings of the horizon within which every design here settles; the slowest, a bias that walks by 1e-9 of the noise, takes 20.
const MOST_DOUBLINGS: u32 = 60;

impl<const N: usize, const M: usize> Tracking<N, M> {
    /// Gains K of the filter that corrects its prediction by K (z − H x), and the covariance after the correction: the fixed point of the
    /// Riccati recursion P⁻ = A P Aᵀ + Q, K = P⁻ Hᵀ (H P⁻ Hᵀ + R)⁻¹, P = (I − K H) P⁻ (Anderson and Moore 1979, section 4.4), by the
    /// doubling algorithm (section 6.7 there), each pass of which does as many steps as all before it. `None` if a matrix cannot be inverted.
    pub fn steady(&self) -> Option<(SMatrix<f64, N, M>, SMatrix<f64, N, N>)> {
        let identity = SMatrix::<f64, N, N>::identity();
        let (_, gains) = self.corrected(&self.process)?;
        // One step from P to the next, as P' = S + Fᵀ P (I + G P)⁻¹ F: without R⁻¹, for a reading may have no noise.
        let kept = identity - gains * self.measurement;
        let seen = self.measurement * self.transition;
        let innovation = self.measurement * self.process * self.measurement.transpose() + self.measured();
        let mut factor = (kept * self.transition).transpose();
        let mut information = seen.transpose() * innovation.try_inverse()? * seen;
        let mut sum = symmetric(&(kept * self.process));
        for _ in 0..MOST_DOUBLINGS {
            let inverse = (identity + information * sum).try_inverse()?;
            let onward = inverse * factor;
            let more = symmetric(&(factor.transpose() * sum * onward));
            information += symmetric(&(factor * inverse * information * factor.transpose()));
            factor *= onward;
            sum += more;
            if more.abs().max() <= f64::EPSILON * sum.abs().max() {
                break;
            }
        }
        let (covariance, gains) = self.corrected(&(self.transition * sum * self.transition.transpose() + self.process))?;
        Some((gains, covariance))
    }

    /// Covariance and gains of a correction that finds the covariance `ahead`, by Joseph's form, which stays symmetric and positive.
    fn corrected(&self, ahead: &SMatrix<f64, N, N>) -> Option<(SMatrix<f64, N, N>, SMatrix<f64, N, M>)> {
        let innovation = self.measurement * ahead * self.measurement.transpose() + self.measured();
        let gains = ahead * self.measurement.transpose() * innovation.try_inverse()?;
        let kept = SMatrix::identity() - gains * self.measurement;
        Some((kept * ahead * kept.transpose() + gains * self.measured() * gains.transpose(), gains))
    }

    /// R.
    fn measured(&self) -> SMatrix<f64, M, M> {
        SMatrix::from_diagonal(&self.noise)
    }
}

/// Without the part that rounding makes antisymmetric.
fn symmetric<const N: usize>(matrix: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    (matrix + matrix.transpose()) * 0.5
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

    /// Angle, rate, acceleration and a bias of the rate that hardly walks, in units far apart: the gains are those of the recursion itself, which
    /// takes 20,000 steps to them.
    #[test]
    fn the_recursion_comes_to_the_same_gains() {
        let t = 5e-4;
        let mut transition = SMatrix::<f64, 4, 4>::identity();
        (transition[(0, 1)], transition[(0, 2)], transition[(1, 2)]) = (t, t * t / 2.0, t);
        let jerk = SVector::<f64, 4>::new(t * t * t / 6.0, t * t / 2.0, t, 0.0);
        let mut process = jerk * jerk.transpose() * 1e4;
        process[(3, 3)] = 1e-10 * t;
        let mut measurement = SMatrix::<f64, 3, 4>::zeros();
        (measurement[(0, 0)], measurement[(1, 1)], measurement[(1, 3)], measurement[(2, 2)]) = (1.0, 1.0, 1.0, 1.0);
        let tracking = Tracking { transition, process, measurement, noise: SVector::<f64, 3>::new(1e-12, 1e-7, 1e-3) };
        let (gains, covariance) = tracking.steady().unwrap();
        let mut slow = process;
        let mut last = gains;
        for _ in 0..20_000 {
            (slow, last) = tracking.corrected(&(transition * slow * transition.transpose() + process)).unwrap();
        }
        for (fast, slow) in gains.iter().zip(&last).chain(covariance.iter().zip(&slow)) {
            assert!((fast - slow).abs() <= 1e-9 * slow.abs() + 1e-15, "{fast} {slow}");
        }
    }

    #[test]
    fn readings_without_noise_are_taken_as_they_are() {
        let one = SMatrix::<f64, 1, 1>::identity();
        let tracking = Tracking { transition: one, process: one, measurement: one, noise: SVector::<f64, 1>::new(0.0) };
        assert_eq!(tracking.steady().unwrap().0[0], 1.0);
    }
}
