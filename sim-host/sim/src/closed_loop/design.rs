//! From data sheets to an estimator: delays, steady-state gains and standard deviations.

use nalgebra::{SMatrix, SVector};
use sprag_shared::control::estimation::Estimator;
use sprag_shared::control::estimation::complementary::Complementary;
use sprag_shared::control::estimation::estimate::Deviation;
use sprag_shared::control::estimation::kalman::Kalman;
use sprag_shared::control::estimation::model_aided::ModelAided;
use sprag_shared::control::estimation::rest_detection::Standing;
use sprag_shared::control::sensing::instruments::Instruments;
use sprag_shared::math;
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::GRAVITY;
use sprag_shared::structure::error::ParameterError;

use super::gains::Tracking;
use crate::scene::controller::EstimatorName;
use crate::sensor::{Inertial, Sampling, Suite};

/// Share of p²α by which the accelerometers' acceleration of the block may be wrong (scale, misalignment), for [`MODEL_TIME`] at a time.
const ACCELERATION_ERROR: f64 = 0.1;
/// How long the equation of motion stays wrong by as much as it may be, s.
const MODEL_TIME: f64 = 0.05;
/// Growth of the ground's acceleration that the kinematic filter must follow, g/s, for [`JERK_TIME`] at a time: 0.5 g at 3 Hz.
const JERK: f64 = 10.0;
/// s.
const JERK_TIME: f64 = 0.02;
/// Time constants of the accelerometers' tracking, s, for parts with noise.
const TRACKING: f64 = 0.0015;
/// Random walk of a gyroscope's bias, rad/s per √s: a degree an hour in a minute.
const BIAS_WALK: f64 = 6e-7;
/// Counts by which a rack may move at once under a block that stands.
const STANDING_COUNTS: f64 = 50.0;
/// For how long a block must be still to stand, s.
const STILL: f64 = 0.02;

/// What a controller knows of its sensors.
#[derive(Clone, Copy, Debug)]
pub struct SensorDesign {
    /// Delays, tracking and resolution.
    pub instruments: Instruments,
    /// The estimator with its gains.
    pub estimator: Estimator,
}

/// All [`Sampling::delays`] together, s.
pub(super) fn delay(bandwidth: f64, sampling: &Sampling) -> f64 {
    let [filter, held, latency] = sampling.delays(bandwidth);
    filter + held + latency
}

/// Variance of white readings, one a `period` (s), with the density of the sensor's noise: N²/(2T), and its quantisation.
fn variance(sensor: &Inertial, period: f64) -> f64 {
    let noise = sensor.noise_density * sensor.noise_density / (2.0 * period);
    noise + sensor.resolution * sensor.resolution / 12.0
}

fn square(x: f64) -> f64 {
    x * x
}

/// θ and θ̇ under white acceleration of a density of `density` ((rad/s²)²/Hz, two-sided).
fn two_states(density: f64, period: f64) -> (SMatrix<f64, 2, 2>, SMatrix<f64, 2, 2>) {
    let t = period;
    let transition = SMatrix::<f64, 2, 2>::new(1.0, t, 0.0, 1.0);
    (transition, SMatrix::<f64, 2, 2>::new(t * t * t / 3.0, t * t / 2.0, t * t / 2.0, t) * density)
}

impl SensorDesign {
    /// For `structure` (loaded), sensors and a control `period` (s); `shock` (s) is how long an impact shakes the sensors, `model_error` the
    /// share of p²α by which the equation of motion may be wrong.
    ///
    /// # Errors
    /// [`ParameterError`] for what the controller refuses.
    pub fn new(
        structure: &Structure,
        suite: &Suite,
        name: EstimatorName,
        period: f64,
        shock: f64,
        model_error: f64,
    ) -> Result<SensorDesign, ParameterError> {
        let block = &structure.block;
        let (size, p) = (block.size(), block.frequency_parameter());
        let weight = p * p * block.slenderness();
        let Suite { gyroscope, block_accelerometer, ground_accelerometer, encoder } = suite;
        let delays = [
            delay(gyroscope.bandwidth, &gyroscope.sampling),
            delay(0.0, &encoder.sampling),
            delay(ground_accelerometer.bandwidth, &ground_accelerometer.sampling),
        ];
        let block_delay = delay(block_accelerometer.bandwidth, &block_accelerometer.sampling);
        let noisy = |sensor: &Inertial| sensor.noise_density > 0.0 || sensor.resolution > 0.0;
        let tracking = if noisy(ground_accelerometer) { TRACKING } else { 0.0 };
        let instruments = Instruments::new(period, encoder.resolution / size, delays, tracking)?;

        let ideal_encoder = encoder.resolution <= 1e-8;
        let of_encoder = if ideal_encoder { 0.0 } else { square(encoder.resolution / size) / 12.0 };
        let of_gyroscope = variance(gyroscope, period);
        let of_forces = (variance(block_accelerometer, period) + variance(ground_accelerometer, period)) / (size * size);
        // One reading in τ_t/T counts in a tracked value: (1 − e)(1 + 4e + 5e²)/(1 + e)³ of the variance (Morrison 1969) with e = e^(−T/τ).
        let fading = |constant: f64| {
            let e = if constant > 0.0 { math::exp(-period / constant) } else { 0.0 };
            (1.0 - e) * (1.0 + 4.0 * e + 5.0 * e * e) / ((1.0 + e) * (1.0 + e) * (1.0 + e))
        };
        let ground = math::square_root(variance(ground_accelerometer, period) * fading(tracking)) / GRAVITY;
        let blank = |delay: f64, noisy: bool| {
            let time = if noisy { 2.0 * delay + shock } else { 0.0 };
            (time / period).ceil() as u16
        };
        let failed = ParameterError { parameter: "estimator gains", value: f64::NAN, range: "solvable" };
        let wrong = |share: f64| 2.0 * MODEL_TIME * square(share * weight);
        let jump = |deviation: f64| (0.1 * p * block.slenderness()).max(8.0 * deviation) as f32;
        let standing = |rotation: f64, velocity: f64| Standing {
            rotation: (STANDING_COUNTS * encoder.resolution / size + 4.0 * rotation) as f32,
            velocity: (1e-9 + 6.0 * velocity) as f32,
            ticks: (STILL / period).clamp(4.0, 60_000.0) as u16,
        };
        let deviation = |rotation: f64, velocity: f64, push: f64| Deviation {
            rotation: rotation as f32,
            velocity: velocity as f32,
            push: push as f32,
            ground: ground as f32,
        };
        let estimator = match name {
            EstimatorName::ModelAided => {
                let (transition, process) = two_states(wrong(model_error), period);
                let (measurement, noise) = (SMatrix::identity(), SVector::<f64, 2>::new(of_encoder, of_gyroscope));
                let (gains, covariance) = Tracking { transition, process, measurement, noise }.steady().ok_or(failed)?;
                let [rotation, velocity] = [0, 1].map(|i| math::square_root(covariance[(i, i)].max(0.0)));
                // A block must also be found to stand when its encoder is lost: by what the gyroscope alone leaves of the velocity.
                let one = SMatrix::<f64, 1, 1>::identity();
                let (process, noise) = (one * process[(1, 1)], SVector::<f64, 1>::new(of_gyroscope));
                let alone = Tracking { transition: one, process, measurement: one, noise }.steady().ok_or(failed)?.1;
                let still = velocity.max(math::square_root(alone[0].max(0.0)));
                Estimator::ModelAided(ModelAided {
                    gains: [[gains[(0, 0)] as f32, gains[(0, 1)] as f32], [gains[(1, 0)] as f32, gains[(1, 1)] as f32]],
                    blank: blank(delays[0], noisy(gyroscope)),
                    jump: jump(math::square_root(of_gyroscope)),
                    standing: standing(rotation, still),
                    deviation: deviation(rotation, velocity, p * p * (ground + rotation)),
                })
            }
            EstimatorName::Kalman => {
                let t = period;
                let density = 2.0 * JERK_TIME * square(p * p * JERK);
                let mut transition = SMatrix::<f64, 4, 4>::identity();
                (transition[(0, 1)], transition[(0, 2)], transition[(1, 2)]) = (t, t * t / 2.0, t);
                let mut process = SMatrix::<f64, 4, 4>::zeros();
                // ∫ of white jerk: t^(5−i−j)/((2−i)!(2−j)!(5−i−j)).
                let factorial = [2.0, 1.0, 1.0];
                for i in 0..3 {
                    for j in 0..3 {
                        let power = (5 - i - j) as f64;
                        process[(i, j)] = density * math::pow(t, power) / (factorial[i] * factorial[j] * power);
                    }
                }
                process[(3, 3)] = if noisy(gyroscope) { BIAS_WALK * BIAS_WALK * t } else { 0.0 };
                let mut measurement = SMatrix::<f64, 3, 4>::zeros();
                (measurement[(0, 0)], measurement[(1, 1)], measurement[(2, 2)], measurement[(1, 3)]) = (1.0, 1.0, 1.0, 1.0);
                let noise = SVector::<f64, 3>::new(of_encoder, of_gyroscope, of_forces);
                let (gains, covariance) = Tracking { transition, process, measurement, noise }.steady().ok_or(failed)?;
                let of = |i: usize| math::square_root(covariance[(i, i)].max(0.0));
                let row = |i: usize| [gains[(i, 0)] as f32, gains[(i, 1)] as f32, gains[(i, 2)] as f32];
                Estimator::Kalman(Kalman {
                    gains: [row(0), row(1), row(2), row(3)],
                    blank: blank(delays[0].max(delays[2]).max(block_delay), noisy(gyroscope) || noisy(block_accelerometer)),
                    jump: jump(math::square_root(of_gyroscope)),
                    standing: standing(of(0), of(1)),
                    deviation: deviation(of(0), of(1), of(2)),
                })
            }
            EstimatorName::Complementary => {
                let (transition, process) = two_states(wrong(ACCELERATION_ERROR) + of_forces * period, period);
                let measurement = SMatrix::<f64, 1, 2>::new(1.0, 0.0);
                let noise = SVector::<f64, 1>::new(of_encoder);
                let (gains, covariance) = Tracking { transition, process, measurement, noise }.steady().ok_or(failed)?;
                let [rotation, velocity] = [0, 1].map(|i| math::square_root(covariance[(i, i)].max(0.0)));
                let noisy = noisy(block_accelerometer) || noisy(ground_accelerometer);
                let smoothing = if noisy { 1.0 - math::exp(-period / TRACKING) } else { 1.0 };
                Estimator::Complementary(Complementary {
                    gains: [gains[0] as f32, gains[1] as f32],
                    smoothing: smoothing as f32,
                    blank: blank(delays[2].max(block_delay), noisy),
                    standing: standing(rotation, velocity),
                    deviation: deviation(rotation, velocity, math::square_root(of_forces * smoothing / (2.0 - smoothing))),
                })
            }
        };
        Ok(SensorDesign { instruments, estimator })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::preset::{SUITES, find};
    use sprag_shared::structure::Restitution;
    use sprag_shared::structure::block::Block;
    use sprag_shared::structure::device::{Device, DeviceKind};

    /// A shock of 1 ms is in a second-order low-pass of 20 Hz for its delay of √2/(2π 20 Hz) = 11.25 ms, and as long again until it has left it.
    #[test]
    fn no_estimator_believes_a_block_accelerometer_before_the_shock_has_left_its_low_pass() {
        let device = Device { kind: DeviceKind::ClutchedPair, mass_ratio: 0.5, ..Device::NONE };
        let structure =
            Structure { device, ..Structure::new(Block::new(2.0, 0.2, 4.0 / 3.0).unwrap(), Restitution::Constant(0.85)) };
        let suite = find(SUITES, "adis16470").unwrap();
        let sampling = Sampling { rate: 0.0, latency: 0.0, ..suite.block_accelerometer.sampling };
        let slow = Suite { block_accelerometer: Inertial { bandwidth: 20.0, sampling, ..suite.block_accelerometer }, ..suite };
        for name in [EstimatorName::Kalman, EstimatorName::Complementary] {
            let blank = |suite: &Suite| match SensorDesign::new(&structure, suite, name, 5e-4, 1e-3, 0.02).unwrap().estimator {
                Estimator::Kalman(Kalman { blank, .. }) | Estimator::Complementary(Complementary { blank, .. }) => blank,
                Estimator::ModelAided(_) => 0,
            };
            // Ticks of 0.5 ms.
            assert_eq!(blank(&slow), 48, "{name:?}");
            assert!(blank(&suite) < 10, "{name:?}");
        }
    }
}
