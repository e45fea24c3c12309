//! White noise of an inertial axis, as it leaves the sensor's low-pass filter.

use std::f64::consts::{PI, SQRT_2};

use sprag_shared::math;

use super::low_pass::{LowPass, State};
use super::random::Random;

/// Equivalent noise bandwidth of a Butterworth filter of second order over its corner frequency: π/(2√2) = 1.1107.
pub const NOISE_BANDWIDTH_RATIO: f64 = PI / (2.0 * SQRT_2);

/// Noise of a one-sided density N (unit/√Hz), as data sheets give it. Averages over τ then have the variance N²/(2τ), so the angle or
/// velocity random walk of IEEE Std 952-1997, Annex C, is N/√2.
///
/// - through a low-pass with corner f_c, as it is at the sampling instants: σ = N √(π f_c/(2√2)), whatever the sampling rate is. What
///   lies above half the rate is folded down, as in a real sensor that is read out more slowly than it moves;
/// - without a low-pass, over the band up to half the sampling rate: σ = N √(rate/2), independent from reading to reading;
/// - with neither, none: it would have no bound.
///
/// The noise is generated reading by reading, at the instants without jitter, so the noise of a reading depends on its number only.
#[derive(Clone, Debug)]
pub(super) struct Noise {
    /// σ of the output.
    deviation: f64,
    filter: Option<LowPass>,
    /// The filter's state under noise of variance 1.
    state: State,
    random: Random,
    span: f64,
    transition: [[f64; 2]; 2],
    /// Lower triangular root of what the noise adds to the state's covariance over the span.
    root: [f64; 3],
}

/// σ of the output of a sensor with noise of `density` (unit/√Hz).
pub fn output_deviation(density: f64, bandwidth: f64, rate: f64) -> f64 {
    if bandwidth > 0.0 {
        density * math::square_root(NOISE_BANDWIDTH_RATIO * bandwidth)
    } else {
        density * math::square_root(0.5 * rate)
    }
}

impl Noise {
    /// Noise of `density` (unit/√Hz) under a filter of `bandwidth` (Hz, 0 for none), read at `rate` (Hz, 0 for continuously).
    pub(super) fn new(density: f64, bandwidth: f64, rate: f64, mut random: Random) -> Noise {
        let deviation = output_deviation(density, bandwidth, rate);
        let filter = (bandwidth > 0.0).then(|| LowPass::new(bandwidth));
        // Stationary under white noise: value and ẏ/σ are independent, of variance 1 and 2.
        let state = if deviation > 0.0 && filter.is_some() {
            State { value: random.normal(), slope: SQRT_2 * random.normal() }
        } else {
            State::default()
        };
        Noise { deviation, filter, state, random, span: f64::NAN, transition: [[0.0; 2]; 2], root: [0.0; 3] }
    }

    fn prepare(&mut self, span: f64) {
        let Some(filter) = &mut self.filter else { return };
        self.span = span;
        self.transition = filter.transition(span);
        // Q = P − Φ P Φᵀ with the stationary P = diag(1, 2).
        let [[a, b], [c, d]] = self.transition;
        let (first, mixed, second) = (1.0 - a * a - 2.0 * b * b, -(a * c + 2.0 * b * d), 2.0 - c * c - 2.0 * d * d);
        let root = math::square_root(first.max(0.0));
        let below = if root > 0.0 { mixed / root } else { 0.0 };
        self.root = [root, below, math::square_root((second - below * below).max(0.0))];
    }

    /// The noise `span` (s) after the last one.
    #[inline]
    pub(super) fn next(&mut self, span: f64) -> f64 {
        if self.deviation == 0.0 {
            return 0.0;
        }
        if self.filter.is_none() {
            return self.deviation * self.random.normal();
        }
        if span > 0.0 {
            if span != self.span {
                self.prepare(span);
            }
            let (first, second) = (self.random.normal(), self.random.normal());
            let ([[a, b], [c, d]], State { value, slope }) = (self.transition, self.state);
            self.state = State {
                value: a * value + b * slope + self.root[0] * first,
                slope: c * value + d * slope + self.root[1] * first + self.root[2] * second,
            };
        }
        self.deviation * self.state.value
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::Purpose;
    use super::*;

    fn noise(density: f64, bandwidth: f64, rate: f64) -> Noise {
        Noise::new(density, bandwidth, rate, Random::new(1, 0, Purpose::Noise))
    }

    /// Standard deviation, and correlation from one reading to the next.
    fn statistics(noise: &mut Noise, span: f64, count: u32) -> (f64, f64) {
        let (mut square, mut product, mut last) = (0.0, 0.0, 0.0);
        for _ in 0..count {
            let value = noise.next(span);
            square += value * value;
            product += value * last;
            last = value;
        }
        ((square / f64::from(count)).sqrt(), product / square)
    }

    #[test]
    fn the_deviation_is_density_times_root_of_bandwidth_at_any_rate() {
        assert!((NOISE_BANDWIDTH_RATIO - 1.110_720_7).abs() < 1e-7);
        for rate in [500.0, 2000.0, 8000.0, 100_000.0] {
            let (deviation, correlation) = statistics(&mut noise(3e-3, 200.0, rate), 1.0 / rate, 2_000_000);
            let expected = 3e-3 * (1.110_720_7_f64 * 200.0).sqrt();
            assert!((deviation / expected - 1.0).abs() < 0.015, "{rate}: {deviation} {expected}");
            // Autocorrelation of filtered white noise: exp(−σt)(cos σt + sin σt).
            let x = 2.0 * PI * 200.0 / SQRT_2 / rate;
            let expected = math::exp(-x) * (math::cos(x) + math::sin(x));
            assert!((correlation - expected).abs() < 0.005, "{rate}: {correlation} {expected}");
        }
    }

    #[test]
    fn without_a_filter_the_band_ends_at_half_the_rate() {
        let (deviation, correlation) = statistics(&mut noise(0.01, 0.0, 800.0), 1.0 / 800.0, 1_000_000);
        assert!((deviation / 0.2 - 1.0).abs() < 0.005, "{deviation}");
        assert!(correlation.abs() < 0.005);
        assert_eq!(noise(0.01, 0.0, 0.0).next(1e-3), 0.0);
    }

    #[test]
    fn the_spectrum_is_flat_at_the_density_below_the_corner() {
        // Averages over 0.1 s hold what lies below some 5 Hz: their variance is N²/(2 · 0.1 s).
        let mut noise = noise(0.02, 500.0, 2000.0);
        let averages = 20_000;
        let square: f64 = (0..averages)
            .map(|_| (0..200).map(|_| noise.next(5e-4)).sum::<f64>() / 200.0)
            .map(|average| average * average / f64::from(averages))
            .sum();
        assert!((square / (0.02_f64 * 0.02 / 0.2) - 1.0).abs() < 0.05, "{square}");
    }

    #[test]
    fn irregular_spans_keep_the_deviation() {
        let mut noise = noise(1.0, 300.0, 0.0);
        let mut square = 0.0;
        for index in 0..1_000_000_u32 {
            let value = noise.next(1e-4 + 1e-5 * f64::from(index % 37));
            square += value * value / 1e6;
        }
        assert!((square / (1.110_720_7 * 300.0) - 1.0).abs() < 0.02, "{square}");
    }
}
